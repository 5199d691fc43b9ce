"""Measured relaxation: from storage and loss modulus (DMA) to a Prony series, and from that to the foundation."""

from .fit import FitWarning, fit_prony
from .isotherms import read_isotherms
from .master import MasterCurve, master_curve
from .modulus import DynamicModulus
from .plausibility import DataWarning
from .read import read_dma
from .series import Foundation, PronySeries

__all__ = [
    "DataWarning",
    "DynamicModulus",
    "FitWarning",
    "Foundation",
    "MasterCurve",
    "PronySeries",
    "fit_prony",
    "master_curve",
    "read_dma",
    "read_isotherms",
]

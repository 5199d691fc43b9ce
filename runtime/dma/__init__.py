"""Measured relaxation: from storage and loss modulus (DMA) to a Prony series, and from that to the foundation."""

from .fit import fit_prony
from .read import DynamicModulus, read_dma
from .series import Foundation, PronySeries

__all__ = ["DynamicModulus", "Foundation", "PronySeries", "fit_prony", "read_dma"]

"""Measured relaxation: from storage and loss modulus (DMA) to a Prony series, and from that to the foundation."""

from hystrip.dma.fit import fit_prony
from hystrip.dma.read import DynamicModulus, read_dma
from hystrip.dma.series import Foundation, PronySeries

__all__ = ["DynamicModulus", "Foundation", "PronySeries", "fit_prony", "read_dma"]

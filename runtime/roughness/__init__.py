"""Measured roughness: from the heights of a scan to the levels of a surface."""

from .levels import RoughnessLevels, levels_of
from .read import read_surface
from .scan import Scan, ScanWarning

__all__ = ["RoughnessLevels", "Scan", "ScanWarning", "levels_of", "read_surface"]

"""Measured roughness: from the heights of a scan to the levels of a surface."""

from .levels import RoughnessLevels, levels_of
from .read import ScanWarning, read_surface
from .scan import Scan

__all__ = ["RoughnessLevels", "Scan", "ScanWarning", "levels_of", "read_surface"]

"""Measured roughness: from the heights of a scan to the levels of a surface."""

from .levels import RoughnessLevels, levels_of
from .read import read_surface
from .scan import Scan

__all__ = ["RoughnessLevels", "Scan", "levels_of", "read_surface"]

"""Measured roughness: from the heights of a scan to the levels of a surface."""

from hystrip.roughness.levels import RoughnessLevels, levels_of
from hystrip.roughness.read import read_surface
from hystrip.roughness.scan import Scan

__all__ = ["RoughnessLevels", "Scan", "levels_of", "read_surface"]

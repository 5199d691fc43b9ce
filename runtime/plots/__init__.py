"""Pictures. They need the extra ``plot`` (matplotlib), and no display."""

from hystrip.plots.law import law_over_pressure
from hystrip.plots.modulus import fitted_modulus
from hystrip.plots.roughness import roughness_levels
from hystrip.plots.strip import strip_fields
from hystrip.plots.style import save
from hystrip.plots.velocity import friction

__all__ = ["fitted_modulus", "friction", "law_over_pressure", "roughness_levels", "save", "strip_fields"]

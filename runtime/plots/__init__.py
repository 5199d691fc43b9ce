"""Pictures. They need the extra ``plot`` (matplotlib), and no display."""

from .friction import friction
from .law import law_over_pressure
from .modulus import fitted_modulus
from .roughness import roughness_levels
from .strip import strip_fields
from .style import save

__all__ = ["fitted_modulus", "friction", "law_over_pressure", "roughness_levels", "save", "strip_fields"]

"""Pictures. They need the extra ``plot`` (matplotlib), and no display."""

from hystrip.plots.law import law_over_pressure
from hystrip.plots.strip import strip_fields
from hystrip.plots.style import save
from hystrip.plots.velocity import friction

__all__ = ["friction", "law_over_pressure", "save", "strip_fields"]

"""Pictures. They need the extra ``plot`` (matplotlib), and no display."""

from hystrip.plots.style import save
from hystrip.plots.velocity import friction_over_velocity

__all__ = ["friction_over_velocity", "save"]

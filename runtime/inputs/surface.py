"""One level of the surface."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .checks import number


@dataclass(frozen=True)
class Level:
    """One level of waviness: ``f = h - (h/4)(cos kx + 1)(cos ky + 1)``, ``k = 2 pi/l`` (Eq. 4).

    Parameters
    ----------
    l : wavelength, m, > 0
    h : height, m, >= 0

    Raises ``InputError`` for a value outside these ranges.

    >>> round(Level(l=10e-6, h=1e-6).k)
    628319
    """

    l: float  # noqa: E741 - the paper's symbol
    h: float

    def __post_init__(self):
        object.__setattr__(self, "l", number("level.l", self.l, "m", 0, strict=True))
        object.__setattr__(self, "h", number("level.h", self.h, "m", 0))

    @property
    def k(self) -> float:
        """Wave number, 1/m."""
        return 2 * np.pi / self.l

    def amplitude(self, theta):
        """Amplitude A of the strip at ``theta = k y`` (Eq. 8), m: zero at ``theta = pi``."""
        return 0.5 * self.h * np.cos(0.5 * theta) ** 2

    def drop(self, theta):
        """Depth by which the strip's crest lies below the level's, ``(h/2)(1 - cos ky)`` (Eq. 8), m."""
        return self.h * np.sin(0.5 * theta) ** 2

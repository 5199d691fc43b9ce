"""One level of the surface."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ..numerics.rounding import LARGEST
from .checks import number, numbers

if TYPE_CHECKING:
    from ..typing import Floats, Numbers


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

    @property
    def is_flat(self) -> bool:
        """Whether there is no wave to speak of: friction goes with ``k h^2``, and this one's is below any number."""
        return self.k * self.h**2 <= 1 / LARGEST

    @property
    def mean_plane(self) -> float:
        """Depth of the mean plane below the crests, m: in complete contact ``p = K (D - mean_plane)`` (derivation:
        ``level.saturation``)."""
        return 0.75 * self.h

    def amplitude(self, theta: Numbers) -> Floats:
        """Amplitude A of the strip at ``theta = k y`` (Eq. 8), m: zero at ``theta = pi``."""
        return 0.5 * self.h * np.cos(np.multiply(0.5, theta)) ** 2

    def drop(self, theta: Numbers) -> Floats:
        """Depth by which the strip's crest lies below the level's, ``(h/2)(1 - cos ky)`` (Eq. 8), m."""
        return self.h * np.sin(np.multiply(0.5, theta)) ** 2

    def strip(self, y: Numbers, D: Numbers) -> tuple[Floats, Floats]:
        """Amplitude A and penetration D_j of the strip at ``y`` (m) where the level is pressed in by ``D`` (m) (Eq. 8), m.

        ``solve_strip(..., l=level.l, A=A, D=D_j)`` solves it. Raises ``InputError`` for what is no number.

        >>> A, D_j = Level(l=10e-6, h=1e-6).strip(y=2.5e-6, D=6e-7)
        >>> print(f"{A:.3g} {D_j:.3g}")
        2.5e-07 1e-07
        """
        theta = self.k * numbers("y", y, "m")
        return self.amplitude(theta), numbers("D", D, "m") - self.drop(theta)

    def profile(self, x: Numbers, y: Numbers) -> Floats:
        """Height f of the gap between the level's crest and its surface at (x, y), m (Eq. 4): zero at crests, h in valleys.

        >>> round(float(Level(l=10e-6, h=1e-6).profile(5e-6, 0.0)), 9)
        1e-06
        """
        x, y = numbers("x", x, "m"), numbers("y", y, "m")
        return self.h * (1 - np.cos(0.5 * self.k * x) ** 2 * np.cos(0.5 * self.k * y) ** 2)

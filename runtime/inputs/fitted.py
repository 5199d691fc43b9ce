"""How well a material's series fits what was measured, and over which frequencies."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from ..errors import InputError
from .checks import numbers

#: rms of the relative residuals above which a fit is called poor
POOR = 0.1


@dataclass(frozen=True)
class FittedBand:
    """Frequencies over which a series was fitted, in parts, and its error in each.

    Parameters
    ----------
    edges : frequencies that bound the parts, Hz, > 0, ascending, n + 1 of them
    rms : root mean square of the relative residuals of storage and loss modulus in each part, n of them

    Raises ``InputError`` for anything else.
    """

    edges: tuple[float, ...]
    rms: tuple[float, ...]

    def __post_init__(self):
        edges = numbers("fit.edges", self.edges, "Hz", 0, strict=True)
        rms = numbers("fit.rms", self.rms, "", 0)
        if edges.ndim != 1 or edges.size < 2 or (np.diff(edges) <= 0).any():
            raise InputError("fit.edges", self.edges, "two ascending frequencies or more (Hz)")
        if rms.shape != (edges.size - 1,):
            raise InputError("fit.rms", self.rms, f"{edges.size - 1} numbers, one for each part between the edges")
        object.__setattr__(self, "edges", tuple(edges.tolist()))
        object.__setattr__(self, "rms", tuple(rms.tolist()))

    @classmethod
    def of_residuals(cls, frequency: Any, residuals: Any) -> FittedBand:
        """From frequencies (n,), Hz, ascending, and relative residuals (2, n), in parts of about a decade."""
        f, squares = np.asarray(frequency), np.mean(np.square(residuals), axis=0)
        parts = max(int(round(np.log10(f[-1] / f[0]))), 1)
        edges = np.geomspace(f[0], f[-1], parts + 1)
        at = np.clip(np.searchsorted(edges, f, side="right") - 1, 0, parts - 1)
        counts, sums = np.bincount(at, minlength=parts), np.bincount(at, squares, minlength=parts)
        keep = counts > 0  # the last frequency stands in the last part, the first in the first
        bounds = [edges[0], *edges[1:][keep]]
        return cls(tuple(bounds), tuple(np.sqrt(sums[keep] / counts[keep])))

    @property
    def low(self) -> float:
        """Lowest frequency fitted, Hz."""
        return self.edges[0]

    @property
    def high(self) -> float:
        """Highest frequency fitted, Hz."""
        return self.edges[-1]

    def moved(self, factor: float) -> FittedBand:
        """The band at ``factor`` times the frequency."""
        return FittedBand(tuple(factor * each for each in self.edges), self.rms)

    def error_between(self, low: float, high: float) -> float | None:
        """The largest error of a part that overlaps ``low`` to ``high``, Hz; None if none does."""
        parts = zip(self.edges, self.edges[1:], self.rms, strict=False)
        met = [rms for start, end, rms in parts if start <= high and end >= low]
        return max(met, default=None)


def check_fit(value: Any) -> None:
    """``InputError`` unless ``value`` is a band or None."""
    if value is not None and not isinstance(value, FittedBand):
        raise InputError("material.fit", value, "None, or the fit of a hystrip.dma.PronySeries")

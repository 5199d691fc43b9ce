"""Heights on a grid, and how their variance is spread over wave numbers."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from ..errors import InputError
from ..inputs.checks import numbers


@dataclass(frozen=True, eq=False)
class Scan:
    """Measured heights on an even grid.

    Parameters
    ----------
    heights : m, shape (n,) for a line or (n, m) for an area, at least 8 points in each direction
    sizes : length of the scan in each direction, m, > 0: the number of points times their distance
    periodic : the scan is one period of a periodic surface: neither trend nor window is needed

    Raises
    ------
    InputError : a value outside its range, or shapes that do not fit
    """

    heights: np.ndarray
    sizes: tuple[float, ...]
    periodic: bool = False

    def __post_init__(self):
        heights = numbers("scan.heights", self.heights, "m")
        sizes = np.atleast_1d(numbers("scan.sizes", self.sizes, "m", 0, strict=True))
        if heights.ndim not in (1, 2) or min(heights.shape) < 8:
            raise InputError("scan.heights", heights.shape, "shape (n,) or (n, m) with at least 8 points in each direction")
        if sizes.shape != (heights.ndim,):
            raise InputError("scan.sizes", self.sizes, f"{heights.ndim} numbers, one for each direction of the heights")
        object.__setattr__(self, "heights", heights)
        object.__setattr__(self, "sizes", tuple(sizes.tolist()))

    @property
    def longest(self) -> float:
        """Longest wavelength resolved in every direction, m: the scan's shorter side, half of it unless periodic."""
        return min(self.sizes) * (1.0 if self.periodic else 0.5)

    @property
    def shortest(self) -> float:
        """Four points of the coarser direction, m: few instruments resolve less."""
        return 4 * max(size / n for size, n in zip(self.sizes, self.heights.shape, strict=True))

    def spectrum(self) -> tuple[np.ndarray, np.ndarray]:
        """Wave number, rad/m, and share of the variance, m^2, of each Fourier mode but the constant; both (modes,).

        Unless the scan is periodic its least-squares plane (line) is subtracted and it is tapered by a Hann window in
        each direction, scaled so that the variance of a stationary roughness stays what it is.
        """
        heights = self.heights - self.heights.mean() if self.periodic else _tapered(self.heights)
        variance = np.abs(np.fft.fftn(heights) / heights.size) ** 2
        axes = [2 * np.pi * np.fft.fftfreq(n, size / n) for n, size in zip(heights.shape, self.sizes, strict=True)]
        q = np.sqrt(sum(np.square(each) for each in np.meshgrid(*axes, indexing="ij")))
        return q.ravel()[1:], variance.ravel()[1:]


def _tapered(heights: np.ndarray) -> np.ndarray:
    grids: list[Any] = np.meshgrid(*(np.linspace(-1, 1, n) for n in heights.shape), indexing="ij")
    rows = np.stack([np.ones(heights.size), *(grid.ravel() for grid in grids)], axis=1)
    trend, *_ = np.linalg.lstsq(rows, heights.ravel(), rcond=None)
    window = np.ones(heights.shape)
    for axis, n in enumerate(heights.shape):
        hann = np.sin(np.pi * (np.arange(n) + 0.5) / n) ** 2
        shape = [1] * heights.ndim
        shape[axis] = n
        window = window * (hann / np.sqrt(np.mean(hann**2))).reshape(shape)
    return (heights - (rows @ trend).reshape(heights.shape)) * window

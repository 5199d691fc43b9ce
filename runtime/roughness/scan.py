"""Heights on a grid, and how their variance is spread over wave numbers."""

import warnings
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..errors import InputError
from ..inputs.checks import number, numbers, truth

#: standard deviations of the others by which a value that several points share is off if it marks what was not measured
_FAR = 20
#: share of the points that have one height, and times as many as have any other, from which it may mark what was not measured: if
#: steps to it are so many times those between others, or, where it is zero, if it is shared by more than that
_SHARED, _OFTEN, _STEP, _ZEROS = 1e-3, 5, 3, 0.02
#: points that such a height is looked for among: sorting all of them takes as long as their spectrum
_LOOKED_AT = 1_000_000


class ScanWarning(UserWarning):
    """A scan of which a good part was not measured, or may not have been. Says how much."""


@dataclass(frozen=True, eq=False)
class Scan:
    """Measured heights on an even grid.

    Parameters
    ----------
    heights : m, shape (n,) for a line or (n, m) for an area, at least 8 points in each direction
    sizes : length of the scan in each direction, m, > 0: the number of points times their distance
    periodic : the scan is one period of a periodic surface: neither trend nor window is needed
    filled : share of the points that were not measured, from 0 to 1; their heights have been made up
    units : what lengths and heights were taken to be in, as text; empty where none had to be found out

    Raises
    ------
    InputError : a value outside its range, or shapes that do not fit; heights that differ by more than the scan is long;
        one height far off that several points share, which marks points that were not measured

    Warns (:class:`ScanWarning`) of one height that many points share, though it is not far off, as where 0 marks such points.
    """

    heights: np.ndarray
    sizes: tuple[float, ...]
    periodic: bool = False
    filled: float = 0.0
    units: str = ""

    def __post_init__(self):
        heights = numbers("scan.heights", self.heights, "m")
        sizes = np.atleast_1d(numbers("scan.sizes", self.sizes, "m", 0, strict=True))
        if heights.ndim not in (1, 2) or min(heights.shape) < 8:
            raise InputError("scan.heights", heights.shape, "shape (n,) or (n, m) with at least 8 points in each direction")
        if sizes.shape != (heights.ndim,):
            raise InputError("scan.sizes", self.sizes, f"{heights.ndim} numbers, one for each direction of the heights")
        periodic = truth("scan.periodic", self.periodic)
        filled = number("scan.filled", self.filled, "", 0)
        if filled > 1:
            raise InputError("scan.filled", self.filled, "a share from 0 to 1")
        _refuse_marks(heights)
        _remark_on_marks(heights)
        if np.ptp(heights) > sizes.max():
            what = f"heights that differ by {np.ptp(heights):.4g} m on a scan of {sizes.max():.4g} m"
            allowed = f"heights that differ by less than that: check the units{_after(self.units)}"
            if "as given" in self.units:  # --unit is one for both
                allowed += "; heights in another unit: --height-factor 1e-3 for nm with --unit um, "
                allowed += "or in text a line above: # Value units: nm"
            raise InputError("scan.heights", what, allowed)
        object.__setattr__(self, "heights", heights)
        object.__setattr__(self, "periodic", periodic)
        object.__setattr__(self, "sizes", tuple(sizes.tolist()))

    def report(self) -> str:
        """Points, lengths, units and how much was made up, as text."""
        points, lengths = (" x ".join(f"{each:.6g}" for each in of) for of in (self.heights.shape, self.sizes))
        filled = f"; {100 * self.filled:.2g} % of the points were undefined and are filled" if self.filled else ""
        return f"scan: {points} points, {lengths} m{_after(self.units)}{filled}"

    @property
    def longest(self) -> float:
        """Longest wavelength resolved in every direction, m: the scan's shorter side, half of it unless periodic."""
        return min(self.sizes) * (1.0 if self.periodic else 0.5)

    @property
    def shortest(self) -> float:
        """Four points of the coarser direction, m: few instruments resolve less."""
        return 4 * max(size / n for size, n in zip(self.sizes, self.heights.shape, strict=True))

    def spectrum(self) -> tuple[np.ndarray, np.ndarray]:
        """Wave vectors of the Fourier modes but the constant, and their shares of the variance.

        Unless the scan is periodic its least-squares plane (line) is subtracted and it is tapered by a Hann window in
        each direction, scaled so that the variance of a stationary roughness stays what it is.

        Returns
        -------
        magnitudes of the components along each direction, rad/m, (directions, modes); shares, m^2, (modes,)
        """
        heights = self.heights - self.heights.mean() if self.periodic else _tapered(self.heights)
        variance = np.abs(np.fft.fftn(heights) / heights.size) ** 2
        axes = [2 * np.pi * np.abs(np.fft.fftfreq(n, size / n)) for n, size in zip(heights.shape, self.sizes, strict=True)]
        q = np.stack([each.ravel() for each in np.meshgrid(*axes, indexing="ij")])
        return q[:, 1:], variance.ravel()[1:]


def _after(units: str) -> str:
    return f" ({units})" if units else ""


def _refuse_marks(heights: np.ndarray) -> None:
    """Refuse a value such as -99999 in place of heights that were not measured."""
    ends = heights.min(), heights.max()
    others = heights[(heights != ends[0]) & (heights != ends[1])]
    for end in ends:
        shared = np.count_nonzero(heights == end)
        if others.size and shared > 1 and abs(end - others.mean()) > _FAR * others.std() > 0:
            what = f"{end:.6g} m at {shared} points, {abs(end - others.mean()) / others.std():.3g} standard deviations off"
            raise InputError("scan.heights", what, "heights that were measured; points that were not are nan in a file")


def _remark_on_marks(heights: np.ndarray) -> None:
    """Warn of one height that points share as no others do, with steps to it as nowhere else; or of many that are zero."""
    some = heights.ravel()[:: 1 + heights.size // _LOOKED_AT]
    values, counts = np.unique(some, return_counts=True)
    if values.size < 3:
        return
    second, most = np.partition(counts, -2)[-2:]
    if most < max(_SHARED * some.size, _OFTEN * second):
        return
    value = values[np.argmax(counts)]
    at = heights == value
    share = at.mean()
    steps = np.concatenate([np.abs(np.diff(heights, axis=axis)).ravel() for axis in range(heights.ndim)])
    border = np.concatenate([np.diff(at, axis=axis).ravel() for axis in range(heights.ndim)])
    others = steps[~border & (steps > 0)]
    steep = not others.size or np.median(steps[border]) > _STEP * np.median(others)
    if steep or (value == 0 and share > _ZEROS):
        said = f"{100 * share:.2g} % of the points are at exactly {value:.6g} m, and at no other height a fifth as many"
        allowed = "if it marks what was not measured, levels come out wrong; such points are nan in a file"
        warnings.warn(f"scan.heights: {said}: {allowed}", ScanWarning, stacklevel=4)


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

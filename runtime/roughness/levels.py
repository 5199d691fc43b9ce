"""The rule by which the power spectrum of a measured surface becomes levels of waviness."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from ..errors import InputError
from ..inputs.checks import choice, number, numbers
from ..inputs.surface import Level
from .scan import Scan

#: variance of Eq. 4 over h^2: the mean square of ``(cos + 1)(cos + 1)/4`` less the square of its mean
VARIANCE = 5 / 64
#: mean square gradient of Eq. 4 over its variance and k^2
GRADIENT = 6 / 5

_WAVELENGTHS = ("gradient", "centre")
#: a band with a smaller part of the variance is empty
_NOTHING = 1e-12


@dataclass(frozen=True, eq=False)
class RoughnessLevels:
    """Levels that stand for a measured surface, and what they were made from.

    Attributes
    ----------
    levels : the largest first
    bands : wavelengths between which each level takes its share, m, shape (levels, 2), longest first
    rms_height : root mean square height in each band, m, (levels,); rms_gradient : the same of the gradient, (levels,)
    rms_left_out : root mean square height of everything that no level stands for, m
    """

    levels: tuple[Level, ...]
    bands: np.ndarray
    rms_height: np.ndarray
    rms_gradient: np.ndarray
    rms_left_out: float

    def report(self) -> str:
        """The levels and their bands, as text."""
        heads = ("level", "band [m]", "rms height [m]", "rms gradient", "l [m]", "h [m]")
        lines = [heads]
        for i, level in enumerate(self.levels):
            band = f"{self.bands[i, 0]:.3g} .. {self.bands[i, 1]:.3g}"
            rms = f"{self.rms_height[i]:.4g}", f"{self.rms_gradient[i]:.4g}"
            lines.append((str(i + 1), band, *rms, f"{level.l:.4g}", f"{level.h:.4g}"))
        widths = [max(len(line[j]) for line in lines) for j in range(len(heads))]
        table = ["  ".join(text.rjust(width) for text, width in zip(line, widths, strict=True)) for line in lines]
        return "\n".join([*table, f"left out: rms height {self.rms_left_out:.3g} m (beyond the bands)"])


def levels_of(
    scan: Scan,
    *,
    count: int | None = None,
    ratio: float | None = None,
    edges: Any = None,
    longest: float | None = None,
    shortest: float | None = None,
    wavelength: str = "gradient",
) -> RoughnessLevels:
    """Levels with the roughness of a scan.

    The rule: the range of wavelengths is cut into bands, one level for each. A band holds the Fourier modes of the
    heights (of an area: of all directions) whose wavelength lies in it; their variances add up to the square of its
    rms height, and weighted with the square of the wave number to the square of its rms gradient. The level's height
    is that at which the surface of Eq. 4 has the same rms height: Eq. 4 has the variance ``5 h^2/64``, so
    ``h = 8/sqrt(5) rms``. Its wavelength is that at which Eq. 4 has the same rms gradient too: its mean square
    gradient is ``6/5 k^2`` times its variance. So a surface that is made of levels, each inside its band, gives just
    these. A line is taken as a cut through an isotropic surface: the same variance, half the mean square gradient.

    Parameters
    ----------
    scan : what was measured
    count : number of bands, equal on a logarithmic scale, an integer from 1 to 20; 2 if neither this nor one of the
        next two is given. Levels are solved as if far apart in wavelength, and three in partial contact already take
        long
    ratio : in place of that, the ratio of the wavelengths that bound a band, > 1; a narrower rest goes to the last band
    edges : in place of that, and of the next two, all wavelengths that bound bands, m, at least two
    longest, shortest : the range, m; by default ``scan.longest`` and ``scan.shortest``
    wavelength : ``"gradient"``, as said above, or ``"centre"``, the geometric mean of the band's bounds

    A band with less than 1e-12 of the variance gives no level.

    Raises
    ------
    InputError : an argument out of range, or a scan without roughness in the range

    Examples
    --------
    >>> import numpy as np
    >>> x = np.arange(128) * (4e-6 / 128)
    >>> wave = np.cos(2 * np.pi * x / 1e-6) + 1
    >>> scan = Scan(3e-7 - 3e-7 / 4 * np.multiply.outer(wave, wave), (4e-6, 4e-6), periodic=True)
    >>> level, = levels_of(scan, count=1).levels
    >>> print(f"{level.l:.6g} {level.h:.6g}")
    1e-06 3e-07
    """
    choice("wavelength", wavelength, _WAVELENGTHS)
    given = {"count": count, "ratio": ratio, "edges": edges}
    if sum(each is not None for each in given.values()) > 1:
        raise InputError("count, ratio, edges", {k: v for k, v in given.items() if v is not None}, "one of the three")
    bounds = _listed(edges, longest, shortest) if edges is not None else _spread(scan, count, ratio, longest, shortest)
    q, variance = scan.spectrum()
    total = variance.sum()
    # a mode on a bound belongs to the band of shorter waves, on the last one to the last band, whatever rounding says
    at = np.searchsorted(2 * np.pi / bounds * (1 - 1e-9), q, side="right") - 1
    at[(at == bounds.size - 1) & (q <= 2 * np.pi / bounds[-1] * (1 + 1e-9))] -= 1
    inside = (at >= 0) & (at < bounds.size - 1)
    add = lambda weight: np.bincount(at[inside], weight[inside], minlength=bounds.size - 1)  # noqa: E731
    height2 = add(variance)
    # of a surface's mean square gradient a cut sees half
    gradient2 = add(variance * q**2) * (2 if scan.heights.ndim == 1 else 1)
    kept = np.flatnonzero(height2 > _NOTHING * total)
    if not kept.size:
        problem = f"no roughness between {bounds[0]:.3g} and {bounds[-1]:.3g} m"
        raise InputError("scan", problem, "bands in which there is some")
    bands = np.stack((bounds[:-1], bounds[1:]), axis=1)[kept]
    height2, gradient2 = height2[kept], gradient2[kept]
    k = np.sqrt(gradient2 / (GRADIENT * height2)) if wavelength == "gradient" else 2 * np.pi / np.sqrt(bands.prod(axis=1))
    levels = tuple(Level(l=2 * np.pi / each, h=np.sqrt(each2 / VARIANCE)) for each, each2 in zip(k, height2, strict=True))
    return RoughnessLevels(levels, bands, np.sqrt(height2), np.sqrt(gradient2), float(np.sqrt(max(total - height2.sum(), 0.0))))


def _listed(edges: Any, longest: Any, shortest: Any) -> np.ndarray:
    if longest is not None or shortest is not None:
        raise InputError("longest, shortest", (longest, shortest), "None where the edges are given")
    bounds = np.unique(np.atleast_1d(numbers("edges", edges, "m", 0, strict=True)))[::-1]
    if bounds.size < 2:
        raise InputError("edges", edges, "two different wavelengths or more (m)")
    return bounds


def _spread(scan: Scan, count: int | None, ratio: float | None, longest: Any, shortest: Any) -> np.ndarray:
    high = scan.longest if longest is None else number("longest", longest, "m", 0, strict=True)
    low = scan.shortest if shortest is None else number("shortest", shortest, "m", 0, strict=True)
    ends = 2 * min(size / n for size, n in zip(scan.sizes, scan.heights.shape, strict=True)), max(scan.sizes)
    for name, value in (("longest", high), ("shortest", low)):
        # as far as rounding of a size goes
        if not ends[0] * (1 - 1e-6) <= value <= ends[1] * (1 + 1e-6):
            raise InputError(name, value, f"a wavelength from {ends[0]:.4g} to {ends[1]:.4g} m: two points to the whole scan")
    if low >= high:
        raise InputError("longest, shortest", (high, low), "a longest wavelength above the shortest (m)")
    if ratio is not None:
        ratio = number("ratio", ratio, "", 1, strict=True)
        bands = max(int(np.log(high / low) / np.log(ratio) + 1e-9), 1)
        if bands > 20:
            raise InputError("ratio", ratio, "a ratio that gives at most 20 bands")
        return np.append(high / ratio ** np.arange(bands), low)
    count = 2 if count is None else count
    if isinstance(count, bool) or not isinstance(count, (int, np.integer)) or not 1 <= count <= 20:
        raise InputError("count", count, "an integer from 1 to 20")
    return np.geomspace(high, low, int(count) + 1)

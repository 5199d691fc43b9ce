"""The rule by which the power spectrum of a measured surface becomes levels of waviness."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from ..errors import InputError
from ..inputs.checks import choice, integer, number, numbers
from ..inputs.surface import Level
from .scan import Scan

#: variance of Eq. 4 over h^2: the mean square of ``(cos + 1)(cos + 1)/4`` less the square of its mean
VARIANCE = 5 / 64
#: mean square gradient of Eq. 4 over its variance and k^2
GRADIENT = 6 / 5

_WAVELENGTHS = ("gradient", "centre")
#: a band with a smaller part of the variance is empty, and one whose rms height is a smaller part of the heights is rounding
_NOTHING, _ROUNDING = 1e-12, 1e-13
#: spacings of the Fourier modes over which the taper of a scan spreads a wave
_SPREAD = 1.5


@dataclass(frozen=True, eq=False)
class RoughnessLevels:
    """Levels that stand for a measured surface, and what they were made from.

    Attributes
    ----------
    levels : the largest first
    bands : wavelengths between which each level takes its share, m, shape (levels, 2), each with its longest first
    rms_height : root mean square height in each band, m, (levels,); rms_gradient : the same of the gradient, (levels,)
    at_bounds : share of each band's variance that lies where the taper spreads a wave over a bound between two bands,
        from 0 to 1, (levels,); zero for a periodic scan
    rms_left_out : root mean square height of everything that no level stands for, m
    """

    levels: tuple[Level, ...]
    bands: np.ndarray
    rms_height: np.ndarray
    rms_gradient: np.ndarray
    at_bounds: np.ndarray
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
        table.append(f"left out: rms height {self.rms_left_out:.3g} m (beyond the bands)")
        split = ", ".join(str(i) for i, share in enumerate(self.at_bounds, start=1) if share > 0.5)
        if split:
            table.append(f"note: more than half of level {split} is so near another band that the taper spreads it over both")
        return "\n".join(table)


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
    heights whose wavelength lies in it: of a mode of an area, the shorter of those that cuts along the two directions
    see. Their variances add up to the square of the band's rms height, and weighted with the square of the wave number
    (that of the mode itself) to the square of its rms gradient. The level's height is that at which the surface of Eq. 4
    has the same rms height: Eq. 4 has the variance ``5 h^2/64``, so ``h = 8/sqrt(5) rms``. Its wavelength is that at
    which Eq. 4 has the same rms gradient too: its mean square gradient is ``6/5 k^2`` times its variance. A line is
    taken as a cut through an isotropic surface: the same variance, half the mean square gradient.

    Eq. 4 has a fifth of its variance in the oblique wave ``cos(kx)cos(ky)``, of wave number ``sqrt(2) k``; along either
    direction that has the wavelength ``l`` too. So a periodic scan of levels gives just these if each ``l`` has a band
    to itself and the waves run along the directions of the scan. One that is no period is tapered, which spreads every
    wave over 1.5 spacings ``2 pi/size`` of the modes: if that stays within the band too, ``h`` comes out, and ``l`` less
    a part of about ``0.3 (l/size)^2``. The report notes bands that have more than half of their variance so close to
    another.

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

    The shortest wavelength is by default that of four points of the *coarser* direction: shorter waves along the finer one
    are left out. A band with less than 1e-12 of the variance, or of roundings of the heights alone, gives no level.

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
    if not isinstance(scan, Scan):
        raise InputError("scan", scan, "a hystrip.roughness.Scan")
    choice("wavelength", wavelength, _WAVELENGTHS)
    given = {"count": count, "ratio": ratio, "edges": edges}
    if sum(each is not None for each in given.values()) > 1:
        raise InputError("count, ratio, edges", {k: v for k, v in given.items() if v is not None}, "one of them")
    bounds = _listed(edges, longest, shortest) if edges is not None else _spread(scan, count, ratio, longest, shortest)
    vectors, variance = scan.spectrum()
    # all waves of a level have its wave number along one direction at least, and no larger one
    q = vectors.max(axis=0)
    total = variance.sum()
    # a mode on a bound belongs to the band of shorter waves, on the last one to the last band, whatever rounding says
    at = np.searchsorted(2 * np.pi / bounds * (1 - 1e-9), q, side="right") - 1
    at[(at == bounds.size - 1) & (q <= 2 * np.pi / bounds[-1] * (1 + 1e-9))] -= 1
    inside = (at >= 0) & (at < bounds.size - 1)
    add = lambda weight: np.bincount(at[inside], weight[inside], minlength=bounds.size - 1)  # noqa: E731
    spread = 0.0 if scan.periodic else _SPREAD * 2 * np.pi / min(scan.sizes)
    near = (np.abs(np.subtract.outer(2 * np.pi / bounds[1:-1], q)) < spread).any(axis=0)
    height2 = add(variance)
    # of a surface's mean square gradient a cut sees half
    gradient2 = add(variance * np.sum(vectors**2, axis=0)) * (2 if scan.heights.ndim == 1 else 1)
    kept = np.flatnonzero(height2 > max(_NOTHING * total, (_ROUNDING * np.abs(scan.heights).max()) ** 2))
    if not kept.size:
        problem = f"no roughness between {bounds[0]:.3g} and {bounds[-1]:.3g} m"
        raise InputError("scan", problem, "bands in which there is some")
    bands = np.stack((bounds[:-1], bounds[1:]), axis=1)[kept]
    height2, gradient2, at_bounds = height2[kept], gradient2[kept], add(variance * near)[kept] / height2[kept]
    k = np.sqrt(gradient2 / (GRADIENT * height2)) if wavelength == "gradient" else 2 * np.pi / np.sqrt(bands.prod(axis=1))
    # oblique waves of a band may be shorter than those of the next, of which levels are solved the largest first
    order = np.argsort(k, kind="stable")
    k, bands, height2, gradient2, at_bounds = (each[order] for each in (k, bands, height2, gradient2, at_bounds))
    levels = tuple(Level(l=2 * np.pi / each, h=np.sqrt(each2 / VARIANCE)) for each, each2 in zip(k, height2, strict=True))
    left_out = float(np.sqrt(max(total - height2.sum(), 0.0)))
    return RoughnessLevels(levels, bands, np.sqrt(height2), np.sqrt(gradient2), at_bounds, left_out)


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
    count = integer("count", 2 if count is None else count, 1, 20, "an integer from 1 to 20")
    return np.geomspace(high, low, count + 1)

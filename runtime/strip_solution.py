"""Single strips: ``hystrip.solve_strip`` and what it returns. SI in, SI out, everything broadcasts."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from .arguments import check_branch, check_types
from .inputs.adhesion import Dugdale
from .inputs.checks import broadcast, numbers
from .inputs.materials import check_edge, parameters
from .orbit.foundation import foundation_of
from .orbit.regimes import CODE, REGIMES, SEQUENCES
from .orbit.solved import Solved

if TYPE_CHECKING:
    import numpy.typing as npt
    from matplotlib.figure import Figure

    from .inputs.materials import Material
    from .typing import Branch, Edge, Floats, Numbers


@dataclass(frozen=True, eq=False, repr=False)
class StripSolution:
    """Steady sliding of strips; arrays have the broadcast shape of the inputs.

    Attributes
    ----------
    p_mean, tau_mean : mean pressure and mean friction stress over a period, Pa
    contact_fraction, adhesion_fraction : parts of the period in contact and in adhesion
    regime : zones in the order a material point meets them (f free, a adhesion, c contact), as in ``"acaf"``
    a, b, c, d : edges, m: contact from ``x = -a`` to ``b``, adhesion from ``-c`` to ``-a`` and from ``b`` to ``d``; NaN where
        absent
    edge, branch : the edge closure and the branch that was asked for
    """

    p_mean: Floats
    tau_mean: Floats
    contact_fraction: Floats
    adhesion_fraction: Floats
    regime: npt.NDArray[np.str_]
    a: Floats
    b: Floats
    c: Floats
    d: Floats
    edge: Edge
    branch: Branch
    _strips: Any
    _solved: Solved
    _scales: dict
    _material: Any

    def __repr__(self) -> str:
        from .display import as_text, of_strips

        return as_text(of_strips(self))

    def _repr_html_(self) -> str:
        from .display import as_html, of_strips

        return as_html(of_strips(self))

    @property
    def wavelength(self) -> Floats:
        """Wavelength of each strip, m."""
        wavelength: Floats = 2 * np.pi / self._scales["k"]
        return wavelength

    @property
    def regime_name(self) -> npt.NDArray[np.object_]:
        """Names of the regimes in words, same shape as ``regime``."""
        return np.vectorize(REGIMES.__getitem__, otypes=[object])(self.regime)

    def pressure(self, x: Numbers) -> Floats:
        """Pressure at x, Pa. ``x`` (m) broadcasts against the strips. At an edge: the value on the side a material point meets
        later."""
        return self.fields(x)[0]

    def gap(self, x: Numbers) -> Floats:
        """Gap between foundation and rigid profile at x, m; zero in contact. ``x`` (m) broadcasts against the strips."""
        return self.fields(x)[1]

    def displacement(self, x: Numbers) -> Floats:
        """Displacement w of the foundation at x, m, positive into the foundation. ``x`` (m) broadcasts against the strips."""
        x = numbers("x", x, "m")
        k, A, D = (self._scales[n] for n in ("k", "A", "D"))
        profile = D - 2 * A * np.sin(0.5 * k * x) ** 2
        return self.gap(x) + profile

    def plot(self) -> Figure:
        """A matplotlib Figure of pressure, foundation and profile of a single strip. Needs the extra ``plot``."""
        from .plots import strip_fields

        return strip_fields(self)

    def fields(self, x: Numbers) -> tuple[Floats, Floats]:
        """``pressure`` (Pa) and ``gap`` (m) at x, which are had together. ``x`` (m) broadcasts against the strips."""
        x = numbers("x", x, "m")
        shape, n = broadcast(x=x, strips=self.p_mean), self.p_mean.size
        k, length, stress, flat = (self._scales[name] for name in ("k", "length", "p", "flat"))
        # every strip has as many points: one row for each of these
        order = np.argsort(np.broadcast_to(np.arange(n).reshape(self.p_mean.shape), shape).ravel(), kind="stable")
        phase = (-k * x).ravel()[order].reshape(n, order.size // max(n, 1)).T
        p, gap = np.empty((2, *phase.shape))
        wavy, level = np.flatnonzero(~flat.ravel()), np.flatnonzero(flat)
        foundation = foundation_of(self._material).flat(self.p_mean.shape)  # not kept: its solver, a module, cannot be pickled
        p[:, wavy], gap[:, wavy] = foundation.fields(self._strips.take(wavy), self._solved.take(wavy), phase[:, wavy])
        p[:, level] = self._solved.p_mean[level]
        contact = self._solved.code[level] == CODE["c"]
        gap[:, level] = np.where(contact, 0.0, p[:, level] - self._strips.D[level])
        out = np.empty((2, order.size))
        out[:, order] = (p * stress.ravel()).T.ravel(), (gap * length.ravel()).T.ravel()
        pressure, opening = out.reshape(2, *shape)
        return pressure, opening


def solve_strip(
    material: Material,
    adhesion: Dugdale,
    *,
    l: Numbers,  # noqa: E741 - the paper's symbol
    A: Numbers,
    D: Numbers,
    V: Numbers,
    edge: Edge = "continuous",
    branch: Branch = "unloading",
) -> StripSolution:
    """Steady sliding of strips over the foundation, solved as one batch.

    Parameters
    ----------
    material, adhesion : the foundation and the adhesion; their fields may be arrays
    l : wavelength, m, > 0
    A : amplitude of the strip's profile ``u = D - A (1 - cos kx)``, m, >= 0
    D : penetration of the strip's crest (the paper's D_j), m
    V : sliding velocity, m/s, >= 0
    edge : ``"continuous"`` or ``"constitutive"``: what w does where the pressure steps
    branch : ``"unloading"`` (most engaged orbit) or ``"loading"`` (least engaged orbit)

    Everything numeric broadcasts.

    Raises
    ------
    InputError : an input outside its range, named with what is allowed
    SolverError : a strip whose solution did not pass its certificate, named

    Examples
    --------
    >>> import hystrip
    >>> material = hystrip.StandardLinearSolid(K=1e9, T_eps=1e-2, T_sigma=1e-4)
    >>> adhesion = hystrip.Dugdale(gamma=2.5e-5, delta_0=1e-8)
    >>> strips = hystrip.solve_strip(material, adhesion, l=1e-5, A=5e-7, D=[2e-7, 2e-6, 2e-5], V=5e-3)
    >>> strips.regime.tolist()
    ['acaf', 'acaf', 'c']
    >>> print(strips.contact_fraction.round(3))
    [0.162 0.296 1.   ]
    """
    check_types(material, adhesion)
    wavelength = numbers("l", l, "m", 0, strict=True)
    A = numbers("A", A, "m", 0)
    D = numbers("D", D, "m")
    V = numbers("V", V, "m/s", 0)
    edge, branch = check_edge(material, edge), check_branch(branch)
    material = material.at_wavelength(wavelength)
    shape = broadcast(
        l=wavelength,
        A=A,
        D=D,
        V=V,
        p_0=adhesion.p_0,
        delta_0=adhesion.delta_0,
        **{f"material.{name}": value for name, value in parameters(material).items()},
    )
    flat_in = [_flat(v, shape) for v in (wavelength, A, D, V, adhesion.p_0, adhesion.delta_0)]
    solved, strips, scales = foundation_of(material).flat(shape).solve(*flat_in, edge, branch)
    scales = {name: value.reshape(shape) for name, value in scales.items()}
    p_mean, tau_mean, contact, adhesion = (
        getattr(solved, name).reshape(shape) for name in ("p_mean", "tau_mean", "contact_fraction", "adhesion_fraction")
    )
    means = p_mean * scales["p"], tau_mean * scales["p"] * scales["k"] * scales["A"]
    unit, regime = 1 / scales["k"], SEQUENCES[solved.code].reshape(shape)
    a, b, c, d = (getattr(solved, name).reshape(shape) * unit for name in "abcd")
    return StripSolution(*means, contact, adhesion, regime, a, -b, c, -d, edge, branch, strips, solved, scales, material)


def _flat(values, shape) -> np.ndarray:
    """Flat array of the broadcast ``values``, a view where they are a single number."""
    values = np.asarray(values, float)
    if values.size == 1:
        return np.broadcast_to(values.reshape(()), (math.prod(shape),))
    return np.broadcast_to(values, shape).ravel()

"""Public interface of the strip: SI in, SI out, everything broadcasts."""

from __future__ import annotations

from dataclasses import dataclass, field
from dataclasses import fields as dataclass_fields
from typing import TYPE_CHECKING, Any

import numpy as np

from hystrip.errors import InputError, SolverError
from hystrip.inputs.adhesion import Dugdale
from hystrip.inputs.checks import broadcast, choice, numbers
from hystrip.solver import Foundation, check_edge, check_material, foundation_of, parameters

from .engine import solve_strips
from .flat import is_flat, solve_flat
from .problem import Strips
from .regimes import CODE, REGIMES, SEQUENCES
from .solved import Solved

BRANCHES = ("unloading", "loading")
if TYPE_CHECKING:
    from hystrip.solver import Material
#: beyond this alpha and beta squared overflow
_GROUP_LIMIT = 1e150


@dataclass(frozen=True, eq=False)
class StripSolution:
    """Steady sliding of strips; arrays have the broadcast shape of the inputs.

    Attributes
    ----------
    p_mean, tau_mean : mean pressure and mean friction stress over a period, Pa
    contact_fraction, adhesion_fraction : parts of the period in contact and in adhesion
    regime : zones in the order a material point meets them (f free, a adhesion, c contact), as in ``"acaf"``
    a, b, c, d : edges, m: contact from ``x = -a`` to ``b``, adhesion from ``-c`` to ``-a`` and from ``b`` to ``d``; NaN where absent
    edge, branch : the edge closure and the branch that was asked for
    """

    p_mean: np.ndarray
    tau_mean: np.ndarray
    contact_fraction: np.ndarray
    adhesion_fraction: np.ndarray
    regime: np.ndarray
    a: np.ndarray
    b: np.ndarray
    c: np.ndarray
    d: np.ndarray
    edge: str
    branch: str
    _strips: Any = field(repr=False)
    _solved: Solved = field(repr=False)
    _scales: tuple = field(repr=False)
    _foundation: Foundation = field(repr=False)

    @property
    def regime_name(self) -> np.ndarray:
        """Names of the regimes in words, same shape as ``regime``."""
        return np.vectorize(REGIMES.__getitem__, otypes=[object])(self.regime)

    def pressure(self, x) -> np.ndarray:
        """Pressure at x, Pa. ``x`` (m) broadcasts against the strips. At an edge: the value on the side a material point meets later."""
        p, _, scales = self._fields(x)
        return p * scales["p"]

    def gap(self, x) -> np.ndarray:
        """Gap between foundation and rigid profile at x, m; zero in contact. ``x`` (m) broadcasts against the strips."""
        _, gap, scales = self._fields(x)
        return gap * scales["length"]

    def displacement(self, x) -> np.ndarray:
        """Displacement w of the foundation at x, m, positive into the foundation. ``x`` (m) broadcasts against the strips."""
        x = numbers("x", x, "m")
        k, A, D = (self._scales[n] for n in ("k", "A", "D"))
        profile = D - 2 * A * np.sin(0.5 * k * x) ** 2
        return self.gap(x) + profile

    def plot(self):
        """A matplotlib Figure of pressure, foundation and profile of a single strip. Needs the extra ``plot``."""
        from hystrip.plots import strip_fields

        return strip_fields(self)

    def _fields(self, x):
        x = numbers("x", x, "m")
        shape = broadcast(x=x, strips=self.p_mean)
        scales = {n: np.broadcast_to(v, shape) for n, v in self._scales.items()}
        index = np.broadcast_to(np.arange(self.p_mean.size).reshape(self.p_mean.shape), shape).ravel()
        phase = (-scales["k"] * x).ravel()
        flat = scales["flat"].ravel()
        p, gap = np.empty(index.size), np.empty(index.size)
        wavy = np.flatnonzero(~flat)
        which = index[wavy]
        picked = Solved(*(getattr(self._solved, f.name)[which] for f in dataclass_fields(Solved)))
        p[wavy], gap[wavy] = self._foundation.fields(self._strips.take(which), picked, phase[wavy])
        level = np.flatnonzero(flat)
        p[level] = self._solved.p_mean[index[level]]
        contact = self._solved.code[index[level]] == CODE["c"]
        gap[level] = np.where(contact, 0.0, p[level] - self._strips.D[index[level]])
        return p.reshape(shape), gap.reshape(shape), {"p": scales["p"], "length": scales["length"]}


def solve_strip(
    material: Material,
    adhesion: Dugdale,
    *,
    l,  # noqa: E741 - the paper's symbol
    A,
    D,
    V,
    edge: str = "continuous",
    branch: str = "unloading",
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
    check_material(material)
    if not isinstance(adhesion, Dugdale):
        raise InputError("adhesion", adhesion, "a hystrip.Dugdale (gamma=0: no adhesion)")
    wavelength = numbers("l", l, "m", 0, strict=True)
    A = numbers("A", A, "m", 0)
    D = numbers("D", D, "m")
    V = numbers("V", V, "m/s", 0)
    edge, branch = check_edge(material, edge), choice("branch", branch, BRANCHES)
    shape = broadcast(
        l=wavelength,
        A=A,
        D=D,
        V=V,
        p_0=adhesion.p_0,
        delta_0=adhesion.delta_0,
        **parameters(material),
    )
    flat_in = [np.broadcast_to(np.asarray(v, float), shape).ravel() for v in (wavelength, A, D, V, adhesion.p_0, adhesion.delta_0)]
    foundation = foundation_of(material).flat(shape)
    solved, strips, scales = foundation.solve(*flat_in, edge, branch)
    out = lambda v: v.reshape(shape)  # noqa: E731
    per_k = 1 / scales["k"]
    return StripSolution(
        p_mean=out(solved.p_mean * scales["p"]),
        tau_mean=out(solved.tau_mean * scales["p"] * scales["k"] * scales["A"]),
        contact_fraction=out(solved.contact_fraction),
        adhesion_fraction=out(solved.adhesion_fraction),
        regime=out(SEQUENCES[solved.code]),
        a=out(solved.a * per_k),
        b=out(-solved.b * per_k),
        c=out(solved.c * per_k),
        d=out(-solved.d * per_k),
        edge=edge,
        branch=branch,
        _strips=strips,
        _solved=solved,
        _scales={n: out(v) for n, v in scales.items()},
        _foundation=foundation,
    )


def solve_si(kernel, l, A, D, V, K, T_eps, T_sigma, p_0, delta_0, J, L, edge, branch):  # noqa: E741
    """Solve flat SI arrays of shape (n,); returns ``Solved``, the dimensionless ``Strips`` and the scales back to SI.

    A strip whose wave is negligible is solved as flat, in units of K alone. Nothing is refused here but groups that overflow.
    """
    k = 2 * np.pi / l
    with np.errstate(over="ignore"):  # refused below, by name
        alpha, beta = k * V * T_sigma, k * V * T_eps
    if np.any(beta > _GROUP_LIMIT):
        raise InputError("V", float(V[beta > _GROUP_LIMIT][0]), f"k V T_eps at most {_GROUP_LIMIT:g}")
    flat = is_flat(A, beta, D, p_0 / K, delta_0)
    unit = np.where(flat, 1.0, A)
    strips = Strips(alpha, beta, J, L, p_0 / K / unit, delta_0 / unit, D / unit, np.full(D.size, float(edge == "constitutive")))
    solved = Solved.empty(D.size)
    unloading = branch == "unloading"
    wavy = np.flatnonzero(~flat)
    solved.put(wavy, solve_strips(kernel, strips.take(wavy), unloading))
    level = np.flatnonzero(flat)
    if level.size:
        code, p = solve_flat(D[level], (p_0 / K)[level], delta_0[level], unloading)
        solved.code[level], solved.p_mean[level], solved.tau_mean[level] = code, p, 0.0
        solved.contact_fraction[level] = code == CODE["c"]
        solved.adhesion_fraction[level] = code == CODE["a"]
        solved.certified[level] = True
    return solved, strips, {"k": k, "A": A, "D": D, "p": K * unit, "length": unit, "flat": flat}


def refuse_uncertified(solved: Solved, inputs: dict[str, np.ndarray], edge: str, branch: str) -> None:
    """``SolverError`` naming the first strip that did not pass its certificate, by its inputs (name to flat array)."""
    bad = np.flatnonzero(~solved.certified)
    if not bad.size:
        return
    strip = ", ".join(f"{n}={float(v[bad[0]])!r}" for n, v in inputs.items())
    raise SolverError(
        f"{bad.size} of {solved.certified.size} strips could not be certified; the first, strip {bad[0]}: "
        f"{strip}, edge={edge!r}, branch={branch!r}"
    )

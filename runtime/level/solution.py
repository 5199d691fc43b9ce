"""Public interface of one level: its means, and its friction law."""

from __future__ import annotations

import warnings
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, overload

import numpy as np

from ..arguments import check_rtol, check_single, check_strips, refuse_faint
from ..errors import ConvergenceWarning, InputError
from ..inputs.adhesion import Dugdale
from ..inputs.checks import broadcast, choice, number, numbers
from ..inputs.surface import Level
from ..level_solution import Inputs, LevelSolution
from ..orbit.groups import ROUNDING
from ..orbit.materials import Material, check_edge
from ..orbit.solution import BRANCHES
from .averages import level_means
from .effort import WorkCounters
from .inverse import invert
from .law import Laws, build_laws
from .saturated import saturated_level
from .strips import QUANTITIES, LevelBatch

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from ..typing import Branch, Edge, Floats, Numbers


@dataclass(frozen=True, eq=False)
class FrictionLaw:
    """Friction stress of a level over nominal pressure at one velocity: ``law(p)``, Pa, any shape.

    ``p_sat`` is where unloading leaves saturated contact; on the loading branch it is a pressure that suffices for it. Zero
    below ``pull_off``, ``tau_sat`` from ``p_sat`` on. ``breaks``: pressures at which it jumps or has a kink. ``below``: largest
    pressure it was built for; asking for more is an ``InputError``. ``error_estimate``: absolute error of the friction, Pa.
    ``converged``: it is within ``rtol`` of the greatest friction.
    """

    pull_off: float
    p_sat: float
    tau_sat: float
    below: float
    error_estimate: float
    converged: bool
    _laws: Laws = field(repr=False)

    @property
    def breaks(self) -> Floats:
        """Pressures, Pa, ascending, at which the law jumps or is not smooth."""
        return self._laws.breaks[0]

    @property
    def strips(self) -> int:
        """Strips that were evaluated to build the law."""
        return int(self._laws.strips[0])

    def __call__(self, p: Numbers) -> Floats:
        """Friction stress at nominal pressure ``p`` (Pa), same shape."""
        return self._evaluate(p, 1)

    def contact_fraction(self, p: Numbers) -> Floats:
        """Contact fraction at nominal pressure ``p`` (Pa), same shape."""
        return self._evaluate(p, 2)

    def plot(self) -> Figure:
        """A matplotlib Figure of friction stress and contact fraction over nominal pressure. Needs the extra ``plot``."""
        from ..plots import law_over_pressure

        return law_over_pressure(self)

    def _evaluate(self, p, quantity):
        p = numbers("p", p, "Pa")
        if (p > self.below).any() and self.below < self.p_sat:
            raise InputError("p", float(p.max()), f"at most {self.below:g} Pa: the law was built up to there")
        return self._laws(np.zeros(p.size, int), p.ravel())[:, quantity].reshape(p.shape)[()]


@overload
def solve_level(
    material: Material, adhesion: Dugdale, level: Level, *, V: Numbers, D: Numbers, pressure: None = None,
    edge: Edge = ..., branch: Branch = ..., rtol: float = ..., strips: int | None = None,
) -> LevelSolution: ...  # fmt: skip
@overload
def solve_level(
    material: Material, adhesion: Dugdale, level: Level, *, V: Numbers, D: None = None, pressure: Numbers,
    edge: Edge = ..., branch: Branch = ..., rtol: float = ..., strips: None = None,
) -> LevelSolution: ...  # fmt: skip
def solve_level(
    material: Material,
    adhesion: Dugdale,
    level: Level,
    *,
    V: Numbers,
    D: Numbers | None = None,
    pressure: Numbers | None = None,
    edge: Edge = "continuous",
    branch: Branch = "unloading",
    rtol: float = 1e-9,
    strips: int | None = None,
) -> LevelSolution:
    """Means of a level over its strips (Eq. 11) at penetration ``D`` (m) or nominal ``pressure`` (Pa) and velocity ``V`` (m/s).

    ``strips=N``: the paper's equal strips (midpoints of N strips of half a cell) instead of adaptive panels; with ``D`` only.
    ``rtol`` is relative to ``|value| + 1e-3 scale``, scale ``K h + p_0`` for pressure, times ``h/l`` for friction, 1 for
    fractions.

    Raises ``InputError`` for inputs out of range, ``SolverError`` for a strip that could not be certified; warns with a
    ``ConvergenceWarning`` of points that are not ``converged``, as the work on each is bounded.

    >>> import hystrip
    >>> material = hystrip.StandardLinearSolid(K=1e9, T_eps=1e-2, T_sigma=1e-4)
    >>> adhesion = hystrip.Dugdale(gamma=2.5e-5, delta_0=1e-8)
    >>> level = hystrip.solve_level(material, adhesion, hystrip.Level(l=1e-5, h=1e-6), V=5e-3, D=6e-7, rtol=1e-6)
    >>> print(f"{float(level.p_mean):.4g} Pa, {float(level.tau_mean):.4g} Pa, {float(level.contact_fraction):.4g}")
    42.54 Pa, 23.53 Pa, 0.4357
    """
    material, V, level, edge, branch, rtol = _checked(material, adhesion, level, V, edge, branch, rtol)
    if (D is None) == (pressure is None):
        raise InputError("D, pressure", {"D": D, "pressure": pressure}, "exactly one of the two")
    strips = check_strips(strips)
    if strips is not None and D is None:
        raise InputError("strips", strips, "None where the pressure is given: equal strips need D")
    name, load = ("D", numbers("D", D, "m")) if pressure is None else ("pressure", numbers("pressure", pressure, "Pa"))
    if name == "pressure":
        refuse_faint(load, material, adhesion, level)
    shape = broadcast(**{"V": V, name: load})
    V, load = (np.broadcast_to(v, shape).ravel() for v in (V, load))
    if name == "D":
        load = _not_just_released(load, level.h, adhesion.p_0 / material.K, adhesion.delta_0)
    work = WorkCounters()
    inputs = Inputs(material, adhesion, level, V.reshape(shape), edge, branch, rtol, strips)
    columns = LevelBatch(material, adhesion, level, edge, branch, V, load, strips=strips, work=work)
    D, values, errors = _means(columns, load if D is None else None, rtol)
    pulled_off = np.isnan(D)
    allowed = rtol * np.abs(values) + columns.atol(np.full(load.size, rtol))
    converged = pulled_off | (errors <= allowed).all(axis=1)
    if strips is None and not converged.all():
        lost = np.flatnonzero(~converged)
        first = f"{name} {load[lost[0]]:g}, V {V[lost[0]]:g}: {work.reason(V[lost[0]])}"
        missed = f"{lost.size} of {load.size} points did not converge to rtol = {rtol:g}"
        warnings.warn(f"{missed}; the first: {first} (see error_estimate)", ConvergenceWarning, stacklevel=2)
    one = lambda v: v.reshape(shape)  # noqa: E731
    return LevelSolution(
        one(D),
        *(one(v) for v in values.T),
        error_estimate=errors.T.reshape(len(QUANTITIES), *shape),
        pulled_off=one(pulled_off),
        converged=one(converged),
        strips=work.solved + work.decided,
        inputs=inputs,
    )


def _not_just_released(D: np.ndarray, h: float, stretch: float, delta_0: float) -> np.ndarray:
    """``D``, or, where it is that at which the valley is just released but for roundings, one at which it adheres: else strips as
    flat as the rounding would be free or not as it falls."""
    released, rounding = h - stretch - delta_0, ROUNDING * (h + stretch + delta_0)
    return np.where(np.abs(D - released) < rounding, released + rounding, D)


def _means(columns: LevelBatch, p: np.ndarray | None, rtol: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Penetrations (n,), NaN below pull-off, means and errors (n, 4), at the columns' penetrations or at the pressures ``p``."""
    accuracy = np.full(columns.size, rtol)
    if p is None:
        means = level_means(columns, accuracy)
        return columns.D, means.values, means.errors
    found, (values, errors) = invert(columns, p, 0.3 * rtol), np.zeros((2, p.size, len(QUANTITIES)))
    values[:, 0], touching = p, np.flatnonzero(~np.isnan(found.D))
    if touching.size:
        at = found.take(touching)
        columns = columns.at(touching, at.D)
        atol = columns.atol(accuracy[touching], pressure=1e-3 if columns.adhesion.p_0 > 0 else 0.0)
        means = level_means(columns, accuracy[touching], atol)
        values[touching], errors[touching] = at.meeting(p[touching], means)
        errors[touching[at.undecided]] += np.abs(values[touching[at.undecided]])
    return found.D, values, errors


def friction_law(
    material: Material,
    adhesion: Dugdale,
    level: Level,
    *,
    V: float,
    edge: Edge = "continuous",
    branch: Branch = "unloading",
    rtol: float = 1e-6,
    below: float | None = None,
) -> FrictionLaw:
    """Friction law of a level at one velocity ``V`` (m/s), from pull-off up to saturation, or up to the pressure ``below`` (Pa).

    ``rtol`` is relative to ``|friction| + 1e-3 scale``, as in ``solve_level``. Raises ``InputError`` for inputs out of range,
    ``SolverError`` for a strip that could not be certified; warns with a ``ConvergenceWarning`` of a law that is not
    ``converged``, as the work on it is bounded.

    >>> import hystrip
    >>> material = hystrip.StandardLinearSolid(K=1e9, T_eps=1e-2, T_sigma=1e-4)
    >>> law = hystrip.friction_law(material, hystrip.Dugdale(gamma=0), hystrip.Level(l=5e-7, h=1e-7), V=5e-3, rtol=1e-3)
    >>> print(law([0, 100, 1e6]).round(1), round(law.p_sat, 1), round(law.tau_sat, 1))
    [ 0.   0.9 90.5] 4912.9 90.5
    """
    material, V, level, edge, branch, rtol = _checked(material, adhesion, level, V, edge, branch, rtol)
    if V.ndim:
        raise InputError("V", V, "a single number: a finite number >= 0 (m/s)")
    top = None if below is None else np.array([number("below", below, "Pa")])
    work = WorkCounters()
    columns = LevelBatch(material, adhesion, level, edge, branch, V.reshape(1), np.zeros(1), work=work)
    laws = _laws(columns, rtol, top)
    p_sat = float(laws.p_sat[0])
    built = p_sat if below is None or below >= p_sat else float(below)
    if built < p_sat and laws.pull_off[0] >= built:
        # nothing is carried up to there: what can be is seen above
        laws = _laws(columns, rtol, None)
    pull_off, error = float(laws.pull_off[0]), float(laws.friction_error[0])
    if not adhesion.p_0 > 0:
        # contact begins at zero pressure, and there is none at it
        pull_off, laws = 0.0, replace(laws, pull_off=np.full(1, np.finfo(float).tiny))
    converged = bool(not work.limits and error <= rtol * laws.greatest[0, 0] + columns.atol(np.full(1, rtol))[0, 1])
    if not converged:
        reason = f"V {float(V):g}: {work.reason(float(V))}"
        message = f"the friction law did not converge to rtol = {rtol:g}; {reason} (see error_estimate)"
        warnings.warn(message, ConvergenceWarning, stacklevel=2)
    return FrictionLaw(pull_off, p_sat, float(laws.saturated[0, 1]), built, error, converged, laws)


def _laws(columns: LevelBatch, rtol: float, top) -> Laws:
    n = columns.size
    s = saturated_level(columns.material, columns.adhesion, columns.level, columns.V, columns.branch)
    saturated = np.stack([s.p_sat, s.tau_sat, np.ones(n), np.zeros(n)], axis=1)
    accuracy = np.full(n, rtol)
    return build_laws(columns, accuracy, columns.atol(accuracy), s.p_sat, s.D_sat, saturated, top)


def _checked(material, adhesion, level, V, edge, branch, rtol):
    check_single(material, adhesion)
    if not isinstance(level, Level):
        raise InputError("level", level, "a hystrip.Level")
    V = numbers("V", V, "m/s", 0)
    edge = check_edge(material, edge)
    return material.at_wavelength(level.l), V, level, edge, choice("branch", branch, BRANCHES), check_rtol(rtol)

"""The whole surface: friction coefficient over nominal pressure and velocity."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, overload

import numpy as np

from .arguments import check_branch, check_levels, check_rtol, check_single, check_strips, refuse_faint
from .errors import InputError, SolverError
from .inputs.adhesion import Dugdale
from .inputs.checks import broadcast, numbers, truth
from .inputs.materials import check_edge
from .inputs.surface import Level

if TYPE_CHECKING:
    from typing import Unpack

    from .inputs.materials import Material
    from .multilevel import Surface
    from .result import Result
    from .typing import Branch, Edge, Numbers, Options, Progress


@overload
def solve(
    material: Material, adhesion: Dugdale, levels: Sequence[Level] | Level, *,
    pressure: Numbers, penetration: None = None, velocity: Numbers, **options: Unpack[Options],
) -> Result: ...  # fmt: skip
@overload
def solve(
    material: Material, adhesion: Dugdale, levels: Sequence[Level] | Level, *,
    pressure: None = None, penetration: Numbers, velocity: Numbers, **options: Unpack[Options],
) -> Result: ...  # fmt: skip
def solve(
    material: Material,
    adhesion: Dugdale,
    levels: Sequence[Level] | Level,
    *,
    pressure: Numbers | None = None,
    penetration: Numbers | None = None,
    velocity: Numbers,
    edge: Edge = "continuous",
    branch: Branch = "unloading",
    rtol: float = 1e-6,
    strips: int | None = None,
    skip: bool = True,
    progress: Progress | None = None,
    temperature: float | None = None,
) -> Result:
    """Friction coefficient of a multilevel surface (Eqs. 11-14).

    Parameters
    ----------
    material : the foundation, of single values
    adhesion : a Dugdale adhesion, of single values; none with ``gamma=0``
    levels : from the largest to the smallest, at least one
    pressure : nominal pressure, Pa
    penetration : that of level 1, m, in place of a pressure
    velocity : sliding velocity, m/s, >= 0; broadcasts with the load. No input may exceed 1e40 in magnitude
    edge, branch : edge closure and branch of loading, as in ``solve_strip``
    rtol : accuracy asked for, relative to ``|tau| + 1e-3 (K h + p_0) h/l`` of level 1 (were it flat: of the largest that is
        not), 1e-12 to 0.1
    strips : average level 1 over the paper's so many equal strips of half a cell (midpoints) instead of adaptive
        panels: to compare with the paper. The laws of the levels below stay adaptive, ``rtol`` holds for them alone,
        and the error estimate says the rest
    skip : use the closed form where every level is saturated (off: every point is solved)
    progress : called with the number of points done and the total
    temperature : K, one for all points, for a material with a ``shift``; without it the material is as it was given. Several
        temperatures are a :func:`hystrip.sweep`

    Raises
    ------
    InputError : an input outside its range, named with what is allowed
    SolverError : a strip that could not be certified, named

    Warns
    -----
    ConvergenceWarning : points whose estimated error exceeds what ``rtol`` allows, as the work on each is bounded, or whose mu
        may be anything: ``converged`` is false there, and the message names the first of them with the reason

    Examples
    --------
    >>> import hystrip
    >>> material = hystrip.StandardLinearSolid(K=1e9, T_eps=1e-2, T_sigma=1e-4)
    >>> levels = [hystrip.Level(l=10e-6, h=1e-6), hystrip.Level(l=500e-9, h=100e-9)]
    >>> result = hystrip.solve(material, hystrip.Dugdale(gamma=0), levels, pressure=5e6, velocity=[1e-3, 1e-2])
    >>> print(result.mu.round(6))  # every level saturated: the closed form
    [9.30e-05 2.72e-04]
    """
    # loaded here: `import hystrip` is to cost next to nothing
    from .flat_levels import solve_points
    from .level.strips import WorkCounters
    from .multilevel import Surface
    from .points import warn_unconverged

    levels = check_levels(levels)
    check_single(material, adhesion)
    if temperature is not None:
        material = material.at_temperature(temperature)
    edge, branch = check_edge(material, edge), check_branch(branch)
    rtol = check_rtol(rtol)
    skip = truth("skip", skip)
    if progress is not None and not callable(progress):
        raise InputError("progress", progress, "a function of the points done and their total")
    velocity = numbers("velocity", velocity, "m/s", 0)
    if (pressure is None) == (penetration is None):
        given = {"pressure": pressure, "penetration": penetration}
        raise InputError("pressure, penetration", given, "exactly one of the two")
    name, load = ("pressure", pressure) if penetration is None else ("penetration", penetration)
    load = numbers(name, load, "Pa" if name == "pressure" else "m")
    if name == "pressure":
        refuse_faint(load, material, adhesion, levels[0])
    shape = broadcast(**{name: load, "velocity": velocity})
    V, L = (np.broadcast_to(v, shape).reshape(-1) for v in (velocity, load))
    work = WorkCounters()
    surface = Surface(material, adhesion, levels, edge, branch, rtol, skip, work, check_strips(strips))
    points = solve_points(surface, V, L, name == "pressure", progress)
    lost = np.flatnonzero(~(np.isfinite(points.tau).all(axis=0) & np.isfinite(points.error)))
    if lost.size:
        first = f"{name} {L[lost[0]]:g}, velocity {V[lost[0]]:g}"
        raise SolverError(f"{lost.size} of {L.size} points have no finite friction; the first: {first}")
    converged = surface.converged(points)
    if strips is None:
        no_pressure = "the pressure of that penetration may be zero, and mu anything"
        reason = lambda i: no_pressure if points.of_unknown_mu[i] else work.reason(V[i])  # noqa: E731
        warn_unconverged(converged, rtol, reason, **{name: L, "velocity": V})
    result = _result(points, surface, shape, V, name, converged)
    return result if temperature is None else replace(result, temperature=float(temperature))


def _result(points, surface: Surface, shape, V, load: str, converged) -> Result:
    from .result import Result

    tau = points.tau.sum(axis=0)
    loaded = points.p != 0
    mu = np.divide(tau, points.p, out=np.full(tau.shape, np.nan), where=loaded)
    # a pressure that a penetration takes errs too: mu is not known where that may be zero
    error, least = points.error + np.abs(np.where(loaded, mu, 0.0)) * points.p_error, np.abs(points.p) - points.p_error
    error = np.divide(error, least, out=np.where(loaded, np.inf, np.nan), where=loaded & ~points.of_unknown_mu)
    one = lambda v: v.reshape(shape)  # noqa: E731
    many = lambda v: v.reshape(len(surface.levels), *shape)  # noqa: E731
    return Result(
        mu=one(mu + 0.0),  # under a pull 0, not -0
        tau=one(tau),
        tau_by_level=many(points.tau),
        pressure=one(points.p),
        velocity=one(V.copy()),
        penetration=one(points.D),
        contact_fraction=one(points.contact[-1]),
        contact_by_level=many(points.contact),
        adhesion_by_level=many(points.adhesion),
        pulled_off=one(points.pulled_off),
        closed_form=one(points.closed_form),
        error_estimate=one(error),
        tau_error=one(points.error),
        pressure_error=one(points.p_error),
        converged=one(converged),
        counts={
            "strips_solved": surface.work.solved,
            "strips_decided_by_threshold": surface.work.decided,
            "points_in_closed_form": int(points.closed_form.sum()),
            "points_below_pull_off": int(points.pulled_off.sum()),
        },
        material=surface.material,
        adhesion=surface.adhesion,
        levels=tuple(surface.levels),
        edge=surface.edge,
        branch=surface.branch,
        rtol=surface.rtol,
        strips=surface.strips,
        load=load,
    )

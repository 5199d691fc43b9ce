"""Friction laws of a level: ``hystrip.friction_law`` and what it returns."""

from __future__ import annotations

import warnings
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np

from .arguments import check_on_level
from .errors import ConvergenceWarning, InputError
from .inputs.adhesion import Dugdale
from .inputs.checks import number, numbers
from .inputs.surface import Level
from .level.law import Laws, build_laws
from .level.saturated import Saturation
from .level.strips import LevelBatch, WorkCounters

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from .inputs.materials import Material
    from .typing import Branch, Edge, Floats, Numbers


@dataclass(frozen=True, eq=False)
class FrictionLaw:
    """Friction stress of a level over nominal pressure at one velocity: ``law(p)``, Pa, any shape.

    ``p_sat`` is where unloading leaves saturated contact; on the loading branch it is a pressure that suffices for it. Zero
    below ``pull_off``, ``tau_sat`` from ``p_sat`` on. ``breaks``: pressures at which it jumps or has a kink. ``below``: largest
    pressure it was built for, ``p_sat`` at most; where it is less, asking for more is an ``InputError``. ``error_estimate``:
    absolute error of the friction, Pa, but next to a jump, whose pressure is known to about ``rtol`` of itself. ``converged``:
    it is within ``rtol`` of the greatest friction.
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
        return np.clip(self._evaluate(p, 2), 0.0, 1.0)  # an interpolant may be a rounding outside

    def plot(self) -> Figure:
        """A matplotlib Figure of friction stress and contact fraction over nominal pressure. Needs the extra ``plot``."""
        from .plots import law_over_pressure

        return law_over_pressure(self)

    def _evaluate(self, p, quantity):
        p = numbers("p", p, "Pa")
        if (p > self.below).any() and self.below < self.p_sat:
            raise InputError("p", float(p.max()), f"at most {self.below:g} Pa: the law was built up to there")
        return self._laws(np.zeros(p.size, int), p.ravel())[:, quantity].reshape(p.shape)[()]


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
    material, V, level, edge, branch, rtol = check_on_level(material, adhesion, level, V, edge, branch, rtol)
    if V.ndim:
        raise InputError("V", V, "a single number: a finite number >= 0 (m/s)")
    top = np.array([np.inf if below is None else number("below", below, "Pa")])
    work = WorkCounters()
    columns = LevelBatch(material, adhesion, level, edge, branch, V.reshape(1), np.zeros(1), work=work)
    laws = _laws(columns, rtol, top)
    p_sat = float(laws.p_sat[0])
    built = p_sat if below is None or below >= p_sat else float(below)
    if built < p_sat and laws.pull_off[0] >= built:
        # nothing is carried up to there: what can be is seen above
        laws, built = _laws(columns, rtol, np.full(1, np.inf)), p_sat
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
    s, accuracy = columns.saturated, np.full(columns.size, rtol)
    means = np.column_stack((s.p_sat, s.tau_sat, np.ones(columns.size), np.zeros(columns.size)))
    return build_laws(columns, accuracy, columns.atol(accuracy), Saturation(s.p_sat, s.D_sat, means), top, None)

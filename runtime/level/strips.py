"""The strips of a level as the integrand of its averages; what they cost, and the limits of the work on every point."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from ..inputs.adhesion import Dugdale
from ..inputs.materials import Material
from ..inputs.surface import Level
from ..numerics.rounding import LARGEST
from ..orbit.contact import Contact
from ..orbit.foundation import Foundation, foundation_of
from ..orbit.groups import ROUNDING, snaps_in
from ..orbit.regimes import CODE
from ..orbit.solved import Solved
from .regime_map import Crossings
from .saturated import SaturatedLevel, saturated_level

if TYPE_CHECKING:
    from .lower_levels import LowerLevelLaws
    from .nonadhesive.family import Family
    from .nonadhesive.law import FamilyLaws

#: What is averaged over the strips of a level, in this order; what lower levels carry in its contact follows.
QUANTITIES = ("p_mean", "tau_mean", "contact_fraction", "adhesion_fraction")
#: Strips of one average, and of all averages of one curve over penetration. Three levels at rtol 1e-9 take 600 and 50,000, six
#: at 1e-3 1,500 and 120,000, two at 1e-12 500 and 130,000; what takes more does not converge.
AVERAGE_LIMIT, CURVE_LIMIT = 10_000, 150_000
#: why the curve over penetration did not tell a point
NO_CURVE = "the curve over penetration did not converge"
AT_JUMP = "the pressure is that of a jump, as at pull-off, to all digits that are known"


@dataclass
class WorkCounters:
    """Work done so far: strips whose orbit was searched for, strips decided by a closed form alone, and
    steps of bisection where no equation told where a regime ends.

    ``limits``: for pairs of velocity and wavelength, the limit that ended the work there.
    """

    solved: int = 0
    decided: int = 0
    bisected: int = 0
    limits: dict[tuple[float, float], str] = field(default_factory=dict)

    def limit_reached(self, V: np.ndarray, wavelength: float, what: str) -> None:
        """Record that the work at the velocities ``V`` (n,) on the level of this ``wavelength`` ended before it converged."""
        for v in np.unique(V).tolist():
            self.limits.setdefault((v, wavelength), what)

    def reason(self, V: float) -> str:
        """Why a point at velocity ``V`` did not converge, in words."""
        found = [f"{what} on the level with l = {length:g} m" for (v, length), what in self.limits.items() if v == V]
        return "; ".join(found) or "the errors of its averages and laws add up to more"


@dataclass(frozen=True)
class LevelBatch:
    """Pairs of velocity and penetration at which one level is averaged; ``V`` and ``D`` of shape (n,).

    ``carry``, if there is a level below: what it contributes at every strip, with ``group`` (n,) telling which of its friction
    laws belongs to a column. ``strips``: average over so many equal strips instead of adaptive panels.
    ``family``: of all strips, where there is no adhesion.
    ``crossings``: points located of the curves that divide the plane of strips, shared by all that is made of these columns.
    """

    material: Material
    adhesion: Dugdale
    level: Level
    edge: str
    branch: str
    V: np.ndarray
    D: np.ndarray
    carry: LowerLevelLaws | FamilyLaws | None = None
    group: np.ndarray | None = None
    strips: int | None = None
    work: WorkCounters = field(default_factory=WorkCounters, compare=False)
    crossings: Crossings = field(default_factory=Crossings, compare=False)
    family: Family | None = None

    def at(self, index, D) -> LevelBatch:
        """The columns ``index`` at other penetrations ``D``."""
        group = None if self.group is None else self.group[index]
        return replace(self, V=self.V[index], D=D, group=group)

    @cached_property
    def spent(self) -> np.ndarray:
        """Strips evaluated so far to follow the curve of each of these columns, (n,), by which that work is limited."""
        return np.zeros(self.size, int)

    @property
    def opens(self) -> float:
        """``D - h`` at which a gap that adheres throughout, ``w = -p_0/K``, opens over the valley, m."""
        return -self.stretch - self.adhesion.delta_0

    def not_just_released(self, D: np.ndarray) -> np.ndarray:
        """``D`` (n,), but where rounding would decide strip by strip whether an adhesive valley is released: there it adheres."""
        released, rounding = self.level.h + self.opens, ROUNDING * (self.level.h - self.opens)
        return np.where((np.abs(D - released) < rounding) & (self.adhesion.p_0 > 0), released + rounding, D)

    @property
    def size(self) -> int:
        return self.D.size

    @property
    def saturated(self) -> SaturatedLevel:
        """Saturated contact of the level by itself."""
        return saturated_level(self.material, self.adhesion, self.level, self.V, self.branch)

    @property
    def scales(self) -> np.ndarray:
        """Natural scale of each quantity: ``K h + p_0``, that times ``h/l``, 1, 1, and those of what is carried."""
        p = self.material.K * self.level.h + self.adhesion.p_0
        own = np.maximum([p, p * self.level.h / self.level.l, 1.0, 1.0], 1 / LARGEST)
        return own if self.carry is None else np.concatenate((own, self.carry.scales))

    def atol(self, rtol: np.ndarray, pressure: float = 1e-3, fraction: float = 1e-3) -> np.ndarray:
        """Absolute tolerances (n, q) that go with relative ones, ``rtol`` (n,): those of a thousandth of the natural scale of
        every quantity, but for that of ``pressure``, and of a ``fraction`` of the surface."""
        sizes = 1e-3 * self.scales
        sizes[0], sizes[self.fractions] = pressure * self.scales[0], fraction
        return rtol[:, None] * sizes

    def solve(self, column: np.ndarray, theta: np.ndarray) -> SolvedStrips:
        """Strips at ``theta = k y`` of the given columns, both of shape (m,). Raises ``SolverError`` for one not certified."""
        foundation, a, A, D = foundation_of(self.material), self.adhesion, self.level.amplitude(theta), self.D[column]
        # without adhesion all strips are alike at D = h, where D_j = 2 A, but for rounding; a small D keeps its digits
        D = np.where((a.p_0 == 0) & (2 * D > self.level.h), D - self.level.h + 2 * A, D - self.level.drop(theta))
        solved, strips, scales = foundation.solve(self.level.l, A, D, self.V[column], a.p_0, a.delta_0, self.edge, self.branch)
        searched = int(np.count_nonzero(solved.searched))
        self.work.solved += searched
        self.work.decided += solved.size - searched
        tau = solved.tau_mean * scales["p"] * scales["k"] * scales["A"]
        return SolvedStrips(solved, strips, scales, solved.p_mean * scales["p"], tau, foundation)

    @property
    def stretch(self) -> float:
        """``p_0/K``: how far the adhesive traction draws the foundation out, m."""
        return self.adhesion.p_0 / self.material.K

    def dimensionless(self, V: np.ndarray, A: np.ndarray, D: np.ndarray) -> Any:
        """Dimensionless strips at the velocities ``V``, (m,) each."""
        foundation, p_0, delta_0 = foundation_of(self.material), self.stretch, self.adhesion.delta_0
        snaps = np.broadcast_to(snaps_in(foundation.J * p_0, delta_0), A.shape)
        return foundation.strips(self.level.k * V, D / A, p_0 / A, delta_0 / A, self.edge, snaps)

    def evaluate(self, column: np.ndarray, theta: np.ndarray) -> tuple[np.ndarray, ...]:
        """Of the strips at ``theta``: codes (m,), values to average (m, q), the greatest pressure, and the least of saturated
        contact, over breaks of the law below (m, k), or NaN, and the edges d, b, a, c (m, 4), NaN where there are none."""
        strips = self.solve(column, theta)
        s, (codes, over_breaks) = strips.solved, self._codes(strips, column)
        values = np.column_stack((strips.p_mean, strips.tau_mean, s.contact_fraction, s.adhesion_fraction))
        if self.carry is not None:
            values = np.concatenate((values, self.carry.over_contact(strips, self.group[column])), axis=1)
        return codes, values, over_breaks, np.stack((s.d, s.b, s.a, s.c), axis=1)

    def codes(self, column: np.ndarray, theta: np.ndarray) -> np.ndarray:
        """Codes (m,) that change where the integrand may not be smooth: regime, and breaks of the law below that are passed."""
        return self._codes(self.solve(column, theta), column)[0]

    def _codes(self, strips: SolvedStrips, column) -> tuple[np.ndarray, np.ndarray]:
        codes = strips.solved.code.astype(int)
        if self.carry is None:
            return codes, np.empty((codes.size, 0))
        passed, over_breaks = self.carry.passed(strips, self.group[column])
        return codes + len(CODE) * passed, over_breaks

    def kinks(self, theta: np.ndarray, x: np.ndarray) -> np.ndarray:
        """Where along lines, with points at ``x`` (m, n), of strips at ``theta`` of these columns (m n,) what they carry all but
        has a kink, (m,); NaN if nowhere (``LowerLevelLaws.kinks``)."""
        if self.carry is None or self.adhesion.p_0 == 0 or not self.size:
            return np.full(len(x), np.nan)
        memory = self.level.k * self.V * np.min(foundation_of(self.material).times)
        return self.carry.kinks(self.solve(np.arange(self.size), theta), self.group, memory, x)

    @property
    def frictions(self) -> np.ndarray:
        """Which quantities are frictions, its own and those it carries: a level below adds three and an error."""
        return 1 + 3 * np.arange(self.scales.size // len(QUANTITIES))

    @property
    def fractions(self) -> np.ndarray:
        """Which quantities are fractions of the surface, (q,): the two after each friction."""
        out = np.zeros(self.scales.size, bool)
        out[self.frictions + 1] = out[self.frictions + 2] = True
        return out


@dataclass(frozen=True)
class SolvedStrips:
    """Solved strips of a batch, with pressure and friction means in Pa."""

    solved: Solved
    strips: Any
    scales: dict
    p_mean: np.ndarray
    tau_mean: np.ndarray
    foundation: Foundation

    @cached_property
    def touching(self) -> tuple[np.ndarray, Contact]:
        """Which strips are in contact, and their contact."""
        index = np.flatnonzero(self.solved.contact_fraction > 0)
        unit, flat = (self.scales[name][index] for name in ("p", "flat"))
        return index, Contact(self.foundation, self.strips.take(index), self.solved.take(index), unit, flat)


def cut_penetration(columns: LevelBatch, p_max: np.ndarray, full: np.ndarray) -> np.ndarray:
    """A penetration from which the level carries more than ``p_max`` (Pa, (n,)) on either branch, at most ``full`` (m, (n,)).

    Averaged over a period Eq. 5 says ``p_mean = K w_mean`` (the steps of w and p cancel), and w is nowhere below the profile: so
    ``p_mean >= K (D - 3 h/4)``. No pressure is below ``-p_0``; -inf, for a level that nothing presses on, counts as that.
    """
    level = columns.level
    p_max = np.maximum(p_max, -columns.adhesion.p_0)
    return np.minimum(p_max / columns.material.K + level.mean_plane + 1e-9 * (level.h + np.abs(p_max) / columns.material.K), full)

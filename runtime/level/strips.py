"""The strips of a level as the integrand of its averages."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

from ..inputs.adhesion import Dugdale
from ..inputs.surface import Level
from ..orbit.foundation import foundation_of
from ..orbit.groups import Strips
from ..orbit.materials import Material, kernel_of
from ..orbit.regimes import CODE
from ..orbit.solved import Solved
from .clinging import Clinging
from .contact import Contact, contact_of
from .effort import WorkCounters
from .margins import POWERS, decisive, margins
from .saturated import saturated_level
from .transitions import Guide

if TYPE_CHECKING:
    from ..orbit.modes.contact import ModeContact

#: What is averaged over the strips of a level, in this order; what lower levels carry in its contact follows.
QUANTITIES = ("p_mean", "tau_mean", "contact_fraction", "adhesion_fraction")


class Carry(Protocol):
    """What the levels below contribute in the contact of a strip. ``passes``: how many ``heights`` there are."""

    scales: np.ndarray
    passes: int

    def crossed(self, strips: SolvedStrips, group: np.ndarray) -> np.ndarray:
        """Codes (m,) of the law breaks that each strip's pressure passes."""

    def heights(self, strips: SolvedStrips, group: np.ndarray) -> np.ndarray:
        """Margins (m, k) of each strip's pressures over the law's breaks, Pa; NaN without contact."""

    def passing(self, crossed: np.ndarray, other: np.ndarray) -> np.ndarray:
        """Which of the ``heights`` vanishes where one code of ``crossed`` becomes another, -1 for none."""

    def over_contact(self, strips: SolvedStrips, group: np.ndarray) -> np.ndarray:
        """Contributions averaged over the period, (m, q)."""


@dataclass(frozen=True)
class Columns:
    """Pairs of velocity and penetration at which one level is averaged; ``V`` and ``D`` of shape (n,).

    ``carry``, if there is a level below: what it contributes at every strip, with ``group`` (n,) telling which of its friction
    laws belongs to a column. ``strips``: average over so many equal strips instead of adaptive panels. ``frictional``: it is for
    pressure and friction that the averages are made; fractions need be accurate against 1 only. ``clinging``: what is
    known of strips that are engaged all along, shared by all that is made of these columns.
    """

    material: Material
    adhesion: Dugdale
    level: Level
    edge: str
    branch: str
    V: np.ndarray
    D: np.ndarray
    carry: Carry | None = None
    group: np.ndarray | None = None
    strips: int | None = None
    frictional: bool = False
    work: WorkCounters = field(default_factory=WorkCounters, compare=False)
    clinging: Clinging = field(default_factory=Clinging, compare=False)

    def at(self, index, D) -> Columns:
        """The columns ``index`` at other penetrations ``D``."""
        group = None if self.group is None else self.group[index]
        return replace(self, V=self.V[index], D=D, group=group)

    @property
    def size(self) -> int:
        return self.D.size

    @property
    def scales(self) -> np.ndarray:
        """Natural scale of each quantity: ``K h + p_0``, that times ``h/l``, 1, 1, and those of what is carried."""
        p = self.material.K * self.level.h + self.adhesion.p_0
        own = np.array([p, p * self.level.h / self.level.l, 1.0, 1.0])
        return own if self.carry is None else np.concatenate((own, self.carry.scales))

    @property
    def floors(self) -> np.ndarray:
        """What is added to the size of each quantity where an accuracy is relative."""
        floors = 1e-3 * self.scales
        if self.frictional:
            own, carried = len(QUANTITIES), floors.size - 1
            fractions = [2, 3, *(i for i in range(own, carried) if (i - own) % 3)]
            floors[fractions] = 1.0
        return floors

    def solve(self, column: np.ndarray, theta: np.ndarray) -> SolvedStrips:
        """Strips at ``theta = k y`` of the given columns, both of shape (m,). Raises ``SolverError`` for one not certified."""
        A = self.level.amplitude(theta)
        D = self.D[column] - self.level.drop(theta)
        l, a = np.full(column.size, self.level.l), self.adhesion  # noqa: E741
        solved, strips, scales = foundation_of(self.material).solve(
            l, A, D, self.V[column], a.p_0, a.delta_0, self.edge, self.branch
        )
        self.work.count(solved)
        tau = solved.tau_mean * scales["p"] * scales["k"] * scales["A"]
        return SolvedStrips(solved, strips, scales, solved.p_mean * scales["p"], tau, kernel_of(self.material))

    def groups(self, V, D, p_0=0.0, delta_0=0.0) -> Strips:
        """Strips at the velocities ``V``, all else in their own units, (m,); for a foundation with one time."""
        m, rate, every = foundation_of(self.material).material, self.level.k * V, np.zeros(D.size)
        chi = every + (self.edge == "constitutive")
        return Strips(rate * m.T_sigma, rate * m.T_eps, every + m.J, every + m.L, every + p_0, every + delta_0, D, chi)

    def codes(self, column: np.ndarray, theta: np.ndarray) -> np.ndarray:
        """Codes that change wherever the integrand may not be smooth, (m,): the regime, and the breaks of the law below that are
        passed."""
        return self._codes(self.solve(column, theta), column)

    def probe(self, column: np.ndarray, theta: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Codes (m,), and margins (m, k) that vanish where they change, as the ``guide`` says."""
        strips = self.solve(column, theta)
        return self._codes(strips, column), self._margins(strips, column)

    @property
    def guide(self) -> Guide:
        """What the margins of ``probe`` mean."""
        if self.carry is None:
            return Guide(decisive, POWERS)
        n, carry = len(CODE), self.carry

        def foretells(code, other):
            passing = carry.passing(code // n, other // n)
            return np.where(
                code % n == other % n, np.where(passing < 0, -1, POWERS.size + passing), decisive(code % n, other % n)
            )

        return Guide(foretells, np.concatenate((POWERS, np.ones(carry.passes, int))))

    def integrand(self, column: np.ndarray, theta: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Codes (m,) and the values to average (m, q)."""
        strips = self.solve(column, theta)
        return self._codes(strips, column), self._values(strips, column)

    def _values(self, strips: SolvedStrips, column):
        if self.carry is None:
            return strips.values
        carried = self.carry.over_contact(strips, self.group[column])
        return np.concatenate((strips.values, carried), axis=1)

    def _margins(self, strips: SolvedStrips, column):
        kernel = kernel_of(self.material)
        own = margins(kernel, strips)
        if self.carry is None:
            return own
        return np.concatenate((own, self.carry.heights(strips, self.group[column])), axis=1)

    def _codes(self, strips: SolvedStrips, column):
        codes = strips.solved.code.astype(int)
        if self.carry is None:
            return codes
        return codes + len(CODE) * self.carry.crossed(strips, self.group[column])

    def costless(self, codes: np.ndarray) -> np.ndarray:
        """Which ``codes`` are of strips whose means take no search and may as well be summed exactly: those in saturated contact,
        except where many means make one curve."""
        return (codes % len(CODE) == CODE["c"]) & (not self.frictional)

    def transitions(self) -> tuple[np.ndarray, np.ndarray]:
        """Columns and thetas (k,) of the transitions known in closed form: where strips become saturated, where they lose
        touch."""
        return _known_transitions(self)

    def ends_of_clinging(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Columns and thetas (k,) of the transitions where strips cease to be engaged all along, and how well each is known."""
        return self.clinging.ends(self)

    @property
    def frictions(self) -> np.ndarray:
        """Which quantities are frictions, its own and those it carries: a level below adds three and an error."""
        return 1 + 3 * np.arange(self.scales.size // len(QUANTITIES))


@dataclass(frozen=True)
class SolvedStrips:
    """Solved strips of a batch, with pressure and friction means in Pa."""

    solved: Solved
    strips: Any
    scales: dict
    p_mean: np.ndarray
    tau_mean: np.ndarray
    kernel: Any

    @cached_property
    def touching(self) -> tuple[np.ndarray, Contact | ModeContact]:
        """Which strips are in contact, and their contact."""
        index = np.flatnonzero(self.solved.contact_fraction > 0)
        return index, contact_of(self.kernel, self, index)

    @property
    def values(self) -> np.ndarray:
        s = self.solved
        return np.column_stack([self.p_mean, self.tau_mean, s.contact_fraction, s.adhesion_fraction])


def saturation_depth(columns: Columns) -> np.ndarray:
    """Penetration from which the whole level is in contact, m; shape (n,)."""
    return saturated_level(columns.material, columns.adhesion, columns.level, columns.V, columns.branch).D_sat


def _known_transitions(columns: Columns) -> tuple[np.ndarray, np.ndarray]:
    m, h, p_0, delta_0 = columns.material, columns.level.h, columns.adhesion.p_0, columns.adhesion.delta_0
    if h == 0:
        return np.empty(0, int), np.empty(0)
    R = foundation_of(m).modulus_ratio(columns.level.k * columns.V)
    # saturated where D - drop >= A (1 + R) - p_0/K, with drop = (h/2)(1 - cos), A = (h/4)(1 + cos)
    numerator = (columns.D + p_0 / m.K) / h - 0.5 - 0.25 * (1 + R)
    saturated = np.divide(4 * numerator, R - 1, out=np.full(columns.size, np.inf), where=R > 1)
    # saturation decides the unloading branch only
    found = [saturated] if columns.branch == "unloading" or p_0 == 0 else []
    if columns.branch == "loading" or p_0 == 0:
        # free where D - drop <= -delta_0 (or 0 without adhesion)
        found.append(1 - 2 * (columns.D + (delta_0 if p_0 > 0 else 0.0)) / h)
    cosines = np.array(found)
    kind, column = np.nonzero((cosines > -1) & (cosines < 1))
    return column, np.arccos(cosines[kind, column])

"""All levels of a surface: laws from the smallest level upwards, as far as the level above asks for them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace

import numpy as np

from .errors import SolverError
from .inputs.adhesion import Dugdale
from .inputs.materials import Material
from .inputs.surface import Level
from .level.averages import level_means, look_below
from .level.error_budget import LEAST_CONTACT, error_budget, peak_pressure, strips_across
from .level.inverse import Penetrations, invert
from .level.law import build_laws, merged
from .level.lower_levels import LowerLevelLaws
from .level.nonadhesive.family import are_families
from .level.nonadhesive.law import crest_pressure, lower_laws, tolerances, with_family
from .level.saturated import Saturation, saturated_friction, saturated_level
from .level.strips import QUANTITIES, LevelBatch, WorkCounters, cut_penetration
from .numerics.rounding import EPS, LARGEST
from .orbit.foundation import foundation_of
from .points import Points

#: velocities solved at a time: enough of them for the batch to pay, few enough to show progress
_BLOCK = 256
#: trailing levels are left out whose friction, and whose pressure of saturation, are below this part of what counts: a tenth of a
#: tolerance is not missed, and no scene of up to a dozen similar levels has any
_TRAILING = 0.1
#: tolerances over the one asked for, of averages and of the laws of lower levels, at which points are solved in turn until they
#: converge, the last time with strips that are searched for; none finer than that. Contacts average over the errors of laws: such
#: as are four times finer at first take a fifth more time (90 random surfaces)
_ATTEMPTS, _FINEST = ((1.0, 8.0), (1.0, 0.5), (0.3, 0.15)), 1e-12
#: accuracy of the friction and the contact that say how well laws without adhesion have to be known; friction of level 1 is at
#: first taken to be so many times what counts beside it
_ROUGH, _GUESS = 1e-2, 30.0
#: share of the friction without adhesion that its error may be at most, whatever counts beside it
_DIGIT = 0.1
#: contact fractions without adhesion are averaged no finer; their laws may err by so many times what others may, and the friction
#: of each level in the contact of level 1 by so much of the whole, over the number of levels
_SHARES, _LAWS, _OF_TOP = 1e-4, 2.0, 0.3


@dataclass(frozen=True)
class Surface:
    """What stays the same over all points of a solution; ``laws``: tolerance of the laws of lower levels; ``families``: whether
    the strips of levels without adhesion are taken to be families."""

    material: Material
    adhesion: Dugdale
    levels: Sequence[Level]
    edge: str
    branch: str
    rtol: float
    skip: bool
    work: WorkCounters
    strips: int | None = None
    laws: float = np.nan
    families: bool = True

    def at_level(self, i: int) -> Material:
        """The material under level ``i``."""
        return self.material.at_wavelength(self.levels[i].l)

    @property
    def friction_floor(self) -> float:
        """Friction, Pa, that counts beside its own for ``rtol``: of the largest level that is not flat beside the others."""
        sizes = [(self.at_level(i).K * level.h + self.adhesion.p_0) * level.h / level.l for i, level in enumerate(self.levels)]
        return 1e-3 * max(next((size for size in sizes if size > EPS * max(sizes)), 0.0), 1 / LARGEST)

    def converged(self, points: Points) -> np.ndarray:
        """Which points err by no more than ``rtol`` allows, and have a mu that is known, or none, (n,)."""
        return (points.error <= self.rtol * (np.abs(points.tau.sum(axis=0)) + self.friction_floor)) & ~points.of_unknown_mu

    def columns(self, i: int, V) -> LevelBatch:
        """Columns of level ``i``, at no penetration yet."""
        of, D = (self.adhesion, self.levels[i], self.edge, self.branch), np.zeros(V.size)
        # the curves behind the laws of lower levels are interpolated over D: equal strips would make steps of them
        return LevelBatch(self.at_level(i), *of, V, D, strips=self.strips if i == 0 else None, work=self.work)

    def saturated(self, V) -> list[Saturation]:
        """Saturation of each level with all below it."""
        out: list[Saturation] = []
        for i in reversed(range(len(self.levels))):
            s = saturated_level(self.material, self.adhesion, self.levels[i], V, self.branch)
            one, zero = np.ones(V.size), np.zeros(V.size)
            p, D, means = s.p_sat, s.D_sat, (s.tau_sat, one, zero)
            if out:
                # the least local pressure, at the crest, has to saturate everything below; and -p_0 keeps the level's own contact
                p = np.maximum(s.p_sat, out[0].p + s.lift)
                D = p / self.at_level(i).K + self.levels[i].mean_plane
                means = (*means, out[0].means[:, 1:], zero)
            out.insert(0, Saturation(p, D, np.column_stack((p, *means))))
        return out

    def carrying(self, V, group, columns: LevelBatch) -> LevelBatch:
        """The columns of level 1 with the laws of level 2, built from the smallest level upwards."""
        M, carry, groups = len(self.levels), None, np.arange(V.size)
        saturated, across = self.saturated(V), strips_across(columns)
        budget = error_budget(columns, group, across)
        rtol = np.full(V.size, self.laws)
        friction = rtol * budget.friction_of_laws(M - 1, V.size)
        # the greatest pressures that the laws of level 2 and below are asked for
        reached = [_most(group, peak_pressure(columns, across), V.size)]
        for i in range(1, M - 1):
            level = self.columns(i, V)
            highest = replace(level, D=cut_penetration(level, reached[-1], saturated[i].D))
            reached.append(peak_pressure(highest, strips_across(highest)))
        for i in range(M - 1, 0, -1):
            level = replace(self.columns(i, V), carry=carry, group=groups)
            atol = level.atol(rtol, fraction=1.0)
            least = np.minimum(atol[:, level.frictions], (rtol * self.friction_floor)[:, None])
            atol[:, level.frictions] = np.maximum(least, friction[:, None])
            counts = budget if i == 1 else budget.further_down(2 * (M - 1))
            laws = build_laws(level, rtol, atol, saturated[i], reached[i - 1], counts)
            # what the next level up carries: all but this level's pressure, and an error, which never asks for anything
            scales = np.concatenate((level.scales[1:], [LARGEST]))
            scales[level.frictions - 1] = np.minimum(scales[level.frictions - 1], 1e3 * self.friction_floor)
            carry = LowerLevelLaws(merged(laws, rtol, atol), self.rtol, scales)
        return replace(columns, carry=carry, group=group)

    def full(self, V, load, by_pressure: bool) -> np.ndarray:
        """Whether all levels are saturated at ``load``, (n,). Thresholds grow with V: beyond that of the fastest all are."""
        of = lambda V: self.saturated(V)[0].p if by_pressure else self.saturated(V)[0].D  # noqa: E731
        if load.size and load.min() >= of(V.max(keepdims=True)):
            return np.ones(load.size, bool)
        return load >= of(V)

    def levels_needed(self, V, load) -> int:
        """How many levels matter at pressures ``load`` (Pa, (n,)): those that follow rub next to nothing, and are saturated under
        next to all pressure. Without adhesion only, where no level rubs more than in saturated contact."""
        if self.adhesion.p_0 > 0:
            return len(self.levels)
        # frictions, of a level and all below it, are every third mean; what follows them is zero
        floor, p_least = _TRAILING * self.rtol * self.friction_floor, _TRAILING * self.rtol * load
        matters = [((s.means[:, 1::3].sum(axis=1) > floor) | (s.p > p_least)).any() for s in self.saturated(V)]
        return 1 + int(np.flatnonzero(matters).max(initial=0))

    def solve(self, V, load, by_pressure: bool, progress: Callable[[int, int], None] | None = None) -> Points:
        """Solve points; ``V`` (m/s) and ``load`` (Pa or m) of shape (n,). Flat levels have been left out (``flat_levels``)."""
        full = self.full(V, load, by_pressure) if self.skip else np.zeros(V.size, bool)
        known = self.levels_needed(V, load) if by_pressure and self.skip and not full.all() else len(self.levels)
        surface = replace(self, levels=self.levels[:known], laws=_ATTEMPTS[0][1] * self.rtol)
        first = _Solve(surface, V, load, by_pressure)
        out, adhesive = first.run(full, progress), self.adhesion.p_0 > 0
        for factor, laws in _ATTEMPTS[1:] if self.strips is None else ():
            same = factor == 1.0 and adhesive
            if same and known == 1:
                continue
            # where the work came to a limit more of it is no help
            size = np.abs(out.tau.sum(axis=0))
            has_digit = (V == 0) | adhesive | (out.error <= _DIGIT * size)
            sure = self.converged(out) & has_digit
            missed = np.flatnonzero(~sure & ~np.isin(V, [limited for limited, _ in self.work.limits]))
            if missed.size and factor * self.rtol >= _FINEST:
                finer = replace(surface, rtol=factor * self.rtol, laws=laws * self.rtol, families=factor == 1.0)
                size = (size + np.where(has_digit, self.friction_floor, 0.0))[missed]
                # with adhesion penetrations don't rest on laws
                found = first.found.take(missed) if same else None
                again = _Solve(finer, V[missed], load[missed], by_pressure, size, found)
                # a friction of which no digit is known is better known by strips that are searched for, whatever the errors
                out.improve(missed, again.run(np.zeros(missed.size, bool), None), ~has_digit[missed] & (not finer.families))
        if known < len(self.levels):
            out.extend(saturated_friction(self.material, self.levels[known:], V))
        return out


class _Solve:
    """Points of a surface; ``friction`` (n,), Pa, that without adhesion errors are held against, and the penetrations ``found``
    of all of them, if they are known."""

    def __init__(self, surface: Surface, V, load, by_pressure: bool, friction=None, found: Penetrations | None = None):
        self.surface, self.V, self.load, self.by_pressure, self.friction = surface, V, load, by_pressure, friction
        self.M, self.out = len(surface.levels), Points.unknown(len(surface.levels), V.size)
        self.given, self.found = found is not None, found or Penetrations.at(np.full(V.size, np.nan))

    def run(self, full, progress) -> Points:
        """Solve them; the points ``full`` (n,) are in saturated contact on every level."""
        self._closed_form(full)
        progress = progress or (lambda done, points: None)
        progress(int(full.sum()), self.V.size)
        rest = np.flatnonzero(~full)
        velocities, group = np.unique(self.V[rest], return_inverse=True)
        for start in range(0, velocities.size, _BLOCK):
            chosen = (group >= start) & (group < start + _BLOCK)
            self._block(velocities[start : start + _BLOCK], rest[chosen], group[chosen] - start)
            progress(int(full.sum() + np.count_nonzero(group < start + _BLOCK)), self.V.size)
        return self.out

    def _closed_form(self, full):
        """Points ``full`` (n,) are in saturated contact on every level."""
        i = slice(None) if full.all() else np.flatnonzero(full)
        out, load, K, depth = self.out, self.load[i], self.surface.at_level(0).K, self.surface.levels[0].mean_plane
        out.p[i] = load if self.by_pressure else K * (load - depth)
        out.D[i] = load / K + depth if self.by_pressure else load
        out.tau[:, i] = saturated_friction(self.surface.material, self.surface.levels, self.V[i])
        out.contact[:, i], out.closed_form[i] = 1.0, True

    def _block(self, V, index, group):
        """Points ``index`` whose velocities are ``V[group]``."""
        surface = self.surface
        possible = surface.families and surface.strips is None
        if possible and are_families(foundation_of(surface.at_level(0)), surface.adhesion.p_0, surface.levels, V):
            with suppress(SolverError):  # strips that are searched for are found, or named
                return self._points(V, index, group, True)
        return self._points(V, index, group, False)

    def _points(self, V, index, group, families: bool):
        surface, load = self.surface, self.load[index]
        columns = surface.columns(0, V[group])
        if families:
            size = np.full(index.size, _GUESS * surface.friction_floor) if self.friction is None else self.friction[index]
            deepest = cut_penetration(columns, load, np.full(load.size, np.inf)) if self.by_pressure else load
            columns = with_family(columns, deepest, surface.rtol * size, carries=self.M > 1)
        if not self.by_pressure:
            columns = replace(columns, D=columns.not_just_released(load))
            look_below(columns)
        if not self.given:
            known = invert(columns, load, 0.5 * surface.rtol) if self.by_pressure else Penetrations.at(columns.D)
            self.found.put(index, known)
        found = self.found.take(index)
        off, touching = np.isnan(found.D), np.flatnonzero(np.isfinite(found.D))
        self.out.pulled_off[index[off]], self.out.p[index[off]] = True, load[off]
        if not touching.size:
            return
        # nobody asks for laws of a velocity at which nothing touches
        index, (touched, group) = index[touching], np.unique(group[touching], return_inverse=True)
        V = V[touched]
        columns = columns.at(touching, found.D[touching])
        rtol, atol = 0.5 * surface.rtol / found.steep[touching], None
        if self.M > 1 and families:
            columns, atol = self._carrying_families(V, group, columns, index, rtol)
        elif self.M > 1:
            columns = surface.carrying(V, group, columns)
        self._write(index, found.take(touching), level_means(columns, rtol, atol))

    def _carrying_families(self, V, group, columns: LevelBatch, index, rtol) -> tuple[LevelBatch, np.ndarray]:
        """The same without adhesion, and the absolute tolerances that go with ``rtol`` (n,)."""
        surface, rough = self.surface, level_means(columns, np.full(columns.size, _ROUGH)).values
        fractions = max(1.0, _SHARES / surface.rtol)
        size = rough[:, 1] + surface.friction_floor if self.friction is None else self.friction[index]
        # what is carried counts on the contact alone
        rare = 1 / np.maximum(rough[:, 2], LEAST_CONTACT)
        rarest, friction = _most(group, rare, V.size), -_most(group, -rare * size, V.size)
        below, laws, p_max = range(1, self.M), _LAWS * surface.laws, _most(group, crest_pressure(columns), V.size)
        levels, saturated = [surface.columns(i, V) for i in below], surface.saturated(V)[1:]
        carry = lower_laws(levels, saturated, p_max, laws, laws * friction, laws * fractions * rarest)
        columns = replace(columns, carry=carry, group=group)
        return columns, tolerances(columns, rtol * _OF_TOP / self.M * size, rtol * fractions)

    def _write(self, index, root: Penetrations, means):
        out, values, own = self.out, means.values, len(QUANTITIES)
        out.D[index] = root.D
        p = out.p[index] = self.load[index] if self.by_pressure else values[:, 0]
        values[:, :own], errors = root.meeting(p, means)
        out.p_error[index] = 0.0 if self.by_pressure else errors[:, 0]
        # what is carried follows its own, three for each level below, then an error for each
        count = own + 3 * (self.M - 1)
        for quantity, rows in enumerate((out.tau, out.contact, out.adhesion), start=1):
            rows[:, index] = values[:, [quantity, *range(own + quantity - 1, count, 3)]].T
        for fractions in (out.contact, out.adhesion):
            fractions[:, index] = np.clip(fractions[:, index], 0.0, 1.0)  # laws, interpolated, may be a rounding outside
        error = errors[:, 1] + means.errors[:, range(own, count, 3)].sum(axis=1) + np.abs(values[:, count:]).sum(axis=1)
        # what is carried is that of the pressure at D: it grows with the contact, and with what that is pressed by; and where it
        # is not known which part of the curve it is
        grown = np.abs(root.slope[:, 1:3]) * errors[:, :1] + root.other[:, 1:3]
        grown /= np.maximum(np.abs(values[:, 1:3]), np.finfo(float).tiny)
        error += np.minimum(grown.sum(axis=1), 1.0) * np.abs(values[:, range(own, count, 3)]).sum(axis=1)
        # the other side of a jump may carry any friction of the lower levels
        out.error[index] = error + np.where(root.in_jump, np.abs(out.tau[1:, index]).sum(axis=0), 0.0)


def _most(group: np.ndarray, values: np.ndarray, groups: int) -> np.ndarray:
    """The greatest of the ``values`` (n,) of each ``group`` (n,), -inf where there is none."""
    out = np.full(groups, -np.inf)
    np.maximum.at(out, group, values)
    return out

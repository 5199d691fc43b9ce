"""A surface without adhesion at points of load and velocity."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from ...errors import SolverError
from ...orbit.foundation import foundation_of
from ..error_budget import LEAST_CONTACT
from .family import are_families
from .stack import FamilyStack, Wanted

if TYPE_CHECKING:
    from ...multilevel import Surface

#: share of what is allowed that a further attempt aims at, how much finer it is at least and at most, and how many there are
_SURE, _FINER, _FINEST, _ATTEMPTS = 0.3, 0.3, 1e-3, 4
#: accuracy of that where there are more levels
_ROUGH = 1e-2
#: friction is at first taken to be this many times what counts beside it
_GUESS = 30.0
#: share of the friction that its error may be at most, whatever counts beside it
_DIGIT = 0.1


@dataclass(frozen=True)
class Points:
    """Results at points (n,): penetration, m; pressure, Pa; friction, Pa, contact and adhesion of each level, (levels,
    n); error of all friction, Pa; and which are ``certain`` to be as accurate as was asked for."""

    D: np.ndarray
    p: np.ndarray
    tau: np.ndarray
    contact: np.ndarray
    error: np.ndarray
    certain: np.ndarray


@dataclass(frozen=True)
class NonadhesiveSurface:
    """A surface at the velocities ``V`` (G,), and ``p_full`` (levels, G): saturation of each level with all below it. With
    adhesion no point is solved."""

    surface: Surface
    V: np.ndarray
    p_full: Sequence[np.ndarray]

    def solve(self, group: np.ndarray, load: np.ndarray, by_pressure: bool) -> Points:
        """Points at ``load`` > 0 (Pa, or m) and velocities ``V[group]``, (n,)."""
        n, levels = load.size, len(self.surface.levels)
        out = Points(
            np.zeros(n), np.zeros(n), np.zeros((levels, n)), np.zeros((levels, n)), np.full(n, np.inf), np.zeros(n, bool)
        )
        if not are_families(foundation_of(self.surface.at_level(0)), self.surface.adhesion.p_0, self.surface.levels, self.V):
            return out
        try:
            self._refine(out, group, load, by_pressure)
        except SolverError:
            # the general path solves them, or names the strip that it can't
            out.certain[:] = False
        return out

    def _refine(self, out: Points, group, load, by_pressure) -> None:
        n, levels, floor, rtol = load.size, len(self.surface.levels), self.surface.friction_floor, self.surface.rtol
        # the friction and the contact of level 1 alone say how well all of it has to be known; where there is only that
        # level it may do
        rough = self if levels == 1 else replace(self, surface=replace(self.surface, rtol=max(rtol, _ROUGH)))
        size = rough._attempt(out, np.arange(n), group, load, by_pressure, np.full(n, _GUESS * floor), 1)
        touching, finer = np.maximum(out.contact[0], LEAST_CONTACT), np.ones(n)
        for _ in range(_ATTEMPTS):
            left = np.flatnonzero(~out.certain)
            if not left.size:
                return
            wanted = finer[left] * size[left]
            size[left] = self._attempt(out, left, group[left], load[left], by_pressure, wanted, levels, wanted / touching[left])
            told = np.maximum(_DIGIT * (size - floor), 0.0)
            finer *= np.clip(_SURE * np.minimum(rtol * size, told) / out.error, _FINEST, _FINER)

    def _attempt(self, out: Points, index, group, load, by_pressure, size, levels, below=None):
        """Solve the points ``index`` on so many levels, to ``rtol size``, and the laws of lower levels to ``rtol below``;
        returns the size of friction, Pa."""
        surface, rtol, floor = self.surface, self.surface.rtol, self.surface.friction_floor
        which, row = np.unique(group, return_inverse=True)
        most, least = np.full(which.size, -np.inf), np.full((2, which.size), np.inf)
        np.maximum.at(most, row, load)
        np.minimum.at(least[0], row, size)
        np.minimum.at(least[1], row, size if below is None else below)
        h = surface.levels[0].h
        p_full, d_max = [p[which] for p in self.p_full[:levels]], None if by_pressure else most / h
        first, wanted = replace(surface, levels=surface.levels[:levels]), Wanted(rtol * least[0], rtol * least[1], rtol)
        stack = FamilyStack(first, self.V[which], p_full, most, d_max, wanted)
        found = stack.at(0, row, load if by_pressure else load / h, stack.laws(), by_pressure)
        friction, error = found.values[:, :-1:2], found.values[:, -1]
        total = floor + friction.sum(axis=1)
        out.D[index], out.p[index], out.error[index] = found.d * h, found.p, error
        out.tau[:levels, index], out.contact[:levels, index] = friction.T, found.values[:, 1:-1:2].T
        # a friction that nothing is told of is left to the general path: relative to it, not to the floor, it may be sure
        told = (error <= _DIGIT * (total - floor)) | (self.V[group] == 0)
        out.certain[index] = (error <= rtol * total) & told & (levels == len(surface.levels))
        return total

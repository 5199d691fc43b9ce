"""Where strips cease to be engaged all along: one curve for every velocity tells it for all penetrations of a level.

A strip whose whole gap adheres is the strip without adhesion at ``S = (D_j + p_0/K)/A`` (``problem.bare_cycle``). Its greatest
gap, ``A g(S)``, may not exceed delta_0. On a level ``D_j = D - h + 2 A``, so that with ``E = D - h + p_0/K``

    S = 2 + E/A,   and such an orbit ends where   E g(S) = delta_0 (S - 2).

Of the curve (S, g) this wants the point on the ray from (2, 0) along (E, delta_0), and A is ``delta_0/g`` there. At ``S = 0``
contact ends in turn. The gap falls with S, as orbits are ordered along the penetration: above ``S = 2`` there is one such
point. What unloading follows is the most engaged orbit, so these are transitions, on that branch, whatever the strip becomes
beyond. None of this decides a strip: panels end there, and are told what is found on either side.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..orbit.crossing import crossing
from ..orbit.direct import certified
from ..orbit.foundation import foundation_of
from ..orbit.groups import TWO_PI, Strips, bare_cycle
from ..orbit.materials import kernel_of
from ..orbit.start import start

if TYPE_CHECKING:
    from .strips import Columns

#: points of a curve: S up to 2, and shares of what lies above; dense at 2, where contact begins and where it fills the period
_BELOW = 2 * (np.arange(1, 13) / 12) ** 2
_ABOVE = np.concatenate(
    (0.2 ** np.arange(9, 2, -1), np.sin(0.5 * np.pi * np.arange(6, 24) / 24) ** 4, 1 - 0.1 ** np.arange(3, 7))
)
#: ``k V T_eps`` of a curve; the least also of what ``S`` at saturation exceeds 2 by: below, the gap forgets what happened in
#: contact
_LEAST, _MOST = 1e-3, 1e12
_EPS = np.finfo(float).eps
#: roundings of a penetration that are counted
_ROUNDED = 0.5
#: steps of Newton at most; one this small leaves an error of its square
_STEPS, _SMALL = 8, 1e-7


class Clinging:
    """The curves (S, g) of every velocity met so far. Belongs to one level with one material and closure."""

    def __init__(self):
        self._rows: dict[float, int] = {}
        #: S, g and the phases where contact begins, where it ends and where the gap is greatest: (velocities, 5, points)
        self._curves = np.empty((0, 5, _BELOW.size + _ABOVE.size))

    def ends(self, columns: Columns) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Columns and thetas (k,) at which strips cease to be engaged all along, or, being so, to touch, as far as known; and by
        how much the rounding of a penetration shifts these."""
        if not _tells(columns):
            return np.empty(0, int), np.empty(0), np.empty(0)
        a, h = columns.adhesion, columns.level.h
        # rounded once
        E = columns.D + (a.p_0 / columns.material.K - h)
        column, _, g = self._met(columns, E, np.full(E.size, -a.delta_0), np.full(E.size, 2 * a.delta_0))
        touching = np.flatnonzero((E < 0) & (E > -a.delta_0))
        column, A = np.concatenate((column, touching)), np.concatenate((a.delta_0 / g, -0.5 * E[touching]))
        inside = np.flatnonzero((A > 0) & (2 * A < h))
        column, theta = column[inside], 2 * np.arccos(np.sqrt(2 * A[inside] / h))
        digit = _ROUNDED * _EPS * (np.abs(columns.D[column]) + h + a.p_0 / columns.material.K)
        return column, theta, digit / np.maximum(0.25 * h * np.sin(theta), np.finfo(float).tiny)

    def crest(self, columns: Columns) -> np.ndarray:
        """Penetrations (n,) at which the crest ceases to be engaged all along, NaN where not known; the columns' own are not
        used."""
        out, a, A = np.full(columns.size, np.nan), columns.adhesion, 0.5 * columns.level.h
        if _tells(columns):
            one = np.ones(columns.size)
            column, S, _ = self._met(columns, one, 0 * one, -a.delta_0 / A * one)
            out[column] = S * A - a.p_0 / columns.material.K
        return out

    def _met(self, columns: Columns, by_g, by_S, constant) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Where ``by_g g + by_S S + constant``, (n,), falls through zero along the curves of the columns: which columns, S and g
        there."""
        row, curves = self._rows_of(columns), self._curves
        value = by_g[:, None] * curves[row, 1] + by_S[:, None] * curves[row, 0] + constant[:, None]
        column, at = np.nonzero((value[:, :-1] > 0) & (value[:, 1:] <= 0))
        before, after, row = value[column, at], value[column, at + 1], row[column]
        share = (before / (before - after))[:, None]
        S, g, x, a, phase = ((1 - share) * curves[row, :, at] + share * curves[row, :, at + 1]).T
        strips = columns.groups(columns.V[column], S)
        S, g = _closer(kernel_of(columns.material), strips, x, a, phase, by_g[column], by_S[column], constant[column])
        found = ~np.isnan(S)
        return column[found], S[found], g[found]

    def _rows_of(self, columns: Columns) -> np.ndarray:
        values, which = np.unique(columns.V, return_inverse=True)
        rows = np.array([self._rows.setdefault(float(v), len(self._rows)) for v in values], int)
        fresh = np.flatnonzero(rows >= len(self._curves))
        if fresh.size:
            self._curves = np.concatenate((self._curves, _curves(columns, values[fresh])))
        return rows[which]


def _tells(columns: Columns) -> bool:
    """Whether orbits that are engaged all along are what is followed, on a wavy level, and have one time to remember."""
    adhesive = columns.branch == "unloading" and columns.adhesion.p_0 > 0 and columns.level.h > 0
    return adhesive and not hasattr(kernel_of(columns.material), "MODES")


def _curves(columns: Columns, V) -> np.ndarray:
    """Curves at the velocities ``V``, (velocities, 5, points), NaN where one is not known."""
    kernel = kernel_of(columns.material)
    foundation, rate = foundation_of(columns.material), columns.level.k * V
    above, beta = foundation.modulus_ratio(rate) - 1, rate * foundation.longest_time
    out = np.full((V.size, 5, _BELOW.size + _ABOVE.size), np.nan)
    usual = np.flatnonzero((beta > _LEAST) & (beta < _MOST) & (above > _LEAST))
    S = np.concatenate((np.tile(_BELOW, (usual.size, 1)), 2 + above[usual, None] * _ABOVE), axis=1)
    strips = columns.groups(np.repeat(V[usual], S.shape[1]), S.ravel())
    cycle = bare_cycle(kernel, strips)
    orbit, good, _ = certified(kernel, cycle, "ac", start(kernel, cycle, "ac"))
    good = np.flatnonzero(good)
    part, x, a = strips.take(good), orbit.x[good], orbit.a[good]
    # the slope of the gap is beta-th of minus this, and falls through zero once, where the load rises
    lag = lambda phase, i: _lag(kernel, part.take(i), a[i], phase)  # noqa: E731
    phase, _ = crossing(lag, np.maximum(a, cycle.centre[good] + np.pi), x + TWO_PI)
    known = np.full((5, strips.size), np.nan)
    known[:, good] = part.D, kernel.gap_after(a, phase, 0.0, 0.0, part.D, part.beta), x, a, phase
    out[usual] = known.reshape(5, *S.shape).swapaxes(0, 1)
    return out


def _lag(kernel, s: Strips, a, phase):
    """Load behind which the gap since ``a`` stays, and its derivative by the phase."""
    behind = -kernel.gap_after(a, phase, 0.0, 0.0, s.D, s.beta) - kernel.forcing(phase, s.D, s.beta)
    rise = kernel.profile_slope(phase) - s.beta * np.cos(phase)
    return behind, -behind / s.beta - rise


def _closer(kernel, strips: Strips, x, a, phase, by_g, by_S, constant) -> tuple[np.ndarray, np.ndarray]:
    """S and the greatest gap where ``by_g g + by_S S + constant`` vanishes, by Newton for the phases and S together; NaN where
    that fails."""
    out = np.full((2, strips.size), np.nan)
    state, index = np.stack((x, a, phase, strips.D)), np.arange(strips.size)
    for _ in range(_STEPS):
        if not index.size:
            break
        with np.errstate(all="ignore"):  # what is lost is no number
            step, g = _step(kernel, strips.take(index), *state, by_g[index], by_S[index], constant[index])
        state = state + step
        size = np.abs(step).max(axis=0)
        x, a, phase, S = state
        ordered = (x < a) & (a < phase) & (phase < x + TWO_PI) & (S > 0)
        done = ordered & (size <= _SMALL)
        out[:, index[done]] = S[done], g[done]
        going = ordered & ~done
        state, index = state[:, going], index[going]
    return out[0], out[1]


def _step(kernel, s: Strips, x, a, phase, S, by_g, by_S, constant) -> tuple[np.ndarray, np.ndarray]:
    """A step of the phases and S, (4, n), and the greatest gap after it. All equations are linear in S."""
    excess, excess_x, excess_a = kernel.excess_link(x, a, 0.0, 0.0, S, s.alpha, s.beta, s.L)
    _, closing_a, closing_x = kernel.gap_link(a, x + TWO_PI, 0.0, 0.0, S, s.beta)
    value, balance = kernel.residual_ac(x, a, s.alpha, s.beta, s.J, s.L, 0.0, 0.0, S, s.chi)
    # of the closing link and the balance of z the same combination as in ``strip.chain``: its slopes are the link's
    balance = balance + s.J * value
    excess_S, closing_S = -kernel.decay_loss(a - x, s.alpha), kernel.decay_loss(x + TWO_PI - a, s.beta)
    determinant = excess_x * closing_a - excess_a * closing_x
    solved = lambda one, two: ((excess_a * two - closing_a * one) / determinant, (closing_x * one - excess_x * two) / determinant)  # noqa: E731
    (x_0, a_0), (x_1, a_1) = solved(excess, balance), solved(excess_S, closing_S)
    g, g_a, g_phase = kernel.gap_link(a, phase, 0.0, 0.0, S, s.beta)
    g_S = kernel.decay_loss(phase - a, s.beta)
    load_rises = kernel.profile_slope(phase) - s.beta * np.cos(phase)
    # the gap is greatest where it equals minus the load
    miss, turn = g + kernel.forcing(phase, S, s.beta), g_phase + load_rises
    phase_0, phase_1 = -(miss + g_a * a_0) / turn, -(g_a * a_1 + g_S + 1) / turn
    g_0, g_1 = g + g_a * a_0 + g_phase * phase_0, g_a * a_1 + g_phase * phase_1 + g_S
    dS = -(by_g * g_0 + by_S * S + constant) / (by_g * g_1 + by_S)
    return np.stack((x_0 + x_1 * dS, a_0 + a_1 * dS, phase_0 + phase_1 * dS, dS)), g_0 + g_1 * dS

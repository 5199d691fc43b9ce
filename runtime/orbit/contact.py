"""Pressure in the contact of strips: its extremes, and where it passes a given value."""

from abc import ABC, abstractmethod
from types import ModuleType
from typing import Any

import numpy as np

from ..numerics.roots import falling_root
from .regimes import CODE
from .solved import Solved


class Contact(ABC):
    """Contact intervals of the strips ``index`` in phase, with the pressure in Pa inside them, arrays (m,).

    ``b``, ``a``: first and last phase (of saturated contact: a period around its peak), ``top``: phase of the peak ``p_peak``;
    ``p_least``: pressure just after entry (without T_sigma it steps there); in saturated contact the least. The pressure rises
    to its peak and falls from there: each value is passed once either way.
    """

    def __init__(self, kernel: ModuleType, strips: Any, solved: Solved, scales: dict, index: np.ndarray):
        self.kernel, self.s = kernel, strips.take(index)
        self.unit, self.flat = scales["p"][index], scales["flat"][index]
        self.full = solved.code[index] == CODE["c"]
        self.mean = np.where(self.flat, solved.p_mean[index], self.s.D - 1)
        storage, loss, compliance = self._foundation()
        self.amplitude = np.where(self.flat, 0.0, np.hypot(storage, loss))
        self.centre = np.broadcast_to(-np.arctan2(loss, storage), index.shape)  # phase of the saturated field's maximum
        self.b = np.where(self.full, self.centre - np.pi, solved.b[index])
        self.a = np.where(self.full, self.centre + np.pi, solved.a[index])
        snap = solved.code[index] == CODE["afc"]
        reach = np.divide(self.s.delta_0, compliance, out=np.zeros(index.size), where=snap)
        self.q_b = np.where(snap, self.s.p_0 - reach, 0.0)
        self._enter(solved, index)
        self.top = self.centre.copy()
        part, every = np.flatnonzero(~self.full), np.arange(index.size)
        self.top[part] = falling_root(lambda phase, sub: self._excess(part[sub], phase)[1], self.b[part], self.a[part])
        self.p_peak = self.pressure(every, self.top)
        entered = self.b + 1e-12 * (self.a - self.b)
        self.p_least = self.pressure(every, np.where(self.full, self.centre - np.pi, entered))
        # the same for all, to the last digit, where it does not step
        rises = ~self.full & (compliance > 0)
        self.p_least[rises] = ((self.q_b - self.s.p_0) * self.unit)[rises]

    @abstractmethod
    def _foundation(self) -> tuple:
        """Storage and loss of the foundation, and its instantaneous compliance."""

    @abstractmethod
    def _enter(self, solved: Solved, index: np.ndarray) -> None:
        """Keep what the pressure in contact starts from."""

    @abstractmethod
    def _excess(self, rows: np.ndarray, phase: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Pressure above -p_0 in partial contact, in the strip's own unit, and its slope; both (m,)."""

    @abstractmethod
    def _excess_alone(self, rows: np.ndarray, phase: np.ndarray) -> np.ndarray:
        """The same without its slope, for phases (m,) or (nodes, m)."""

    def pressure(self, rows: np.ndarray, phase: np.ndarray) -> np.ndarray:
        """Pressure, Pa, of the strips ``rows`` (m,) at the phases ``phase`` (m,) or (nodes, m) in their contact."""
        full = self.full[rows]
        p = np.empty(phase.shape)
        i = rows[full]
        p[..., full] = self.mean[i] + self.amplitude[i] * np.cos(phase[..., full] - self.centre[i])
        i = rows[~full]
        p[..., ~full] = self._excess_alone(i, phase[..., ~full]) - self.s.p_0[i]
        return p * self.unit[rows]

    def slope(self, rows: np.ndarray, phase: np.ndarray) -> np.ndarray:
        """Derivative of the pressure by phase, in the strip's own unit, of strip ``rows`` at ``phase`` in its contact."""
        out = -self.amplitude[rows] * np.sin(phase - self.centre[rows])
        part = np.flatnonzero(~self.full[rows])
        out[part] = self._excess(rows[part], phase[part])[1]
        return out

    def passes(self, rows: np.ndarray, p: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Phases at which the pressure of the strips ``rows`` (k,) passes ``p`` (k,), Pa, not above their peaks, upward and
        downward."""
        level, full = p / self.unit[rows], self.full[rows]
        at = rows[full]
        up, down = self.b[rows], self.a[rows]
        up[full], down[full] = passages(level[full], self.mean[at], self.amplitude[at], self.centre[at])
        goal = level + self.s.p_0[rows]
        rising, falling = (np.flatnonzero(~full & passed) for passed in (self.q_b[rows] < goal, goal > 0))
        pair, upward = np.concatenate((rising, falling)), np.arange(rising.size + falling.size) < rising.size
        i, goal = rows[pair], goal[pair]
        sign, outer = np.where(upward, -1.0, 1.0), np.where(upward, self.b[i], self.a[i])
        low, high = np.where(upward, outer, self.top[i]), np.where(upward, self.top[i], outer)

        def excess(phase, sub):
            value, slope = self._excess(i[sub], phase)
            return sign[sub] * (value - goal[sub]), sign[sub] * slope

        # as far along as on a parabola about the peak; at exit the excess is zero
        peak, least = self.p_peak[i] / self.unit[i] + self.s.p_0[i], np.where(upward, self.q_b[i], 0.0)
        share = np.divide(peak - goal, peak - least, out=np.zeros(i.size), where=peak > least)
        found = falling_root(excess, low, high, self.top[i] + (outer - self.top[i]) * np.sqrt(np.clip(share, 0.0, 1.0)))
        up[rising], down[falling] = found[upward], found[~upward]
        return up, down


class SingleContact(Contact):
    """Of a foundation with one relaxation time."""

    def _foundation(self) -> tuple:
        s = self.s
        return self.kernel.storage(s.alpha, s.beta), self.kernel.loss(s.alpha, s.beta, s.L), s.J

    def _enter(self, solved: Solved, index: np.ndarray) -> None:
        pass

    def _arguments(self, i: np.ndarray, phase: np.ndarray) -> tuple:
        s = self.s
        return self.b[i], phase, self.q_b[i], s.p_0[i], s.D[i], s.alpha[i], s.beta[i], s.L[i]

    def _excess(self, rows: np.ndarray, phase: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        start, _, *entry = self._arguments(rows, phase)
        return self.kernel.excess_event(phase, *self.kernel.excess_entry(start, *entry))

    def _excess_alone(self, rows: np.ndarray, phase: np.ndarray) -> np.ndarray:
        return self.kernel.excess_after(*self._arguments(rows, phase))


def passages(level: np.ndarray, mean: np.ndarray, amplitude: np.ndarray, centre: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Phases at which ``mean + amplitude cos(phase - centre)`` passes ``level`` upward and downward, about its peak ``centre``.

    Where it is above all along they are a period apart; all arguments of one shape, ``level`` nowhere above the peak.
    """
    cosine = np.divide(level - mean, amplitude, out=np.full(level.shape, -1.0), where=amplitude > 0)
    half = np.arccos(np.clip(cosine, -1, 1))
    return centre - half, centre + half

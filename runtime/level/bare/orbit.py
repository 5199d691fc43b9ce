"""Orbits of strips without adhesion in closed form, from the width of their contact.

With the width ``a - b`` of the contact given, the boundary equations (``residual_ac`` at p_0 = 0) are linear and
homogeneous in ``(D - 1, cos m, sin m)``, m the phase in the middle of the contact: two equations that leave one
direction, and so m and D without any search. Orbits are ordered: at a larger penetration more of the period is in
contact. So every strip has one width and every width one strip, and the direction is that strip's: of its two senses
the one in which the mean pressure is positive.
"""

from __future__ import annotations

from copy import copy
from dataclasses import dataclass

import numpy as np

from ...orbit.foundation import Foundation
from ...orbit.groups import Strips
from ...orbit.modes.polish import arguments
from ...orbit.modes.problem import ModeStrips, take_modes
from ...orbit.solved import groups

#: a penetration beside which the profile is nothing: what is left of an equation is its coefficient of D
_HUGE = 1e200
#: how far the equations may be missed, in the size of their terms
_ROUNDING = 1e-9


@dataclass(frozen=True)
class Orbits:
    """Strips in partial contact, arrays (N,), in units of A and K A: penetration ``D``, entry ``b`` and exit ``a``,
    means of pressure and of friction (times kA). ``certified``: the equations hold, the strip
    carries pressure."""

    D: np.ndarray
    b: np.ndarray
    a: np.ndarray
    p_mean: np.ndarray
    tau_mean: np.ndarray
    certified: np.ndarray


class Wave:
    """A foundation under a wave: ``rate`` (N,) is k V of each strip, 1/s. Everything that its orbits ask of the
    generated solver."""

    def __init__(self, foundation: Foundation, rate: np.ndarray):
        self.kernel = foundation.kernel
        self.many = hasattr(self.kernel, "MODES")
        if self.many:
            self.m = self.kernel.at_speed(foundation.modes, rate)
        else:
            m = foundation.material
            one = np.ones(rate.size)
            self.times = rate * m.T_sigma, rate * m.T_eps, m.J * one, m.L * one

    def at(self, index: np.ndarray) -> Wave:
        """The strips ``index``."""
        chosen = copy(self)
        if self.many:
            chosen.m = take_modes(self.m, index)
        else:
            chosen.times = tuple(v[index] for v in self.times)
        return chosen

    def strips(self, D):
        """The strips with these penetrations, (N,)."""
        none = np.zeros(D.size)
        if self.many:
            return ModeStrips(self.m, none, none, D)
        return Strips(*self.times, none, none, D, none)

    def _arguments(self, D):
        return arguments(self.strips(D)) if self.many else groups(self.strips(D))

    def residual(self, middle, width, D):
        """Both boundary equations, (2, N)."""
        b, a = middle - 0.5 * width, middle + 0.5 * width
        return np.array(np.broadcast_arrays(*self.kernel.residual_ac(b, a, *self._arguments(D))))

    def means(self, b, a, D):
        """Means of pressure and friction."""
        return self.kernel.means_ac(b, a, *self._arguments(D))

    def orbits(self, width: np.ndarray, means: bool = True) -> Orbits:
        """The strips whose contact is so wide, radians between 0 and 2 pi, (N,); their ``means`` are nan if not
        wanted."""
        N, none = width.size, np.zeros(width.size)
        # all at once: with D alone, and without it what multiplies cos m, and sin m
        middles, penetrations = np.repeat((0.0, 0.0, 0.5 * np.pi), N), np.repeat((_HUGE, 0.0, 0.0), N)
        three = self.at(np.tile(np.arange(N), 3)).residual(middles, np.tile(width, 3), penetrations).reshape(2, 3, N)
        penetrate = three[:, 0] / _HUGE
        cosine, sine = (penetrate[1] * three[0, k] - penetrate[0] * three[1, k] for k in (1, 2))
        middle = np.arctan2(-cosine * np.sign(sine), np.abs(sine))
        # D from both equations, each as far as it depends on it
        left = self.residual(middle, width, none)
        D = -(left * penetrate).sum(axis=0) / (penetrate * penetrate).sum(axis=0)
        b, a = middle - 0.5 * width, middle + 0.5 * width
        p_mean, tau_mean = self.means(b, a, D) if means else np.full((2, D.size), np.nan)
        missed, size = np.abs(left + penetrate * D), np.abs(penetrate).max(axis=0) * (1 + np.abs(D))
        met = (missed <= _ROUNDING * size).all(axis=0) & (D > 0) & ~(p_mean <= 0)
        return Orbits(D, b, a, p_mean, tau_mean, met)

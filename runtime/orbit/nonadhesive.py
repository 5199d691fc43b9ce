"""Orbits of strips without adhesion in closed form, from the width of their contact.

With the width ``a - b`` of the contact given, the boundary equations (``residual_ac`` at p_0 = 0) are linear and homogeneous in
``(D - 1, cos m, sin m)``, m the phase in the middle of the contact: two equations that leave one direction, and so m and D
without any search. Orbits are ordered: at a larger penetration more of the period is in contact. So every strip has one width
and every width one strip, and the direction is that strip's, in the sense that makes the mean pressure positive.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from ..errors import SolverError
from ..numerics.rounding import LARGEST
from .batch import pick

if TYPE_CHECKING:
    from .abstract_foundation import Foundation

#: how far the equations may be missed, in the size of their terms: rounding alone reaches 1e-12
_ROUNDING = 1e-9


@dataclass(frozen=True)
class Orbits:
    """Strips in partial contact, arrays (N,), in units of A and K A: penetration ``D``, entry ``b`` and exit ``a``,
    means of pressure and of friction (times kA). ``certified``: the equations hold, the strip carries pressure."""

    D: np.ndarray
    b: np.ndarray
    a: np.ndarray
    p_mean: np.ndarray
    tau_mean: np.ndarray
    certified: np.ndarray

    def sure(self) -> Orbits:
        """These; ``SolverError`` if one of them is not certified."""
        if not self.certified.all():
            raise SolverError("a strip without adhesion was not certified")
        return self


class Waves:
    """Waves of N strips without adhesion over a foundation, each at its own speed: ``strips``, at whatever penetration, and the
    share of their speed, ``pace``, that they are had at."""

    def __init__(self, foundation: Foundation, strips: Any, pace: np.ndarray):
        self.foundation, self.kernel, self.strips, self.pace = foundation, foundation.kernel, strips, pace

    def pressure(self, orbits: Orbits) -> Callable[..., np.ndarray]:
        """Pressure in contacts, as a function of shares (k, n) of them from entry to exit and the rows (k,) of strips, or all."""
        s, b, width = replace(self.strips, D=orbits.D), orbits.b, orbits.a - orbits.b
        constants = self.foundation.excess(b, self.foundation.entry("cf", (b, orbits.a), s), s)

        def at(share, rows=None):
            rows = np.arange(width.size) if rows is None else rows
            known = (c[..., None] if np.ndim(c) else c for c in (pick(constant, rows) for constant in constants))
            return np.maximum(self.kernel.excess_event(b[rows, None] + width[rows, None] * share, *known)[0], 0.0)

        return at

    def orbits(self, width: np.ndarray, means: bool = True) -> Orbits:
        """The strips whose contact is so wide, radians between 0 and 2 pi, (N,); their ``means`` are nan if not wanted."""
        N, none = width.size, np.zeros(width.size)
        # all at once: with D alone, beside which the profile is nothing, and without it what multiplies cos m, and sin m
        middles, D = np.repeat((0.0, 0.0, 0.5 * np.pi), N), np.repeat((LARGEST, 0.0, 0.0), N)
        half = np.tile(0.5 * width, 3)
        tiled = replace(self.strips.take(np.tile(np.arange(N), 3)), D=D)
        three = self.kernel.residual_ac(middles - half, middles + half, *tiled.arguments)
        three = np.array(np.broadcast_arrays(*three)).reshape(2, 3, N)
        penetrate = three[:, 0] / LARGEST
        cosine, sine = (penetrate[1] * three[0, k] - penetrate[0] * three[1, k] for k in (1, 2))
        middle = np.arctan2(-cosine * np.sign(sine), np.abs(sine))
        b, a = middle - 0.5 * width, middle + 0.5 * width
        # D from both equations, each as far as it depends on it
        left = np.array(np.broadcast_arrays(*self.kernel.residual_ac(b, a, *replace(self.strips, D=none).arguments)))
        D = -(left * penetrate).sum(axis=0) / (penetrate * penetrate).sum(axis=0)
        p_mean, tau_mean = self.kernel.means_ac(b, a, *replace(self.strips, D=D).arguments) if means else np.full((2, N), np.nan)
        missed, size = np.abs(left + penetrate * D), np.abs(penetrate).max(axis=0) * (1 + np.abs(D))
        certified = (missed <= _ROUNDING * size).all(axis=0) & (D > 0) & ~(p_mean <= 0)
        # nothing steps: in the limit of infinite speed friction falls like 1/V
        return Orbits(D, b, a, p_mean, tau_mean * self.pace, certified)

"""The foundation with several relaxation times and its generated solver, as ``orbit.abstract_foundation.Foundation``."""

from __future__ import annotations

from functools import lru_cache, partial
from types import ModuleType

import numpy as np

from ...errors import InputError
from ...inputs.model import ModelMaterial, modes_of
from ..abstract_foundation import Foundation
from ..flat import is_flat, solve_with_flat
from ..groups import snaps_in
from ..materials import parameters
from ..nonadhesive import Waves
from ..si import CERTIFIED, refuse_uncertified
from .engine import solve_modes
from .fields import greatest_gap, least_gap, zones_of
from .problem import ModeStrips, take_modes


class ManyTimes(Foundation):
    """With several relaxation times. ``modes``: the kernel's ``Modes`` in seconds, last axis strips or of length one."""

    def __init__(self, kernel: ModuleType, material, K=None, modes=None):
        self.kernel, self.material = kernel, material
        if modes is None:
            K, modes = material.K, material.modes if isinstance(material, ModelMaterial) else _of_prony(kernel, material)[1]
        self.K, self.modes, self.parameters, self.J = K, modes, (K, modes), modes.J_0

    @property
    def longest_time(self):
        return float(self.modes.beta.max())

    @property
    def lossiest_rate(self):
        """By a grid in the logarithm of the rate, refined about its largest value."""
        times = self.modes.alpha[self.modes.alpha > 0]
        if not times.size or (self.modes.alpha == 0).any():
            return np.inf
        low, high = np.log(0.1 / times.max()), np.log(10 / times.min())
        for _ in range(6):
            grid = np.linspace(low, high, 401)
            top = grid[np.argmax(self.kernel.loss(self.kernel.at_speed(self.modes, np.exp(grid))))]
            width = grid[1] - grid[0]
            low, high = top - width, top + width
        return float(np.exp(top))

    def flat(self, shape) -> ManyTimes:
        m = self.material
        if isinstance(m, ModelMaterial) or not any(np.ndim(v) for v in (m.K, *m.moduli, *m.times)):
            return self
        spread = lambda v: np.broadcast_to(v, shape).ravel()  # noqa: E731
        K, moduli, times = spread(m.K), np.stack([spread(v) for v in m.moduli]), np.stack([spread(v) for v in m.times])
        return ManyTimes(self.kernel, m, *modes_of(self.kernel, {"K": K, "K_i": moduli, "tau_i": times}))

    def solve(self, l, A, D, V, p_0, delta_0, edge, branch):  # noqa: E741
        K, p_0, delta_0 = (np.broadcast_to(np.asarray(v, float), l.shape) for v in (self.K, p_0, delta_0))
        k = 2 * np.pi / l
        with np.errstate(over="ignore"):  # refused below, by name
            m = self.kernel.at_speed(self.modes, k * V)
            longest = np.broadcast_to(m.beta.max(axis=0), l.shape)
        if np.any(longest > CERTIFIED):
            raise InputError(
                "V", float(V[longest > CERTIFIED][0]), f"k V times the longest retardation time at most {CERTIFIED:g}"
            )
        flat = is_flat(A, longest, D, p_0 / K, delta_0)
        unit = np.where(flat, 1.0, A)
        strips = ModeStrips(m, p_0 / K / unit, delta_0 / unit, D / unit, snaps_in(m.J_0 * (p_0 / K), delta_0))
        solved = solve_with_flat(partial(solve_modes, self.kernel), strips, flat, branch == "unloading")
        named = {"l": l, "A": A, "D": D, "V": V, **self._named(l.shape), "p_0": p_0, "delta_0": delta_0}
        refuse_uncertified(solved, named, edge, branch)
        return solved, strips, {"k": k, "A": A, "D": D, "p": K * unit, "length": unit, "flat": flat}

    def _named(self, shape):
        named = parameters(self.material)
        # a material of arrays was spread over the strips in `flat`; the strip's own values are in K and the modes
        return {n: np.broadcast_to(v, shape) for n, v in named.items() if np.ndim(v) == 0} | {"K": np.broadcast_to(self.K, shape)}

    def at_rate(self, rate):
        return (self.kernel.at_speed(self.modes, np.atleast_1d(np.asarray(rate, float))),)

    def boundary_arguments(self, rate, D, p_0, delta_0, edge):
        return *self.at_rate(rate), p_0, delta_0, D

    def strips(self, arguments):
        return ModeStrips(*arguments)

    def fold(self, sequence, edges, arguments):
        """Determinant of the boundary equations' derivatives by the edges."""
        _, rows = getattr(self.kernel, f"residual_and_jacobian_{sequence}")(*edges, *arguments)
        return np.linalg.det(np.array([np.broadcast_arrays(edges[0], *row)[1:] for row in rows]).transpose(2, 0, 1))

    def release(self, edges, arguments):
        s = ModeStrips(*arguments)
        return greatest_gap(self.kernel, edges, s) - s.delta_0

    def closing(self, edges, arguments):
        return least_gap(self.kernel, edges, ModeStrips(*arguments))

    def waves(self, rate):
        return ModeWaves(self.kernel, *self.at_rate(rate))

    def moduli(self, strips):
        return self.kernel.storage(strips.m), self.kernel.loss(strips.m), strips.m.J_0

    def saturated(self, strips, phase):
        return self.kernel.saturated_pressure(phase, strips.D, strips.m)

    def zones(self, sequence, edges, strips):
        return (zone[:3] for zone in zones_of(self.kernel, sequence, strips, edges))

    def excess(self, start, entry, strips):
        return self.kernel.excess_entry(start, entry, strips.p_0, strips.D, strips.m)

    def gap(self, start, phase, entry, pressure, strips):
        return self.kernel.gap_after(start, phase, entry, pressure, strips.D, strips.m)


class ModeWaves(Waves):
    """Strips without adhesion. ``groups``: the kernel's ``Modes`` at the strips' speeds."""

    def take(self, index):
        return ModeWaves(self.kernel, take_modes(self.groups, index))

    def _arguments(self, D):
        none = np.zeros(D.size)
        return self.groups, none, none, D

    def local_pressure(self, orbits):
        state = self.kernel.state_ac(orbits.b, orbits.a, *self._arguments(orbits.D))
        entry = self.kernel.overstress(state, 0.0, self.groups)

        def local(rows, phase):
            m = type(self.groups)(*(v[..., None] if np.ndim(v) else v for v in take_modes(self.groups, rows)))
            after = self.kernel.overstress_after(orbits.b[rows, None], phase, entry[:, rows, None], m)
            return self.kernel.contact_pressure(phase, after, orbits.D[rows, None])

        return local


def _of_prony(kernel, material):
    if any(np.ndim(v) for v in (material.K, *material.moduli, *material.times)):
        column = lambda v: np.stack(np.broadcast_arrays(*v)).reshape(len(v), -1)  # noqa: E731
        return modes_of(kernel, {"K": np.ravel(material.K), "K_i": column(material.moduli), "tau_i": column(material.times)})
    return _of_numbers(kernel, material.K, material.moduli, material.times)


@lru_cache(maxsize=256)
def _of_numbers(kernel, K: float, moduli: tuple[float, ...], times: tuple[float, ...]):
    """Found once for all strips of a foundation: with fourteen times it takes as long as hundreds of strips."""
    column = lambda v: np.array(v, float)[:, None]  # noqa: E731
    K, modes = modes_of(kernel, {"K": np.array([K]), "K_i": column(moduli), "tau_i": column(times)})
    for shared in (K, *modes):
        shared.setflags(write=False)
    return K, modes

"""The foundation with one relaxation time and its generated solver, as ``orbit.foundation.Foundation``."""

from __future__ import annotations

from types import ModuleType

import numpy as np

from ..inputs.material import StandardLinearSolid
from ..numerics.roots import falling_root
from .contact import SingleContact
from .fields import fields
from .groups import TWO_PI, slowed
from .nonadhesive import SingleWaves
from .si import refuse_uncertified, solve_si


class SingleTime:
    """See ``orbit.foundation.Foundation``."""

    def __init__(self, kernel: ModuleType, material: StandardLinearSolid):
        self.kernel, self.material, self.K = kernel, material, material.K

    @property
    def longest_time(self):
        return self.material.T_eps

    @property
    def lossiest_rate(self):
        return 1 / self.material.T_sigma if self.material.T_sigma > 0 else np.inf

    def flat(self, shape) -> SingleTime:
        """The same with array parameters broadcast to ``shape`` and flattened, like everything else."""
        m = self.material
        if not any(np.ndim(v) for v in (m.K, m.T_eps, m.T_sigma)):
            return self
        return SingleTime(
            self.kernel, StandardLinearSolid(*(np.broadcast_to(v, shape).ravel() for v in (m.K, m.T_eps, m.T_sigma)))
        )

    def solve(self, l, A, D, V, p_0, delta_0, edge, branch):  # noqa: E741
        m = self.material
        inputs = (l, A, D, V, m.K, m.T_eps, m.T_sigma, p_0, delta_0)
        solved, strips, scales = solve_si(self.kernel, *inputs, m.J, m.L, edge=edge, branch=branch)
        names = ("l", "A", "D", "V", "K", "T_eps", "T_sigma", "p_0", "delta_0")
        refuse_uncertified(solved, dict(zip(names, inputs, strict=True)), edge, branch)
        return solved, strips, scales

    def fields(self, strips, solved, phase):
        return fields(self.kernel, strips, solved, phase)

    def boundary_arguments(self, rate, D, p_0, delta_0, edge):
        m, one = self.material, np.ones(D.size)
        chi = one * (edge == "constitutive")
        rate = rate * slowed(rate * m.T_sigma)
        return rate * m.T_sigma, rate * m.T_eps, one * m.J, one * m.L, p_0, delta_0, D, chi

    def fold(self, sequence, edges, arguments):
        """``T' - 1`` times the load at the last edge: no pole there. Those at the other edges vanish where there is no fold."""
        _, beta, J, _, p_0, delta_0, D, chi = arguments
        *_, fold = getattr(self.kernel, f"onset_slope_{sequence}")(*edges, *arguments)
        return fold * (self.kernel.forcing(edges[-1], D, beta) + delta_0 + chi * J * p_0)

    def release(self, edges, arguments):
        """Where the load harmonic rises through ``-p_0 - delta_0`` a gap of delta_0 turns."""
        _, beta, _, _, p_0, delta_0, D, _ = arguments
        centre, half = self.kernel.forcing_arc(p_0 + delta_0, D, beta)
        last = edges[-1]
        return self.kernel.gap_after(last, np.maximum(centre + TWO_PI - half, last), 0 * D, -p_0, D, beta) - delta_0

    def closing(self, edges, arguments):
        """Where the load harmonic falls through ``-p_0`` a gap of nothing turns."""
        _, beta, J, L, p_0, delta_0, D, chi = arguments
        centre, half = self.kernel.forcing_arc(p_0, D, beta)
        first, (gap, _) = edges[0], self.kernel.adhesive_onset(p_0, delta_0, J, L, chi)
        return self.kernel.gap_after(first, np.maximum(centre + half, first), gap, -p_0, D, beta)

    def peak(self, sequence, edges, arguments, pressure):
        alpha, beta, J, L, p_0, delta_0, D, _ = arguments
        place = 0 if sequence in ("ac", "cf", "afc") else 1
        q_on = self.kernel.snap_onset(p_0, delta_0, J, L)[0] if sequence == "afc" else 0 * D
        groups = q_on, p_0, D, alpha, beta, L
        entry = self.kernel.excess_entry(edges[place], *groups)

        def slope(phase, sub):
            return self.kernel.excess_event(phase, *(constant[sub] for constant in entry))[1]

        top = falling_root(slope, edges[place], edges[place + 1])
        return self.kernel.excess_after(edges[place], top, *groups) - p_0 - pressure

    def waves(self, rate):
        m, one = self.material, np.ones(rate.size)
        return SingleWaves(self.kernel, (rate * m.T_sigma, rate * m.T_eps, one * m.J, one * m.L))

    def contact(self, strips, solved, scales, index):
        return SingleContact(self.kernel, strips, solved, scales, index)

    def modulus_ratio(self, rate):
        return self.kernel.modulus_ratio(rate * self.material.T_sigma, rate * self.material.T_eps)

    def saturation_pressure(self, p_0, l, h, V):  # noqa: E741
        m = self.material
        return self.kernel.level_saturation_pressure(m.K, m.T_eps, m.T_sigma, p_0, l, h, V)

    def saturation_penetration(self, p_0, l, h, V):  # noqa: E741
        m = self.material
        return self.kernel.level_saturation_penetration(m.K, m.T_eps, m.T_sigma, p_0, l, h, V)

    def saturation_friction(self, l, h, V):  # noqa: E741
        m = self.material
        return self.kernel.level_saturation_friction(m.K, m.T_eps, m.T_sigma, l, h, V)

    def surely_saturated(self, p_0, l, h, V):  # noqa: E741
        """Either the forcing ``H + p_0`` is positive all along every strip, so contact once made is never left, and no strip is
        out of reach; or the excess pressure is, whatever the state: with the creep behind it not above D the pressure is at least
        ``K_g u - (K_g - K) D``."""
        m = self.material
        steepest = np.hypot(1.0, 2 * np.pi / l * V * m.T_eps)
        forced = 0.5 * h * (1 + steepest)
        glassy = np.divide(h, m.J, out=np.full(np.shape(m.J), np.inf), where=np.asarray(m.J) > 0)
        return np.maximum(np.minimum(forced, glassy) - p_0 / m.K, h)

"""Orbits of the standard linear solid, to hold solvers for several relaxation times against."""

from __future__ import annotations

from functools import cache
from types import ModuleType

import numpy as np

import hystrip
from hystrip.generated import standard_linear_solid


class Orbits:
    """Orbits of one regime of random strips of the standard linear solid, ``constitutive``, as the runtime finds them."""

    def __init__(self, sequence: str, J: float | None = None):
        draw, count = np.random.default_rng(5), 300
        beta, J_0 = 10.0 ** draw.uniform(-2, 3, count), 10.0 ** draw.uniform(-3, -1e-3, count)
        p_0, delta_0, D = 10.0 ** draw.uniform(-2, 1, count), 10.0 ** draw.uniform(-2, 0.5, count), draw.uniform(-2, 3, count)
        J_0 = J_0 if J is None else np.full(count, J)
        k = 2 * np.pi
        strips = hystrip.solve_strip(
            hystrip.StandardLinearSolid(K=1.0, T_eps=beta / k, T_sigma=J_0 * beta / k),
            hystrip.Dugdale(p_0=p_0, delta_0=delta_0),
            l=1.0,
            A=1.0,
            D=D,
            V=1.0,
            edge="constitutive",
        )
        self.rows = np.flatnonzero(strips.regime == sequence)
        self.k, self.sequence = k, sequence
        self.beta, self.J_0, self.p_0, self.delta_0, self.D = (v[self.rows] for v in (beta, J_0, p_0, delta_0, D))
        onset = np.where(np.isnan(strips.d), strips.b, strips.d)  # after a snap contact begins at the onset
        at = {"d": -k * onset, "b": -k * strips.b, "a": k * strips.a, "c": k * strips.c}  # s = -k x at x = d, b, -a, -c
        self.edges: list[np.ndarray] = []
        for name in standard_linear_solid.REGIMES[sequence]["edges"]:
            edge = at[name][self.rows]
            if self.edges:
                edge = edge + 2 * np.pi * np.ceil((self.edges[-1] - edge) / (2 * np.pi) - 1e-9)
            self.edges.append(edge)
        self.p_mean, self.tau_mean = strips.p_mean[self.rows], strips.tau_mean[self.rows] / k

    @property
    def parameters(self) -> tuple[np.ndarray, ...]:
        return self.p_0, self.delta_0, self.D

    @property
    def branch(self) -> tuple[np.ndarray, np.ndarray]:
        """(K_1, tau_1) in seconds, with the mode axis."""
        return (1 / self.J_0 - 1)[None], (self.J_0 * self.beta / self.k)[None]

    def held(self, solver: ModuleType, modes) -> float:
        """How far ``solver`` is from these orbits: polished edges against these edges, and both means, relative to 1 + |.|."""
        functions = solver.REGIMES[self.sequence]
        m = solver.at_speed(modes, np.full(len(self.rows), self.k))
        edges = list(self.edges)
        for _ in range(3):
            residual, rows = functions["residual_and_jacobian"](*edges, m, *self.parameters)
            residual, jacobian = np.stack(np.broadcast_arrays(*residual)), np.array([np.broadcast_arrays(*row) for row in rows])
            step = np.linalg.solve(np.moveaxis(jacobian, -1, 0), residual.T[..., None])[..., 0].T
            edges = [edge - part for edge, part in zip(edges, step, strict=True)]
        p_mean, tau_mean = functions["means"](*edges, m, *self.parameters)
        far = [np.abs(edge - known) for edge, known in zip(edges, self.edges, strict=True)]
        far += [
            np.abs(p_mean - self.p_mean) / (1 + np.abs(self.p_mean)),
            np.abs(tau_mean - self.tau_mean) / (1 + np.abs(self.tau_mean)),
        ]
        return float(np.max(far))


#: the same orbits are held against many materials
orbits_of = cache(Orbits)

"""The corrected Eq. 16 written out in NumPy, with and without the look whether it holds."""

import numpy as np


def friction(scene, adhesion, p, V):
    """Friction (Pa) of all levels in saturated contact at velocities V (n,)."""
    m, (l, h) = scene.material, _sizes(scene)  # noqa: E741
    tau = 3 * np.pi**2 / 16 * m.K * V * (m.T_eps - m.T_sigma) * h**2 / (l**2 + (2 * np.pi * V * m.T_sigma) ** 2)
    return tau.sum(axis=0), 0, 0


def checked_friction(scene, adhesion, p, V):
    """The same; the points at which some level is not saturated count as failures."""
    m, (l, h) = scene.material, _sizes(scene)  # noqa: E741
    w = 2 * np.pi * V / l
    p_sat = m.K * h * (2 * np.sqrt((1 + (w * m.T_eps) ** 2) / (1 + (w * m.T_sigma) ** 2)) - 1) / 4 - adhesion.p_0
    needed = p_sat[-1]
    for own in p_sat[-2::-1]:
        needed = np.maximum(own, needed + own + adhesion.p_0)
    return friction(scene, adhesion, p, V)[0], 0, int((p < needed).sum())


def _sizes(scene):
    return (np.array([getattr(level, name) for level in scene.levels])[:, None] for name in ("l", "h"))

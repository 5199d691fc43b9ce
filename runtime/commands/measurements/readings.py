"""Eq. 13 read in both ways: the law of the lower level over the contact alone, and over the whole cell as printed."""

from typing import Any

import numpy as np

MATERIAL = {"K": 1e9, "T_eps": 1e-2, "T_sigma": 1e-4}
LEVELS = ((10e-6, 1e-6), (500e-9, 100e-9))  # l, h
GAMMA, DELTA_0, PRESSURE = 2.5e-5, 1e-8, 100.0  # N/m, m, Pa
VELOCITIES = (1e-3, 3e-3, 5e-3, 1e-2, 2e-2, 5e-2)
RTOL = 1e-4


def readings() -> dict[str, Any]:
    """Table of the friction coefficient in both readings, for the paper's two levels."""
    found = both(np.array(VELOCITIES), GAMMA, "continuous", "unloading", RTOL)
    more = (found["cell"] - found["contact"]) / found["contact"]
    rows = [
        [f"{V:g}", f"{100 * free:.3g}", f"{law:.4g}", f"{mu:.4g}", f"{cell:.4g}", f"{100 * by:+.2g} %"]
        for V, free, law, mu, cell, by in zip(
            VELOCITIES, found["free"], found["law"], found["contact"], found["cell"], more, strict=True
        )
    ]
    return {
        "caption": f"The paper's two levels at {PRESSURE:g} Pa, gamma = {GAMMA:g} N/m, continuous, unloading, rtol "
        f"{RTOL:g}. Where "
        "level 1 is free, p = 0, the printed form adds tau_2[0], which is not zero because the small level clings at p = 0.",
        "shown": f"Up to {100 * float(more.max()):.0f} % of mu, at V = {VELOCITIES[int(more.argmax())]:g} m/s.",
        "head": ["V, m/s", "free part of level 1, %", "tau_2[0], Pa", "mu, contact alone", "mu, whole cell", "apart"],
        "rows": rows,
    }


def both(velocity: np.ndarray, gamma: float, edge: str, branch: str, rtol: float) -> dict[str, np.ndarray]:
    """Friction coefficient in both readings, its error, the free part of level 1 and the law of level 2 at p = 0."""
    import hystrip

    material, adhesion = hystrip.StandardLinearSolid(**MATERIAL), hystrip.Dugdale(gamma=gamma, delta_0=DELTA_0)
    levels = [hystrip.Level(l=length, h=height) for length, height in LEVELS]

    def solved(levels: list[Any], pressure: float) -> Any:
        return hystrip.solve(
            material, adhesion, levels, pressure=pressure, velocity=velocity, edge=edge, branch=branch, rtol=rtol
        )

    upper = solved(levels, PRESSURE)
    free = 1.0 - upper.contact_by_level[0] - upper.adhesion_by_level[0]
    law = solved(levels[1:], 0.0).tau
    beyond = free * law
    if adhesion.p_0 > 0:
        beyond = beyond + upper.adhesion_by_level[0] * solved(levels[1:], -float(adhesion.p_0)).tau
    return {
        "velocity": velocity,
        "contact": upper.mu,
        "cell": upper.mu + beyond / PRESSURE,
        "error": upper.error_estimate,
        "free": free,
        "law": law,
    }

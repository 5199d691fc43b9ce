"""Eq. 12 to 14 as the runtime carries them out, against plain sums over strips and points of the paper's two levels."""

from typing import Any

import numpy as np

MATERIAL = {"K": 1e9, "T_eps": 1e-2, "T_sigma": 1e-4}
ADHESION = {"gamma": 2.5e-5, "delta_0": 1e-8}
LEVELS = ((10e-6, 1e-6), (500e-9, 100e-9))  # l, h
VELOCITY = 5e-3
PRESSURES = (100.0, 5e6)  # partial contact, complete contact
STRIPS, POINTS = 600, 1000  # of the plain sums, in half a cell and in the contact of a strip
RTOL = 1e-4


def two_levels() -> dict[str, Any]:
    """Table of both levels' friction by the runtime and by plain sums."""
    import hystrip

    material, adhesion = hystrip.StandardLinearSolid(**MATERIAL), hystrip.Dugdale(**ADHESION)
    levels = [hystrip.Level(l=length, h=height) for length, height in LEVELS]
    below = hystrip.friction_law(material, adhesion, levels[1], V=VELOCITY, rtol=RTOL)
    rows = []
    for pressure in PRESSURES:
        found = hystrip.solve(material, adhesion, levels, pressure=pressure, velocity=VELOCITY, rtol=RTOL)
        plain = _plain_sums(material, adhesion, levels[0], float(found.penetration), below)
        for number, (value, other) in enumerate(zip(found.tau_by_level.ravel(), plain, strict=True), 1):
            rows.append([f"{pressure:g}", f"level {number}", *(f"{v:.5g}" for v in (value, other)), _apart(value, other)])
        mu = sum(plain) / pressure
        rows.append([f"{pressure:g}", "mu", f"{float(found.mu):.5g}", f"{mu:.5g}", _apart(float(found.mu), mu)])
    length, height = zip(*LEVELS, strict=True)
    return {
        "caption": f"Eq. 12 to 14 for the two levels of the paper's Fig. 4 at V = {VELOCITY:g} m/s (l = {length[0]:g} and "
        f"{length[1]:g} m, h = {height[0]:g} and {height[1]:g} m): friction by the runtime, asked for {RTOL:g}, and by plain "
        f"sums over {STRIPS} equal strips and {POINTS} points of each contact, whose error is that of their step. Pressures in "
        "Pa. At the larger pressure every level is in complete contact, and mu is that of Eq. 16, corrected.",
        "head": ["nominal pressure", "", "runtime", "plain sums", "apart"],
        "rows": rows,
    }


def _plain_sums(material: Any, adhesion: Any, upper: Any, D: float, law: Any) -> tuple[float, float]:
    """Own and carried friction of the upper level: p f_x over all of each strip, the law below over its contact."""
    import hystrip

    theta = np.pi * (np.arange(STRIPS) + 0.5) / STRIPS
    A = upper.h / 4 * (1 + np.cos(theta))
    strips = hystrip.solve_strip(
        material,
        adhesion,
        l=upper.l,
        A=A,
        D=D - upper.h / 2 * (1 - np.cos(theta)),
        V=VELOCITY,
        edge="continuous",
        branch="unloading",
    )
    # the fields broadcast against the strips: points along the first axis
    t = ((np.arange(POINTS) + 0.5) / POINTS)[:, None]
    slope = A * 2 * np.pi / upper.l * np.sin(2 * np.pi * (t - 0.5))
    own = strips.pressure((t - 0.5) * upper.l) * slope
    touches, full = strips.contact_fraction > 0, strips.contact_fraction == 1
    first = np.where(full, -upper.l / 2, np.where(touches, -strips.a, 0.0))
    width = np.where(full, upper.l, np.where(touches, strips.b + strips.a, 0.0))
    carried = width / upper.l * law(strips.pressure(first + width * t))
    return float(own.mean()), float(np.where(touches, carried, 0.0).mean())


def _apart(value: float, other: float) -> str:
    return f"{abs(value - other) / abs(other):.0e}"

"""Friction stress and real contact of one level over nominal pressure."""

from typing import Any

import numpy as np

from .style import COLUMN, OKABE_ITO, stacked, styled
from .units import unit_for


@styled
def law_over_pressure(law: Any, points: int = 400) -> Any:
    """Draw a :class:`hystrip.FrictionLaw` as a matplotlib Figure: friction stress and contact fraction, from pull-off to a little
    above saturation, at ``points`` pressures."""
    reach = law.p_sat if law.below >= law.p_sat else law.below
    # a flat level is saturated where it is pulled off
    span = max(reach - law.pull_off, 1e-3 * abs(law.pull_off), np.finfo(float).tiny)
    end = reach + 0.1 * span if law.below >= law.p_sat else reach
    upper, lower = stacked(2, COLUMN, 1.2 * COLUMN)
    (pascals, unit), (stress, stress_unit) = unit_for("Pa", law.pull_off, end), unit_for("Pa", law.tau_sat)
    inner = [b for b in law.breaks if law.pull_off < b < end]
    start = law.pull_off - 0.1 * span
    ends = [law.pull_off, *inner, end]
    for low, high in zip(ends[:-1], ends[1:], strict=True):
        # a jump of the law is not joined by a line
        p = np.linspace(np.nextafter(low, high), np.nextafter(high, low), max(points // len(ends), 20))
        upper.plot(p / pascals, law(p) / stress, color=OKABE_ITO[0])
        lower.plot(p / pascals, law.contact_fraction(p), color=OKABE_ITO[0])
    for panel in (upper, lower):
        panel.plot([start / pascals, law.pull_off / pascals], [0, 0], color=OKABE_ITO[0])
        panel.axvline(law.pull_off / pascals, color="0.5", linewidth=0.6, linestyle=":")
    upper.set_ylabel(rf"friction stress $\tau$ ({stress_unit})")
    lower.set_ylabel("contact fraction")
    lower.set_xlabel(f"nominal pressure $p$ ({unit})")
    lower.set_xlim(start / pascals, end / pascals)
    lower.set_ylim(-0.03, 1.05)
    return upper.figure

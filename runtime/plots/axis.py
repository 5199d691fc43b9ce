"""Logarithmic axes where values span decades, linear ones elsewhere."""

from typing import Any

import numpy as np


def over_decades(x: np.ndarray) -> bool:
    """Whether values in ascending order are positive and spaced as on a logarithmic axis rather than a linear one."""
    if not x.size:
        return False
    low, high = x[0], x[-1]
    return bool(0 < 10 * low <= high * (1 + 1e-12) and np.median(x) - np.sqrt(low * high) < (low + high) / 2 - np.median(x))


def make_logarithmic(panel: Any, which: str, low: float, high: float) -> None:
    """Make an axis, ``"x"`` or ``"y"``, logarithmic, with labels at the least number of places."""
    from matplotlib.ticker import LogFormatterSciNotation, LogLocator

    panel.set(**{f"{which}scale": "log"})
    if high < 100 * low:
        axis = getattr(panel, f"{which}axis")
        axis.set_minor_locator(LogLocator(subs=(2, 5)))
        axis.set_minor_formatter(LogFormatterSciNotation(minor_thresholds=(np.inf, np.inf)))


def scale(panel: Any, low: float, high: float, logarithmic: bool) -> None:
    """Limits of the horizontal axis and its kind, with labels that do not overlap."""
    if logarithmic:
        make_logarithmic(panel, "x", low, high)
    else:
        panel.locator_params(axis="x", nbins=5)
    panel.set_xlim(low, high)

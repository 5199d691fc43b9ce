"""Units of axes, chosen from the data."""

from typing import Any

import numpy as np

_PREFIXES = {
    "m": ((1.0, "m"), (1e-3, "mm"), (1e-6, "µm"), (1e-9, "nm"), (1e-12, "pm")),
    "Pa": ((1e9, "GPa"), (1e6, "MPa"), (1e3, "kPa"), (1.0, "Pa"), (1e-3, "mPa")),
}


def unit_for(unit: str, *values: Any) -> tuple[float, str]:
    """Factor and name of the largest unit in which the largest magnitude is 1 or more: ``(1e-6, "µm")`` for 5e-6 m.

    >>> unit_for("Pa", [0.0, -4.2e4, 1e3]), unit_for("m", 1e-7), unit_for("m/s", 3.0)
    ((1000.0, 'kPa'), (1e-09, 'nm'), (1.0, 'm/s'))
    """
    known = _PREFIXES.get(unit, ((1.0, unit),))
    magnitudes = np.abs(np.concatenate([np.ravel(np.asarray(each, float)) for each in values]))
    magnitudes = magnitudes[np.isfinite(magnitudes)]
    most = magnitudes.max() if magnitudes.size else 0.0
    if most == 0:
        return next(pair for pair in known if pair[0] == 1.0)
    return next((pair for pair in known if most >= 0.999 * pair[0]), known[-1])


def length(metres: float) -> str:
    """A length in words, e.g. ``"500 nm"``."""
    factor, unit = unit_for("m", metres)
    return f"{metres / factor:.4g} {unit}"


def pressure(pascals: float) -> str:
    """A pressure in words, e.g. ``"2.5 kPa"``."""
    factor, unit = unit_for("Pa", pascals)
    return f"{pascals / factor:.4g} {unit}"

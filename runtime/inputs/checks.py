"""Validation of numbers: every refusal names the field, the value and what is allowed, before any work is done."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from hystrip.errors import InputError


def numbers(field: str, value: Any, unit: str, minimum: float = -np.inf, strict: bool = False) -> np.ndarray:
    """``value`` as a float64 array (0-d for a scalar), finite and within its range.

    Raises
    ------
    InputError : not numeric, not finite, or below ``minimum`` (or equal to it, if ``strict``)
    """
    allowed = _allowed(unit, minimum, strict)
    if isinstance(value, (str, bytes, bool)) or value is None:
        raise InputError(field, value, allowed)
    try:
        raw = np.asarray(value)
        if raw.dtype.kind not in "iuf":
            raise InputError(field, value, allowed)
        array = raw.astype(np.float64)
    except (TypeError, ValueError):
        raise InputError(field, value, allowed) from None
    bad = ~np.isfinite(array) | ((array <= minimum) if strict else (array < minimum))
    if bad.any():
        first = value if array.ndim == 0 else float(array[bad][0])
        raise InputError(field, first, allowed)
    return array


def number(field: str, value: Any, unit: str, minimum: float = -np.inf, strict: bool = False) -> float:
    """One finite number within its range, as a float. Raises ``InputError`` as ``numbers`` does."""
    array = numbers(field, value, unit, minimum, strict)
    if array.ndim:
        raise InputError(field, value, "a single number: " + _allowed(unit, minimum, strict))
    return float(array)


def choice(field: str, value: Any, allowed: Sequence[str]) -> str:
    """``value`` if it is one of ``allowed``, else ``InputError``."""
    if not isinstance(value, str) or value not in allowed:
        raise InputError(field, value, "one of " + ", ".join(repr(a) for a in allowed))
    return value


def broadcast(**arrays: np.ndarray) -> tuple[int, ...]:
    """Common shape of the arrays; ``InputError`` names those that do not fit together."""
    try:
        return np.broadcast_shapes(*(np.shape(a) for a in arrays.values()))
    except ValueError:
        shapes = {name: np.shape(a) for name, a in arrays.items() if np.ndim(a)}
        raise InputError(", ".join(shapes), list(shapes.values()), "shapes that broadcast together") from None


def _allowed(unit: str, minimum: float, strict: bool) -> str:
    bound = "" if minimum == -np.inf else f" {'>' if strict else '>='} {minimum:g}"
    return f"a finite number{bound}" + (f" ({unit})" if unit else "")

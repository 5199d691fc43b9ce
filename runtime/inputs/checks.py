"""Validation of numbers: every refusal names the field, the value and what is allowed, before any work is done."""

import sys
from collections.abc import Sequence
from typing import Any

import numpy as np

from ..errors import InputError

#: greatest magnitude of an input, and the least of one that must not be zero: far beyond anything physical in SI, and
#: near enough that no product or quotient of a few of them leaves the range of a double
LARGEST, SMALLEST = 1e40, 1e-40
#: entries of a sequence that is made an array: 0.8 GB of them
_MOST = 100_000_000
#: entries of a sequence that are looked at one by one
_MOST_ENTRIES = 10_000


def numbers(field: str, value: Any, unit: str, minimum: float = -np.inf, strict: bool = False) -> np.ndarray:
    """``value`` as a float64 array (0-d for a scalar), finite and within its range.

    Raises
    ------
    InputError : not numeric, not finite, below ``minimum`` (or equal to it, if ``strict``), or of a magnitude above
        ``LARGEST`` (or below ``SMALLEST``, where zero is excluded); a quantity with a unit of its own, which would be
        dropped; an array with masked entries
    """
    allowed = _allowed(unit, minimum, strict)
    if isinstance(value, (str, bytes, bool)) or value is None:
        raise InputError(field, value, allowed)
    parts = value if isinstance(value, (list, tuple)) and not isinstance(next(iter(value), 0.0), (int, float)) else ()
    if any(map(has_unit, (value, *parts))):
        raise InputError(field, value, f"{allowed}, without a unit of its own: convert it first")
    if "numpy.ma" in sys.modules and np.ma.is_masked(value):  # loading it takes longer than most calls
        raise InputError(field, value, f"{allowed}, none of them masked")
    if not isinstance(value, np.ndarray) and hasattr(value, "__len__") and _length(value) > _MOST:  # such as range(10**12)
        raise InputError(field, value, f"{allowed}, at most {_MOST:.0e} of them")
    try:
        raw = np.asarray(value)
        if raw.dtype.kind == "O" and all(type(each) in (int, float) for each in raw.flat):  # integers of more than 64 bits
            raw = raw.astype(np.float64)
        if raw.dtype.kind not in "iuf" or holds_truth(value):
            raise InputError(field, value, allowed)
        with np.errstate(over="ignore"):  # a longer float: refused below, by name
            array = raw.astype(np.float64)
    except (TypeError, ValueError, OverflowError):
        raise InputError(field, value, allowed) from None
    bad = ~np.isfinite(array) | ((array <= minimum) if strict else (array < minimum))
    if bad.any():
        raise InputError(field, _first(value, array, bad), allowed)
    bad = np.abs(array) > LARGEST
    if bad.any():
        raise InputError(field, _first(value, array, bad), f"{allowed} of magnitude up to {LARGEST:g}")
    bad = array < minimum + SMALLEST
    if strict and bad.any():
        raise InputError(field, _first(value, array, bad), f"{allowed}, from {SMALLEST:g}")
    return array


def number(field: str, value: Any, unit: str, minimum: float = -np.inf, strict: bool = False) -> float:
    """One finite number within its range, as a float. Raises ``InputError`` as ``numbers`` does."""
    array = numbers(field, value, unit, minimum, strict)
    if array.ndim:
        raise InputError(field, value, "a single number: " + _allowed(unit, minimum, strict))
    return float(array)


def integer(field: str, value: Any, least: int, most: float, allowed: str) -> int:
    """``value`` as an int from ``least`` to ``most``; else ``InputError`` with what is ``allowed``, in words."""
    if isinstance(value, bool) or not isinstance(value, (int, np.integer)) or not least <= value <= most:
        raise InputError(field, value, allowed)
    return int(value)


def sequence(field: str, values: Any, allowed: str) -> list[Any]:
    """The entries of a list, a tuple, an array or anything else in an order and of a known length, else ``InputError``."""
    known = hasattr(values, "__len__") and hasattr(values, "__iter__")
    if not known or isinstance(values, (str, bytes, dict, set, frozenset)) or (hasattr(values, "ndim") and not values.ndim):
        raise InputError(field, values, allowed)
    if _length(values) > _MOST_ENTRIES:
        raise InputError(field, values, f"{allowed}; at most {_MOST_ENTRIES} of them")
    return list(values)


def choice(field: str, value: Any, allowed: Sequence[str]) -> str:
    """The one of ``allowed`` that ``value`` equals, a plain string whatever kind of one that is, else ``InputError``."""
    if not isinstance(value, str) or value not in allowed:
        raise InputError(field, value, "one of " + ", ".join(repr(a) for a in allowed))
    return allowed[allowed.index(value)]


def truth(field: str, value: Any) -> bool:
    """``value`` if it is True or False; a text such as "no" would count as true. Raises ``InputError``."""
    if not isinstance(value, (bool, np.bool_)):
        raise InputError(field, value, "True or False")
    return bool(value)


def broadcast(**arrays: np.ndarray) -> tuple[int, ...]:
    """Common shape of the arrays; ``InputError`` names those that do not fit together."""
    try:
        return np.broadcast_shapes(*(np.shape(a) for a in arrays.values()))
    except ValueError:
        shapes = {name: np.shape(a) for name, a in arrays.items() if np.ndim(a)}
        raise InputError(", ".join(shapes), list(shapes.values()), "shapes that broadcast together") from None


def has_unit(value: Any) -> bool:
    """Whether a value is a quantity of Pint, Astropy or the like, whose unit would be dropped."""
    return hasattr(value, "to") and (hasattr(value, "units") or hasattr(value, "unit"))


def holds_truth(value: Any) -> bool:
    """Whether True or False stands somewhere among numbers, which NumPy takes for 1 or 0."""
    if isinstance(value, np.ndarray):
        return value.dtype.kind == "b"
    kinds = set(map(type, value)) if isinstance(value, (list, tuple)) else set()
    nested = not kinds.isdisjoint((list, tuple, np.ndarray))
    return not kinds.isdisjoint((bool, np.bool_)) or (nested and any(map(holds_truth, value)))


def _length(value: Any) -> float:
    """Entries of a sequence; inf where there are more than a machine integer counts, one of what is a single number."""
    try:
        return len(value)
    except OverflowError:
        return np.inf
    except TypeError:  # such as an array of xarray without dimensions
        return 1


def _first(value: Any, array: np.ndarray, bad: np.ndarray) -> Any:
    """What is wrong: the value as given, or the first bad entry of an array."""
    return float(array[bad][0]) if array.ndim or isinstance(value, np.ndarray) else value


def _allowed(unit: str, minimum: float, strict: bool) -> str:
    bound = "" if minimum == -np.inf else f" {'>' if strict else '>='} {minimum:g}"
    return f"a finite number{bound}" + (f" ({unit})" if unit else "")

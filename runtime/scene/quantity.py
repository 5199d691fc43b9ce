"""A physical quantity: a number in SI, or text with a unit such as ``"10 um"``."""

import functools
import math
import re
from decimal import Decimal
from typing import Any

from ..errors import InputError
from ..extras import require
from ..inputs.checks import LARGEST

_TEXT = re.compile(r"\s*(?P<number>[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d{1,3})?)\s*(?P<unit>(?:[^\W\d_]|°).*?)?\s*")
#: what is added to degrees, and how many of them five kelvin are
_OFFSETS = {
    **dict.fromkeys(("°C", "degC", "celsius", "℃"), ("273.15", "5")),
    **dict.fromkeys(("°F", "degF", "fahrenheit"), ("459.67", "9")),
}
#: a difference of temperatures, which no zero of a scale moves
DIFFERENCE = "K (difference)"
_LONGEST = 100  # characters of a quantity, or of a unit
#: a number raised to a power, or one of many digits: computing it could take for ever
_ENDLESS = re.compile(r"\d[\s)]*(\*\*|\^)|\d{4}")
_UNIT = re.compile(r"[\w\s*/^().·⋅\-\u2212²³⁻¹]+")
_RAISED = str.maketrans("⁻\u2212¹²³", "--123")


def to_si(value: float | str, unit: str, field: str) -> float:
    """The quantity as a finite number in `unit`.

    Parameters
    ----------
    value : number in `unit`, or text of a number and a unit
    unit : SI unit that is wanted, e.g. ``"Pa/m"``
    field : name used in the error

    Raises
    ------
    InputError : not finite, of a magnitude beyond that of any input, no unit, a unit that is unknown or of another dimension
    MissingExtra : a unit is written and Pint is not installed
    """
    try:
        number = _converted(value, unit, field) if isinstance(value, str) else float(value)
    except OverflowError:  # an integer beyond all numbers
        number = math.inf
    if not math.isfinite(number):
        raise InputError(field, value, _allowed(unit))
    if abs(number) > LARGEST:
        raise InputError(field, value, f"{_allowed(unit)}, of magnitude up to {LARGEST:g}")
    return number


def _converted(text: str, unit: str, field: str) -> float:
    if len(text) > _LONGEST:
        raise InputError(field, text, f"{_allowed(unit)}, of at most {_LONGEST} characters")
    if unit == "1":
        raise InputError(field, text, _allowed(unit))
    # The number is read here, not by Pint: that reads "0,1 kPa" as 0 kPa.
    match = _TEXT.fullmatch(text)
    if match is None:
        raise InputError(field, text, _allowed(unit))
    if match["unit"] is None:
        raise InputError(field, text, f"a number in {unit} without quotes, or text with a unit")
    if unit == DIFFERENCE:
        if match["unit"] in _OFFSETS:
            problem = f"{match['unit']} is that of a temperature, told from a zero of its own"
            raise InputError(
                field, text, f"{_allowed(unit)} or 'delta_degC', since it is a difference of temperatures; {problem}"
            )
    elif unit == "K" and match["unit"] in _OFFSETS:  # no factor turns degrees into kelvin
        offset, scale = _OFFSETS[match["unit"]]
        kelvin = float((Decimal(match["number"]) + Decimal(offset)) * 5 / Decimal(scale))
        if kelvin <= 0:
            raise InputError(field, text, f"a temperature above absolute zero, -{offset} {match['unit']}")
        return kelvin
    if not _UNIT.fullmatch(match["unit"]):
        raise InputError(field, text, _allowed(unit))
    return float(Decimal(match["number"]) * _factor(match["unit"], unit, field, text, _allowed(unit)))


def unit_factor(written: str, unit: str, field: str, allowed: str) -> float:
    """What a number in the unit ``written`` is multiplied with to be one in ``unit``. Raises as :func:`to_si`."""
    if len(written) > _LONGEST or not _UNIT.fullmatch(written):
        raise InputError(field, written, allowed)
    return float(_factor(written, unit, field, written, allowed))


def plain_unit(unit: str) -> str:
    """A unit with its powers as ``**``: ``cm2``, ``cm^2`` and ``cm²`` are one, as are ``rad.s-1`` and ``rad·s⁻¹``."""
    unit = re.sub(r"[.·⋅](?=[^\W\d_])", "*", unit.translate(_RAISED))
    return re.sub(r"(?<=[^\W\d_])\^?(-?\d)", r"**\1", unit)


def _factor(written: str, unit: str, field: str, text: str, allowed: str) -> Decimal:
    pint = require("pint", "units", "a quantity written with a unit")
    try:
        return _in_si(plain_unit(written), unit)
    except pint.UndefinedUnitError:
        raise InputError(field, text, f"{allowed}; the unit {written!r} is not known (case counts)") from None
    except pint.DimensionalityError:
        raise InputError(field, text, f"{allowed}; {written!r} is a unit of something else") from None
    except Exception:  # Pint's parser ends malformed input in errors of many kinds
        raise InputError(field, text, f"{allowed}; {written!r} cannot be read as a unit") from None


@functools.lru_cache(maxsize=256)
def _in_si(written: str, unit: str) -> Decimal:
    if _ENDLESS.search(written):
        raise ValueError(written)
    registry, unit = _registry(), "K" if unit == DIFFERENCE else unit
    parsed = registry.parse_units(written)
    if unit == "K" and registry.Quantity(Decimal(0), parsed).to(unit).magnitude:  # another scale with a zero of its own
        raise ValueError(written)
    return registry.Quantity(Decimal(1), parsed).to(unit).magnitude


@functools.cache
def _registry() -> Any:
    # Decimal keeps "10 um" the number 1e-05 instead of 9.999999999999999e-06.
    return require("pint", "units", "a quantity written with a unit").UnitRegistry(non_int_type=Decimal)


def _allowed(unit: str) -> str:
    if unit == "1":
        return "a finite number, without quotes"
    return f"a finite number in {unit}, or text with a unit such as {EXAMPLES[unit]!r}"


EXAMPLES: dict[str, Any] = {
    "m": "10 um",
    "s": "10 ms",
    "Pa": "0.1 kPa",
    "Pa/m": "1 GPa/m",
    "J/m^2": "25 uJ/m^2",
    "m/s": "5 mm/s",
    "K": "20 degC",
    DIFFERENCE: "51.6 K",
    "J/mol": "80 kJ/mol",
}
"""An example for every SI unit that a scene uses."""

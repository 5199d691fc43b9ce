"""What the columns of a table of moduli are, from their names and units."""

import re
import unicodedata
from dataclasses import dataclass

import numpy as np

from ..errors import InputError

_BRACKETED = re.compile(r"^(?P<name>.*?)\s*[\[(](?P<unit>[^\[\]()]*(?:\([^()]*\)[^\[\]()]*)?)[\])]$")
_SLASHED = re.compile(r"^(?P<name>.+?)\s+(?:/|in)\s+(?P<unit>\S+)$")
_COMMA = re.compile(r"^(?P<name>[^,]+),\s*(?P<unit>[^\s,]+)$")

#: names as they stand after ``_plain``: without spaces, signs and case, primes as ' and "
_NAMES = {
    "frequency": ("f", "freq", "frequency", "frequenz", "testfrequency", "oscillationfrequency", "reducedfrequency"),
    "omega": ("omega", "ω", "w", "angularfrequency", "angfrequency", "kreisfrequenz", "reducedangularfrequency"),
    "storage": ("'", "stor", "storage", "storagemodulus", "storagemod", "modulus'", "prime", "speichermodul", "1"),
    "loss": ('"', "loss", "lossmodulus", "lossmod", 'modulus"', "doubleprime", "primeprime", "verlustmodul", "2"),
    "tan": ("tandelta", "tand", "tanδ", "losstangent", "lossfactor", "dampingfactor", "tan", "verlustfaktor"),
    "absolute": ("*", "star", "abs", "complexmodulus", "absolutemodulus", "dynamicmodulus", "modulus*"),
    "temperature": ("t", "temp", "temperature", "temperatur", "sampletemperature", "testtemperature"),
    "set": ("set",),
}
#: roles that may have the letter of the modulus before or after them: E', G'', E_stor, storage modulus E'
_MODULI = ("storage", "loss", "absolute")
#: single letters that mean something else in the other case: force, time
_OTHER_CASE = ("F", "t", "W")
_KINDS = {"tensile": "E", "tension": "E", "youngs": "E", "compression": "E", "elongational": "E", "shear": "G"}

_PA = {"Pa": 1.0, "kPa": 1e3, "MPa": 1e6, "GPa": 1e9}
_HZ = {"mHz": 1e-3, "Hz": 1.0, "kHz": 1e3, "MHz": 1e6, "GHz": 1e9}
_PER_SECOND = ("1/s", "s^-1", "s-1", "s⁻¹", "s**-1", "1/sec")
_RADIANS = {"rad/s": 1.0, "rad s^-1": 1.0, "rad/sec": 1.0, "rad·s⁻¹": 1.0, "rad s-1": 1.0, "krad/s": 1e3}
_TURNS = re.compile(r"rad|deg|rev|turn|rpm|rps|cyc|count")
_KELVIN = ("K", "kelvin", "degK")
_CELSIUS = ("C", "°C", "ºC", "degC", "deg C", "celsius", "℃")
_FAHRENHEIT = ("F", "°F", "degF", "deg F", "fahrenheit")


@dataclass(frozen=True)
class Column:
    """A column that is understood: its ``index`` and ``name`` in the file, its ``role``, the letter of its modulus, its
    ``unit`` as written ("" where the name gives none)."""

    index: int
    name: str
    role: str
    kind: str
    unit: str


def columns_of(names: list[str]) -> list[Column]:
    """The columns that are understood, in the order of the file."""
    found = []
    for index, written in enumerate(names):
        role, kind = _role(written)
        if role:
            found.append(Column(index, written, role, kind, ""))
            continue
        name, unit = _split(written)
        role, kind = _role(name)
        if role:
            found.append(Column(index, written, role, kind, unit))
    return found


def is_header(cells: list[str]) -> bool:
    """Whether a row names a frequency and two of storage modulus, loss modulus, its absolute value and tan delta."""
    roles = {column.role for column in columns_of(cells)}
    return bool(roles & {"frequency", "omega"}) and len(roles & {"storage", "loss", "tan", "absolute"}) >= 2


def factor(column: Column, where: str) -> float:
    """What numbers of a column are multiplied with: for moduli to Pa, for frequencies to rad/s. Raises ``InputError``."""
    place, unit = f"{where}, column {column.name!r}, unit", column.unit
    if column.role in _MODULI:
        return _PA[unit] if unit in _PA else _converted(unit, "Pa", place, "a unit of stress such as MPa")
    if column.role == "tan":
        if unit in ("", "-", "1", "--"):
            return 1.0
        if unit == "%":
            return 0.01
        raise InputError(place, unit, "none, or %")
    wanted = "Hz, or rad/s" if column.role == "frequency" else "rad/s"
    if unit in _RADIANS:
        return _RADIANS[unit]
    if unit in _PER_SECOND:  # as the name says
        return 1.0 if column.role == "omega" else 2 * np.pi
    if column.role == "frequency":
        return 2 * np.pi * (_HZ[unit] if unit in _HZ else _converted(unit, "Hz", place, wanted))
    if "rad" in unit:
        return _converted(unit, "rad/s", place, wanted)
    raise InputError(place, unit or None, f"{wanted}, since it is an angular frequency")


def to_kelvin(values: np.ndarray, column: Column, where: str) -> np.ndarray:
    """Temperatures in K. Raises ``InputError`` for a unit that is none of temperature, or for values not above zero."""
    if column.unit in _KELVIN:
        kelvin = values
    elif column.unit in _CELSIUS:
        kelvin = values + 273.15
    elif column.unit in _FAHRENHEIT:
        kelvin = (values + 459.67) / 1.8
    else:
        raise InputError(f"{where}, column {column.name!r}, unit", column.unit or None, "K, °C or °F")
    if (kelvin <= 0).any():
        raise InputError(f"{where}, column {column.name!r}", float(values[kelvin <= 0][0]), "temperatures above absolute zero")
    return kelvin


def _converted(unit: str, to: str, place: str, wanted: str) -> float:
    if not unit:
        raise InputError(place, None, f'{wanted}: in the name as in "E\' [MPa]", or in a second row')
    if to == "Hz" and _TURNS.search(unit):  # an angle counts as a number there: off by 2 pi
        raise InputError(place, unit, wanted)
    from ..scene.quantity import unit_factor

    return unit_factor(unit, to, place, wanted)


def _split(written: str) -> tuple[str, str]:
    """Name and unit of a heading such as ``E' [MPa]``, ``f / Hz``, ``omega in rad/s``, ``Frequency, Hz``."""
    for form in (_BRACKETED, _SLASHED, _COMMA):
        match = form.match(written.strip())
        if match and match["name"]:
            return match["name"], match["unit"].strip()
    return written, ""


def _plain(name: str) -> str:
    text = unicodedata.normalize("NFKC", name).casefold()
    for sign in ("″", "“", "”", "''", "′′", "’’", "´´", "``"):
        text = text.replace(sign, '"')
    for sign in ("′", "’", "´", "`", "‘"):
        text = text.replace(sign, "'")
    text = text.replace("''", '"').replace("(delta)", "delta").replace("(δ)", "δ")
    return re.sub(r"[\s_\-.|]", "", text)


def _role(name: str) -> tuple[str, str]:
    """Role of a name ("" if it is none) and the letter of the modulus ("" if it does not say)."""
    text, kind = _plain(name), ""
    if len(text) == 1 and name.strip() in _OTHER_CASE:
        return "", ""
    for word, letter in _KINDS.items():
        if word in text:
            text, kind = text.replace(word, ""), letter
    for role, names in _NAMES.items():
        if text in names and (role not in _MODULI or len(text) > 1 or kind):
            return role, kind
    for letter in "eg":
        if kind not in ("", letter.upper()):
            continue
        # E', E_stor, Estorage; storage modulus E'
        symbols = (
            text.removeprefix(letter),
            re.sub(rf"^(storage|loss|complex|speicher|verlust)(modul(?:us)?){letter}\W*$", r"\1\2", text),
        )
        for role in _MODULI:
            if any(each != text and each in _NAMES[role] for each in symbols):
                return role, letter.upper()
    return "", ""

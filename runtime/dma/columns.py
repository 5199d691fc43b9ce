"""What the columns of a table of moduli are, from their names and units."""

import re
import unicodedata
from dataclasses import dataclass, replace

import numpy as np

from ..errors import InputError
from ..scene.quantity import plain_unit, unit_factor
from .pairs import PAIRS

_BRACKETED = re.compile(r"^(?P<name>.*?)\s*/?\s*[\[({<](?P<unit>[^\[\]()]*(?:\([^()]*\)[^\[\]()]*)?)[\])}>]$")
_SLASHED = re.compile(r"^(?P<name>.+?)(?:\s*/\s*|\s+in\s+)(?P<unit>\S+)$")
_LOGARITHM = re.compile(r"\W*(log|lg|ln)(10|_|\W)", re.IGNORECASE)
_COMPLIANCE = re.compile(r"[JD]\W*'|.*(compliance|nachgiebigkeit)", re.IGNORECASE)
_COMMA = re.compile(r"^(?P<name>[^,]+),\s*(?P<unit>[^\s,]+)$")
_UNDERSCORED = re.compile(r"^(?P<name>.+)_(?P<unit>[^\s_]+)$")

#: a temperature or a frequency in a name, or a number for one
_AT_ONE = re.compile(r".*\d\s*([°º]|deg|K\b|C\b|F\b|Hz)", re.IGNORECASE)
_NUMBER = re.compile(r"[-+\u2212]?\d+([.,]\d+)?")
ONE_BELOW_THE_OTHER = "several temperatures stand one below the other, each row with its temperature in a column of its own"

#: names as they stand after ``_plain``: without spaces, signs and case, primes as ' and "
_NAMES = {
    "frequency": "f freq frequency frequenz testfrequency oscillationfrequency reducedfrequency",
    "omega": "omega ω w angularfrequency angfrequency angularfreq angfreq kreisfrequenz reducedangularfrequency",
    "storage": "' stor storage storagemodulus storagemod modulus' 'modulus 'modul prime speichermodul 1",
    "loss": '" loss lossmodulus lossmod modulus" "modulus "modul doubleprime primeprime verlustmodul 2',
    "tan": "tandelta tand tanδ losstangent lossfactor dampingfactor tan verlustfaktor",
    "phase": "delta δ phase phaseangle phaseangledelta phaseangleδ lossangle phasenwinkel verlustwinkel",
    "absolute": "* star abs complexmodulus absolutemodulus dynamicmodulus modulus* *modulus",
    "temperature": "t temp temperature temperatur sampletemperature testtemperature",
    "set": "set",
}
_NAMES = {role: tuple(names.split()) for role, names in _NAMES.items()}
#: roles that may have the letter of the modulus before or after them: E', G'', E_stor, storage modulus E'
_MODULI = ("storage", "loss", "absolute")
#: characters of a name at most: looking into a longer text takes the square of its length
_LONGEST = 200
#: single letters that mean something else in the other case: force, time, difference
_OTHER_CASE = ("F", "t", "W", "Δ")
_KINDS = {"tensile": "E", "tension": "E", "young's": "E", "youngs": "E", "compression": "E", "elongational": "E", "shear": "G"}

_PA = {"Pa": 1.0, "kPa": 1e3, "MPa": 1e6, "GPa": 1e9}
_HZ = {"mHz": 1e-3, "Hz": 1.0, "kHz": 1e3, "MHz": 1e6, "GHz": 1e9}
_PER_SECOND = ("1/s", "s**-1", "1/sec")
_RADIANS = ("rad/s", "rad/sec", "rad s**-1", "rad*s**-1")
_ANGLES = {**dict.fromkeys(("°", "deg", "degree", "degrees"), np.pi / 180), **dict.fromkeys(("rad", "radian", "radians"), 1.0)}
_TURNS = re.compile(r"rad|deg|rev|turn|rpm|rps|cyc|count")
_PRIMES = str.maketrans(dict.fromkeys("″“”", '"') | dict.fromkeys("′’´`‘", "'"))
_KELVIN = ("K", "kelvin", "degK")
_CELSIUS = ("C", "°C", "ºC", "degC", "celsius", "℃")
_FAHRENHEIT = ("F", "°F", "ºF", "degF", "fahrenheit")
#: units that may follow an underscore, which stands between the words of a name as well
_AFTER_UNDERSCORE = {*_PA, *_HZ, *_ANGLES, *_KELVIN, *_CELSIUS, *_FAHRENHEIT}
#: and those that may follow a blank: of each role its own, "Set C" and "delta K" are other things
_BEHIND_BLANK = {**dict.fromkeys(_MODULI, tuple(_PA)), "phase": tuple(_ANGLES), "omega": (*_RADIANS, "rad")}
_BEHIND_BLANK |= {"frequency": (*_HZ, *_RADIANS), "temperature": (*_KELVIN, *_CELSIUS, *_FAHRENHEIT)}


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
    found, unsure = [], []
    for index, written in enumerate(names):
        if len(_single_spaced(written)) > _LONGEST:
            continue
        role, kind = _role(written)
        if role:
            found.append(Column(index, written, role, kind, ""))
            continue
        name, unit = _split(written)
        role, kind = _role(name)
        if role and not _role(unit)[0]:  # E''/E' is a ratio
            found.append(Column(index, written, role, kind, unit))
            continue
        name, _, unit = _single_spaced(written).rpartition(" ")
        role, kind = _role(name)
        if unit in _BEHIND_BLANK.get(role, ()):
            unsure.append(Column(index, written, role, kind, unit))
    # a second column of a role is what a blank may as well part from its name
    known = {column.role for column in found}
    return sorted((*found, *(each for each in unsure if each.role not in known)), key=lambda column: column.index)


def lacking(names: list[str]) -> tuple[int, str]:
    """How many of the three columns that are needed a row of names lacks, and these in words."""
    roles = {column.role for column in columns_of(names)}
    frequency, moduli = bool(roles & {"frequency", "omega"}), max(len(roles & set(pair)) for pair in PAIRS)
    words = [] if frequency else ["frequency or omega"]
    logarithms = [name for name in names if _LOGARITHM.match(name)]
    if moduli < 2:
        words.append(f"{'one more' if moduli else 'two'} of storage, loss (E', E'' or G', G''), |E*|, and tan delta or delta")
    if logarithms:
        words.append(f"the numbers themselves where {logarithms[0]!r} has logarithms")
    compliances = [name for name in names if _COMPLIANCE.match(name)]
    if compliances and moduli < 2:
        inverse = "E' = J'/(J'^2 + J''^2), E'' = J''/(J'^2 + J''^2)"
        words.append(f"moduli where {compliances[0]!r} is a compliance: {inverse}")
    at = [name for name in names if _AT_ONE.match(name) or (frequency and _NUMBER.fullmatch(name))]
    if len(at) > 1:
        words.append(f"{ONE_BELOW_THE_OTHER}, and frequencies so, not in columns such as {at[0]!r} and {at[1]!r}")
    # of several logarithms, or columns for one temperature each, it is known what is wrong
    missing = min(3 - frequency - moduli, 2 if len(logarithms) > 1 or len(at) > 1 else 3)
    return missing, "; ".join(words)


def factor(column: Column, where: str) -> float:
    """What numbers of a column are multiplied with: for moduli to Pa, for frequencies to rad/s, for angles to rad.

    Raises ``InputError`` for a unit of something else, or a missing one.
    """
    place, unit = f"{where}, column {column.name!r}, unit", plain_unit(column.unit)
    if column.role in _MODULI:
        return _PA[unit] if unit in _PA else _converted(unit, "Pa", place, "a unit of stress such as MPa")
    if column.role == "tan":
        if unit in ("", "-", "1", "--"):
            return 1.0
        if unit == "%":
            return 0.01
        raise InputError(place, unit, "none, or %")
    if column.role == "phase":
        if unit not in _ANGLES:
            raise InputError(place, unit or None, "deg (°) or rad")
        return _ANGLES[unit]
    wanted = "Hz, or rad/s" if column.role == "frequency" else "rad/s"
    if per_second(column):  # as the name says
        return 1.0 if column.role == "omega" else 2 * np.pi
    if "rad" in unit:
        return 1.0 if unit in _RADIANS else _converted(unit, "rad/s", place, wanted)
    if column.role == "frequency":
        return 2 * np.pi * (_HZ[unit] if unit in _HZ else _converted(unit, "Hz", place, wanted))
    raise InputError(place, unit or None, f"{wanted}, since it is an angular frequency")


def per_second(column: Column) -> bool:
    """Whether the unit says neither Hz nor rad/s."""
    return plain_unit(column.unit) in _PER_SECOND


def with_unit_below(column: Column, below: str, where: str) -> Column:
    """The column with the unit that stands below its name.

    Raises ``InputError`` if the name has another, or what stands below is none.
    """
    bracketed = _BRACKETED.match(_single_spaced(below))
    below = bracketed["unit"] if bracketed and not bracketed["name"] else below
    if column.role == "set" or not below:
        return column
    found = replace(column, unit=below)
    if column.unit and _one(found, where) != _one(column, where):
        raise InputError(f"{where}, column {column.name!r}, unit below it", below, f"{column.unit!r} as in the name, or none")
    return found


def _one(column: Column, where: str) -> float:
    """What a 1 in the column is."""
    return float(to_kelvin(np.ones(1), column, where)[0]) if column.role == "temperature" else factor(column, where)


def to_kelvin(values: np.ndarray, column: Column, where: str) -> np.ndarray:
    """Temperatures in K. Raises ``InputError`` for a unit that is none of temperature, or for values not above zero."""
    unit = column.unit.replace(" ", "")  # ° C
    if unit in _KELVIN:
        kelvin = values
    elif unit in _CELSIUS:
        kelvin = values + 273.15
    elif unit in _FAHRENHEIT:
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
    return unit_factor(unit, to, place, wanted)


def _split(written: str) -> tuple[str, str]:
    """Name and unit of a heading such as ``E' [MPa]``, ``f / Hz``, ``omega in rad/s``, ``Frequency, Hz``, ``f_Hz``."""
    plain = _single_spaced(written)
    for form in (_BRACKETED, _SLASHED, _COMMA, _UNDERSCORED):
        match = form.match(plain)
        if match and match["name"] and (form is not _UNDERSCORED or match["unit"] in _AFTER_UNDERSCORE):
            return match["name"], match["unit"].strip()
    return written, ""


def _single_spaced(text: str) -> str:
    """With one space for each run of them: the patterns take the cube of a run's length."""
    return " ".join(text.split())


def _plain(name: str) -> str:
    text = unicodedata.normalize("NFKC", name.translate(_PRIMES)).casefold()  # which would take an acute accent apart
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
        # E', E_stor, Estorage; storage modulus E', storage (E')
        symbols = (
            text.removeprefix(letter),
            re.sub(rf"^(storage|loss|complex|speicher|verlust)(modul(?:us)?|)\(?{letter}\W*$", r"\1\2", text),
        )
        for role in _MODULI:
            if any(each != text and each in _NAMES[role] for each in symbols):
                return role, letter.upper()
    return "", ""

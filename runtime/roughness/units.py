"""Units of a scan: those that its file states, and the one that is given for what it does not."""

import codecs
import contextlib
import itertools
import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from ..errors import InputError
from ..extras import require

#: of coordinates, which SurfaceTopography takes only if both are stated
_OF_COORDINATES = {key: re.compile(rf"#\s*{key} units:\s*(\S+)") for key in ("Lateral", "Value")}
#: what stands between the numbers of a point, and beside units in names such as ``x [mm]``, ``z/um``, ``Lateral um``
_BETWEEN_NUMBERS, _BESIDE_UNITS = re.compile(r"[\s,;]+"), re.compile(r"[\s()\[\]{},;:=/#]+")
_OF_HEIGHTS = re.compile(r"\b(?:heights?|z)\b[\s\[({/:,]*(?:in\b[\s\[({]*)?([^\W\d_]+)", re.IGNORECASE)
#: of lengths in text of SPIP and Wyko, where it does not say
_USUAL = {"spip": "nm", "wyko": "mm"}
#: bytes of a file in which numbers begin
_HEAD = 100_000


@dataclass(frozen=True)
class Units:
    """Units of a scan.

    Attributes
    ----------
    heights : of the heights as they come from the reader
    factors : what lengths as they come from the reader are multiplied with to be in the unit of the heights
    said : units of heights and lengths, and by whose word, as text
    """

    heights: str
    factors: tuple[float, ...]
    said: str

    def heights_in(self, unit: str) -> float:
        """What heights are multiplied with to be in another unit."""
        return float(_module().get_unit_conversion_factor(self.heights, unit))


def units_of(reader: Any, channel: Any, given: str | None, where: str) -> Units:
    """Units of a channel of an open file; ``given`` stands for what the file does not state.

    Raises
    ------
    InputError : something has no unit, what is given contradicts the file, or is no unit of length; names it
    """
    heights, lengths = _stated(reader, channel, where)
    given = None if given is None else _known(given, where)
    if given is None and (heights is None or None in lengths):
        what = [name for name, lacks in (("lengths", None in lengths), ("heights", heights is None)) if lacks]
        allowed = f"a length unit such as 'um' of the {' and '.join(what)}, since the file does not say (--unit)"
        raise InputError(f"{where}, unit", None, allowed)
    if None not in (heights, *lengths) and any(given not in (None, each) for each in (heights, *lengths)):
        stated = f"lengths in {' x '.join(_once(lengths))}, heights in {heights}"
        raise InputError(f"{where}, unit", given, f"no unit but that of the file, which says: {stated}")
    unit: Any = heights or given  # one of them, or it was refused above
    # as they come from the reader: where the file states a unit of the heights, lengths have been converted to it
    come_in = [given if each is None else each if channel.unit is None else unit for each in lengths]
    factors = tuple(_module().get_unit_conversion_factor(each, unit) for each in come_in)
    parts = " x ".join(_once([f"{each or given} {_whose(each)}" for each in lengths]))
    return Units(unit, factors, f"lengths in {parts}, heights in {unit} {_whose(heights)}")


def lacks_lengths(channel: Any) -> bool:
    """Whether a channel of an open file says nothing about the lengths of the scan; uneven steps do."""
    return channel.physical_sizes is None and channel.is_uniform is not False


def _whose(stated: str | None) -> str:
    return "as given" if stated is None else "as the file says"


def _stated(reader: Any, channel: Any, where: str) -> tuple[str | None, list[str | None]]:
    """Unit of the heights, and those of the lengths, as the file states them, else None."""
    header = channel.info.get("raw_metadata") or {}
    heights = channel.unit and _known(channel.unit, where)
    lengths = [heights] * channel.dim
    if lacks_lengths(channel):  # they are given, in the unit that is given
        lengths = [None] * channel.dim
    elif reader.format() == "asc":
        usual = _USUAL.get(header.get("format_flavor"))
        both = header.get("xunit") or usual, header.get("yunit") or usual or header.get("xunit")
        lengths = [each and _known(each, where) for each in both[: channel.dim]]
    elif reader.format() == "xyz":  # both stated, the reader may have converted one to the other
        heights, lengths = _above_points(where, channel)
    if heights is None and reader.format() == "asc":
        heights = _above_matrix(where)
    return heights, lengths


def _above_points(where: str, channel: Any) -> tuple[str | None, list[str | None]]:
    """Units of the heights and of the lengths of points as text: in remarks, or in the line above the numbers."""
    found: dict[str, str] = {}
    heading = ""
    for line in itertools.takewhile(_lacks_numbers, _lines(where)):
        for key, pattern in _OF_COORDINATES.items():
            if match := pattern.match(line):
                found[key] = _known(match[1], where)
        heading = line if line.strip() else heading
    if found:
        return found.get("Value"), [found.get("Lateral")] * channel.dim
    units = [_known(word, where) for word in re.split(_BESIDE_UNITS, heading) if _is_unit(word)]
    if len(units) == channel.dim + 1:  # one for each column
        return units[-1], [*units[:-1]]
    return None, [channel.unit] * channel.dim


def _above_matrix(where: str) -> str | None:
    """Unit of the heights of a matrix as text that a line above it states in words: ``Height [nm]``, ``z in um``."""
    lines = itertools.takewhile(_lacks_numbers, _lines(where))
    words = [match[1] for match in map(_OF_HEIGHTS.search, lines) if match]
    return next((_known(word, where) for word in words if _is_unit(word)), None)


def _lines(where: str) -> list[str]:
    """The first lines of a text file."""
    with open(where, "rb") as file:
        head = file.read(_HEAD)
    for encoding in ("utf-16",) if head[:2] in (codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE) else ("utf-8-sig", "latin-1"):
        with contextlib.suppress(UnicodeDecodeError):  # a character that is cut at the end is none
            return codecs.getincrementaldecoder(encoding)().decode(head).splitlines()
    return []


def _lacks_numbers(line: str) -> bool:
    """Whether a line is none of the coordinates of a point."""
    words = _BETWEEN_NUMBERS.split(line.strip())
    try:
        return len([float(word) for word in words if word]) < 2
    except ValueError:
        return True


def _known(unit: Any, where: str) -> str:
    if not _is_unit(unit):
        raise InputError(f"{where}, unit", unit, f"one of {', '.join(_module().length_units)}")
    return str(_module().mangle_length_unit_utf8(unit))


def _is_unit(word: Any) -> bool:
    return isinstance(word, str) and _module().mangle_length_unit_utf8(word) in _module().length_units


def _once(words: Sequence[Any]) -> list[Any]:
    return list(dict.fromkeys(words))


def _module() -> Any:
    return require("SurfaceTopography.Support.UnitConversion", "roughness", "reading a measured surface")

"""Units of a scan: those that its file states, and the one that is given for what it does not."""

import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from ..errors import InputError
from ..extras import require

#: of coordinates, which SurfaceTopography takes only if both are stated
_OF_COORDINATES = {key: re.compile(rf"#\s*{key} units:\s*(\S+)") for key in ("Lateral", "Value")}


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
    elif reader.format() == "asc" and "format_flavor" not in header:  # the flavours have units by convention
        both = header.get("xunit"), header.get("yunit") or header.get("xunit")
        lengths = [each and _known(each, where) for each in both[: channel.dim]]
    elif reader.format() == "asc":
        lengths = [heights or "nm"] * channel.dim
    elif reader.format() == "xyz":  # both stated, the reader has converted one to the other
        heights, lateral = _in_comments(where)
        lengths = [lateral] * channel.dim
    return heights, lengths


def _in_comments(where: str) -> tuple[str | None, str | None]:
    found: dict[str, str] = {}
    with open(where, encoding="utf-8-sig", errors="replace") as file:
        for line in file:
            if not line.startswith("#"):
                break
            for key, pattern in _OF_COORDINATES.items():
                if match := pattern.match(line):
                    found[key] = _known(match[1], where)
    return found.get("Value"), found.get("Lateral")


def _known(unit: Any, where: str) -> str:
    units = _module()
    name = units.mangle_length_unit_utf8(unit) if isinstance(unit, str) else unit
    if not isinstance(unit, str) or name not in units.length_units:
        raise InputError(f"{where}, unit", unit, f"one of {', '.join(units.length_units)}")
    return str(name)


def _once(words: Sequence[Any]) -> list[Any]:
    return list(dict.fromkeys(words))


def _module() -> Any:
    return require("SurfaceTopography.Support.UnitConversion", "roughness", "reading a measured surface")

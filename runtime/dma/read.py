"""Reading dynamic mechanical analysis (DMA) data: frequency, storage and loss modulus from a text file."""

import os
import re
from dataclasses import asdict, replace

import numpy as np

from ..errors import InputError
from ..inputs.checks import LARGEST, truth
from ..inputs.shift import WLF, Arrhenius, Shift
from .columns import ONE_BELOW_THE_OTHER, Column, columns_of, factor, lacking, per_second, to_kelvin, with_unit_below
from .contradictions import remark_on_contradictions
from .modulus import SMALLEST_MODULUS, DynamicModulus
from .pairs import PAIRS, in_range, moduli
from .plausibility import remark_on, remark_on_loss, remark_on_repeats, remark_on_temperatures
from .readings import Readings, celsius
from .table import NO_NUMBER, Table, as_number, decimal_comma, read_table, refuse_footer

#: columns that mean nothing without a unit
_WITH_UNIT = ("frequency", "omega", "storage", "loss", "absolute", "phase")
#: a remark that states a shift; spreadsheets put text in quotes
_SHIFT = re.compile(r'[\s"]*#\s*shift:\s*')
_NUMBER = re.compile(r"[-+\u2212]?[.,]?\d[\d.,]*([deDE][-+]?\d+)?$|[-+]?(nan|inf)", re.IGNORECASE)


def read_dma(
    path: str | os.PathLike[str], temperature_set: str | None = None, decimal: str | None = None, shear: bool = False
) -> DynamicModulus:
    """Read frequency, storage and loss modulus from what an instrument exports as text.

    Columns are parted by comma, semicolon, tab or blanks; numbers have a decimal point or comma. A row of names, in any order and
    below any remarks, with the unit in the name or in a row of its own; the same names again may stand above each step::

        f, E_stor, E_loss            Frequency [Hz];E' [MPa];tan delta
        Hz, MPa, MPa                 0,01;1,02;0,108
        0.01, 1.02, 0.11

    Names: ``f``, ``frequency``, ``omega``, ``angular frequency``; ``E'``, ``E_stor``, ``storage modulus`` and the like for
    storage and loss, of E or G; ``E*``; ``tan delta``, or the phase angle ``delta`` in deg or rad. Two of storage, loss, the
    absolute value and one of the last two will do. Units: any of stress and of frequency (other than Pa, kPa, MPa, GPa, Hz,
    kHz, rad/s: extra ``units``). Other columns are ignored, but for ``Set`` and temperature: raw data at several temperatures,
    more than 2 K apart or in steps of 1 K, have to become a master curve first (``hystrip.dma.master_curve``). Rows with an
    empty or undefined number are left out. ``columns`` of what is returned says what was taken for what.

    Parameters
    ----------
    path : the file
    temperature_set : of raw data at several temperatures, take the rows with this entry in the column ``Set``
    decimal : ``"."`` or ``","``, for a file that can be read both ways
    shear : moduli without a letter in their names are shear moduli, G; otherwise they are taken for Young's, E

    Raises
    ------
    InputError : the file cannot be read, or a column, unit or number in it not be used; names file, place and what is
        allowed

    Warns (``hystrip.dma.DataWarning``) of moduli, losses and temperatures of no rubber, as wrong units give; of tan delta, delta,
    absolute values or angular frequencies that contradict the columns that are used; and of rows at one frequency
    with different moduli, as in sweeps of strain.
    """
    readings = read_readings(path, decimal, shear)
    rows, sets = np.arange(readings.omega.size), readings.sets()
    if temperature_set is not None:
        if temperature_set not in sets:
            has = f"one of {', '.join(sets)}" if sets else f"None: {readings.where} has no column 'Set'"
            raise InputError("temperature_set", temperature_set, has)
        rows = sets[temperature_set]
    elif len(sets) > 1:
        one = "one temperature: a master curve (`hystrip master` makes one), or the rows of one set"
        raise InputError(f"{readings.where}, Set", list(sets), one)
    readings.refuse_several_temperatures(rows)
    found = readings.of(rows)
    remark_on_repeats(readings, [rows])
    if readings.temperature is None:
        return found
    at = f"temperature of the rows used: {celsius(readings.temperature[rows])}"
    return replace(found, columns=(*found.columns, at))


def read_readings(path: str | os.PathLike[str], decimal: str | None = None, shear: bool = False) -> Readings:
    """All rows of a file, as :func:`read_dma` reads it. Raises ``InputError`` as that does."""
    shear = truth("shear", shear)
    table = read_table(path, lacking)
    where = table.where
    columns = columns_of(table.names)
    pair, chosen = _chosen(where, table, columns)
    chosen, rows = _with_units(table, chosen)
    used = [column for role, column in chosen.items() if role != "set"]
    comma = decimal_comma(table, [table.number(row, column.index) for _, row in rows for column in used], decimal)
    factors = {column.role: 1.0 if column.role == "temperature" else factor(column, where) for column in used}
    numbers, kept = _numbers(table, rows, used, comma)
    if not numbers.size:
        raise InputError(where, "no row of numbers", "two or more, each with frequency and moduli")
    values = {column.role: numbers[:, i] * factors[column.role] for i, column in enumerate(used)}

    def refuse(role: str, good: np.ndarray, allowed: str) -> None:
        if not good.all():
            at, column = int(np.argmin(good)), chosen[role]
            written = float(numbers[at, used.index(column)])
            raise InputError(f"{where}, line {kept[at][0]}, column {column.name!r}", written, allowed)

    for role in (used[0].role, *pair):
        refuse(role, *in_range(role, values[role]))
    storage, loss = moduli(pair, values)
    first, second = (values[role] for role in pair)
    if pair[1] == "absolute":
        good, rule = (second >= first, "not below") if pair[0] == "storage" else (second > first, "above")
        refuse("absolute", good, f"numbers {rule} those of {chosen[pair[0]].name!r}")
    refuse(pair[1], np.isfinite(storage), "numbers > 0 where the storage modulus follows from them")
    for role, found, zero in (("storage", storage, ""), ("loss", loss, "0, or ")):
        follows = f"numbers of which a {role} modulus of {zero}{SMALLEST_MODULUS:g} to {LARGEST:g} Pa follows"
        good = (found >= SMALLEST_MODULUS) & (found <= LARGEST) | ((found == 0) & (role == "loss"))
        refuse(role if role in pair else pair[1], good, follows)
    temperature = to_kelvin(values["temperature"], chosen["temperature"], where) if "temperature" in chosen else None
    remark_on(_taken(where, next(chosen[role] for role in chosen if role in ("storage", "loss", "absolute"))), storage)
    remark_on_loss(_taken(where, chosen[pair[1]]), loss / storage)
    below = [] if rows is table.rows else table.rows[0][1]
    remark_on_contradictions(table, kept, below, columns, [chosen[role] for role in (used[0].role, *pair)], comma)
    if temperature is not None:
        remark_on_temperatures(_taken(where, chosen["temperature"]), temperature)
    cells = lambda at: np.array([table.cell(row, at) for _, row in kept], object)  # noqa: E731
    names = cells(chosen["set"].index) if "set" in chosen else None
    others = set(range(len(table.names))) - {column.index for column in chosen.values()}
    ignored = {table.names[i]: cells(i) for i in sorted(others) if table.names[i]}
    kind, taken = _kind(where, [chosen[role] for role in pair], shear)
    said = _said(table, chosen, taken, comma, len(rows) - len(kept), list(ignored))
    return Readings(where, values[used[0].role], storage, loss, kind, temperature, names, said, ignored)


def _taken(where: str, column: Column) -> str:
    return f"{where}, column {column.name!r}, taken for {column.unit or 'a number'}"


def _kind(where: str, columns: list[Column], shear: bool) -> tuple[str, str]:
    """E or G, and what has to be said about it where the names of the columns do not."""
    kinds = {column.kind for column in columns} - {""}
    if len(kinds) > 1:
        raise InputError(where, [column.name for column in columns], "both of E or both of G")
    if shear and kinds == {"E"}:
        raise InputError("shear", shear, f"False: {[column.name for column in columns]} in {where} are moduli E")
    if kinds:
        return kinds.pop(), ""
    if shear:
        return "G", "moduli: of shear, G, as asked for"
    return "E", "moduli: taken for Young's, E; for shear moduli, G: names such as G', or shear=True (--shear)"


def _chosen(where: str, table: Table, columns: list[Column]) -> tuple[tuple[str, str], dict[str, Column]]:
    """The two columns that give the moduli, and all that are used: frequency first. Raises ``InputError`` for two of a kind."""
    roles = {column.role for column in columns}
    pair = next(each for each in PAIRS if set(each) <= roles)
    frequency = "frequency" if "frequency" in roles else "omega"
    chosen = {}
    for role in (frequency, *pair, *(each for each in ("temperature", "set") if each in roles)):
        found = [column for column in columns if column.role == role]
        if len(found) > 1:
            hint = ONE_BELOW_THE_OTHER if len({column.kind for column in found}) == 1 else "of E or of G"
            raise InputError(f"{where}, line {table.line}", [column.name for column in found], f"one column of {role}; {hint}")
        chosen[role] = found[0]
    return pair, chosen


def _with_units(table: Table, chosen: dict[str, Column]) -> tuple[dict[str, Column], list[tuple[int, list[str]]]]:
    """The columns with the units in the row below the names, if that is one of units; and the rows of numbers."""
    below = table.rows[0][1] if table.rows else []
    needed = [table.number(below, column.index) for role, column in chosen.items() if role in _WITH_UNIT]
    if all(map(NO_NUMBER.fullmatch, needed)) or any(_NUMBER.match(cell) for cell in needed):
        return chosen, table.rows
    found = {role: with_unit_below(each, table.cell(below, each.index), table.where) for role, each in chosen.items()}
    return found, table.rows[1:]


def _numbers(
    table: Table, rows: list[tuple[int, list[str]]], columns: list[Column], comma: bool
) -> tuple[np.ndarray, list[tuple[int, list[str]]]]:
    """Numbers of the rows that have all of them, (n, columns), and these rows."""
    out, kept = [], []
    for line, row in rows:
        values, place = [], f"{table.where}, line {line}"
        for column in columns:
            text = table.number(row, column.index)
            try:
                values.append(as_number(text, comma))
            except ValueError:
                refuse_footer(table, line)
                allowed = f"a number with a decimal {'comma' if comma else 'point'}, or nothing"
                raise InputError(f"{place}, column {column.name!r}", text, allowed) from None
        if np.isinf(values).any():
            raise InputError(place, [table.cell(row, column.index) for column in columns], "finite numbers")
        if not np.isnan(values).any():
            out.append(values)
            kept.append((line, row))
    return np.array(out, dtype=float).reshape(-1, len(columns)), kept


def _said(table: Table, chosen: dict[str, Column], taken: str, comma: bool, left_out: int, ignored: list[str]) -> tuple[str, ...]:
    words = {"omega": "angular frequency", "storage": "storage modulus", "loss": "loss modulus", "tan": "tan delta",
             "phase": "phase angle delta", "absolute": "absolute value of the modulus",
             "set": "set of one temperature"}  # fmt: skip
    lines = []
    for role, column in chosen.items():
        said = "omega" if "rad" in column.unit and role == "frequency" else role
        word = words.get(said, said) + f" {column.kind}".rstrip()
        unit = f", in {column.unit}" if column.unit and role not in ("tan", "set") else ""
        if role in ("frequency", "omega") and per_second(column):
            unit += ", taken for Hz, cycles per second" if role == "frequency" else ", taken for rad/s"
        lines.append(f"{column.name!r}: {word}{unit}")
    if taken:
        lines.append(taken)
    if ignored:
        lines.append(f"ignored: {', '.join(map(repr, ignored[:8]))}" + (", ..." if len(ignored) > 8 else ""))
    lines.append(f"cells parted by {table.separator}, decimal {'comma' if comma else 'point'}")
    if table.times > 1:
        lines.append(f"{table.times} tables with the same names, one below the other")
    if left_out:
        lines.append(f"{left_out} row{'s' if left_out > 1 else ''} left out: a number is missing")
    return tuple(lines)


def shift_remark(shift: Shift) -> str:
    """A remark above a table of moduli that says how they shift with temperature; :func:`read_shift` reads it after a ``#``."""
    values = " ".join(f"{name}={value!r}" for name, value in asdict(shift).items())
    return f"shift: {type(shift).__name__} {values}"


def read_shift(path: str | os.PathLike[str]) -> WLF | Arrhenius | None:
    """The shift that a remark above the table of a file states, as in a master curve of ``hystrip master``; None without one.

    Raises ``InputError`` for a remark that is no shift, or a file that cannot be read.
    """
    table = read_table(path, lacking)
    for line in table.remarks:
        stated = _SHIFT.match(line)
        if not stated:
            continue
        words = re.split(r'[\s,;"]+', line[stated.end() :].strip(' \t,;"'))
        try:
            kind = {"WLF": WLF, "Arrhenius": Arrhenius}[words[0]]
            return kind(**{name: float(value) for name, _, value in (word.partition("=") for word in words[1:])})
        except (KeyError, IndexError, TypeError, ValueError) as error:
            allowed = "# shift: WLF C_1=.. C_2=.. T_ref=.. vertical=.., or Arrhenius E_a=.. T_ref=.. vertical=.."
            raise InputError(f"{table.where}, shift", f"{line} ({error})", allowed) from None
    return None

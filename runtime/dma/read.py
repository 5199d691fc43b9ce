"""Reading dynamic mechanical analysis (DMA) data: frequency, storage and loss modulus from a text file."""

import os
import re
from dataclasses import asdict, dataclass

import numpy as np

from ..errors import InputError
from ..inputs.shift import WLF, Arrhenius, Shift
from .columns import Column, columns_of, factor, is_header, to_kelvin
from .modulus import DynamicModulus
from .table import Table, as_number, decimal_comma, read_table

#: in which order of preference two columns give storage and loss modulus
_PAIRS = (("storage", "loss"), ("storage", "tan"), ("loss", "tan"), ("absolute", "tan"))
#: columns that mean nothing without a unit
_WITH_UNIT = ("frequency", "omega", "storage", "loss", "absolute")
_NUMBER = re.compile(r"[-+\u2212]?[.,]?\d[\d.,]*([eE][-+]?\d+)?$|[-+]?(nan|inf)", re.IGNORECASE)
#: K: temperatures closer than this are one step of a furnace
_ONE_STEP = 1.0


@dataclass(frozen=True, eq=False)
class Readings:
    """What a file holds, row by row (n,): angular frequency (rad/s), moduli (Pa), temperature (K) and the text in the
    column ``Set``, None where there is no such column; and what each column was taken for."""

    where: str
    omega: np.ndarray
    storage: np.ndarray
    loss: np.ndarray
    kind: str
    temperature: np.ndarray | None
    set: np.ndarray | None
    columns: tuple[str, ...]

    def of(self, rows: np.ndarray) -> DynamicModulus:
        """The modulus of some rows, at their mean temperature."""
        if np.count_nonzero(rows) < 2:
            raise InputError(self.where, f"{np.count_nonzero(rows)} rows of numbers", "two or more, at different frequencies")
        T = None if self.temperature is None else float(self.temperature[rows].mean())
        return DynamicModulus(self.omega[rows], self.storage[rows], self.loss[rows], self.kind, T, self.columns)

    def isotherms(self) -> list[np.ndarray]:
        """Rows of each temperature, or of each set where the file has sets; one of all rows without either."""
        if self.set is not None:
            return [self.set == name for name in dict.fromkeys(self.set.tolist())]
        if self.temperature is None:
            return [np.ones(self.omega.size, bool)]
        ordered = np.sort(self.temperature)
        starts = np.concatenate(([-np.inf], 0.5 * (ordered[1:] + ordered[:-1])[np.diff(ordered) > _ONE_STEP], [np.inf]))
        steps = [(self.temperature > low) & (self.temperature <= high) for low, high in zip(starts, starts[1:], strict=False)]
        return [rows for rows in steps if rows.any()]


def read_dma(path: str | os.PathLike[str], temperature_set: str | None = None, decimal: str | None = None) -> DynamicModulus:
    """Read frequency, storage and loss modulus from what an instrument exports as text.

    Columns are parted by comma, semicolon or tab; numbers have a decimal point or comma. A row of names, in any order and
    below any remarks, with the unit in the name or in a row of its own::

        f, E_stor, E_loss            Frequency [Hz];E' [MPa];tan delta
        Hz, MPa, MPa                 0,01;1,02;0,108
        0.01, 1.02, 0.11

    Names: ``f``, ``frequency``, ``omega``, ``angular frequency``; ``E'``, ``E_stor``, ``storage modulus`` and the like for
    storage and loss, of E or G; ``tan delta``, ``E*``. Two of storage, loss (or the absolute value) and tan delta will do.
    Units: any of stress and of frequency (other than Pa, kPa, MPa, GPa, Hz, kHz, rad/s: extra ``units``). Other columns
    are ignored, but for ``Set`` and temperature: raw data at several temperatures have to become a master curve first
    (``hystrip.dma.master_curve``). Rows with an empty or undefined number are left out. ``columns`` of what is returned says
    what was taken for what.

    Parameters
    ----------
    path : the file
    temperature_set : of raw data at several temperatures, take the rows with this entry in the column ``Set``
    decimal : ``"."`` or ``","``, for a file that can be read both ways

    Raises
    ------
    InputError : the file cannot be read, or a column, unit or number in it not be used; names file, place and what is
        allowed
    """
    readings = read_readings(path, decimal)
    if temperature_set is not None:
        names = [] if readings.set is None else list(dict.fromkeys(readings.set.tolist()))
        if temperature_set not in names:
            has = f"one of {', '.join(names)}" if names else f"None: {readings.where} has no column 'Set'"
            raise InputError("temperature_set", temperature_set, has)
        return readings.of(readings.set == temperature_set)
    isotherms = readings.isotherms()
    if len(isotherms) > 1:
        _refuse_raw(readings, isotherms)
    return readings.of(np.ones(readings.omega.size, bool))


def read_readings(path: str | os.PathLike[str], decimal: str | None = None) -> Readings:
    """All rows of a file, as :func:`read_dma` reads it. Raises ``InputError`` as that does."""
    table = read_table(path, is_header)
    where = table.where
    columns = columns_of(table.names)
    pair, chosen = _chosen(where, table, columns)
    units, rows = _with_units(table, list(chosen.values()))
    chosen = {role: _given(column, unit) for (role, column), unit in zip(chosen.items(), units, strict=True)}
    used = [column for role, column in chosen.items() if role != "set"]
    comma = decimal_comma(where, [table.cell(row, column.index) for _, row in rows for column in used], decimal)
    factors = {role: 1.0 if role == "temperature" else factor(each, where) for role, each in chosen.items() if role != "set"}
    numbers, kept = _numbers(table, rows, used, comma)
    if not numbers.size:
        raise InputError(where, "no row of numbers", "two or more, each with frequency and moduli")
    frequency = used[0].role
    values = {column.role: numbers[:, i] * factors[column.role] for i, column in enumerate(used)}
    for role in (frequency, *pair):
        good = values[role] >= 0 if role in ("loss", "tan") else values[role] > 0
        if not good.all():
            bound = ">= 0" if role in ("loss", "tan") else "> 0"
            at = int(np.argmin(good))
            raise InputError(
                f"{where}, line {kept[at][0]}, column {chosen[role].name!r}",
                float(values[role][at] / factors[role]),
                f"numbers {bound}",
            )
    storage, loss = _moduli(pair, values)
    if pair == ("loss", "tan") and not np.isfinite(storage).all():
        raise InputError(
            f"{where}, column {chosen['tan'].name!r}", 0.0, "numbers > 0 where the storage modulus follows from them"
        )
    temperature = to_kelvin(values["temperature"], chosen["temperature"], where) if "temperature" in chosen else None
    names = np.array([table.cell(row, chosen["set"].index) for _, row in kept]) if "set" in chosen else None
    kind = next((chosen[role].kind for role in pair if chosen[role].kind), "E")
    said = _said(table, columns, chosen, comma, len(rows) - len(kept))
    return Readings(where, values[frequency], storage, loss, kind, temperature, names, said)


def _chosen(where: str, table: Table, columns: list[Column]) -> tuple[tuple[str, str], dict[str, Column]]:
    """The two columns that give the moduli, and all that are used: frequency first. Raises ``InputError`` for two of a kind."""
    roles = {column.role for column in columns}
    pair = next(each for each in _PAIRS if set(each) <= roles)
    frequency = "frequency" if "frequency" in roles else "omega"
    chosen = {}
    for role in (frequency, *pair, *(each for each in ("temperature", "set") if each in roles)):
        found = [column for column in columns if column.role == role]
        if len(found) > 1:
            raise InputError(f"{where}, line {table.line}", [column.name for column in found], f"one column of {role}")
        chosen[role] = found[0]
    kinds = {chosen[role].kind for role in pair} - {""}
    if len(kinds) > 1:
        raise InputError(f"{where}, line {table.line}", [chosen[role].name for role in pair], "both of E or both of G")
    return pair, chosen


def _with_units(table: Table, columns: list[Column]) -> tuple[list[str], list[tuple[int, list[str]]]]:
    """Units of the columns from the row below the names, if that is one of units; and the rows of numbers."""
    none = [""] * len(columns)
    if not table.rows or all(column.unit for column in columns if column.role in _WITH_UNIT):
        return none, table.rows
    cells = [table.cell(table.rows[0][1], column.index) for column in columns]
    needed = [cell for cell, column in zip(cells, columns, strict=True) if column.role in _WITH_UNIT]
    if not any(needed) or any(_NUMBER.match(cell) for cell in needed):
        return none, table.rows
    return cells, table.rows[1:]


def _given(column: Column, unit: str) -> Column:
    """The column with the unit that stands below its name, unless the name has one."""
    return Column(column.index, column.name, column.role, column.kind, column.unit or unit)


def _numbers(
    table: Table, rows: list[tuple[int, list[str]]], columns: list[Column], comma: bool
) -> tuple[np.ndarray, list[tuple[int, list[str]]]]:
    """Numbers of the rows that have all of them, (n, columns), and these rows."""
    out, kept = [], []
    for line, row in rows:
        values = []
        for column in columns:
            text = table.cell(row, column.index)
            try:
                values.append(as_number(text, comma))
            except ValueError:
                sign = "comma" if comma else "point"
                raise InputError(
                    f"{table.where}, line {line}, column {column.name!r}", text, f"a number with a decimal {sign}, or nothing"
                ) from None
        if np.isinf(values).any():
            raise InputError(
                f"{table.where}, line {line}", [table.cell(row, column.index) for column in columns], "finite numbers"
            )
        if not np.isnan(values).any():
            out.append(values)
            kept.append((line, row))
    return np.array(out, dtype=float).reshape(-1, len(columns)), kept


def _moduli(pair: tuple[str, str], values: dict[str, np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
    first, second = (values[role] for role in pair)
    if pair == ("storage", "loss"):
        return first, second
    if pair == ("storage", "tan"):
        return first, first * second
    if pair == ("loss", "tan"):
        return np.divide(first, second, out=np.full(first.shape, np.inf), where=second > 0), first
    size = first / np.hypot(1.0, second)
    return size, size * second


def _said(table: Table, columns: list[Column], chosen: dict[str, Column], comma: bool, left_out: int) -> tuple[str, ...]:
    words = {
        "frequency": "frequency",
        "omega": "angular frequency",
        "storage": "storage modulus",
        "loss": "loss modulus",
        "tan": "tan delta",
        "absolute": "absolute value of the modulus",
        "temperature": "temperature",
        "set": "set of one temperature",
    }
    lines = []
    for role, column in chosen.items():
        unit = "rad/s" if column.role == "frequency" and "rad" in column.unit else column.unit
        word = "angular frequency" if unit == "rad/s" else words[role] + (f" {column.kind}" if column.kind else "")
        lines.append(f"{column.name!r}: {word}" + (f", in {unit}" if unit and role not in ("tan", "set") else ""))
    ignored = [name for i, name in enumerate(table.names) if name and i not in {column.index for column in chosen.values()}]
    if ignored:
        lines.append(f"ignored: {', '.join(map(repr, ignored[:8]))}" + (", ..." if len(ignored) > 8 else ""))
    lines.append(f"cells parted by {table.separator}, decimal {'comma' if comma else 'point'}")
    if left_out:
        lines.append(f"{left_out} rows left out: a number is missing")
    return tuple(lines)


def _refuse_raw(readings: Readings, isotherms: list[np.ndarray]) -> None:
    """Refuse raw data at several temperatures: their bands overlap. A temperature that drifts along one sweep does not matter."""
    bands = [(readings.omega[rows].min(), readings.omega[rows].max()) for rows in isotherms]
    bands.sort()
    apart = all(before[1] < after[0] * (1 - 1e-9) for before, after in zip(bands, bands[1:], strict=False))
    if readings.set is None and apart:
        return
    if readings.set is not None:
        shown: list = list(dict.fromkeys(readings.set.tolist()))
        raise InputError(
            f"{readings.where}, Set",
            shown,
            "one temperature: a master curve (`hystrip master` makes one), or the rows of one set",
        )
    shown = [f"{readings.temperature[rows].mean():.1f} K" for rows in isotherms]
    raise InputError(f"{readings.where}, temperature", shown, "one temperature: a master curve (`hystrip master` makes one)")


def shift_remark(shift: Shift) -> str:
    """A remark above a table of moduli that says how they shift with temperature; :func:`read_shift` reads it after a ``#``."""
    values = " ".join(f"{name}={value!r}" for name, value in asdict(shift).items())
    return f"shift: {type(shift).__name__} {values}"


def read_shift(path: str | os.PathLike[str]) -> WLF | Arrhenius | None:
    """The shift that a remark above the table of a file states, as in a master curve of ``hystrip master``; None without one.

    Raises ``InputError`` for a remark that is no shift, or a file that cannot be read.
    """
    table = read_table(path, is_header)
    for line in table.remarks:
        if not line.startswith("# shift:"):
            continue
        words = line.removeprefix("# shift:").replace(",", " ").replace(";", " ").split()
        try:
            kind = {"WLF": WLF, "Arrhenius": Arrhenius}[words[0]]
            return kind(**{name: float(value) for name, _, value in (word.partition("=") for word in words[1:])})
        except (KeyError, IndexError, TypeError, ValueError) as error:
            allowed = "# shift: WLF C_1=.. C_2=.. T_ref=.. vertical=.., or Arrhenius E_a=.. T_ref=.. vertical=.."
            raise InputError(f"{table.where}, shift", f"{line} ({error})", allowed) from None
    return None

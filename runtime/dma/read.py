"""Reading dynamic mechanical analysis (DMA) data: frequency, storage and loss modulus from a CSV file."""

from __future__ import annotations

import csv
import os
from dataclasses import dataclass, field

import numpy as np

from ..errors import InputError
from ..inputs.checks import numbers

_MODULUS = {"Pa": 1.0, "kPa": 1e3, "MPa": 1e6, "GPa": 1e9}
_FREQUENCY = {"f": ("Hz", 2 * np.pi), "omega": ("rad/s", 1.0)}
_LARGEST = 1 << 26  # bytes; a master curve has a few thousand


@dataclass(frozen=True, eq=False)
class DynamicModulus:
    """Storage and loss modulus over angular frequency, sorted by it.

    Parameters
    ----------
    omega : angular frequency, rad/s, > 0, shape (n,), n >= 2
    storage, loss : moduli, Pa, > 0 and >= 0, shape (n,)
    kind : ``"E"`` (tension, compression) or ``"G"`` (shear)

    Raises
    ------
    InputError : a value outside its range, or shapes that differ

    >>> data = DynamicModulus(omega=[10.0, 1.0], storage=[2e6, 1e6], loss=[3e5, 1e5])
    >>> data.storage.tolist()
    [1000000.0, 2000000.0]
    """

    omega: np.ndarray
    storage: np.ndarray
    loss: np.ndarray
    kind: str = field(default="E")

    def __post_init__(self):
        omega = numbers("dma.omega", self.omega, "rad/s", 0, strict=True)
        storage = numbers("dma.storage", self.storage, "Pa", 0, strict=True)
        loss = numbers("dma.loss", self.loss, "Pa", 0)
        shapes = [each.shape for each in (omega, storage, loss)]
        if omega.ndim != 1 or omega.size < 2 or len(set(shapes)) > 1:
            raise InputError("dma", shapes, "omega, storage and loss of one shape (n,), n >= 2")
        if self.kind not in ("E", "G"):
            raise InputError("dma.kind", self.kind, "'E' (tension) or 'G' (shear)")
        order = np.argsort(omega, kind="stable")
        for name, values in (("omega", omega), ("storage", storage), ("loss", loss)):
            object.__setattr__(self, name, values[order])

    def between(self, low: float | None = None, high: float | None = None) -> DynamicModulus:
        """The part from ``low`` to ``high``, in Hz. Raises InputError if fewer than two frequencies remain."""
        f = self.omega / (2 * np.pi)
        # a limit as written and a frequency that came through 2 pi and back differ by rounding
        keep = (f >= (low or 0) * (1 - 1e-12)) & (f <= (np.inf if high is None else high * (1 + 1e-12)))
        if keep.sum() < 2:
            span = f"{f[0]:.4g} to {f[-1]:.4g} Hz"
            raise InputError("frequencies", (low, high), f"a range with two measured frequencies or more; measured: {span}")
        return DynamicModulus(self.omega[keep], self.storage[keep], self.loss[keep], self.kind)


def read_dma(path: str | os.PathLike[str], temperature_set: str | None = None) -> DynamicModulus:
    """Read a CSV file in the layout that pyvisco reads.

    The first row holds names, the second their units, then numbers::

        f, E_stor, E_loss
        Hz, MPa, MPa
        0.01, 1.02, 0.11

    Columns, in any order: ``f`` in Hz (or ``omega`` in rad/s); ``E_stor`` and ``E_loss`` (shear: ``G_stor``,
    ``G_loss``) in Pa, kPa, MPa or GPa. Others are ignored, but for ``Set``: raw data at several temperatures have to
    be shifted to a master curve first. Rows with an empty or undefined number are left out.

    Parameters
    ----------
    path : the file
    temperature_set : of raw data at several temperatures, take the rows with this entry in the column ``Set``

    Raises
    ------
    InputError : the file cannot be read, or a column, unit or number in it not be used; names file, place and what is
        allowed
    """
    where = os.fspath(path)
    rows = _rows(where)
    if len(rows) < 2:
        raise InputError(where, f"{len(rows)} rows", "a row of names, a row of units, then numbers")
    names, units = rows[0], rows[1]
    at = {name: column for column, name in enumerate(names) if name}
    frequency = next((name for name in _FREQUENCY if name in at), None)
    if frequency is None:
        raise InputError(f"{where}, row 1", names, "a column named 'f' (Hz) or 'omega' (rad/s)")
    kind = next((letter for letter in "EG" if f"{letter}_stor" in at), None)
    if kind is None or f"{kind}_loss" not in at:
        raise InputError(f"{where}, row 1", names, "columns 'E_stor' and 'E_loss', or 'G_stor' and 'G_loss'")
    for name in (frequency, f"{kind}_stor", f"{kind}_loss"):
        if names.count(name) > 1:
            raise InputError(f"{where}, row 1", names, f"one column named {name!r}")
    factors = {frequency: _frequency_factor(where, frequency, _cell(units, at[frequency]))}
    for name in (f"{kind}_stor", f"{kind}_loss"):
        unit = _cell(units, at[name])
        if unit not in _MODULUS:
            raise InputError(f"{where}, row 2, {name}", unit, "one of " + ", ".join(_MODULUS))
        factors[name] = _MODULUS[unit]
    kept = _of_one_temperature(where, rows[2:], at, temperature_set)
    table = _numbers(where, kept, [at[name] for name in factors], list(factors))
    if len(table) < 2:
        raise InputError(where, f"{len(table)} rows of numbers", "two or more")
    omega, storage, loss = (table * np.array(list(factors.values()))).T
    for name, values, good in (
        (frequency, omega, omega > 0),
        (f"{kind}_stor", storage, storage > 0),
        (f"{kind}_loss", loss, loss >= 0),
    ):
        if not good.all():
            bound = ">= 0" if values is loss else "> 0"
            raise InputError(f"{where}, {name}", float((values / factors[name])[~good][0]), f"numbers {bound}")
    return DynamicModulus(omega, storage, loss, kind)


def _rows(path: str) -> list[list[str]]:
    try:
        with open(path, "rb") as file:
            data = file.read(_LARGEST + 1)
    except OSError as error:
        raise InputError(path, path, f"a CSV file that can be read ({error.strerror or error})") from None
    if len(data) > _LARGEST:
        raise InputError(path, path, "a CSV file of at most 64 MiB")
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise InputError(path, path, f"a CSV file, which is UTF-8 text (byte {error.start} is not)") from None
    try:
        return [[cell.strip() for cell in row] for row in csv.reader(text.splitlines())]
    except csv.Error as error:
        raise InputError(path, path, f"a CSV file ({error})") from None


def _cell(row: list[str], column: int) -> str:
    return row[column] if column < len(row) else ""


def _frequency_factor(where: str, name: str, unit: str) -> float:
    expected, factor = _FREQUENCY[name]
    if unit != expected:
        raise InputError(f"{where}, row 2, {name}", unit, expected)
    return factor


def _of_one_temperature(where: str, rows: list[list[str]], at: dict[str, int], wanted: str | None) -> list[tuple[int, list[str]]]:
    """Numbered rows, of one temperature alone."""
    numbered = [(number, row) for number, row in enumerate(rows, start=3) if any(row)]
    sets = list(dict.fromkeys(_cell(row, at["Set"]) for _, row in numbered)) if "Set" in at else []
    if wanted is not None:
        if wanted not in sets:
            raise InputError(
                "temperature_set", wanted, f"one of {', '.join(sets)}" if sets else f"None: {where} has no column 'Set'"
            )
        return [(number, row) for number, row in numbered if _cell(row, at["Set"]) == wanted]
    if len(sets) > 1:
        raise InputError(f"{where}, Set", sets, "one temperature: a master curve, or the rows of one set (temperature_set)")
    return numbered


def _numbers(where: str, rows: list[tuple[int, list[str]]], columns: list[int], names: list[str]) -> np.ndarray:
    out = []
    for number, row in rows:
        cells = [_cell(row, column) for column in columns]
        values = []
        for name, text in zip(names, cells, strict=True):
            try:
                values.append(float(text or "nan"))
            except ValueError:
                raise InputError(f"{where}, row {number}, {name}", text, "a number with a decimal point, or nothing") from None
        if np.isinf(values).any():
            raise InputError(f"{where}, row {number}", cells, "finite numbers")
        if not np.isnan(values).any():
            out.append(values)
    return np.array(out, dtype=float).reshape(-1, len(columns))

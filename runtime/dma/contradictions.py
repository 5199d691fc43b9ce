"""Columns beyond those that give frequency and moduli: where they contradict these, it is said."""

import itertools
import warnings
from collections.abc import Sequence

import numpy as np

from ..errors import InputError
from .columns import Column, factor, with_unit_below
from .pairs import moduli
from .plausibility import POOR_REPEAT, DataWarning
from .table import Table, as_number, last_digit

_Rows = Sequence[tuple[int, list[str]]]


def remark_on_contradictions(
    table: Table, rows: _Rows, below: list[str], columns: Sequence[Column], used: Sequence[Column], comma: bool
) -> None:
    """Warn of other columns, with their units in the name or ``below``, that contradict the three ``used`` in some rows: by
    more than their last digits and some per cent of scatter, as averages of tan delta have. Those not understood are left out.
    """
    frequency, *pair = used
    roles, indices = (pair[0].role, pair[1].role), [column.index for column in used]
    with np.errstate(all="ignore"):
        ends = itertools.product(*(np.maximum(_ends(table, rows, column, comma), 0.0) for column in pair))
        corners = [moduli(roles, dict(zip(roles, each, strict=True))) for each in ends]
        tans, sizes = zip(*((loss / storage, np.hypot(storage, loss)) for storage, loss in corners), strict=True)
        follow = {"tan": (pair, "tan delta", tans), "phase": (pair, "tan delta", tans), "absolute": (pair, "|E*|", sizes)}
        follow["omega"] = ([frequency], "angular frequency", _ends(table, rows, frequency, comma))
        for column in columns:
            if column.index in indices or column.role not in follow:
                continue
            try:
                low, high = _ends(table, rows, with_unit_below(column, table.cell(below, column.index), table.where), comma)
            except InputError:  # without a unit, say
                continue
            if column.role == "phase":
                low, high = np.tan(np.minimum((low, high), np.pi / 2))
            of, what, found = follow[column.role]
            least, most = np.min(found, axis=0), np.max(found, axis=0)
            differ = (high * (1 + POOR_REPEAT) < least) | (low > most * (1 + POOR_REPEAT))
            if differ.any():
                excess = np.minimum((low + high) / (least + most) - 1, 1e9)
                _warn(table, rows, column, of, what, np.where(differ, excess, 0.0))


def _ends(table: Table, rows: _Rows, column: Column, comma: bool) -> tuple[np.ndarray, np.ndarray]:
    """Least and greatest numbers, in SI, that are written as those in the column; NaN where there is none."""
    low, high = np.full((2, len(rows)), np.nan)
    for i, (_, row) in enumerate(rows):
        text = table.number(row, column.index)
        try:
            value, half = as_number(text, comma), last_digit(text, comma) / 2
        except ValueError:
            continue
        low[i], high[i] = value - half, value + half
    unit = factor(column, table.where)
    return low * unit, high * unit


def _warn(table: Table, rows: _Rows, column: Column, of: Sequence[Column], what: str, excess: np.ndarray) -> None:
    at, names = int(np.flatnonzero(excess)[0]), " and ".join(repr(each.name) for each in of)
    first, worst = (float(f"{100 * each:.2g}") for each in (excess[at], np.abs(excess).max()))
    warnings.warn(
        f"{table.where}, column {column.name!r}: {np.count_nonzero(excess)} of {excess.size} rows contradict {names}, by up to "
        f"{worst:g} % of the {what} that follows; the first, line {rows[at][0]}, by {first:+g} %. What they contradict is used: "
        "another unit, or other data?",
        DataWarning,
        stacklevel=5,
    )

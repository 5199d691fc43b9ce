"""Isotherms from a file of readings at several temperatures: which rows were measured at one temperature."""

import os
from dataclasses import replace

import numpy as np

from ..errors import InputError
from .modulus import DynamicModulus
from .plausibility import remark_on_repeats
from .read import read_readings
from .readings import Readings, degrees

#: K: gaps wider than this part temperatures whatever was measured
_APART = 1.0
#: K: a frequency measured twice within this was repeated at one temperature
_ONE = 0.75
#: K: so far the temperature of one sweep of frequency may drift
_DRIFT = 3.0
#: K, and times the gaps within an isotherm: gaps that part isotherms closer than ``_APART``
_GAP, _CLEAR = 0.2, 2.0
#: decades: frequencies nearer than this are one
_SAME = 0.002


def read_isotherms(path: str | os.PathLike[str], decimal: str | None = None, shear: bool = False) -> list[DynamicModulus]:
    """Isotherms in a file with a column of temperatures, in the order of the file.

    Read as :func:`read_dma` does. Each entry of a column ``Set`` is an isotherm, so that a temperature measured twice gives
    two, each with a shift of its own. Without such a column temperatures more than 1 K apart are different ones, and sweeps
    repeated within 0.75 K are one isotherm; closer steps, of a ramp or of a furnace that drifts, are parted by clear gaps of
    temperature, or else by sweeps: rows along which frequency only grows, or only falls, while temperature changes by 3 K at
    most. Each isotherm has the mean temperature of its rows; ``columns`` says where it drifts.

    Raises
    ------
    InputError : as from :func:`read_dma`; for fewer than two isotherms, temperatures that cannot be told apart, and
        isotherms of one frequency
    """
    readings = read_readings(path, decimal, shear)
    if readings.temperature is None:
        raise InputError(readings.where, "no column of temperatures", "one such as 'T [degC]', with at least two temperatures")
    groups = grouped(readings)
    for rows in groups:
        if _count(readings, rows) < 2:
            found = f"one frequency at {degrees(readings.temperature[rows].mean())}"
            raise InputError(f"{readings.where}, temperature", found, "two or more frequencies at each temperature")
    drift = max(np.ptp(readings.temperature[rows]) for rows in groups)
    if drift > _ONE:
        line = f"temperature drifts by up to {drift:.1f} K within an isotherm: its mean is taken, and shifts are as uncertain"
        readings = replace(readings, columns=(*readings.columns, line))
    found = [readings.of(rows) for rows in groups]
    if len(found) < 2:
        raise InputError(readings.where, f"one temperature, {degrees(found[0].temperature)}", "at least two temperatures")
    remark_on_repeats(readings, groups)
    return found


def grouped(readings: Readings) -> list[np.ndarray]:
    """Indices of the rows of each isotherm, of readings with temperatures. Raises ``InputError`` where they are no isotherms."""
    return _by_set(readings) if readings.set is not None else _by_temperature(readings)


def repeats_differ(isotherm: DynamicModulus) -> float:
    """By how much moduli measured twice at one frequency of an isotherm differ at most, relative; 0 where none was."""
    starts = _different(np.log10(isotherm.omega))
    ratios = [np.maximum.reduceat(each, starts) / np.minimum.reduceat(each, starts) for each in (isotherm.storage, isotherm.loss)]
    return float(np.max(ratios)) - 1


def _by_set(readings: Readings) -> list[np.ndarray]:
    groups = readings.sets()
    for name, rows in groups.items():
        T = readings.temperature[rows]
        if np.ptp(T) > _DRIFT:
            span = f"{degrees(T.min())} to {degrees(T.max())}"
            raise InputError(f"{readings.where}, Set {name!r}", span, f"one temperature, within {_DRIFT:g} K")
    return list(groups.values())


def _by_temperature(readings: Readings) -> list[np.ndarray]:
    order = np.argsort(readings.temperature, kind="stable")
    found = []
    for rows in np.split(order, np.flatnonzero(np.diff(readings.temperature[order]) > _APART) + 1):
        if np.ptp(readings.temperature[rows]) < _ONE or _is_one(readings, rows):
            found.append(rows)
            continue
        parts = _at_gaps(readings, rows) or _sweeps(readings, np.sort(rows))
        if not parts:
            T = readings.temperature[rows]
            span = f"{degrees(T.min())} to {degrees(T.max())}, without gaps of {_APART:g} K"
            allowed = "temperatures that can be told apart, a sweep of frequency at each from row to row, or a column Set"
            raise InputError(f"{readings.where}, temperature", span, allowed)
        found += parts
    return found


def _is_one(readings: Readings, rows: np.ndarray) -> bool:
    """Whether rows are one isotherm: near in temperature, or one sweep of a temperature that drifts."""
    span, count = np.ptp(readings.temperature[rows]), _count(readings, rows)
    return count > 1 and (span < _ONE or (span <= _DRIFT and count == rows.size))


def _at_gaps(readings: Readings, rows: np.ndarray) -> list[np.ndarray]:
    """Rows, sorted by temperature, parted at gaps that are clearly wider than all others; none where no gaps are."""
    steps = np.diff(readings.temperature[rows])
    sizes = np.unique(steps)
    clear = (sizes[1:] >= _GAP) & (sizes[1:] >= _CLEAR * sizes[:-1])
    for least in sizes[1:][clear][::-1]:
        parts = np.split(rows, np.flatnonzero(steps >= least) + 1)
        if all(_is_one(readings, part) for part in parts):
            return parts
    return []


def _sweeps(readings: Readings, rows: np.ndarray) -> list[np.ndarray]:
    """Rows, in the order of the file, parted where frequency turns back; none where that gives no isotherms."""
    x = np.log10(readings.omega[rows])
    starts, direction = [], 0
    for i in range(1, rows.size):
        step = x[i] - x[i - 1]
        way = 0 if abs(step) <= _SAME or rows[i] > rows[i - 1] + 1 else int(np.sign(step))
        if way == 0 or way == -direction:
            starts.append(i)
            direction = 0
        else:
            direction = way
    parts = np.split(rows, starts)
    return parts if all(_is_one(readings, part) for part in parts) else []


def _count(readings: Readings, rows: np.ndarray) -> int:
    """How many frequencies were measured."""
    return len(_different(np.sort(np.log10(readings.omega[rows]))))


def _different(x: np.ndarray) -> list[int]:
    """Where in ascending decades of frequency the next one begins; neighbours may be many and close."""
    starts = [0]
    while (after := int(np.searchsorted(x, x[starts[-1]] + _SAME, side="right"))) < x.size:
        starts.append(after)
    return starts

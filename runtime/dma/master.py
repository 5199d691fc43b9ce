"""Time-temperature superposition: isotherms of a modulus become one master curve, with its shift factors and their law.

Shift factors are those at which all isotherms lie best on one smooth curve: a cubic spline of log modulus over log reduced
frequency, storage and loss each with its own, fitted together with the shifts by least squares (variable projection).
"""

import os
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..errors import InputError
from ..inputs.checks import choice, number
from ..inputs.shift import R_GAS, WLF, Arrhenius
from .modulus import DynamicModulus
from .read import read_readings

LAWS = ("best", "WLF", "Arrhenius")
#: K: without a temperature asked for, the isotherm nearest to 20 degrees Celsius is the reference
_ROOM = 293.15
#: knots of the smooth curve per decade of reduced frequency
_KNOTS = 1.0
#: steps per decade in which the first guess of a shift is sought, and decades that neighbours may lie apart at most
_STEPS, _APART = 20, 4.0
#: share of an isotherm that has to overlap its neighbour for the first guess
_OVERLAP = 0.2
#: decades that a measured shift is uncertain by at least, with the temperature of its isotherm
_LEAST_ERROR = 0.02


@dataclass(frozen=True, eq=False)
class MasterCurve:
    """A master curve.

    Attributes
    ----------
    data : all measured points at the reference temperature, a :class:`DynamicModulus`
    temperatures : of the isotherms, K, ascending, shape (n,)
    a_T, b_T : horizontal and vertical shift factors, (n,): ``E*(omega, T) = b_T E*(a_T omega, T_ref)``; 1 at the reference
    a_T_error : relative standard errors of a_T, (n,)
    shift : the law fitted to them, a :class:`hystrip.WLF` or :class:`hystrip.Arrhenius`
    rms : root mean square of the relative distance of points from the smooth curve; law_rms : of log10 a_T from the law
    isotherms : what was measured, in the order of the temperatures
    """

    data: DynamicModulus
    temperatures: np.ndarray
    a_T: np.ndarray
    b_T: np.ndarray
    a_T_error: np.ndarray
    shift: WLF | Arrhenius
    rms: float
    law_rms: float
    isotherms: tuple[DynamicModulus, ...]

    @property
    def T_ref(self) -> float:
        """Temperature of the master curve, K."""
        return self.shift.T_ref

    def report(self) -> str:
        """Shift factors, their law, and how well they hold, as text."""
        s, f = self.shift, self.data.frequency
        law = f"C_1 = {s.C_1:.4g}, C_2 = {s.C_2:.4g} K" if isinstance(s, WLF) else f"E_a = {s.E_a / 1e3:.4g} kJ/mol"
        lines = [
            f"isotherms  {len(self.temperatures)}, {_celsius(self.temperatures[0])} to {_celsius(self.temperatures[-1])}, "
            f"{f.size} points",
            f"master     at {_celsius(self.T_ref)}: {f[0]:.3g} to {f[-1]:.3g} Hz; points lie {100 * self.rms:.2g} % rms off one "
            "smooth curve",
            f"shift      {type(s).__name__}: {law}, vertical exponent {s.vertical:.3g}; "
            f"log10 a_T is {self.law_rms:.2g} rms off it",
            "",
            f"{'T [degC]':>10}  {'a_T':>11}  {'of the law':>11}  {'b_T':>8}",
        ]
        fitted = s.factor(self.temperatures)
        for T, a, of_law, b in zip(self.temperatures, self.a_T, fitted, self.b_T, strict=True):
            lines.append(f"{T - 273.15:10.2f}  {a:11.4g}  {of_law:11.4g}  {b:8.4f}")
        return "\n".join(lines)


def read_isotherms(path: str | os.PathLike[str], decimal: str | None = None) -> list[DynamicModulus]:
    """Isotherms in a file with a column of temperatures (and, where one temperature was measured twice, ``Set``).

    Read as :func:`read_dma` does. Raises ``InputError`` as that does, and for fewer than two temperatures.
    """
    readings = read_readings(path, decimal)
    if readings.temperature is None:
        raise InputError(readings.where, "no column of temperatures", "one such as 'T [degC]', with at least two temperatures")
    found = [readings.of(rows) for rows in readings.isotherms()]
    if len(found) < 2:
        raise InputError(readings.where, f"one temperature, {found[0].temperature:.1f} K", "at least two temperatures")
    return found


def master_curve(
    isotherms: Sequence[DynamicModulus], *, T_ref: float | None = None, law: str = "best", vertical: bool = False
) -> MasterCurve:
    """Shift isotherms into one master curve, and fit the shift factors by a law.

    Parameters
    ----------
    isotherms : moduli, each with its ``temperature``; at least two, of which neighbours overlap after shifting
    T_ref : temperature of the master curve, K: the isotherm nearest to it is the reference (by default, nearest to 20 degC)
    law : ``"WLF"``, ``"Arrhenius"``, or ``"best"``: the one that is nearer
    vertical : shift moduli too, by ``b_T = (T/T_ref)^v`` with the v that fits best, from -3 to 3

    Raises
    ------
    InputError : fewer than two isotherms, temperatures that are missing or equal, neighbours that cannot overlap, or factors
        that no law of the kind has (times that grow with temperature)
    """
    choice("law", law, LAWS)
    isotherms = _checked(isotherms)
    T = np.array([each.temperature for each in isotherms])
    at = int(np.argmin(np.abs(T - (_ROOM if T_ref is None else number("T_ref", T_ref, "K", 0, strict=True)))))
    log_a, exponent, errors, rms = _together(isotherms, at, _sequential(isotherms, at), vertical)
    shift, law_rms = _law(T, log_a, errors, float(T[at]), exponent, law)
    a_T, b_T = 10.0**log_a, (T / T[at]) ** exponent
    moved = [each.shifted(a, b) for each, a, b in zip(isotherms, a_T, b_T, strict=True)]
    whole = (np.concatenate([getattr(each, name) for each in moved]) for name in ("omega", "storage", "loss"))
    data = DynamicModulus(*whole, isotherms[0].kind, float(T[at]), isotherms[0].columns)
    return MasterCurve(data, T, a_T, b_T, errors * np.log(10), shift, rms, law_rms, tuple(isotherms))


def _checked(isotherms: Any) -> list[DynamicModulus]:
    found = list(isotherms) if np.iterable(isotherms) else []
    if len(found) < 2 or not all(isinstance(each, DynamicModulus) for each in found):
        raise InputError("isotherms", isotherms, "two or more hystrip.dma.DynamicModulus")
    for i, each in enumerate(found):
        if each.temperature is None:
            raise InputError(f"isotherms[{i}].temperature", None, "its temperature, K")
        if (each.loss <= 0).any():
            raise InputError(f"isotherms[{i}].loss", 0.0, "loss moduli > 0: their logarithms are shifted")
    found.sort(key=lambda each: each.temperature)
    for lower, upper in zip(found, found[1:], strict=False):
        if upper.temperature - lower.temperature < 1e-6:
            raise InputError("isotherms", f"two at {upper.temperature:.2f} K", "different temperatures")
    return found


def _logs(each: DynamicModulus) -> tuple[np.ndarray, np.ndarray]:
    """log10 of omega (n,) and of storage and loss (2, n)."""
    return np.log10(each.omega), np.log10((each.storage, each.loss))


def _sequential(isotherms: list[DynamicModulus], at: int) -> np.ndarray:
    """First guesses of log10 a_T, (n,): each isotherm on its neighbour nearer to the reference."""
    found = np.zeros(len(isotherms))
    order = [(i, i - 1) for i in range(at + 1, len(isotherms))] + [(i, i + 1) for i in range(at - 1, -1, -1)]
    for i, neighbour in order:
        found[i] = found[neighbour] + _onto(isotherms[i], isotherms[neighbour], i > at)
    return found


def _onto(moved: DynamicModulus, fixed: DynamicModulus, hotter: bool) -> float:
    """log10 of the factor that brings one isotherm onto another: hotter ones go to lower frequencies."""
    x, y = _logs(moved)
    x_0, y_0 = _logs(fixed)
    best, least = None, np.inf
    for shift in np.arange(0, _APART + 1e-9, 1 / _STEPS) * (-1 if hotter else 1):
        inside = (x + shift >= x_0[0]) & (x + shift <= x_0[-1])
        if np.count_nonzero(inside) < max(2, _OVERLAP * x.size):
            continue
        apart = [row[inside] - np.interp(x[inside] + shift, x_0, row_0) for row, row_0 in zip(y, y_0, strict=True)]
        mismatch = float(np.mean(np.square(apart)))
        if mismatch < least:
            best, least = float(shift), mismatch
    if best is None:
        temperatures = f"{_celsius(fixed.temperature)} and {_celsius(moved.temperature)}"
        raise InputError("isotherms", temperatures, "neighbours whose bands of frequency overlap")
    return best


def _together(isotherms: list[DynamicModulus], at: int, start: np.ndarray, vertical: bool):
    """All shifts at once: log10 a_T (n,), the exponent of b_T, standard errors of the first (n,), and the relative rms about the
    smooth curve."""
    from scipy.optimize import least_squares

    logs = [_logs(each) for each in isotherms]
    owner = np.repeat(np.arange(len(logs)), [x.size for x, _ in logs])
    x, y = np.concatenate([x for x, _ in logs]), np.concatenate([y for _, y in logs], axis=1)
    T = np.array([each.temperature for each in isotherms])
    warmth = np.log10(T / T[at])[owner]
    free = np.flatnonzero(np.arange(len(logs)) != at)

    def log_a(parameters):
        out = np.zeros(len(logs))
        out[free] = parameters[: free.size]
        return out

    def residuals(parameters):
        rows = _splines(x + log_a(parameters)[owner])
        goal = (y - parameters[-1] * warmth).T if vertical else y.T
        return (goal - rows @ np.linalg.lstsq(rows, goal, rcond=None)[0]).ravel()

    bounds = np.full((2, free.size + vertical), [[-np.inf], [np.inf]])
    bounds[:, free.size :] = [[-3.0], [3.0]]
    first = np.append(start[free], [0.5] if vertical else [])
    found = least_squares(residuals, first, bounds=bounds, x_scale=0.1, xtol=1e-10, ftol=1e-12)
    freedom = max(found.fun.size - found.x.size, 1)
    covariance = np.linalg.pinv(found.jac.T @ found.jac) * (2 * found.cost / freedom)
    errors = np.zeros(len(logs))
    errors[free] = np.sqrt(np.diag(covariance))[: free.size]
    exponent = float(found.x[-1]) if vertical else 0.0
    return log_a(found.x), exponent, errors, float(np.sqrt(np.mean(found.fun**2)) * np.log(10))


def _splines(x: np.ndarray) -> np.ndarray:
    """Cubic B-splines over the range of ``x``, (points, splines); those that no point determines are left out."""
    from scipy.interpolate import BSpline

    low, high = x.min(), x.max()
    inner = np.linspace(low, high, max(int(np.ceil(_KNOTS * (high - low))), 1) + 1)
    knots = np.concatenate((np.full(3, low), inner, np.full(3, high)))
    return BSpline.design_matrix(np.clip(x, low, high), knots, 3).toarray()


def _law(T, log_a, errors, T_ref: float, exponent: float, law: str) -> tuple[WLF | Arrhenius, float]:
    """The law nearest to the shift factors, each counted by its standard error, and the rms distance of log10 a_T from it."""
    weight = 1 / np.hypot(errors, _LEAST_ERROR)
    found = []
    if law in ("best", "Arrhenius"):
        u = (1 / T - 1 / T_ref) / np.log(10) / R_GAS
        E_a = float((weight * u) @ (weight * log_a) / np.sum((weight * u) ** 2))
        if E_a > 0:
            found.append(Arrhenius(E_a, T_ref, exponent))
    if law in ("best", "WLF") and T.size > 2:
        found.append(_wlf(T, log_a, weight, T_ref, exponent))
    if not found:
        what = "two temperatures" if T.size == 2 and law == "WLF" else f"log10 a_T = {np.round(log_a, 2).tolist()}"
        raise InputError("isotherms", what, "times that become shorter with temperature, at three temperatures or more for WLF")
    off = [np.log10(each.factor(T)) - log_a for each in found]
    # Schwarz's criterion: WLF has a constant more, and always comes as near
    free = [2 if isinstance(each, WLF) else 1 for each in found]
    misfit = [
        T.size * np.log(np.sum((weight * each) ** 2) + 1e-12) + n * np.log(T.size) for each, n in zip(off, free, strict=True)
    ]
    best = int(np.argmin(misfit))
    return found[best], float(np.sqrt(np.mean(off[best] ** 2)))


def _wlf(T, log_a, weight, T_ref: float, exponent: float) -> WLF:
    from scipy.optimize import least_squares

    rise = T - T_ref
    lowest = max(1.0, -1.02 * rise.min())  # the law holds above T_ref - C_2

    def residuals(s):
        C_1, C_2 = np.exp(s)
        return weight * (-C_1 * rise / (C_2 + rise) - log_a)

    bounds = ([np.log(1e-3), np.log(lowest)], [np.log(1e4), np.log(1e5)])
    start = np.log([10.0, max(100.0, 1.5 * lowest)])
    C_1, C_2 = np.exp(least_squares(residuals, start, bounds=bounds, xtol=1e-12, ftol=1e-14).x)
    return WLF(float(C_1), float(C_2), T_ref, exponent)


def _celsius(T: float) -> str:
    return f"{T - 273.15:.1f} degC"

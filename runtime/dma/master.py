"""Time-temperature superposition: isotherms of a modulus become one master curve, with its shift factors and their law."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..errors import InputError
from ..inputs.checks import choice, number, truth
from ..inputs.shift import R_GAS, WLF, Arrhenius
from .isotherms import repeats_differ
from .modulus import DynamicModulus
from .plausibility import POOR_REPEAT
from .readings import celsius, degrees
from .superposition import LARGEST_EXPONENT, Superposition, apart, superpose

LAWS = ("best", "WLF", "Arrhenius")
#: K: without a temperature asked for, the isotherm nearest to 20 degrees Celsius is the reference
_ROOM = 293.15
#: K: isotherms have to span as much for a law, and a reference may lie so far outside them
_STEP = 1.0
#: isotherms that are shifted within minutes
_MOST = 1000
#: decades of overlap below which neighbours are remarked on
_POOR_OVERLAP = 0.5
#: decades, and times what three of four are off and its standard error, by which a shift stands out from the law
_OFF, _STANDS_OUT = 0.2, 5.0
#: decades that a measured shift is uncertain by at least, with the temperature of its isotherm
_LEAST_ERROR = 0.02
#: times the temperatures' range: beyond, C_2 bends the law by less than a hundredth of what it shifts
_STRAIGHT = 25.0
#: exponents of b_T that rubber elasticity has: density, which falls with temperature by 7e-4/K at most, times temperature
_ELASTIC = (0.75, 1.0)


@dataclass(frozen=True, eq=False)
class MasterCurve:
    """A master curve.

    Attributes
    ----------
    data : all measured points at the reference temperature, a :class:`DynamicModulus`
    temperatures : of the isotherms, K, ascending, shape (n,)
    a_T, b_T : horizontal and vertical shift factors, (n,): ``E*(omega, T) = b_T E*(a_T omega, T_ref)``; 1 at the reference
    a_T_error, b_T_error : relative standard errors of these, (n,): from the scatter of the points about the smooth curve, and of
        whole isotherms; vertical_error : standard error of ``shift.vertical``. Zero for what was not fitted
    shift : the law fitted to them, a :class:`hystrip.WLF` or :class:`hystrip.Arrhenius`
    rms : root mean square of the relative distance of points from the smooth curve; law_rms : of log10 a_T from the law
    isotherms : what was measured, in the order of the temperatures
    remarks : isotherms off the law, neighbours that hardly overlap, temperatures at which repeats differ, a vertical exponent
        that may be zero or is none of rubber elasticity, constants of WLF of which only the ratio is known, in words
    """

    data: DynamicModulus
    temperatures: np.ndarray
    a_T: np.ndarray
    b_T: np.ndarray
    a_T_error: np.ndarray
    b_T_error: np.ndarray
    vertical_error: float
    shift: WLF | Arrhenius
    rms: float
    law_rms: float
    isotherms: tuple[DynamicModulus, ...]
    remarks: tuple[str, ...] = ()

    @property
    def T_ref(self) -> float:
        """Temperature of the master curve, K."""
        return self.shift.T_ref

    def report(self) -> str:
        """Shift factors, their law, and how well they hold, as text."""
        s, f = self.shift, self.data.frequency
        law = f"C_1 = {s.C_1:.4g}, C_2 = {s.C_2:.4g} K" if isinstance(s, WLF) else f"E_a = {s.E_a / 1e3:.4g} kJ/mol"
        error = f" +- {self.vertical_error:.2g}" if self.vertical_error else ""
        lines = [
            f"isotherms  {len(self.temperatures)}, {celsius(self.temperatures[0])} to {celsius(self.temperatures[-1])}, "
            f"{f.size} points",
            f"master     at {celsius(self.T_ref)}: {f[0]:.3g} to {f[-1]:.3g} Hz; points lie {100 * self.rms:.2g} % rms off one "
            "smooth curve",
            f"shift      {type(s).__name__}: {law}, vertical exponent {s.vertical:.3g}{error}; "
            f"log10 a_T is {self.law_rms:.2g} rms off it",
            *(f"note       {remark}" for remark in self.remarks),
            "",
            f"{'T [degC]':>10}  {'a_T':>11}  {'error':>8}  {'of the law':>11}  {'b_T':>8}",
        ]
        fitted = s.factor(self.temperatures)
        for T, a, error, of_law, b in zip(self.temperatures, self.a_T, self.a_T_error, fitted, self.b_T, strict=True):
            lines.append(f"{T - 273.15:10.2f}  {a:11.4g}  {100 * error:6.2g} %  {of_law:11.4g}  {b:8.4f}")
        return "\n".join(lines)


def master_curve(
    isotherms: Sequence[DynamicModulus], *, T_ref: float | None = None, law: str = "best", vertical: bool = False
) -> MasterCurve:
    """Shift isotherms into one master curve, and fit the shift factors by a law.

    Parameters
    ----------
    isotherms : moduli, each with its ``temperature``; at least two, of which neighbours overlap after shifting by 0.2
        decades. Two at one temperature each get a shift of their own: how far apart these are says how well it repeats
    T_ref : temperature of the master curve, K, within the measured ones (between isotherms shift factors are interpolated);
        by default that of the isotherm nearest to 20 degC
    law : ``"WLF"``, ``"Arrhenius"``, or ``"best"``: the one that is nearer
    vertical : shift moduli too, by ``b_T = (T/T_ref)^v`` with the v that fits best, from -3 to 3

    Raises
    ------
    InputError : fewer than two isotherms, temperatures that are missing or all the same, a ``T_ref`` outside them, neighbours
        that do not overlap after shifting, moduli that do not change with frequency, or factors that no law of the kind has
        (times that grow with temperature)
    """
    choice("law", law, LAWS)
    vertical = truth("vertical", vertical)
    isotherms = _checked(isotherms)
    T = np.array([each.temperature for each in isotherms])
    wanted = _ROOM if T_ref is None else _reference(T_ref, T)
    at = int(np.argmin(np.abs(T - wanted)))
    T_ref = float(T[at]) if T_ref is None else wanted
    found = superpose(isotherms, at, vertical)
    log_a, errors = _moved(T, found, at, T_ref, law)
    shift, law_rms = _law(T, log_a, errors, T_ref, found.exponent, law)
    a_T, b_T = 10.0**log_a, (T / T_ref) ** found.exponent
    moved = [each.shifted(a, b) for each, a, b in zip(isotherms, a_T, b_T, strict=True)]
    whole = (np.concatenate([getattr(each, name) for each in moved]) for name in ("omega", "storage", "loss"))
    data = isotherms[0]._with(*whole, T_ref)
    off = log_a - np.log10(shift.factor(T))
    remarks = (*_remarks(isotherms, found, off, errors), *(_remarks_on_exponent(found) if vertical else ()))
    if isinstance(shift, WLF) and shift.C_2 > _STRAIGHT * np.ptp(T):
        ratio = f"{shift.C_1 / shift.C_2:.3g} /K"
        remarks += (f"log10 a_T is straight over temperature: C_1 and C_2 of WLF are known by their ratio alone, {ratio}",)
    rms, error = float(found.rms * np.log(10)), found.exponent_error
    of_a, of_b = errors * np.log(10), np.abs(np.log(T / T_ref)) * error
    return MasterCurve(data, T, a_T, b_T, of_a, of_b, error, shift, rms, law_rms, tuple(isotherms), remarks)


def _reference(T_ref: Any, T: np.ndarray) -> float:
    wanted = number("T_ref", T_ref, "K", 0, strict=True)
    if not T[0] - _STEP <= wanted <= T[-1] + _STEP:
        raise InputError("T_ref", degrees(wanted), f"a measured temperature, {degrees(T[0])} to {degrees(T[-1])}")
    return wanted


def _moved(T: np.ndarray, found: Superposition, at: int, T_ref: float, law: str) -> tuple[np.ndarray, np.ndarray]:
    """log10 of the shift factors (n,) against another temperature, interpolated as distances from the law; and their errors."""
    _, first = np.unique(T, return_index=True)  # of repeats one is enough
    weight = np.zeros(T.size)
    weight[first] = [np.interp(T_ref, T[first], each) for each in np.eye(first.size)]
    if T_ref == T[at]:
        offset = 0.0
    else:
        errors = np.sqrt(np.diag(found.covariance))
        shift, _ = _law(T, found.log_a, errors, float(T[at]), found.exponent, law)
        offset = float(np.log10(shift.factor(T_ref)) + weight @ (found.log_a - np.log10(shift.factor(T))))
    against = np.eye(T.size) - weight
    return found.log_a - offset, np.sqrt(np.diag(against @ found.covariance @ against.T))


def _remarks(isotherms: list[DynamicModulus], found: Superposition, off: np.ndarray, errors: np.ndarray) -> tuple[str, ...]:
    """What is odd about isotherms, their shifts, and the decades (n,) by which these are ``off`` the law, with their errors."""
    said = []
    far = np.abs(off) > np.maximum(_OFF, _STANDS_OUT * np.maximum(np.quantile(np.abs(off), 0.75), errors))
    for i in np.flatnonzero(far):
        others = f"others within 10^{np.abs(off[~far]).max():.2f}: another temperature, frequency or sample?"
        said.append(f"at {celsius(isotherms[i].temperature)} a_T is 10^{off[i]:.2f} times that of the law, {others}")
    for i, shared in apart(isotherms, found, _POOR_OVERLAP):
        lower, upper = (celsius(each.temperature) for each in isotherms[i : i + 2])
        said.append(f"{lower} and {upper} share {shared:.1f} decades: the shift between them rests on little")
    for each in isotherms:
        if (differ := repeats_differ(each)) > POOR_REPEAT:
            percent = f"{100 * differ:.2g} %"
            said.append(f"at {celsius(each.temperature)} moduli measured twice differ by up to {percent} (Set keeps them apart)")
    return tuple(said)


def _remarks_on_exponent(found: Superposition) -> list[str]:
    """What is odd about the exponent of b_T, as far as its standard error tells."""
    v, (least, most) = found.exponent, _ELASTIC
    stated = f"the vertical exponent, {v:.2g} +- {found.exponent_error:.2g},"
    if abs(v) > LARGEST_EXPONENT * (1 - 1e-6):
        return [f"{stated} stands at a bound: no power of temperature shifts these moduli"]
    reach = 2 * found.exponent_error
    elastic = least - reach <= v <= most + reach
    usual = f"that of rubber elasticity, {least:g} to {most:g}"
    if abs(v) <= reach:
        return [f"{stated} cannot be told from 0, no vertical shift{f', nor from {usual}' if elastic else ''}"]
    return [] if elastic else [f"{stated} is neither 0 nor {usual}: filler, glass, or a sample that changed"]


def _checked(isotherms: Any) -> list[DynamicModulus]:
    found = list(isotherms) if np.iterable(isotherms) else []
    if len(found) < 2 or not all(isinstance(each, DynamicModulus) for each in found):
        raise InputError("isotherms", isotherms, "two or more hystrip.dma.DynamicModulus")
    if len(found) > _MOST:
        raise InputError("isotherms", len(found), f"at most {_MOST} of them: every few kelvin will do")
    for i, each in enumerate(found):
        if each.temperature is None:
            raise InputError(f"isotherms[{i}].temperature", None, "its temperature, K")
        if (each.loss <= 0).any():
            at = f"that at {celsius(each.temperature)} and {each.frequency[np.argmin(each.loss)]:.4g} Hz is not"
            raise InputError(f"isotherms[{i}].loss", 0.0, f"loss moduli > 0, since their logarithms are shifted: {at}")
        if each.kind != found[0].kind:
            raise InputError(f"isotherms[{i}].kind", each.kind, f"{found[0].kind!r}, that of the first")
    found.sort(key=lambda each: each.temperature)
    low, high = found[0].temperature, found[-1].temperature
    if high - low < _STEP:
        raise InputError("isotherms", f"{degrees(low)} to {degrees(high)}", f"temperatures that differ, by {_STEP:g} K in all")
    return found


def _law(T, log_a, errors, T_ref: float, exponent: float, law: str) -> tuple[WLF | Arrhenius, float]:
    """The law nearest to the shift factors, each counted by its standard error, and the rms distance of log10 a_T from it."""
    weight = 1 / np.hypot(errors, _LEAST_ERROR)
    several = np.unique(np.round((T - T[0]) / _STEP)).size > 2  # repeats determine no curvature
    found = []
    if law in ("best", "Arrhenius"):
        u = (1 / T - 1 / T_ref) / np.log(10) / R_GAS
        E_a = float((weight * u) @ (weight * log_a) / np.sum((weight * u) ** 2))
        if E_a > 0:
            found.append(Arrhenius(E_a, T_ref, exponent))
    if law in ("best", "WLF") and several:
        wlf = _wlf(T, log_a, weight, T_ref, exponent)
        if np.sum((weight * (np.log10(wlf.factor(T)) - log_a)) ** 2) < np.sum((weight * log_a) ** 2):  # nearer than no shift
            found.append(wlf)
    if not found:
        what = "two temperatures" if law == "WLF" and not several else f"log10 a_T = {np.round(log_a, 2).tolist()}"
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

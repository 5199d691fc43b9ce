"""Time-temperature superposition: how relaxation times and moduli change with temperature."""

import warnings
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np

from ..errors import InputError
from ..plausibility import COLDEST, HOTTEST
from .checks import number, numbers

#: gas constant, J/(mol K) (exact since 2019)
R_GAS = 8.314462618
#: decades that a shift may span: beyond, no time and no modulus is one of the material's
_FURTHEST = 30.0
#: J/mol: with less, 100 K shift no time by more than a fifth; kJ/mol taken for J/mol come out there
_WEAKEST = 1000.0


class ShiftWarning(UserWarning):
    """Temperatures or an activation energy of no rubber, as degrees taken for kelvin, or kJ/mol for J/mol, are."""


class Shift(Protocol):
    """``E*(omega, T) = b_T E*(a_T omega, T_ref)``."""

    @property
    def T_ref(self) -> float:
        """Temperature at which moduli and times are given, K."""

    @property
    def vertical(self) -> float:
        """Exponent of ``b_T``."""

    def factor(self, T: Any) -> np.ndarray:
        """``a_T``: relaxation times at T (K, any shape) over those at ``T_ref``."""

    def modulus_factor(self, T: Any) -> np.ndarray:
        """``b_T``: moduli at T over those at ``T_ref``."""


@dataclass(frozen=True)
class WLF:
    """Williams, Landel and Ferry's shift: ``log10 a_T = -C_1 (T - T_ref)/(C_2 + T - T_ref)``.

    Parameters
    ----------
    C_1 : first constant, > 0
    C_2 : second constant, K, > 0
    T_ref : temperature at which moduli and times are given, K, > 0
    vertical : moduli are multiplied with ``b_T = (T/T_ref)^vertical``: 0 none, 1 that of an ideal rubber

    Raises ``InputError`` for values outside these ranges. The law holds above ``T_ref - C_2`` only.

    >>> float(WLF(C_1=17.44, C_2=51.6, T_ref=293.15).factor(293.15))
    1.0
    """

    C_1: float
    C_2: float
    T_ref: float
    vertical: float = 0.0

    def __post_init__(self):
        for name, unit in (("C_1", ""), ("C_2", "K"), ("T_ref", "K")):
            object.__setattr__(self, name, number(f"shift.{name}", getattr(self, name), unit, 0, strict=True))
        _check_vertical(self)

    def factor(self, T: Any) -> np.ndarray:
        """``a_T``: relaxation times at T (K, any shape) over those at ``T_ref``."""
        T = temperatures(T, max(self.T_ref - self.C_2, 0.0))
        with np.errstate(divide="ignore"):  # next to the bound: refused below, by name
            decades = -self.C_1 * (T - self.T_ref) / (self.C_2 + T - self.T_ref)
        return 10.0 ** _refuse_far(decades, T)

    def modulus_factor(self, T: Any) -> np.ndarray:
        """``b_T``: moduli at T (K, any shape) over those at ``T_ref``."""
        return _modulus_factor(self, T)


@dataclass(frozen=True)
class Arrhenius:
    """Arrhenius' shift: ``ln a_T = (E_a/R) (1/T - 1/T_ref)``.

    Parameters
    ----------
    E_a : activation energy, J/mol, > 0
    T_ref : temperature at which moduli and times are given, K, > 0
    vertical : moduli are multiplied with ``b_T = (T/T_ref)^vertical``: 0 none, 1 that of an ideal rubber

    Raises ``InputError`` for values outside these ranges.

    >>> round(float(Arrhenius(E_a=1e5, T_ref=300.0).factor(310.0)), 4)
    0.2744
    """

    E_a: float
    T_ref: float
    vertical: float = 0.0

    def __post_init__(self):
        for name, unit in (("E_a", "J/mol"), ("T_ref", "K")):
            object.__setattr__(self, name, number(f"shift.{name}", getattr(self, name), unit, 0, strict=True))
        _check_vertical(self)

    def factor(self, T: Any) -> np.ndarray:
        """``a_T``: relaxation times at T (K, any shape) over those at ``T_ref``."""
        T = temperatures(T)
        return 10.0 ** _refuse_far(self.E_a / R_GAS * (1 / T - 1 / self.T_ref) / np.log(10), T)

    def modulus_factor(self, T: Any) -> np.ndarray:
        """``b_T``: moduli at T (K, any shape) over those at ``T_ref``."""
        return _modulus_factor(self, T)


def factors_at(shift: Shift | None, temperature: Any) -> tuple[float, float]:
    """``a_T`` and ``b_T`` at one temperature, K. Raises ``InputError``, also where there is no shift; warns (``ShiftWarning``) of
    temperatures and an activation energy of no rubber."""
    T = number("temperature", temperature, "K", 0, strict=True)
    if shift is None:
        allowed = "None, or a material with a shift (hystrip.WLF, hystrip.Arrhenius; in a scene [material.shift])"
        raise InputError("temperature", temperature, allowed)
    usual = f"usual are {COLDEST:g} to {HOTTEST:g} K; degrees have to be given in K, or in a scene with their unit"
    odd = [f"{name} is {each:g} K; {usual}" for name, each in (("shift.T_ref", shift.T_ref), ("temperature", T))
           if not COLDEST <= each <= HOTTEST]  # fmt: skip
    if isinstance(shift, Arrhenius) and shift.E_a < _WEAKEST:
        odd.append(f"shift.E_a is {shift.E_a:g} J/mol; usual are {_WEAKEST:g} J/mol and more: may it be in kJ/mol?")
    for remark in odd:
        warnings.warn(remark, ShiftWarning, stacklevel=4)
    return float(shift.factor(T)), float(shift.modulus_factor(T))


def check_shift(value: Any) -> None:
    """``InputError`` unless ``value`` is a shift or None."""
    if value is not None and not isinstance(value, (WLF, Arrhenius)):
        raise InputError("material.shift", value, "None, a hystrip.WLF or a hystrip.Arrhenius")


def temperatures(T: Any, above: float = 0.0) -> np.ndarray:
    """``T`` as an array of temperatures above a bound, K. Raises ``InputError``."""
    return numbers("temperature", T, "K", above, strict=True)


def _modulus_factor(shift: Shift, T: Any) -> np.ndarray:
    T = temperatures(T)
    _refuse_far(shift.vertical * np.log10(T / shift.T_ref), T)
    return (T / shift.T_ref) ** shift.vertical


def _refuse_far(decades: np.ndarray, T: np.ndarray) -> np.ndarray:
    """The ``decades`` by which T shifts, none of them too many."""
    far = np.abs(decades) > _FURTHEST
    if far.any():
        allowed = f"a temperature (K) that shifts times and moduli by at most {_FURTHEST:g} decades"
        raise InputError("temperature", float(T[far].flat[0]), allowed)
    return decades


def check_exponents(field: str, vertical: Any) -> None:
    """``InputError`` unless the exponents ``vertical`` of T/T_ref are numbers from -10 to 10."""
    for each in np.ravel(numbers(field, vertical, "", -10)):
        if each > 10:
            raise InputError(field, float(each), "a number from -10 to 10, the exponent of T/T_ref")


def _check_vertical(shift: Any) -> None:
    vertical = number("shift.vertical", shift.vertical, "")
    check_exponents("shift.vertical", vertical)
    object.__setattr__(shift, "vertical", vertical)

"""Rows of a table of moduli, and which of them were measured at one temperature."""

from dataclasses import dataclass

import numpy as np

from ..errors import InputError
from .modulus import DynamicModulus

#: K: temperatures so far apart are two steps of a furnace, and what it may drift by in one
_ONE_STEP, _DRIFT = 1.0, 2.0


@dataclass(frozen=True, eq=False)
class Readings:
    """What a file holds, row by row (n,): angular frequency (rad/s), moduli (Pa), temperature (K) and the text in the
    column ``Set``, None where there is no such column; what each column was taken for; and the text in the columns that are
    ignored, by their names."""

    where: str
    omega: np.ndarray
    storage: np.ndarray
    loss: np.ndarray
    kind: str
    temperature: np.ndarray | None
    set: np.ndarray | None
    columns: tuple[str, ...]
    ignored: dict[str, np.ndarray]

    def of(self, rows: np.ndarray) -> DynamicModulus:
        """The modulus of some rows, given by their indices, at their mean temperature. Raises ``InputError`` for rows at fewer
        than two frequencies."""
        omega, at = self.omega[rows], "" if self.temperature is None else f" at {celsius(self.temperature[rows])}"
        if omega.max() <= omega.min() * (1 + 1e-12):
            found = f"{omega.size} row{'s' if omega.size > 1 else ''} of numbers{at}, at {omega[0] / (2 * np.pi):.4g} Hz alone"
            together = f" at one temperature, within {_DRIFT:g} K" if at else ""
            raise InputError(f"{self.where}, frequency", found, f"at least two different{together}")
        T = None if self.temperature is None else float(self.temperature[rows].mean())
        return DynamicModulus(omega, self.storage[rows], self.loss[rows], self.kind, T, self.columns)

    def refuse_several_temperatures(self, rows: np.ndarray) -> None:
        """Raise ``InputError`` for rows, given by their indices, that were not measured at one temperature."""
        if self.temperature is None:
            return
        T = np.sort(self.temperature[rows]).round(6)  # degrees are kelvin but for rounding
        if np.ptp(T) > _DRIFT or np.diff(T).max(initial=0.0) >= _ONE_STEP:
            allowed = f"rows within {_DRIFT:g} K and without steps of {_ONE_STEP:g} K; of several temperatures"
            allowed += " `hystrip master` makes a master curve"
            raise InputError(f"{self.where}, temperature", f"{rows.size} rows at {celsius(T)}", allowed)

    def sets(self) -> dict[str, np.ndarray]:
        """Indices of the rows of each set, in the order of the file; empty without such a column."""
        if self.set is None:
            return {}
        names, first, of = np.unique(self.set, return_index=True, return_inverse=True)
        rows = np.split(np.argsort(of, kind="stable"), np.cumsum(np.bincount(of))[:-1])
        return {str(names[i]): rows[i] for i in np.argsort(first)}


def celsius(T: float | np.ndarray) -> str:
    """Temperatures, K, as text: one, or a range."""
    low, high = (f"{each - 273.15:.1f}" for each in (np.min(T), np.max(T)))
    return f"{low} degC" if low == high else f"{low} to {high} degC"


def degrees(T: float) -> str:
    """A temperature (K) for a message, in both units."""
    return f"{celsius(T)} ({T:.2f} K)"

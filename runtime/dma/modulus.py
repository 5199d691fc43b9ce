"""Storage and loss modulus over angular frequency: measured, tabulated or computed."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ..errors import InputError
from ..inputs.checks import LARGEST, has_unit, holds_truth, number, numbers
from .plausibility import DataWarning, remark_on, remark_on_loss, remark_on_temperatures

#: frequencies per decade at which a function is tabulated: several to each relaxation time of the finest series
_PER_DECADE = 12
#: the most that may be asked for
_MOST = 1000
#: Pa, least modulus: a vacuum is stiffer, and residuals relative to less leave the range of a double when squared
SMALLEST_MODULUS = 1e-20


@dataclass(frozen=True, eq=False)
class DynamicModulus:
    """Storage and loss modulus over angular frequency, sorted by it.

    Parameters
    ----------
    omega : angular frequency, rad/s, > 0, shape (n,), n >= 2, of which two differ
    storage, loss : moduli, Pa, > 0 and >= 0, shape (n,)
    kind : ``"E"`` (tension, compression) or ``"G"`` (shear)
    temperature : at which it was measured, K, or None
    columns : what each column of a file was taken for, in words

    Raises
    ------
    InputError : a value outside its range, or shapes that differ

    Warns (``hystrip.dma.DataWarning``) of moduli, losses and a temperature of no rubber, as wrong units give; of those in a
    file :func:`read_dma` does.

    >>> data = DynamicModulus(omega=[10.0, 1.0], storage=[2e6, 1e6], loss=[3e5, 1e5])
    >>> data.storage.tolist()
    [1000000.0, 2000000.0]
    """

    omega: np.ndarray
    storage: np.ndarray
    loss: np.ndarray
    kind: str = "E"
    temperature: float | None = None
    columns: tuple[str, ...] = field(default=(), repr=False)

    def __post_init__(self):
        omega = numbers("dma.omega", self.omega, "rad/s", 0, strict=True)
        storage = numbers("dma.storage", self.storage, "Pa", 0, strict=True)
        loss = numbers("dma.loss", self.loss, "Pa", 0)
        for name, values in (("dma.storage", storage), ("dma.loss", loss)):
            lost = (values > 0) & (values < SMALLEST_MODULUS)
            if lost.any():
                zero = "0, or " if name == "dma.loss" else ""
                raise InputError(name, float(values[lost].flat[0]), f"{zero}numbers from {SMALLEST_MODULUS:g} Pa on")
        shapes = [each.shape for each in (omega, storage, loss)]
        if omega.ndim != 1 or omega.size < 2 or len(set(shapes)) > 1:
            raise InputError("dma", shapes, "omega, storage and loss of one shape (n,), n >= 2")
        if omega.max() <= omega.min() * (1 + 1e-12):
            raise InputError("dma.omega", float(omega[0]), "at least two different frequencies (rad/s)")
        if self.kind not in ("E", "G"):
            raise InputError("dma.kind", self.kind, "'E' (tension) or 'G' (shear)")
        if self.temperature is not None:
            object.__setattr__(self, "temperature", number("dma.temperature", self.temperature, "K", 0, strict=True))
        order = np.argsort(omega, kind="stable")
        for name, values in (("omega", omega), ("storage", storage), ("loss", loss)):
            object.__setattr__(self, name, values[order])
        if self.columns:  # of a file it has been said, with their names
            return
        remark_on("dma.storage, taken for Pa", self.storage, "values")
        remark_on_loss("dma.loss over dma.storage", self.loss / self.storage, "values")
        if self.temperature is not None:
            remark_on_temperatures("dma.temperature, taken for K", np.array([self.temperature]), "values")

    @classmethod
    def from_complex(cls, omega: Any, modulus: Any, kind: str = "E") -> DynamicModulus:
        """From a table of the complex modulus ``E*(omega) = storage + i loss``, Pa, shape (n,).

        Raises ``InputError`` as for :class:`DynamicModulus`.
        """
        allowed = "complex numbers, storage + i loss (Pa)"
        if has_unit(modulus):
            raise InputError("modulus", modulus, f"{allowed}, without a unit of their own: convert them first")
        if np.asarray(modulus).dtype.kind in "bSU" or holds_truth(modulus):
            raise InputError("modulus", modulus, allowed)
        try:
            values = np.asarray(modulus, dtype=complex)
        except (TypeError, ValueError):
            raise InputError("modulus", modulus, allowed) from None
        return cls(omega, values.real, values.imag, kind)

    @classmethod
    def from_function(
        cls, modulus: Callable[[np.ndarray], Any], low: float, high: float, per_decade: int = _PER_DECADE, kind: str = "E"
    ) -> DynamicModulus:
        """From a function ``E*(omega)`` of rad/s that returns the complex modulus, Pa; e.g. a fractional model.

        Parameters
        ----------
        low, high : band, Hz, > 0
        per_decade : frequencies in each decade, up to 1000

        Raises ``InputError`` for a bad argument, or for values that are no modulus of a solid.

        >>> def fractional_zener(omega):
        ...     x = (1j * omega * 1e-4) ** 0.5
        ...     return 1e6 + 1e9 * x / (1 + x)
        >>> DynamicModulus.from_function(fractional_zener, 1e-2, 1e4).omega.size
        73
        """
        low, high = number("low", low, "Hz", 0, strict=True), number("high", high, "Hz", 0, strict=True)
        if not low < high:
            raise InputError("low, high", (low, high), "a lowest frequency below the highest (Hz)")
        each = number("per_decade", per_decade, "", 0, strict=True)
        if each > _MOST:
            raise InputError("per_decade", per_decade, f"a number up to {_MOST}")
        if not callable(modulus):
            raise InputError("modulus", modulus, "a function E*(omega) of rad/s")
        omega = 2 * np.pi * np.geomspace(low, high, max(round(each * np.log10(high / low)) + 1, 2))
        values = modulus(omega)
        if np.shape(values) not in ((), omega.shape):
            raise InputError("modulus", f"values of shape {np.shape(values)}", f"one for each omega, of shape {omega.shape}")
        return cls.from_complex(omega, values if np.ndim(values) else np.full(omega.shape, values), kind)

    @property
    def frequency(self) -> np.ndarray:
        """Frequency, Hz, shape (n,)."""
        return self.omega / (2 * np.pi)

    def between(self, low: float | None = None, high: float | None = None) -> DynamicModulus:
        """The part from ``low`` to ``high``, in Hz. Raises InputError for no numbers, or if fewer than two frequencies remain."""
        f = self.frequency
        least = 0.0 if low is None else number("low", low, "Hz", 0)
        most = LARGEST if high is None else number("high", high, "Hz", 0)
        # a limit as written and a frequency that came through 2 pi and back differ by rounding
        keep = (f >= least * (1 - 1e-12)) & (f <= most * (1 + 1e-12))
        if np.unique(f[keep]).size < 2:
            span = f"{f[0]:.4g} to {f[-1]:.4g} Hz"
            raise InputError("frequencies", (low, high), f"a range with two measured frequencies or more; measured: {span}")
        return self._with(self.omega[keep], self.storage[keep], self.loss[keep])

    def shifted(self, factor: float, vertical: float = 1.0) -> DynamicModulus:
        """At ``factor`` times the frequency (a_T) and moduli over ``vertical`` (b_T), both > 0: moved along a master curve.

        Raises ``InputError`` for other factors."""
        factor, vertical = number("factor", factor, "", 0, strict=True), number("vertical", vertical, "", 0, strict=True)
        return self._with(self.omega * factor, self.storage / vertical, self.loss / vertical)

    def _with(self, omega, storage, loss, temperature: float | None = None) -> DynamicModulus:
        """Of the same kind. What is odd about it has been said."""
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", DataWarning)
            return DynamicModulus(omega, storage, loss, self.kind, temperature or self.temperature, self.columns)

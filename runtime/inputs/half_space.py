"""A viscoelastic half-space, as a foundation for each level of the surface."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import lru_cache, partial
from typing import TYPE_CHECKING, Any

import numpy as np

from ..errors import InputError
from .checks import number, numbers
from .fitted import FittedBand, check_fit
from .material import as_call
from .prony import Prony
from .shift import Shift, check_shift

if TYPE_CHECKING:
    from ..loading import Solver
    from ..typing import Floats, Number, Numbers

#: stiffness under Eq. 4 over that under one wave, ``(1/2 + sqrt(2)/4)/(3/4)``: derivation/half_space.py
SHAPE = (0.5 + 0.25 * np.sqrt(2)) / 0.75


@dataclass(frozen=True, eq=False)
class HalfSpace:
    """Half-space whose Young's modulus relaxes: ``E(t) = E + sum_i E_i exp(-t/tau_i)``, with a constant Poisson ratio.

    Each level of wavelength l slides over a foundation of its own, ``K_l(i omega) = c (pi/l) E(i omega)/(1 - nu^2)`` with
    ``c = (1/2 + sqrt(2)/4)/(3/4)``: in full contact its friction is that of the half-space under the same three waves
    (``cos kx``, ``cos ky`` and ``cos kx cos ky``, whose wavenumber is ``sqrt(2) k``). In partial contact the foundation is an
    approximation: its points do not feel their neighbours.

    Parameters
    ----------
    E : relaxed Young's modulus, Pa, > 0
    nu : Poisson ratio, from 0 to 0.5
    moduli : E_i, Young's modulus of each branch, Pa, >= 0
    times : tau_i, relaxation time of each branch, s, > 0
    solver, shift, fit : as for :class:`hystrip.Prony`

    Single values; ``moduli`` and ``times`` sequences of n of them (n = 0: elastic). Branches of modulus zero are dropped and
    equal times merged. Raises ``InputError`` for values outside these ranges.

    >>> import hystrip
    >>> rubber = hystrip.HalfSpace(E=2e6, nu=0.5, moduli=[8e6], times=[1e-3])
    >>> fine, coarse = (rubber.at_wavelength(l) for l in (1e-6, 1e-3))
    >>> print(f"{fine.K:.4g} {coarse.K:.4g}")
    9.534e+12 9.534e+09
    """

    E: float
    nu: float
    moduli: tuple[float, ...] = ()
    times: tuple[float, ...] = ()
    solver: Solver | None = None
    shift: Shift | None = field(default=None, kw_only=True)
    fit: FittedBand | None = field(default=None, kw_only=True)

    __repr__ = as_call

    if TYPE_CHECKING:

        def __init__(
            self,
            E: Number,
            nu: Number,
            moduli: Sequence[Number] | Floats = ...,
            times: Sequence[Number] | Floats = ...,
            solver: Solver | None = None,
            *,
            shift: Shift | None = None,
            fit: FittedBand | None = None,
        ) -> None: ...

    def __post_init__(self) -> None:
        check_shift(self.shift)
        check_fit(self.fit)
        E = number("material.E", self.E, "Pa", 0, strict=True)
        nu = number("material.nu", self.nu, "", 0)
        check_poisson("material.nu", nu)
        series = _series(E, self.moduli, self.times, self.solver)
        for name, value in (("E", E), ("nu", nu), ("moduli", series.moduli), ("times", series.times)):
            object.__setattr__(self, name, value)
        object.__setattr__(self, "_at", lru_cache(maxsize=64)(self._foundation))

    @property
    def n(self) -> int:
        """Number of relaxation times, after merging."""
        return len(self.times)

    @property
    def E_glassy(self) -> float:
        """Glassy modulus ``E + sum E_i``, Pa."""
        return self.E + sum(self.moduli)

    @property
    def modulus(self) -> Prony:
        """The modulus as a Prony series, in Pa: the times of every level's foundation, at another scale."""
        return Prony(self.E, self.moduli, self.times, self.solver, shift=self.shift, fit=self.fit)

    def at_temperature(self, temperature: float) -> HalfSpace:
        """The half-space at a temperature, K, as its ``shift`` has it. Raises ``InputError`` where it has none."""
        at = self.modulus.at_temperature(temperature)
        return HalfSpace(at.K, self.nu, at.moduli, at.times, self.solver, fit=at.fit)

    def at_wavelength(self, l: Numbers) -> Prony:  # noqa: E741 - the paper's symbol
        """The foundation under a level of wavelength ``l``, m, > 0; an array gives a foundation for each strip."""
        l = numbers("l", l, "m", 0, strict=True)  # noqa: E741
        if not l.size:
            raise InputError("l", l, "a wavelength (m), or an array of at least one")
        return self._at(float(l)) if l.ndim == 0 else self._foundation(l)

    def _foundation(self, l) -> Prony:  # noqa: E741 - the paper's symbol
        per_modulus = SHAPE * np.pi / (l * (1 - self.nu**2))
        moduli = [per_modulus * each for each in self.moduli]
        return Prony(per_modulus * self.E, moduli, self.times, self.solver, shift=self.shift, fit=self.fit)

    def _key(self):
        return (self.E, self.nu, self.moduli, self.times, self.solver, self.shift, self.fit)

    def __eq__(self, other):
        return isinstance(other, HalfSpace) and self._key() == other._key()

    def __hash__(self):
        return hash(self._key())

    def __reduce__(self):
        make = partial(HalfSpace, shift=self.shift, fit=self.fit)
        return make, (self.E, self.nu, self.moduli, self.times, self.solver)


def check_poisson(field: str, nu: Any) -> None:
    """``InputError`` unless all of ``nu`` are numbers from 0 to 0.5."""
    for each in np.ravel(numbers(field, nu, "", 0)):
        if each > 0.5:
            raise InputError(field, float(each), "a Poisson ratio from 0 to 0.5")


def _series(E: float, moduli: Any, times: Any, solver: Any) -> Prony:
    """The modulus as a checked Prony series; errors name the moduli in Pa."""
    try:
        series = Prony(E, moduli, times, solver)
    except InputError as error:
        raise InputError(error.field, error.value, error.allowed.replace("Pa/m", "Pa")) from None
    for name, values in (("moduli", series.moduli), ("times", series.times)):
        for i, value in enumerate(values):
            if np.ndim(value):
                raise InputError(f"material.{name}[{i}]", value, "a single number")
    return series

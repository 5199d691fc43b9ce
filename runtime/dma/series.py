"""A relaxation spectrum as a Prony series of the modulus, and the foundation that follows from it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ..errors import InputError
from ..inputs.checks import number, numbers
from ..inputs.fitted import FittedBand
from ..inputs.material import StandardLinearSolid

if TYPE_CHECKING:
    from ..inputs.half_space import HalfSpace
    from ..inputs.prony import Prony
    from ..inputs.shift import Shift


@dataclass(frozen=True)
class Foundation:
    """What a generalised foundation needs: ``K*(i omega) = K + sum_j moduli_j i omega times_j/(1 + i omega times_j)``.

    ``K``: relaxed stiffness per area, Pa/m; ``moduli``: stiffness of each branch, Pa/m; ``times``: relaxation times,
    s, ascending.
    """

    K: float
    moduli: tuple[float, ...]
    times: tuple[float, ...]


@dataclass(frozen=True)
class PronySeries:
    """Prony series fitted to a modulus: ``E* = relaxed + sum_j moduli_j i omega times_j/(1 + i omega times_j)``.

    Attributes
    ----------
    relaxed : relaxed (equilibrium) modulus, Pa
    moduli : modulus of each branch, Pa, > 0; times : its relaxation time, s, ascending
    kind : ``"E"`` or ``"G"``, which modulus was measured
    offered : number of relaxation times offered to the fit; those that got no modulus were dropped
    band : lowest and highest frequency fitted, Hz; outside it the series says nothing
    points : rows fitted, each with a storage and a loss modulus
    rms_storage, rms_loss : root mean square of the relative residuals of storage and loss modulus
    worst, worst_at : the largest relative residual, and its frequency, Hz
    relaxed_error, moduli_errors, times_errors : relative standard errors, from the residuals left and the linearised problem;
        zero for times that were not fitted, infinite where the data does not determine a number at all
    fit : the error decade by decade
    """

    relaxed: float
    moduli: tuple[float, ...]
    times: tuple[float, ...]
    kind: str
    offered: int
    band: tuple[float, float]
    points: int
    rms_storage: float
    rms_loss: float
    worst: float
    worst_at: float
    relaxed_error: float = 0.0
    moduli_errors: tuple[float, ...] = ()
    times_errors: tuple[float, ...] = ()
    fit: FittedBand | None = None

    @property
    def rms(self) -> float:
        """Root mean square of all relative residuals, of storage and loss modulus."""
        return float(np.hypot(self.rms_storage, self.rms_loss) / np.sqrt(2))

    @property
    def quality(self) -> str:
        """How well it fits, in a few words."""
        low, high = self.band
        return (
            f"{100 * self.rms:.2g} % rms between {low:.4g} and {high:.4g} Hz (storage {100 * self.rms_storage:.2g} %, loss "
            f"{100 * self.rms_loss:.2g} %), at most {100 * self.worst:.2g} % at {self.worst_at:.4g} Hz, with "
            f"{_times(len(self.times))}"
        )

    @property
    def glassy(self) -> float:
        """Modulus at infinite frequency, Pa."""
        return self.relaxed + sum(self.moduli)

    def modulus(self, omega: Any) -> np.ndarray:
        """Complex modulus (storage + i loss), Pa, at angular frequencies ``omega``, rad/s, any shape.

        Raises ``InputError`` for what is no number."""
        x = np.multiply.outer(numbers("omega", omega, "rad/s"), np.array(self.times))
        return self.relaxed + (1j * x / (1 + 1j * x)) @ np.array(self.moduli)

    def foundation(self, length: float) -> Foundation:
        """Foundation with the stiffness per area ``modulus/length`` in every term; the times stay as they are.

        A Winkler foundation knows no modulus, only a stiffness per area [Pa/m]: the length (m, > 0) has to come from
        the geometry.

        - A layer of thickness H on a rigid base, free to slide and bulge at its sides: ``length = H`` with E. Bonded,
          and thin against the contact: H with the oedometric modulus ``E (1 - nu)/((1 + nu)(1 - 2 nu))``, that is
          ``length = H (1 + nu)(1 - 2 nu)/(1 - nu)``.
        - A half-space: :meth:`half_space`, whose stiffness goes with the wavelength of a level.
        - Shear data (G): divide the length by ``2 (1 + nu)``, since ``E = 2 (1 + nu) G`` with a constant Poisson ratio.

        Raises ``InputError`` for a length that is not a finite number > 0.

        >>> PronySeries(1e6, (2e6,), (1e-3,), "E", 1, (1.0, 1e3), 20, 0.0, 0.0, 0.0, 1.0).foundation(length=1e-3)
        Foundation(K=1000000000.0, moduli=(2000000000.0,), times=(0.001,))
        """
        length = number("length", length, "m", 0, strict=True)
        return Foundation(self.relaxed / length, tuple(each / length for each in self.moduli), self.times)

    def material(self, length: float, shift: Shift | None = None) -> Prony:
        """The foundation as a material (``length`` as for :meth:`foundation`), of as many times as the series has.

        Raises ``InputError`` for a bad length.
        """
        from ..inputs.prony import Prony

        each = self.foundation(length)
        return Prony(each.K, each.moduli, each.times, shift=shift, fit=self.fit)

    def half_space(self, nu: float, shift: Shift | None = None) -> HalfSpace:
        """The half-space of this modulus, in which every level gets the stiffness of its own wavelength.

        Parameters
        ----------
        nu : Poisson ratio, 0 to 0.5; also turns a shear modulus G into ``E = 2 (1 + nu) G``

        Raises ``InputError`` for another ratio.
        """
        from ..inputs.half_space import HalfSpace

        per_modulus = 2 * (1 + number("nu", nu, "", 0)) if self.kind == "G" else 1.0
        moduli = [per_modulus * each for each in self.moduli]
        return HalfSpace(per_modulus * self.relaxed, nu, moduli, self.times, shift=shift, fit=self.fit)

    def standard_linear_solid(self, length: float) -> StandardLinearSolid:
        """The material of a series with one branch: ``T_sigma`` is its time, ``T_eps = T_sigma (1 + modulus/relaxed)``.

        Raises ``InputError`` for a bad length, or if there is not exactly one branch (``fit_prony(data, terms=1)``
        gives one).
        """
        if len(self.times) != 1:
            raise InputError("series", f"{len(self.times)} relaxation times", "exactly one for a standard linear solid")
        time, ratio = self.times[0], self.moduli[0] / self.relaxed
        return StandardLinearSolid(K=self.foundation(length).K, T_eps=time * (1 + ratio), T_sigma=time)

    def report(self) -> str:
        """The terms and the quality of the fit, as text."""
        low, high = self.band
        lines = [
            f"fitted     {self.points} points, {low:.4g} to {high:.4g} Hz ({np.log10(high / low):.3g} decades)",
            f"series     {_times(len(self.times))} of {self.offered} offered; "
            f"{self.kind} relaxed {self.relaxed:.4g} Pa, glassy {self.glassy:.4g} Pa",
            f"residuals  storage {100 * self.rms_storage:.2g} % rms, loss {100 * self.rms_loss:.2g} % rms, "
            f"at most {100 * self.worst:.2g} % (at {self.worst_at:.4g} Hz)",
            "",
            f"{'time [s]':>12}  {self.kind + ' [Pa]':>12}  standard errors",
            f"{'relaxed':>12}  {self.relaxed:12.4g}  {' ' * 12}  {_percent(self.relaxed_error)}",
        ]
        n = len(self.times)
        errors = zip(self.times_errors or (0.0,) * n, self.moduli_errors or (0.0,) * n, strict=True)
        for time, modulus, (of_time, of_modulus) in zip(self.times, self.moduli, errors, strict=True):
            lines.append(f"{time:12.4g}  {modulus:12.4g}  {_percent(of_time) if of_time else '':>12}  {_percent(of_modulus)}")
        return "\n".join(lines)


def _percent(share: float) -> str:
    return f"{100 * share:.2g} %" if share < 10 else "undetermined"


def _times(count: int) -> str:
    return f"{count} relaxation time{'s' if count > 1 else ''}"

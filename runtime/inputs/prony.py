"""The viscoelastic foundation with several relaxation times."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from ..errors import InputError
from .checks import broadcast, numbers, sequence
from .fitted import FittedBand, check_fit
from .material import StandardLinearSolid, as_call
from .shift import Shift, check_shift, factors_at

if TYPE_CHECKING:
    from ..loading import Solver
    from ..typing import Floats, Number, Numbers

#: branches that may be given; those of equal times become one
_MOST = 1000
#: relaxation times of a series: three or four per decade over all that is ever measured
MOST_TIMES = 40


@dataclass(frozen=True, eq=False)
class Prony:
    """Foundation with n relaxation times, 1 to 40: ``p = K w + sum_i K_i (w - e_i)``, ``tau_i e_i' + e_i = w`` (Prony series).

    A pressure held at a constant displacement w relaxes as ``(K + sum_i K_i exp(-t/tau_i)) w``. One time is the
    standard linear solid with ``T_sigma = tau``, ``T_eps = tau (1 + K_1/K)``. Branches of modulus zero are dropped and
    times that agree within 1.5e-8 merged, so that a series that is really one of fewer times is solved as that.

    Parameters
    ----------
    K : relaxed stiffness per area, Pa/m, > 0
    moduli : K_i, stiffness of each branch, Pa/m, >= 0
    times : tau_i, relaxation time of each branch, s, > 0
    solver : from ``hystrip.load_solver``, in place of that in the package
    shift : how it changes with temperature, a :class:`hystrip.WLF` or :class:`hystrip.Arrhenius`, or None
    fit : over which frequencies it was fitted, and how well (``hystrip.dma``), or None

    ``moduli`` and ``times``: sequences of n numbers, or of n arrays that broadcast (for ``solve_strip``; then all
    moduli have to be > 0 and the times of a branch apart from those of the others). Raises ``InputError`` for values
    outside these ranges.

    >>> import hystrip
    >>> hystrip.Prony(K=1e9, moduli=[2e9, 0, 5e9], times=[1e-3, 1, 1e-3])
    Prony(K=1000000000.0, moduli=(7000000000.0,), times=(0.001,))
    """

    # floats, or arrays where it was given arrays
    K: Any
    moduli: tuple[Any, ...]
    times: tuple[Any, ...]
    solver: Solver | None = None
    shift: Shift | None = field(default=None, kw_only=True)
    fit: FittedBand | None = field(default=None, kw_only=True)

    __repr__ = as_call

    if TYPE_CHECKING:

        def __init__(
            self,
            K: Numbers,
            moduli: Sequence[Numbers] | Floats,
            times: Sequence[Numbers] | Floats,
            solver: Solver | None = None,
            *,
            shift: Shift | None = None,
            fit: FittedBand | None = None,
        ) -> None: ...

    def __post_init__(self) -> None:
        check_shift(self.shift)
        check_fit(self.fit)
        K = numbers("material.K", self.K, "Pa/m", 0, strict=True)
        moduli = _each("material.moduli", self.moduli, "Pa/m", strict=False)
        times = _each("material.times", self.times, "s", strict=True)
        if len(moduli) != len(times):
            raise InputError("material.moduli, material.times", (len(moduli), len(times)), "as many moduli as times")
        if self.solver is not None and not hasattr(self.solver, "prony_kernel"):
            raise InputError("material.solver", self.solver, "None, or what hystrip.load_solver returns")
        names = [*(f"material.moduli[{i}]" for i in range(len(moduli))), *(f"material.times[{i}]" for i in range(len(times)))]
        shape = broadcast(**{"material.K": K}, **dict(zip(names, moduli + times, strict=True)))
        if shape:
            _refuse_degenerate(moduli, times)
            order = _common_order(times)
            moduli, times = [moduli[i] for i in order], [times[i] for i in order]
        else:
            moduli, times = _merged(moduli, times)
        if len(times) > MOST_TIMES:
            raise InputError("material.times", f"{len(times)} different times", f"at most {MOST_TIMES}")
        one = lambda v: float(v) if np.ndim(v) == 0 else v  # noqa: E731
        for name, value in (("K", one(K)), ("moduli", tuple(map(one, moduli))), ("times", tuple(map(one, times)))):
            object.__setattr__(self, name, value)

    @classmethod
    def from_retardation(
        cls,
        K_glassy: Number,
        compliances: Sequence[Number] | Floats,
        times: Sequence[Number] | Floats,
        solver: Solver | None = None,
    ) -> Prony:
        """The same foundation from its retardation form: ``J(t) = 1/K_glassy + sum_j J_j (1 - exp(-t/lambda_j))``.

        Parameters
        ----------
        K_glassy : instantaneous stiffness per area, Pa/m, > 0 (single number, like all others here)
        compliances : J_j, m/Pa, >= 0
        times : lambda_j, retardation times, s, > 0

        Raises ``InputError`` for values outside these ranges.
        """
        K_g = float(_single("material.K_glassy", numbers("material.K_glassy", K_glassy, "Pa/m", 0, strict=True)))
        J = [_single(f"material.compliances[{j}]", v) for j, v in enumerate(_each("material.compliances", compliances, "m/Pa"))]
        lambdas = [_single(f"material.times[{j}]", v) for j, v in enumerate(_each("material.times", times, "s", strict=True))]
        if len(J) != len(lambdas):
            raise InputError("material.compliances, material.times", (len(J), len(lambdas)), "as many compliances as times")
        J, lambdas = (np.array(v) for v in _merged(J, lambdas))
        K = 1 / (1 / K_g + J.sum())
        # 1/K*(s) = 1/K_g + sum J_j/(1 + lambda_j s) vanishes at s = -1/tau_i; the times alternate, tau_i < lambda_i
        rates = _interlaced(1 / K_g, -J, 1 / lambdas)
        moduli = [1 / (x * np.sum(J * lambdas / (1 - lambdas * x) ** 2)) for x in rates]
        return cls(K, moduli, [1 / x for x in rates], solver)

    @property
    def n(self) -> int:
        """Number of relaxation times, after merging."""
        return len(self.times)

    @property
    def K_glassy(self) -> Any:
        """Glassy stiffness ``K + sum K_i``, Pa/m."""
        return self.K + sum(self.moduli)

    @property
    def retardation(self) -> tuple[float, tuple[float, ...], tuple[float, ...]]:
        """``(1/K_glassy, J_j, lambda_j)`` of ``from_retardation``: m/Pa, m/Pa and s, the times ascending; for single values."""
        if any(np.ndim(v) for v in (self.K, *self.moduli, *self.times)):
            raise InputError("material", self, "a single material (not arrays) for its retardation form")
        K_i, tau = np.array(self.moduli), np.array(self.times)
        # K*(s) = K + sum K_i tau_i s/(1 + tau_i s) vanishes at s = -1/lambda_j
        lambdas = _interlaced(self.K, -K_i, tau)
        J = [1 / np.sum(K_i * lam * tau / (lam - tau) ** 2) for lam in lambdas]
        return 1 / self.K_glassy, tuple(map(float, J)), tuple(map(float, lambdas))

    @property
    def single(self) -> StandardLinearSolid | None:
        """The standard linear solid that this is with one time (with none: an elastic foundation), else None."""
        if self.n == 0:
            return StandardLinearSolid(self.K, 0.0, 0.0)
        if self.n > 1 or self.solver is not None:
            return None
        tau = self.times[0]
        return StandardLinearSolid(self.K, np.asarray(tau) * (1 + np.asarray(self.moduli[0]) / self.K), tau)

    def at_wavelength(self, l: Any) -> Prony:  # noqa: E741 - the paper's symbol
        """The foundation under a level of wavelength ``l``, m: this one, which is local."""
        return self

    def at_temperature(self, temperature: float) -> Prony:
        """The foundation at a temperature, K, as its ``shift`` has it. Raises ``InputError`` where it has none."""
        a_T, b_T = factors_at(self.shift, temperature)
        fit = self.fit and self.fit.moved(1 / a_T)
        return Prony(
            self.K * b_T, [b_T * each for each in self.moduli], [a_T * each for each in self.times], self.solver, fit=fit
        )

    def _key(self):
        numbers = (np.asarray(v).tobytes() for v in (self.K, *self.moduli, *self.times))
        return (type(self), *numbers, self.solver, self.shift, self.fit)

    def __eq__(self, other):
        return isinstance(other, Prony) and self._key() == other._key()

    def __hash__(self):
        return hash(self._key())


def _each(field_name: str, values: Any, unit: str, strict: bool = False) -> list[np.ndarray]:
    """Every entry of a sequence, checked under its own name."""
    allowed = f"a sequence of numbers {'>' if strict else '>='} 0 ({unit}), one for each time"
    entries = sequence(field_name, values, allowed)
    if len(entries) > _MOST:
        raise InputError(field_name, values, f"{allowed}, at most {_MOST} of them")
    found = [numbers(f"{field_name}[{i}]", v, unit, 0, strict=strict) for i, v in enumerate(entries)]
    for i, each in enumerate(found):
        if not each.size:
            raise InputError(f"{field_name}[{i}]", entries[i], "a number, or an array of at least one")
    return found


def _single(name: str, value: np.ndarray) -> np.ndarray:
    if value.ndim:
        raise InputError(name, value, "a single number")
    return value


def _refuse_degenerate(moduli, times) -> None:
    for i, (modulus, time) in enumerate(zip(moduli, times, strict=True)):
        if (modulus == 0).any():
            raise InputError(f"material.moduli[{i}]", 0.0, "numbers > 0 where the material has arrays (leave the branch out)")
        for j in range(i):
            if np.any(times[j] == time):
                wanted = f"times other than times[{j}] where the material has arrays"
                raise InputError(f"material.times[{i}]", float(time.flat[0]), wanted)


def _common_order(times) -> list[int]:
    """Ascending order of the branches, the same for all strips of an array."""
    stacked = np.stack(np.broadcast_arrays(*times)).reshape(len(times), -1)
    order = np.argsort(stacked[:, 0])
    if np.any(np.diff(stacked[order], axis=0) <= 0):
        shown = [np.asarray(t).tolist() for t in times]
        raise InputError("material.times", shown, "branches in the same order of times for all strips")
    return list(order)


def _merged(weights, times) -> tuple[list, list]:
    """Branches by ascending time, those of weight zero dropped, those of one time added up.

    Times that differ by less than the root of a rounding are one, their weighted mean: what that changes is of the square."""
    found: list[list[float]] = []
    for weight, time in sorted(zip(map(float, weights), map(float, times), strict=True), key=lambda branch: branch[1]):
        if weight > 0 and found and time - found[-1][1] <= np.sqrt(np.finfo(float).eps) * time:
            last = found[-1]
            last[0] += weight
            last[1] += (time - last[1]) * (weight / last[0])
        elif weight > 0:
            found.append([weight, time])
    return [weight for weight, _ in found], [time for _, time in found]


def _interlaced(base: float, weights: np.ndarray, poles: np.ndarray) -> np.ndarray:
    """Zeros of ``f(x) = base + sum weights_i poles_i/(x - poles_i)``: one above each pole and below the next, in their order.

    With ``base > 0``, ``weights < 0`` f rises from -inf to +inf between poles (to ``base`` after the last). It is
    written in the distance from the pole below, which keeps a zero next to its pole to full relative precision.
    """
    order = np.argsort(poles)
    p, q = poles[order], -weights[order] * poles[order]
    out = np.empty(p.size)
    for i in range(p.size):
        others = np.arange(p.size) != i
        offset = p[i] - p[others]
        width = p[i + 1] - p[i] if i + 1 < p.size else q.sum() / base + q[i] / base + p[i]

        def value(d, i=i, offset=offset, others=others):
            return base - q[i] / d - np.sum(q[others] / (offset + d))

        low, high = 0.0, width
        d = min(0.5 * width, q[i] / base)
        for _ in range(4000):
            if value(d) < 0:
                low = d
            else:
                high = d
            new = 0.5 * (low + high) if low > 0.25 * high else max(np.sqrt(low * high), 1e-4 * high)
            if new in (low, high) or high - low <= 2 * np.finfo(float).eps * high:
                break
            d = new
        out[i] = p[i] + 0.5 * (low + high)
    back = np.empty(p.size)
    back[order] = out
    return back

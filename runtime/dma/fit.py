"""Fitting a Prony series to storage and loss modulus."""

import warnings
from collections.abc import Callable
from typing import Any

import numpy as np

from ..errors import InputError
from ..inputs.checks import integer, number, numbers, sequence
from ..inputs.fitted import POOR, FittedBand
from ..inputs.prony import MOST_TIMES
from .modulus import DynamicModulus
from .placement import Placement, held
from .projection import relative_errors, solved
from .series import PronySeries

#: rms of the relative residuals that is asked for where nothing else is
ACCURACY = 0.02
#: a branch below this share of the glassy modulus is rounding of the solver
_NOTHING = 1e-12
#: numbers of times that are tried where evenly spaced ones don't reach the accuracy; what does not reach it at all takes the
#: fewest that come this near to the best
_TRIED, _AS_GOOD = (5, 10, 20), 1.05


class FitWarning(UserWarning):
    """A series that fits poorly what it was fitted to. Says over which band, and by how much."""


def fit_prony(
    data: DynamicModulus | Callable[[np.ndarray], Any] | tuple[Any, Any],
    *,
    accuracy: float | None = None,
    terms: int | None = None,
    per_decade: float | None = None,
    times: Any = None,
    band: tuple[float, float] | None = None,
) -> PronySeries:
    """Fit ``relaxed + sum_j moduli_j i omega times_j/(1 + i omega times_j)`` to measured moduli.

    Minimises the sum of the squared relative residuals of storage and loss modulus, each relative to its own measured
    value (a loss of zero relative to the storage modulus), over non-negative moduli and, with ``accuracy`` or ``terms``, over
    the times too. Times that get no modulus are dropped. Warns (``hystrip.dma.FitWarning``) where more than 10 % rms are left.

    Parameters
    ----------
    data : what was measured; or a table ``(omega, E*)`` of complex moduli, Pa, over rad/s; or a function ``E*(omega)``,
        such as a fractional model, together with ``band``
    accuracy : as few relaxation times, up to 40, as bring the root mean square of the residuals down to this, 1e-6 to 0.5;
        0.02 if neither this nor one of the next three is given. Where 40 do not, as few as fit about as well as any
    terms : in place of that, so many relaxation times, an integer from 1 to 40, placed where they fit best
    per_decade : in place of that, relaxation times per decade, > 0, evenly over the measured band from ``1/omega_max`` to
        ``1/omega_min``, both included
    times : in place of that, the relaxation times themselves, s, > 0
    band : lowest and highest frequency, Hz; all that was measured without it

    Raises
    ------
    InputError : an argument out of range; more unknowns than numbers measured; or no relaxed modulus comes out: a
        foundation needs one

    Examples
    --------
    >>> import numpy as np
    >>> omega = np.geomspace(1, 1e6, 50)
    >>> x = 1j * omega * 1e-3
    >>> modulus = 1e6 + 5e6 * x / (1 + x)
    >>> series = fit_prony(DynamicModulus(omega, modulus.real, modulus.imag))
    >>> print(f"{series.relaxed:.6g} {series.moduli[0]:.6g} {series.times[0]:.6g}")
    1e+06 5e+06 0.001

    A fractional Zener model over eight decades:

    >>> def fractional_zener(omega):
    ...     x = (1j * omega * 1e-4) ** 0.4
    ...     return 1e6 + 1e9 * x / (1 + x)
    >>> series = fit_prony(fractional_zener, band=(1e-2, 1e6), accuracy=0.01)
    >>> len(series.times) < 15 and series.rms < 0.01
    True
    """
    data = _as_data(data, band)
    given = {"accuracy": accuracy, "terms": terms, "per_decade": per_decade, "times": times}
    if sum(each is not None for each in given.values()) > 1:
        shown = {key: each for key, each in given.items() if each is not None}
        raise InputError("accuracy, terms, per_decade, times", shown, "one of them")
    if terms is not None:
        terms = integer("terms", terms, 1, MOST_TIMES, f"an integer from 1 to {MOST_TIMES}")
        _refuse_too_many(terms, 2 * terms + 1, data)
        series = _series(data, _placed(Placement(data), terms), True)
    elif times is not None:
        offered = np.unique(np.atleast_1d(numbers("times", times, "s", 0, strict=True)))
        if not offered.size:
            raise InputError("times", times, "at least one relaxation time (s)")
        _refuse_too_many(offered.size, offered.size + 1, data)
        series = _series(data, offered, False)
    elif per_decade is not None:
        count = _count(data, number("per_decade", per_decade, "", 0, strict=True))
        _refuse_too_many(count, count + 1, data)
        series = _series(data, _evenly(data, count), False)
    else:
        accuracy = ACCURACY if accuracy is None else number("accuracy", accuracy, "", 1e-6)
        if accuracy > 0.5:
            raise InputError("accuracy", accuracy, "a number from 1e-6 to 0.5")
        series = _series(data, _fewest(data, accuracy), True)
    if series.rms > POOR:
        warnings.warn(f"poor fit: {series.quality}", FitWarning, stacklevel=2)
    return series


def _as_data(data: Any, band: Any) -> DynamicModulus:
    allowed = "(lowest, highest) frequency, Hz"
    if band is not None and len(sequence("band", band, allowed)) != 2:
        raise InputError("band", band, allowed)
    if callable(data):
        if band is None:
            raise InputError("band", None, f"{allowed}, over which the function is fitted")
        return DynamicModulus.from_function(data, *band)
    if isinstance(data, tuple) and len(data) == 2:
        data = DynamicModulus.from_complex(*data)
    if not isinstance(data, DynamicModulus):
        raise InputError("data", data, "a hystrip.dma.DynamicModulus, a pair (omega, E*), or a function E*(omega)")
    if band is None:
        return data
    return data.between(*(number(f"band[{i}]", each, "Hz", 0) for i, each in enumerate(band)))


def _refuse_too_many(count: int, unknowns: int, data: DynamicModulus) -> None:
    if count > MOST_TIMES:
        raise InputError("relaxation times", count, f"at most {MOST_TIMES}: give a smaller per_decade, or accuracy")
    if unknowns > 2 * _different(data):
        what = f"{count} relaxation times for {_different(data)} frequencies"
        raise InputError("relaxation times", what, "fewer unknowns than moduli measured: give a smaller per_decade, or terms")


def _different(data: DynamicModulus) -> int:
    """How many frequencies were measured: one that was measured twice determines no more unknowns."""
    return np.unique(data.omega).size


def _count(data: DynamicModulus, per_decade: float) -> int:
    return int(min(round(per_decade * np.log10(data.omega[-1] / data.omega[0])) + 1, MOST_TIMES + 1))


def _evenly(data: DynamicModulus, count: int) -> np.ndarray:
    low, high = 1 / data.omega[-1], 1 / data.omega[0]
    return np.geomspace(low, high, count) if count > 1 else np.array([np.sqrt(low * high)])


def _rms(residuals: np.ndarray) -> float:
    return float(np.sqrt(np.mean(residuals**2)))


def _fewest(data: DynamicModulus, accuracy: float) -> np.ndarray:
    """As few times as reach the accuracy, where they fit best; or, if none do, as few as leave about as little as any.

    How many are enough is seen from evenly spaced ones, if there are enough of these, which is had at once."""
    most = min(MOST_TIMES, _different(data) - 1)
    found: dict[int, tuple[float, np.ndarray]] = {}
    placement = Placement(data)

    def left(count: int) -> float:
        if count not in found:
            times = _placed(placement, count)
            found[count] = (placement.solved(times)[1], times)
        return found[count][0]

    def spread(count: int) -> float:
        # what fits noise as well counts for nothing: what is left per number measured that is not used up
        return left(count) / np.sqrt(max(1 - (2 * count + 1) / (2 * data.omega.size), 1e-3))

    counts = [count for count in _TRIED if count < most] + [most]
    even = next((count for count in range(1, most + 1) if placement.solved(_evenly(data, count))[1] <= accuracy), None)
    enough = even or next((count for count in counts if left(count) <= accuracy), None)
    # noise, or more decades than so many times can span
    good, goal = (left, accuracy) if enough else (spread, _AS_GOOD * min(map(spread, counts)))
    enough = enough or next(count for count in counts if spread(count) <= goal)
    if good(enough) > goal:
        return _evenly(data, enough)
    low, high = 0, enough  # fewer than `high` times may do, `low` do not
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (low, middle) if good(middle) <= goal else (middle, high)
    return found[high][1]


def _placed(placement: Placement, terms: int) -> np.ndarray:
    """Times at which ``terms`` branches fit best; their moduli follow from them."""
    return min(map(placement.refined, _starts(placement, terms)), key=lambda found: found[1])[0]


def _starts(placement: Placement, terms: int) -> list[np.ndarray]:
    """Guesses of the times: even over the band, with its ends and without; and at even shares of a finely resolved spectrum."""
    data = placement.data
    low, high = np.log(1 / data.omega[-1]), np.log(1 / data.omega[0])
    inner = np.exp(low + (high - low) * (np.arange(terms) + 0.5) / terms)
    starts = [inner] if terms == 1 else [inner, _evenly(data, terms)]
    fine = _evenly(data, max(_count(data, 4.0), terms))
    moduli = placement.solved(fine)[0][1:]
    if not moduli.any():
        return starts
    # shares of the logarithm of the modulus: soft and slow branches matter as much as stiff and fast ones
    rise = np.diff(np.log(np.cumsum(np.concatenate(([moduli.sum() * 1e-6], moduli[::-1])))))[::-1]
    share = np.cumsum(rise) / rise.sum()
    return [*starts, np.exp(np.interp((np.arange(terms) + 0.5) / terms, share, np.log(fine)))]


def _series(data: DynamicModulus, times: np.ndarray, free: bool) -> PronySeries:
    """The series at these times, with what is known of its quality; ``free``: the times were fitted too."""
    offered = times.size
    moduli, residuals = solved(data, times)
    keep = moduli[1:] > _NOTHING * moduli.sum()
    if not keep.any() and data.loss.any():
        band = f"{1 / data.omega[-1]:.3g} to {1 / data.omega[0]:.3g} s"
        raise InputError("relaxation times", times.tolist(), f"times of which one gets a modulus, such as those from {band}")
    if not keep.any():
        raise InputError("data", "no relaxation", "data whose loss modulus is not zero throughout")
    f = data.frequency
    if moduli[0] <= _NOTHING * moduli.sum():
        problem = f"no relaxed modulus between {f[0]:.4g} and {f[-1]:.4g} Hz"
        raise InputError("data", problem, "a solid: frequencies low enough for the storage modulus to level off, or fewer times")
    times, moduli = times[keep], moduli[np.concatenate(([True], keep))]
    modulus_errors, time_errors = relative_errors(data, moduli, times, residuals, free)
    if free:
        modulus_errors[1:][held(data, times)] = time_errors[held(data, times)] = np.inf
    n = f.size
    worst = int(np.argmax(np.abs(residuals)))
    return PronySeries(
        relaxed=float(moduli[0]),
        moduli=tuple(moduli[1:].tolist()),
        times=tuple(times.tolist()),
        kind=data.kind,
        offered=int(offered),
        band=(float(f[0]), float(f[-1])),
        points=n,
        rms_storage=_rms(residuals[:n]),
        rms_loss=_rms(residuals[n:]),
        worst=float(abs(residuals[worst])),
        worst_at=float(f[worst % n]),
        relaxed_error=float(modulus_errors[0]),
        moduli_errors=tuple(modulus_errors[1:].tolist()),
        times_errors=tuple(time_errors.tolist()),
        fit=FittedBand.of_residuals(f, residuals.reshape(2, n)),
    )

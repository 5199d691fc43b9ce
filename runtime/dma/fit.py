"""Fitting a Prony series to storage and loss modulus."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..errors import InputError
from ..inputs.checks import number, numbers
from .read import DynamicModulus
from .series import PronySeries

#: a branch below this share of the glassy modulus is rounding of the solver
_NOTHING = 1e-12
_MOST_TIMES = 500


def fit_prony(
    data: DynamicModulus, *, per_decade: float | None = None, terms: int | None = None, times: Any = None
) -> PronySeries:
    """Fit ``relaxed + sum_j moduli_j i omega times_j/(1 + i omega times_j)`` to measured moduli.

    Minimises the sum of the squared relative residuals of storage and loss modulus, each relative to its own measured
    value (a loss of zero relative to the storage modulus), over non-negative moduli: ``scipy.optimize.nnls``. Times
    that get no modulus are dropped.

    Parameters
    ----------
    data : what was measured
    per_decade : relaxation times per decade, > 0, evenly over the measured band from ``1/omega_max`` to
        ``1/omega_min``, both included; 1 if neither this nor one of the next two is given
    terms : in place of that, so many relaxation times, an integer from 1 to 8, placed where they fit best
    times : in place of that, the relaxation times themselves, s, > 0

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
    >>> series = fit_prony(DynamicModulus(omega, modulus.real, modulus.imag), terms=1)
    >>> print(f"{series.relaxed:.6g} {series.moduli[0]:.6g} {series.times[0]:.6g}")
    1e+06 5e+06 0.001
    """
    given = {"per_decade": per_decade, "terms": terms, "times": times}
    if sum(each is not None for each in given.values()) > 1:
        raise InputError("per_decade, terms, times", {k: v for k, v in given.items() if v is not None}, "one of the three")
    if terms is not None:
        if isinstance(terms, bool) or not isinstance(terms, (int, np.integer)) or not 1 <= terms <= 8:
            raise InputError("terms", terms, "an integer from 1 to 8")
        _refuse_too_many(int(terms), 2 * int(terms) + 1, data)
        offered = _placed(data, int(terms))
    elif times is not None:
        offered = np.unique(np.atleast_1d(numbers("times", times, "s", 0, strict=True)))
        _refuse_too_many(offered.size, offered.size + 1, data)
    else:
        offered = _evenly(data, 1.0 if per_decade is None else number("per_decade", per_decade, "", 0, strict=True))
        _refuse_too_many(offered.size, offered.size + 1, data)
    return _series(data, offered)


def _refuse_too_many(count: int, unknowns: int, data: DynamicModulus) -> None:
    if unknowns > 2 * data.omega.size:
        what = f"{count} relaxation times for {data.omega.size} frequencies"
        raise InputError("relaxation times", what, "fewer unknowns than moduli measured: give a smaller per_decade, or terms")
    if count > _MOST_TIMES:
        raise InputError("relaxation times", count, f"at most {_MOST_TIMES}: give a smaller per_decade")


def _evenly(data: DynamicModulus, per_decade: float) -> np.ndarray:
    low, high = 1 / data.omega[-1], 1 / data.omega[0]
    count = min(round(per_decade * np.log10(high / low)) + 1, _MOST_TIMES + 1)
    return np.geomspace(low, high, count) if count > 1 else np.array([np.sqrt(low * high)])


def _system(data: DynamicModulus, times: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Matrix and goal of the relative residuals, storage rows above loss rows; the relaxed modulus comes first."""
    x = np.multiply.outer(data.omega, times)
    storage, loss = x**2 / (1 + x**2), x / (1 + x**2)
    one = np.ones((data.omega.size, 1))
    rows = np.block([[one, storage], [0 * one, loss]])
    measured = np.concatenate((data.storage, data.loss))
    size = np.where(measured > 0, measured, np.concatenate((data.storage, data.storage)))
    return rows / size[:, None], measured / size


def _solved(data: DynamicModulus, times: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Moduli (1 + times,), Pa, and relative residuals (2 n,)."""
    from scipy.optimize import nnls

    rows, goal = _system(data, times)
    # columns of one size: moduli of rubber span decades, and the solver's tolerance is absolute
    size = np.linalg.norm(rows, axis=0)
    size[size == 0] = 1.0
    found, _ = nnls(rows / size, goal)
    moduli = found / size
    return moduli, rows @ moduli - goal


def _placed(data: DynamicModulus, terms: int) -> np.ndarray:
    """Times at which ``terms`` branches fit best; their moduli follow from them (variable projection)."""
    from scipy.optimize import least_squares

    span = np.log(1 / data.omega[-1]), np.log(1 / data.omega[0])
    best = None
    for start in _starts(data, terms, span):
        # within a decade of what was measured: beyond, a branch cannot be told from a constant
        bounds = span[0] - np.log(10), span[1] + np.log(10)
        found = least_squares(lambda s: _solved(data, np.exp(s))[1], start, bounds=bounds, xtol=1e-14, ftol=1e-14, gtol=1e-14)
        if best is None or found.cost < best.cost:
            best = found
    return np.unique(np.exp(best.x))


def _starts(data: DynamicModulus, terms: int, span: tuple[float, float]) -> list[np.ndarray]:
    """Two guesses of ln(times): even over the band; and at even shares of a finely resolved spectrum."""
    even = span[0] + (span[1] - span[0]) * (np.arange(terms) + 0.5) / terms
    fine = _evenly(data, 4.0)
    moduli = _solved(data, fine)[0][1:]
    if not moduli.any():
        return [even]
    # shares of the logarithm of the modulus: soft and slow branches matter as much as stiff and fast ones
    rise = np.diff(np.log(np.cumsum(np.concatenate(([max(moduli.sum(), 1.0) * 1e-6], moduli[::-1])))))[::-1]
    share = np.cumsum(rise) / rise.sum()
    shared = np.interp((np.arange(terms) + 0.5) / terms, share, np.log(fine))
    return [even, shared]


def _series(data: DynamicModulus, times: np.ndarray) -> PronySeries:
    moduli, residuals = _solved(data, times)
    keep = moduli[1:] > _NOTHING * moduli.sum()
    if not keep.any():
        raise InputError("dma", "no relaxation", "data whose loss modulus is not zero throughout")
    if moduli[0] <= _NOTHING * moduli.sum():
        problem = f"no relaxed modulus between {data.omega[0] / (2 * np.pi):.4g} and {data.omega[-1] / (2 * np.pi):.4g} Hz"
        raise InputError("dma", problem, "a solid: frequencies low enough for the storage modulus to level off, or fewer times")
    n = data.omega.size
    f = data.omega / (2 * np.pi)
    worst = int(np.argmax(np.abs(residuals)))
    rms = [float(np.sqrt(np.mean(part**2))) for part in (residuals[:n], residuals[n:])]
    return PronySeries(
        relaxed=float(moduli[0]),
        moduli=tuple(moduli[1:][keep].tolist()),
        times=tuple(times[keep].tolist()),
        kind=data.kind,
        offered=int(times.size),
        band=(float(f[0]), float(f[-1])),
        points=n,
        rms_storage=rms[0],
        rms_loss=rms[1],
        worst=float(abs(residuals[worst])),
        worst_at=float(f[worst % n]),
    )

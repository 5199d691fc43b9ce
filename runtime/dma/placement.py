"""The relaxation times that fit best (variable projection).

The moduli that belong to given times leave the times a problem of their own, whose Jacobian is Kaufman's: the derivative of the
columns, less what a change of the moduli takes up (BIT 15, 1975, 49).
"""

import numpy as np
from numpy.polynomial.chebyshev import chebvander

from ..numerics.chebyshev import coefficients, lobatto
from .modulus import DynamicModulus
from .projection import by_log_times, columns, nonnegative, sizes, system

#: relaxation times per decade whose columns span those of all times between, to rounding: over the logarithm of the time they are
#: analytic up to pi/2 beside the real axis; and how many more of them on either side
_PER_DECADE, _BEYOND = 8, 12
#: directions of that space, over the largest, that are nothing but rounding
_ROUNDING = 1e-14
#: Chebyshev nodes per decade of frequency, and how many more, through which moduli of branches interpolate to rounding: they are
#: analytic there as over the time
_NODES, _MORE = 26, 24
#: frequencies whose interpolants are made at a time: 10 MB for ten decades
_ROWS = 4096
#: frequencies summed over at a time: products of small matrices stay in one thread
_AT_ONCE = 64
#: closer to a bound than this, as logarithms of times, a time is held by it alone
_HELD = 0.01


def bounds(data: DynamicModulus) -> tuple[float, float]:
    """Logarithms of the times (s) between which times are looked for: within a decade of what was measured. Beyond, a branch
    cannot be told from a constant."""
    return np.log(1 / data.omega[-1]) - np.log(10), np.log(1 / data.omega[0]) + np.log(10)


def held(data: DynamicModulus, times: np.ndarray) -> np.ndarray:
    """Which of the times that fit best (s, (n,)) stand at a bound, where not they but the bound is found."""
    return np.abs(np.subtract.outer(np.log(times), bounds(data))).min(axis=1) < _HELD


class Placement:
    """Where relaxation times fit ``data`` best. Residuals are told in the space that columns can span: some dozens of numbers,
    had from columns at as many frequencies as determine them, however many were measured. Where a machine is busy, threads that
    share larger matrices wait for one another far longer than they compute."""

    def __init__(self, data: DynamicModulus):
        self.data = data
        self.bounds = bounds(data)
        count = _PER_DECADE * int(np.ceil((self.bounds[1] - self.bounds[0]) / np.log(10))) + 2 * _BEYOND
        margin = _BEYOND * np.log(10) / _PER_DECADE
        rows, goal = system(data, np.exp(np.linspace(self.bounds[0] - margin, self.bounds[1] + margin, count + 1)))
        directions, spread, _ = np.linalg.svd(rows / np.linalg.norm(rows, axis=0), full_matrices=False)
        directions = directions[:, spread > _ROUNDING * spread[0]]
        self._goal = directions.T @ goal
        self._beyond, self._count = np.sum((goal - directions @ self._goal) ** 2), goal.size
        self._omega, taken = _sampled(data.omega, directions / sizes(data)[:, None])
        self._taken = _in_parts(taken)

    def _shares(self, of: np.ndarray) -> np.ndarray:
        """Columns (2 m, k) at the frequencies they are taken at in the space that columns span."""
        return (self._taken.swapaxes(1, 2) @ _in_parts(of)).sum(axis=0)

    def solved(self, times: np.ndarray) -> tuple[np.ndarray, float]:
        """Moduli (1 + times,), Pa, that fit best with branches of these times, s, and the root mean square of what they leave of
        all that was measured."""
        moduli, residuals = nonnegative(self._shares(columns(self._omega, times)), self._goal)
        return moduli, float(np.sqrt((np.sum(residuals**2) + self._beyond) / self._count))

    def refined(self, start: np.ndarray) -> tuple[np.ndarray, float]:
        """Times that fit best, starting from ``start``, s, and half the sum of the squares of what they leave in the space."""
        from scipy.optimize import least_squares

        def solved(s):
            rows = self._shares(columns(self._omega, np.exp(s)))
            return rows, *nonnegative(rows, self._goal)

        def jacobian(s):
            rows, moduli, _ = solved(s)
            basis, _ = np.linalg.qr((rows / np.maximum(np.linalg.norm(rows, axis=0), 1e-300))[:, moduli > 0])
            change = self._shares(by_log_times(self._omega, np.exp(s), moduli[1:]))
            return change - basis @ (basis.T @ change)

        low, high = self.bounds
        inside = np.clip(np.log(start), low + 1e-9, high - 1e-9)
        found = least_squares(
            lambda s: solved(s)[2], inside, jacobian, bounds=self.bounds, xtol=1e-12, ftol=1e-12, gtol=1e-14, max_nfev=200
        )
        return np.unique(np.exp(found.x)), float(found.cost)


def _sampled(omega: np.ndarray, weights: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Frequencies (m,), and weights (2 m, k) that make of columns there the sums that ``weights`` (2 n, k) make of those at
    ``omega`` (n,), ascending: of many the nodes of an interpolant."""
    low, width = np.log(omega[0]), np.log(omega[-1] / omega[0])
    order = int(_NODES * width / np.log(10)) + _MORE
    if omega.size <= order + 1:
        return omega, weights
    found, x = np.zeros((2, order + 1, weights.shape[1])), np.clip(2 * (np.log(omega) - low) / width - 1, -1, 1)
    for start in range(0, omega.size, _ROWS):
        some = slice(start, start + _ROWS)
        found += chebvander(x[some], order).T @ weights.reshape(2, omega.size, -1)[:, some]
    found = coefficients(np.eye(order + 1)).T @ found
    return np.exp(low + width * lobatto(order)), found.reshape(-1, weights.shape[1])


def _in_parts(columns: np.ndarray) -> np.ndarray:
    """Columns (N, k) as (parts, at once, k), with zeros at the end."""
    N, k = columns.shape
    parts = -(-N // _AT_ONCE)
    out = np.zeros((parts * _AT_ONCE, k))
    out[:N] = columns
    return out.reshape(parts, _AT_ONCE, k)

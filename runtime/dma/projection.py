"""Moduli that fit best at given relaxation times, and how well moduli and times are known.

The residuals are those of storage and loss modulus, each relative to what was measured. For given times they are linear in
the moduli: non-negative least squares.
"""

import numpy as np

from .modulus import DynamicModulus


def columns(omega: np.ndarray, times: np.ndarray) -> np.ndarray:
    """Moduli over ``omega`` (n,) of a unit of each branch, (2 n, 1 + times), storage above loss; the relaxed one comes first."""
    x = np.multiply.outer(omega, times)
    one = np.ones((omega.size, 1))
    return np.block([[one, 1 / (1 + x**-2)], [0 * one, 1 / (x + 1 / x)]])


def system(data: DynamicModulus, times: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Matrix (2 n, 1 + times) and goal (2 n,) of the relative residuals, as :func:`columns`."""
    size = sizes(data)
    return columns(data.omega, times) / size[:, None], np.concatenate((data.storage, data.loss)) / size


def solved(data: DynamicModulus, times: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Moduli (1 + times,), Pa, and relative residuals (2 n,)."""
    return nonnegative(*system(data, times))


def nonnegative(rows: np.ndarray, goal: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The moduli that fit best, and their residuals."""
    from scipy.optimize import nnls

    # columns of one size: moduli of rubber span decades, and the solver's tolerance is absolute
    size = np.linalg.norm(rows, axis=0)
    size[size == 0] = 1.0
    found, _ = nnls(rows / size, goal, maxiter=100 * rows.shape[1])
    moduli = found / size
    return moduli, rows @ moduli - goal


def by_log_times(omega: np.ndarray, times: np.ndarray, moduli: np.ndarray) -> np.ndarray:
    """Derivatives (2 n, times) of what branches of these moduli add, by the logarithms of the times."""
    x = np.multiply.outer(omega, times)
    small = np.minimum(x, 1 / x)  # x^2/(1 + x^2)^2 is the same for x and 1/x
    storage = 2 * (small / (1 + small**2)) ** 2
    loss = small / (1 + small**2) * np.where(x > 1, -1, 1) * (1 - small**2) / (1 + small**2)
    return np.concatenate((storage, loss)) * moduli


def relative_errors(
    data: DynamicModulus, moduli: np.ndarray, times: np.ndarray, residuals: np.ndarray, free_times: bool
) -> tuple[np.ndarray, np.ndarray]:
    """Relative standard errors of the moduli (1 + times,) and of the times (times,), from the residuals left and the
    linearised problem; the times' are zero unless they were fitted."""
    rows, _ = system(data, times)
    jacobian = rows * moduli
    if free_times:
        jacobian = np.concatenate((jacobian, by_log_times(data.omega, times, moduli[1:]) / sizes(data)[:, None]), axis=1)
    freedom = max(residuals.size - jacobian.shape[1], 1)
    _, spread, directions = np.linalg.svd(jacobian, full_matrices=False)
    scaled = directions / np.maximum(spread, 1e-15 * spread[0])[:, None]
    errors = np.sqrt(np.sum(scaled**2, axis=0) * np.sum(residuals**2) / freedom)
    n = moduli.size
    return errors[:n], errors[n:] if free_times else np.zeros(times.size)


def sizes(data: DynamicModulus) -> np.ndarray:
    """What residuals are relative to, (2 n,): the measured value; a loss of zero relative to the storage modulus."""
    measured = np.concatenate((data.storage, data.loss))
    return np.where(measured > 0, measured, np.concatenate((data.storage, data.storage)))

"""Small linear systems, many at a time, of which one may be singular without spoiling the others."""

import numpy as np


def solve_each(matrix: np.ndarray, right: np.ndarray) -> np.ndarray:
    """``x`` of ``matrix x = right`` for matrices (N, k, k) and columns (N, k, m), every row scaled by its largest entry.

    NaN where a matrix is singular or something is not finite."""
    scale = np.abs(matrix).max(axis=2, keepdims=True)
    good = np.isfinite(scale).all(axis=(1, 2)) & (scale > 0).all(axis=(1, 2)) & np.isfinite(right).all(axis=(1, 2))
    rows, columns = (np.divide(part, scale, out=np.zeros(part.shape), where=good[:, None, None]) for part in (matrix, right))
    rows[~good] = np.eye(matrix.shape[1])
    try:
        found = np.linalg.solve(rows, columns)
    except np.linalg.LinAlgError:
        good &= np.linalg.det(rows) != 0
        rows[~good] = np.eye(matrix.shape[1])
        found = np.linalg.solve(rows, columns)
    found[~good] = np.nan
    return found

"""Batches of small linear systems in which some are singular."""

import numpy as np

from hystrip.numerics.linear import solve_each


def test_one_singular_matrix_spoils_no_other():
    rng = np.random.default_rng(1)
    # rows of very different size, as equations with fast and slow modes have
    matrix = rng.normal(size=(6, 4, 4)) * 10.0 ** rng.uniform(-150, 150, (6, 4, 1))
    x = rng.normal(size=(6, 4, 2))
    right = matrix @ x
    matrix[1, 2] = 0.0
    matrix[2, 3] = matrix[2, 0]
    right[3, 1, 0] = np.inf
    matrix[4, 0, 0] = np.nan
    found = solve_each(matrix, right)
    assert np.isnan(found[1:5]).all()
    assert np.allclose(found[[0, 5]], x[[0, 5]], rtol=1e-10)


def test_nothing_to_solve():
    assert solve_each(np.empty((0, 3, 3)), np.empty((0, 3, 1))).shape == (0, 3, 1)

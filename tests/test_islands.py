"""Levels drawn out to just below the penetration at which some strips, away from the crest, let go: an island in y, too narrow at
first for the nodes of an average."""

import numpy as np
import pytest

import hystrip

#: T_eps, p_0, delta_0, h, V, the closure, and a penetration within a thousandth of h of that of such an island
LEVELS = [
    (0.157, 1100.0, 1.14e-7, 4.57e-7, 1.88e-3, "continuous", -3.0762e-7),
    (0.0377, 259.0, 5.28e-8, 2.14e-7, 1.33e-2, "continuous", -1.9749e-8),
    (0.0792, 162.0, 3.66e-8, 1.58e-7, 2.04e-3, "continuous", 5.6044e-9),
    (0.184, 58.2, 1.24e-8, 1.15e-7, 4.46e-2, "continuous", 6.1534e-8),
    (0.106, 188.0, 5.13e-8, 4.08e-7, 8.03e-4, "constitutive", 2.17416e-7),
]


@pytest.mark.parametrize("T_eps, p_0, delta_0, h, V, edge, D", LEVELS)
def test_a_narrow_island_is_not_passed_over(T_eps, p_0, delta_0, h, V, edge, D):
    of = hystrip.StandardLinearSolid(1e9, T_eps, 1e-3), hystrip.Dugdale(p_0=p_0, delta_0=delta_0)
    level = hystrip.Level(l=1e-5, h=h)
    equal = hystrip.solve_level(*of, level, V=V, D=D, edge=edge, strips=20_000)
    for rtol in (1e-2, 1e-6):
        alone = hystrip.solve_level(*of, level, V=V, D=D, edge=edge, rtol=rtol)
        near = hystrip.solve_level(*of, level, V=V, D=D - h * np.array([0.0, 1e-6]), edge=edge, rtol=rtol)
        assert abs(alone.p_mean - equal.p_mean) <= alone.error_estimate[0] + equal.error_estimate[0]
        assert abs(alone.p_mean - near.p_mean[0]) <= alone.error_estimate[0] + near.error_estimate[0, 0]
    surface = hystrip.solve(*of, [level], penetration=D, velocity=V, edge=edge, rtol=1e-3)
    assert abs(surface.tau - alone.tau_mean) <= surface.tau_error + alone.error_estimate[1]

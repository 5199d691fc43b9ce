"""What `tools/validation.py` compares with: Persson's theory in its limits, Tamaas where it is installed."""

import sys
from pathlib import Path

import numpy as np
import pytest

import hystrip

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tools"))

from peers import half_space, persson  # noqa: E402

LEVELS = [hystrip.Level(1e-3, 2e-5), hystrip.Level(1e-4, 3e-6)]
MATERIAL = hystrip.HalfSpace(E=2e6, nu=0.49, moduli=[3e7, 2e6], times=[1e-6, 1e-2])
NONE = hystrip.Dugdale(gamma=0)


def test_waves_have_the_variance_and_the_slope_of_the_levels():
    level = LEVELS[0]
    q, along, square = np.array(persson.waves([level])).T
    assert square.sum() == pytest.approx(5 / 64 * level.h**2, rel=1e-14)
    assert (q**2 * square).sum() == pytest.approx(6 / 5 * level.k**2 * 5 / 64 * level.h**2, rel=1e-14)
    x = np.linspace(0, level.l, 64, endpoint=False)
    f = level.h - level.h / 4 * np.multiply.outer(np.cos(level.k * x) + 1, np.cos(level.k * x) + 1)
    assert f.var() == pytest.approx(square.sum(), rel=1e-12)
    slope = level.h / 4 * level.k * np.multiply.outer(np.sin(level.k * x), np.cos(level.k * x) + 1)
    assert (slope**2).mean() == pytest.approx((along**2 * square).sum(), rel=1e-12)


def test_persson_is_complete_contact_under_large_loads_and_linear_under_small_ones():
    V = np.geomspace(1e-4, 1, 5)
    mu, contact = persson.friction(MATERIAL, LEVELS, 1e9, V)
    ours = hystrip.solve(MATERIAL, NONE, LEVELS, pressure=1e9, velocity=V, edge="constitutive")
    assert (contact == 1).all() and mu == pytest.approx(ours.mu, rel=1e-12)
    small = [persson.friction(MATERIAL, LEVELS, p, V)[1] for p in (1.0, 2.0)]
    assert small[1] == pytest.approx(2 * small[0], rel=1e-6) and (small[0] < 1e-3).all()


@pytest.mark.skipif(not half_space.available(), reason="needs Tamaas (extra `bench`)")
def test_tamaas_in_complete_contact_is_the_formula():
    """In the units that the tool uses: what is compared there in partial contact is the same half-space."""
    level, V, p = hystrip.Level(1.0, 0.02), 0.1, 1.0
    material = hystrip.HalfSpace(E=2.0, nu=0.0, moduli=[18.0], times=[1.0])
    mu = hystrip.solve(material, NONE, [level], pressure=p, velocity=V).mu
    coarse, fine = (half_space.viscoelastic(level, 9.0, 1.0, p, V, 16, steps)[0] for steps in (32, 64))
    assert (2 * fine - coarse) / p == pytest.approx(float(mu), rel=0.01) and half_space.elastic_contact(level, p, 16) == 1

"""Transitions that are known or foretold: where strips cease to be engaged all along, where orbits end at a fold."""

from dataclasses import replace

import numpy as np
import pytest

import hystrip
from hystrip.level.breaks import breakpoints, let_go
from hystrip.level.clinging import Clinging
from hystrip.level.means import level_means
from hystrip.level.strips import Columns, saturation_depth
from hystrip.orbit.regimes import CODE

MATERIAL = hystrip.StandardLinearSolid(K=1e9, T_eps=1e-2, T_sigma=1e-4)
WEAK = hystrip.Dugdale(gamma=2.5e-5, delta_0=1e-8)
SMALL = hystrip.Level(l=500e-9, h=100e-9)
ENGAGED = [CODE[name] for name in ("c", "ac", "a")]


def _columns(V, D, edge="continuous", branch="unloading", adhesion=WEAK, material=MATERIAL, level=SMALL):
    return Columns(material, adhesion, level, edge, branch, np.full(D.size, float(V)), D)


def _over_the_curve(V, **rest):
    """Columns from where strips let go up to saturation."""
    columns = _columns(V, np.zeros(1), **rest)
    low, top = let_go(columns), saturation_depth(columns)[0]
    near = low + columns.adhesion.delta_0 * np.array((0.1, 0.5, 0.9))
    D = np.concatenate((near, np.linspace(low, top, 25)[1:-1]))
    return columns.at(np.zeros(D.size, int), D)


SCENES = [
    (5e-3, {}),
    (1e-4, {"edge": "constitutive"}),
    (1e-3, {"material": hystrip.StandardLinearSolid(1e9, 1e-2, 0.0), "edge": "constitutive"}),
    (1e-2, {"adhesion": hystrip.Dugdale(gamma=1e-7, delta_0=1e-10), "level": hystrip.Level(l=1e-5, h=1e-6)}),
    (3e-4, {"material": hystrip.StandardLinearSolid(1e9, 1e-2, 8e-3)}),
]


@pytest.mark.parametrize(("V", "rest"), SCENES)
def test_what_is_known_is_where_codes_change_and_nothing_is_missed(V, rest):
    columns = _over_the_curve(V, **rest)
    column, theta, rounding = columns.ends_of_clinging()
    aside = np.maximum(1e-12, 4 * rounding)
    low, high = (columns.codes(column, theta + side * aside) for side in (-1, 1))
    assert column.size > 10 and (low != high).all()
    assert np.isin(low, ENGAGED).sum() + np.isin(high, ENGAGED).sum() >= column.size
    across = np.linspace(0.01, 3.13, 150)
    codes = columns.codes(np.repeat(np.arange(columns.size), across.size), np.tile(across, columns.size))
    engaged = np.isin(codes, ENGAGED).reshape(columns.size, -1)
    row, at = np.nonzero(engaged[:, 1:] != engaged[:, :-1])
    for i, k in zip(row, at, strict=True):
        assert ((column == i) & (theta > across[k]) & (theta < across[k + 1])).any()


def test_contact_of_strips_that_cling_begins_where_their_crest_touches_the_foundation_at_rest():
    """At rest the foundation is drawn up by p_0/K: the strip with ``D_j = -p_0/K`` just touches it, whatever the velocity."""
    lift = WEAK.p_0 / MATERIAL.K
    D = SMALL.h - lift - 0.5 * WEAK.delta_0
    for V in (1e-4, 1e-1):
        columns = _columns(V, np.array([D]))
        _, theta, _ = columns.ends_of_clinging()
        assert np.abs(D - SMALL.drop(theta) + lift).min() < 1e-12 * lift


def test_a_foundation_without_memory_tells_nothing():
    """There a gap is what it is at rest: all strips of a level let go at one penetration."""
    for V in (0.0, 1e-9):
        columns = _over_the_curve(V)
        column, theta, _ = columns.ends_of_clinging()
        assert (columns.D[column] < SMALL.h - WEAK.p_0 / MATERIAL.K).all()
        assert np.allclose(columns.D[column] - SMALL.drop(theta), -WEAK.p_0 / MATERIAL.K, rtol=1e-9, atol=0)


@pytest.mark.parametrize(
    "rest",
    [
        {"branch": "loading"},
        {"adhesion": hystrip.Dugdale(gamma=0)},
        {"edge": "constitutive", "material": hystrip.Prony(K=1e9, moduli=(1e10, 1e9), times=(1e-4, 1e-3))},
        {"level": hystrip.Level(l=1e-6, h=0.0)},
    ],
)
def test_nothing_is_said_where_it_does_not_hold(rest):
    columns = _columns(1e-3, np.linspace(-1e-7, 1e-6, 20), **rest)
    assert columns.ends_of_clinging()[0].size == 0 and np.isnan(columns.clinging.crest(columns)).all()


@pytest.mark.parametrize("V", [1e-4, 5e-3, 0.1])
def test_the_crest_changes_where_it_is_said_to(V):
    columns = _columns(V, np.zeros(1))
    (D,) = columns.clinging.crest(columns)
    sides = columns.at(np.zeros(2, int), D + np.array((-1e-12, 1e-12)) * SMALL.h)
    low, high = sides.codes(np.arange(2), np.zeros(2))
    assert low != high == CODE["ac"]
    (points,), _ = breakpoints(columns, saturation_depth(columns))
    assert np.abs(points - D).min() < 1e-13 * SMALL.h + 1e-15 * WEAK.p_0 / MATERIAL.K


def test_velocities_do_not_depend_on_one_another():
    columns = _over_the_curve(5e-3)
    many = replace(columns, V=columns.V * np.linspace(0.5, 2, columns.size), clinging=Clinging())
    column, theta, _ = many.ends_of_clinging()
    for i in (3, 11, 20):
        alone = replace(many.at(np.array([i]), many.D[[i]]), clinging=Clinging())
        assert alone.ends_of_clinging()[1].tolist() == theta[column == i].tolist()


@pytest.mark.parametrize("rtol", [1e-3, 1e-7])
def test_means_are_those_found_by_looking(rtol, monkeypatch):
    columns = _over_the_curve(2e-3)
    means = level_means(columns, np.full(columns.size, rtol))
    monkeypatch.setattr(Clinging, "ends", lambda self, columns: (np.empty(0, int), np.empty(0), np.empty(0)))
    found = level_means(columns, np.full(columns.size, rtol))
    assert (np.abs(means.values - found.values) <= means.errors + found.errors + 1e-13 * np.abs(found.values)).all()
    assert means.strips.sum() < 0.8 * found.strips.sum()


def test_a_wrong_place_costs_strips_and_nothing_else(monkeypatch):
    columns = _over_the_curve(2e-3)
    means = level_means(columns, np.full(columns.size, 1e-6))
    right = Clinging.ends

    def wrong(self, columns):
        column, theta, rounding = right(self, columns)
        return column, 0.97 * theta, rounding

    monkeypatch.setattr(Clinging, "ends", wrong)
    misled = level_means(columns, np.full(columns.size, 1e-6))
    assert (np.abs(means.values - misled.values) <= means.errors + misled.errors + 1e-13 * np.abs(means.values)).all()

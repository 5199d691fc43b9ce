"""Where the strips of a level change regime: breaks over penetration, islands, narrow zones; the greatest pressure in contact."""

import numpy as np
import pytest
import surfaces

import hystrip
from hystrip.level.averages import level_means
from hystrip.level.breaks import Islands, Zones, between_breaks, first_contact, islands, locate_vanishing, scan
from hystrip.level.interpolation import Intervals, interpolate
from hystrip.level.strips import LevelBatch
from hystrip.orbit.regimes import CODE

MATERIAL = hystrip.StandardLinearSolid(K=1e9, T_eps=1e-2, T_sigma=1e-4)
WEAK = hystrip.Dugdale(gamma=2.5e-5, delta_0=1e-8)
SMALL = hystrip.Level(l=500e-9, h=100e-9)


def _columns(V, edge="continuous", branch="unloading", adhesion=WEAK, level=SMALL, material=MATERIAL):
    V = np.atleast_1d(V).astype(float)
    return LevelBatch(material, adhesion, level, edge, branch, V, np.zeros(V.size))


@pytest.mark.parametrize("branch", ["unloading", "loading"])
@pytest.mark.parametrize("edge", ["continuous", "constitutive"])
def test_breaks_are_where_the_crest_changes(edge, branch):
    columns = _columns([1e-5, 1e-3, 1e-2], edge, branch)
    top = columns.saturated.D_sat
    row, _, high, _ = between_breaks(columns, np.arange(columns.size), scan(columns, top))
    for i in range(columns.size):
        points = high[row == i]
        inner = points[(points > first_contact(columns)) & (points < top[i] * (1 - 1e-9))]
        step = 1e-12 * SMALL.h
        sides = np.stack((inner - step, inner + step))
        at = columns.at(np.full(sides.size, i), sides.ravel())
        every = np.arange(sides.size)
        crest, edge_codes = (
            at.codes(every, np.full(sides.size, theta)).reshape(sides.shape) for theta in (0.0, np.pi * (1 - 1e-7))
        )
        changed = (crest[0] != crest[1]) | (edge_codes[0] != edge_codes[1])
        known = np.abs(inner - (SMALL.h - WEAK.p_0 / MATERIAL.K)) < 1e-3 * SMALL.h  # the flat edge's own thresholds
        known |= np.abs(inner - (SMALL.h - WEAK.p_0 / MATERIAL.K - WEAK.delta_0)) < 1e-3 * SMALL.h
        known |= np.abs(inner - (SMALL.h - WEAK.delta_0)) < 1e-3 * SMALL.h
        assert inner.size and (changed | known).all()


def _random(number):
    """Two-level scenes of the survey that once did not end."""
    return surfaces.draw(np.random.default_rng((1, number)), levels=2)


def test_a_zone_narrower_than_the_first_step_counts():
    """Next to first contact only strips around the crest adhere: their part of the mean shrinks with their number, and does not
    vanish before them."""
    scene = _random(4)
    columns = _columns(scene.velocity[2:], scene.edge, scene.branch, scene.adhesion, scene.levels[1], scene.material)
    D = -scene.adhesion.delta_0 + np.array([0.03, 0.1, 0.3, 1.0, 3.0]) * 1e-11
    means = level_means(columns.at(np.zeros(D.size, int), D), np.full(D.size, 1e-5))
    assert (means.values[:, 0] < 0).all() and (np.diff(means.values[:, 0]) < 0).all()
    widths = np.array([zones.high[0] for zones in means.zones])
    assert [zones.code[0] for zones in means.zones] == [CODE["af"]] * D.size and (np.diff(widths) > 0).all()


@pytest.mark.parametrize(("number", "inside", "allowed"), [(4, 8e-7, 3000), (0, 1.418e-7, 12000)])
def test_the_curve_of_a_scene_with_narrow_zones_converges(number, inside, allowed):
    """Zones too narrow to be seen at every penetration, an island of strips that let go: the curve converges all the same (it
    once took minutes), and holds."""
    scene = _random(number)
    columns = _columns(scene.velocity[2:], scene.edge, scene.branch, scene.adhesion, scene.levels[0], scene.material)
    rtol = np.full(1, 1e-3)
    _, low, high, _ = between_breaks(columns, np.zeros(1, int), inside * np.linspace(0.8, 1.2, 81)[None])
    here = (low < inside) & (inside < high)
    low, high = np.maximum(low[here], 0.9 * inside), np.minimum(high[here], 1.1 * inside)
    (pieces,) = interpolate(columns, Intervals.of(np.zeros(1, int), low, high, rtol, columns.atol(rtol)))
    assert columns.spent[0] < allowed
    for piece in pieces:
        t = np.array([0.21, 0.47, 0.83])
        true = level_means(columns.at(np.zeros(t.size, int), piece.penetration(t)), np.full(t.size, 1e-7)).values
        assert (np.abs(piece.values(t) - true)[:, :2] <= 2 * piece.errors.most[:2]).all()


def test_an_island_vanishes_where_its_strips_do():
    scene = _random(0)
    columns = _columns(scene.velocity[2:], scene.edge, scene.branch, scene.adhesion, scene.levels[0], scene.material)
    seen = [np.array([v]) for v in (2.5728, 2.6259, 0, CODE["f"], 1.4170062189113333e-07, 1.4203712327079623e-07, 1e3)]
    (D,) = locate_vanishing(columns, Islands(*seen))
    across = np.linspace(2.5728, 2.6259, 5001)
    for side, there in ((-1e-6, True), (1e-6, False)):
        at = columns.at(np.zeros(across.size, int), np.full(across.size, D * (1 + side)))
        codes = at.codes(np.arange(across.size), across)
        assert (codes == CODE["f"]).any() == there


def test_a_zone_whose_means_do_not_tell_is_no_island():
    wide = _zones((2, 0.0, 1.0, 0.0), (5, 1.001, 1.003, 7.0), (7, 1.004, np.pi, 1.0))
    plain = _zones((2, 0.0, 1.002, 0.0), (7, 1.0020001, np.pi, 1.0))
    D, weight = np.arange(5.0), 0.002 / np.pi * 7.0
    assert islands(0, D, [wide, wide, plain, plain, wide], np.full(1, 20 * weight)) == []
    (found,) = islands(0, D, [wide, wide, plain, plain, wide], np.full(1, weight))
    assert (found.code, found.present, found.absent) == (5, 1.0, 2.0) and np.isclose(found.weight, 1.0)


def test_nested_islands_vanish_one_by_one():
    """Around a minimum of the peak pressure breaks of the law below are passed down and up again: each level between two of them
    is an island of its own, as wide as all inside it."""
    nested = _zones((2, 0.0, 1.0, 0.0), (5, 1.0, 1.2, 3.0), (7, 1.2, 1.3, 9.0), (5, 1.3, 1.5, 3.0), (2, 1.5, np.pi, 0.0))
    inner, plain = nested.code[[0, 1, 4]], _zones((2, 0.0, np.pi, 0.0))
    found = Islands.joined(islands(0, np.arange(2.0), [nested, plain], np.full(1, 1e-2)))
    assert [*zip(found.code, found.low, found.high, strict=True)] == [(5, 1.0, 1.5), (7, 1.2, 1.3)]
    one = Zones(inner, *(np.delete(v, [2, 3], axis=0) for v in (nested.low, nested.high, nested.first, nested.last, nested.mean)))
    assert [each.code for each in islands(0, np.arange(2.0), [nested, one], np.full(1, 1e-2))] == [7]
    # one that hardly tells beside another is left to what comes of the parts
    assert [each.code for each in islands(0, np.arange(2.0), [nested, plain], np.full(1, 1e-9))] == [5, 7]


def _zones(*rows):
    """Zones with a code, ends and a value each."""
    code, low, high, value = np.array(rows).T
    return Zones(code, low, high, *[value[:, None]] * 3)


@pytest.mark.parametrize("T_sigma", [1e-4, 1e-9, 0.0])
def test_the_greatest_pressure_of_a_contact(T_sigma):
    """Without T_sigma pressure has no memory, and its peak is the harmonic's."""
    material = hystrip.StandardLinearSolid(1e9, 1e-2, T_sigma)
    columns = _columns(1e-2, "constitutive", material=material, level=hystrip.Level(l=10e-6, h=1e-6)).at(
        np.zeros(1, int), np.array([6e-7])
    )
    theta = np.linspace(0, 2, 20)
    strips = columns.solve(np.zeros(theta.size, int), theta)
    index, contact = strips.touching
    share = np.concatenate((np.geomspace(1e-9, 1e-2, 4000, endpoint=False), np.linspace(1e-2, 1, 4000)))
    phase = contact.b[:, None] + (contact.a - contact.b)[:, None] * share
    p = contact.pressure(np.repeat(np.arange(index.size), share.size), phase.ravel()).reshape(phase.shape)
    assert index.size > 10 and (contact.p_peak >= p.max(axis=1) * (1 - 1e-12)).all()
    assert np.allclose(contact.p_peak, p.max(axis=1), rtol=1e-4, atol=0)


@pytest.mark.parametrize("rtol", [1e-4, 1e-2, 20.0])
def test_a_panel_next_to_the_flat_edge_may_be_narrower_than_what_is_left_out_there(rtol):
    """Where nothing counts any accuracy is asked for; panels with nodes beyond the strip next to the edge end all the same."""
    scene = surfaces.draw(np.random.default_rng((811, 29)), velocities=1, levels=2)
    columns = _columns(scene.velocity, scene.edge, scene.branch, scene.adhesion, scene.levels[1], scene.material)
    D = -scene.adhesion.delta_0 + np.linspace(0.5, 1.0, 20) * scene.levels[1].h
    means = level_means(columns.at(np.zeros(20, int), D), np.full(20, rtol))
    assert means.strips.max() < 150 and np.isfinite(means.errors).all()
    for zones in means.zones:
        assert (zones.low < zones.high).all() and (zones.low[1:] >= zones.high[:-1]).all()


def test_a_narrow_zone_next_to_a_threshold_is_seen():
    """Contact in a band of a two-thousandth of the period, between free strips and saturated adhesion without contact."""
    material = hystrip.StandardLinearSolid(K=1e9, T_eps=1e-2, T_sigma=1.0764e-5)
    of = material, hystrip.Dugdale(gamma=9.32819e-11, delta_0=1.19442e-11), hystrip.Level(l=1.36351e-07, h=8.8108e-09)
    even = hystrip.solve_level(*of, V=3.32204e-05, D=9.898e-10, strips=20_000).p_mean
    for rtol in (1e-1, 1e-3):
        found = hystrip.solve_level(*of, V=3.32204e-05, D=9.898e-10, rtol=rtol)
        assert found.p_mean == pytest.approx(even, abs=1e-3)


def test_a_fold_is_not_where_the_load_at_an_edge_vanishes():
    """There the determinant of the boundary equations vanishes, too: points that are none were located by the thousand, and the
    law of a lower level did not converge."""
    material = hystrip.StandardLinearSolid(K=1e9, T_eps=1e-2, T_sigma=0.0)
    adhesion = hystrip.Dugdale(gamma=1.4931775378619024e-07, delta_0=1.45496017169782e-09)
    levels = [hystrip.Level(1e-5, 1.679979557806022e-07), hystrip.Level(6.34896432027914e-07, 6.335408820807411e-08)]
    found = hystrip.solve(material, adhesion, levels, pressure=40.7145, velocity=3.38645e-3, branch="loading", rtol=1e-8)
    assert found.converged.all() and found.counts["strips_solved"] < 12_000

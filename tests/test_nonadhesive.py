"""Levels without adhesion: strips in closed form from the width of their contact, level means from one family of them,
laws as averages of laws."""

import numpy as np
import pytest
import surfaces

import hystrip
import hystrip.level.nonadhesive.law
import hystrip.multilevel
import hystrip.orbit.nonadhesive
from hystrip.errors import SolverError
from hystrip.level.averages import level_means
from hystrip.level.nonadhesive.average import Span
from hystrip.level.nonadhesive.law import with_family
from hystrip.level.strips import LevelBatch
from hystrip.orbit.foundation import foundation_of

K, T_EPS = 1e9, 1e-2
NONE = hystrip.Dugdale(gamma=0)
SOFT = hystrip.StandardLinearSolid(K, T_EPS, 1e-3)
MATERIALS = {
    "one time": SOFT,
    "far apart": hystrip.StandardLinearSolid(K, T_EPS, 1e-6),
    "elastic": hystrip.StandardLinearSolid(K, T_EPS, T_EPS),
    "Kelvin-Voigt": hystrip.StandardLinearSolid(K, T_EPS, 0.0),
    "two times": hystrip.Prony(K=K, moduli=[3e9, 9e10], times=[1e-2, 1e-4]),
    "three times": hystrip.Prony(K=K, moduli=[3e9, 1e9, 9e10], times=[1e-2, 1e-3, 1e-4]),
}
LENGTH, HEIGHT = 1e-5, 1e-6
LEVEL = hystrip.Level(LENGTH, HEIGHT)
SIMILAR = tuple(hystrip.Level(LENGTH / 5**i, HEIGHT / 5**i) for i in range(8))
SPEEDS = np.array([0.0, 1e-7, 1e-5, 1e-4, 1e-3, 1e-1, 1e2])


def closure(material):
    return "constitutive" if isinstance(material, hystrip.Prony) else "continuous"


@pytest.mark.parametrize("name", MATERIALS)
def test_the_orbit_of_a_width_is_the_strip_that_the_search_finds(name):
    material = MATERIALS[name]
    phi = np.concatenate((np.linspace(0.02, 0.98, 13), [1e-3, 1 - 1e-3]))
    V, phi = (v.ravel() for v in np.meshgrid(SPEEDS, phi))
    orbits = foundation_of(material).waves(LEVEL.k * V).orbits(2 * np.pi * phi).sure()
    A = 1e-7
    strips = hystrip.solve_strip(material, NONE, l=LENGTH, A=A, D=orbits.D * A, V=V, edge=closure(material))
    size = 1 + orbits.D
    assert np.abs(strips.p_mean / (K * A) - orbits.p_mean).max() <= 1e-11 * size.max()
    assert (np.abs(strips.p_mean / (K * A) - orbits.p_mean) <= 1e-11 * size).all()
    assert (np.abs(strips.tau_mean / (K * A * LEVEL.k * A) - orbits.tau_mean) <= 1e-11 * size).all()
    # an edge is known as well as D is, over the slope of what decides it
    assert np.abs(strips.contact_fraction - phi).max() <= 1e-9


@pytest.mark.parametrize("width", [1e-6, 1e-3, 1.0, 3.0, 6.0, 2 * np.pi - 1e-4])
def test_elastic_strips_are_arcs_of_a_cosine(width):
    """V = 0: contact where the profile is below the plane, ``D = 1 - cos(w/2)``, mean pressure ``(sin(w/2) - (w/2)
    cos(w/2))/pi``, no friction."""
    o = foundation_of(SOFT).waves(np.zeros(1)).orbits(np.array([width]))
    half = width / 2
    exact = 2 * np.sin(half / 2) ** 2
    assert abs(o.D[0] - exact) <= 1e-13 * exact
    assert abs(o.p_mean[0] - (np.sin(half) - half * np.cos(half)) / np.pi) <= 1e-15
    assert abs(o.tau_mean[0]) <= 1e-30


@pytest.mark.parametrize("d", [1e-8, 1e-3, 0.3, 0.999, 1 - 1e-9, 1.0, 1 + 1e-9, 1.2, 3.0, 5.4])
def test_the_nodes_of_a_cell_know_its_area_and_its_mean_amplitude(d):
    """With the strips in complete contact, or out of contact, the weights make up the whole cell."""
    s_sat = np.array([11.0])
    for n in (40, 60):
        span = Span(np.array([d]), s_sat)
        u, s, weight = span.nodes(n)
        complete = np.pi if d <= 1 else 2 * np.arccos(np.sqrt(min(2 * (d - 1) / 9, 1.0)))
        outside = 2 * np.arcsin(np.sqrt(d)) if d < 1 else complete
        assert abs(weight.sum() - outside / np.pi) <= 1e-11
        mean = (outside + np.sin(outside)) / (2 * np.pi)
        assert abs((weight * u).sum() - mean) <= 1e-11
        assert (s > 0).all() and (s <= 11 * (1 + 1e-12)).all() and np.abs(u * (2 - s) - 2 * (1 - d)).max() <= 1e-12


@pytest.mark.parametrize("name", MATERIALS)
def test_means_are_those_of_panels(name):
    """At penetrations below and above the height, up to saturation, against panels over searched strips: within what
    was asked for always, within the estimate in 99 of 100 values."""
    material = MATERIALS[name]
    bounded = []
    V = np.array([0.0, 3e-4, 1e3])
    s_sat = 1 + foundation_of(material).modulus_ratio(LEVEL.k * V)
    one, wide = np.ones(3), s_sat / 2 - 1
    D = HEIGHT * np.concatenate((-0.1 * one, 1e-3 * one, 0.2 * one, 0.97 * one, 1 + 0.05 * wide, 1 + 0.7 * wide, s_sat / 2 + 0.1))
    # where all strips are alike panels see rounding
    known = np.abs(D / HEIGHT - 1) > 1e-12
    V, D = np.tile(V, 7)[known], D[known]
    columns = LevelBatch(material, NONE, LEVEL, closure(material), "unloading", V, D)
    reference = level_means(columns, np.full(D.size, 1e-10))
    scales = np.abs(reference.values) + 1e-3 * columns.scales
    for rtol in (1e-3, 1e-6, 1e-9):
        s = hystrip.solve_level(material, NONE, LEVEL, V=V, D=D, edge=closure(material), rtol=rtol)
        values = np.stack((s.p_mean, s.tau_mean, s.contact_fraction, s.adhesion_fraction), axis=1)
        miss = np.abs(values - reference.values)
        assert (miss <= rtol * scales).all()
        bounded.append(miss <= s.error_estimate.T + reference.errors + 1e-13 * scales)
    assert np.concatenate(bounded).mean() >= 0.99


@pytest.mark.parametrize("name", MATERIALS)
def test_pressure_and_penetration_agree(name):
    material = MATERIALS[name]
    p = K * HEIGHT * np.array([1e-6, 1e-3, 0.1, 0.24, 0.3, 2.0])[:, None]
    given = {"velocity": np.array([1e-5, 1e-3]), "edge": closure(material), "rtol": 1e-9}
    by_pressure = hystrip.solve(material, NONE, SIMILAR[:1], pressure=p, **given)
    again = hystrip.solve(material, NONE, SIMILAR[:1], penetration=by_pressure.penetration, **given)
    assert np.abs(again.pressure - p).max() <= 1e-9 * K * HEIGHT
    floor = 1e-3 * K * HEIGHT**2 / LENGTH
    assert (np.abs(again.tau - by_pressure.tau) <= 2e-9 * (by_pressure.tau + floor)).all()
    assert not by_pressure.pulled_off.any() and (np.diff(by_pressure.penetration, axis=0) > 0).all()


@pytest.mark.parametrize("branch", ["unloading", "loading"])
def test_a_range_without_traction_is_no_adhesion(branch):
    """Curves of loading were parted where a gap of that range would open: work to the last digits only."""
    p = np.linspace(0, 2e3, 41)
    laws = [
        hystrip.friction_law(SOFT, adhesion, LEVEL, V=1e-3, branch=branch, rtol=1e-5)
        for adhesion in (NONE, hystrip.Dugdale(p_0=0.0, delta_0=5e-10))
    ]
    assert np.array_equal(laws[0](p), laws[1](p)) and laws[0].strips == laws[1].strips


def test_nothing_is_carried_without_pressure():
    r = hystrip.solve(SOFT, NONE, SIMILAR[:2], pressure=[-1.0, 0.0, 10.0], velocity=1e-3, rtol=1e-3)
    assert r.pulled_off.tolist() == [True, True, False] and r.tau[2] > 0 and (r.tau[:2] == 0).all()
    r = hystrip.solve(SOFT, NONE, SIMILAR[:2], penetration=[-1e-7, 0.0, 1e-7], velocity=1e-3, rtol=1e-3)
    assert (r.tau[:2] == 0).all() and (r.pressure[:2] == 0).all() and r.tau[2] > 0


def general(monkeypatch, scene, rtol, **options):
    """By searched strips and panels alone."""
    with monkeypatch.context() as patch:
        patch.setattr(hystrip.multilevel, "are_families", lambda *_: False)
        return scene.solve(rtol, **options)


def bare_surfaces(seed, count, levels):
    rng = np.random.default_rng(seed)
    drawn = (surfaces.draw(rng, velocities=2, levels=levels) for _ in iter(int, 1))
    bare = (s for s in drawn if s.adhesion.p_0 == 0)
    return [next(bare) for _ in range(count)]


@pytest.mark.parametrize("i", range(6))
def test_one_level_is_what_panels_give(monkeypatch, i):
    scene = bare_surfaces(5, i + 1, 1)[i]
    reference = general(monkeypatch, scene, 1e-11)
    for rtol in (1e-3, 1e-6, 1e-9):
        r = scene.solve(rtol)
        miss, size = np.abs(r.tau - reference.tau), np.abs(reference.tau) + scene.floor
        assert (miss <= rtol * size).all() and (miss <= r.tau_error + reference.tau_error + 1e-14 * size).all()


@pytest.mark.parametrize("i", range(3))
def test_two_levels_are_what_panels_give(monkeypatch, i):
    scene = bare_surfaces(6, i + 1, 2)[i]
    reference = general(monkeypatch, scene, 1e-5)
    for rtol in (1e-3, 1e-4):
        r = scene.solve(rtol)
        miss, size = np.abs(r.tau - reference.tau), np.abs(reference.tau) + scene.floor
        assert (miss <= rtol * size + reference.tau_error).all()
        assert (miss <= r.tau_error + reference.tau_error).all()
        assert np.abs(r.contact_by_level - reference.contact_by_level).max() <= 1e-3


@pytest.mark.parametrize("name", ["one time", "Kelvin-Voigt"])
def test_a_law_that_ends_too_soon_is_told(monkeypatch, name):
    """Local pressures beyond the end of the law below show in the estimate; where laws reach far enough they do not."""
    given = {"pressure": 1.0, "velocity": 1e-3, "rtol": 1e-5}
    far = hystrip.solve(MATERIALS[name], NONE, SIMILAR[:2], **given)
    monkeypatch.setattr(hystrip.level.nonadhesive.law, "_BETWEEN", 1.3)
    further = hystrip.solve(MATERIALS[name], NONE, SIMILAR[:2], **given)
    assert abs(far.tau - further.tau) <= far.tau_error + further.tau_error
    monkeypatch.setattr(hystrip.level.nonadhesive.law, "_BETWEEN", 0.9)
    monkeypatch.setattr(hystrip.multilevel, "_ATTEMPTS", hystrip.multilevel._ATTEMPTS[:1])
    with pytest.warns(hystrip.ConvergenceWarning):
        near = hystrip.solve(MATERIALS[name], NONE, SIMILAR[:2], **given)
    assert 1e-6 * far.tau < abs(near.tau - far.tau) <= near.tau_error + far.tau_error


def test_levels_that_are_saturated_below_carry_the_closed_form():
    """Level 2 is saturated wherever level 1 is in contact, but for its edges: at large pressures level 1 carries
    contact times tau_sat."""
    tiny = hystrip.Level(1e-7, 1e-12)
    r = hystrip.solve(SOFT, NONE, [LEVEL, tiny], pressure=[10.0, 100.0, 300.0], velocity=3e-4, rtol=1e-6)
    saturated = foundation_of(SOFT).saturation_friction(tiny.l, tiny.h, np.array([3e-4]))[0]
    assert np.allclose(r.tau_by_level[1], r.contact_by_level[0] * saturated, rtol=1e-3)
    assert np.allclose(r.contact_by_level[1], r.contact_by_level[0], rtol=1e-3)


def counted(levels, rtol, V=3e-4):
    return hystrip.solve(SOFT, NONE, levels, pressure=100.0, velocity=V, rtol=rtol).counts["strips_solved"]


def test_strips_of_a_sweep():
    V = np.geomspace(1e-5, 1e-2, 100)
    strips = [counted(SIMILAR[:1], rtol, V) / V.size for rtol in 10.0 ** -np.arange(3, 11)]
    assert strips[0] <= 60 and strips[-1] <= 800
    assert (np.diff(strips) > 0).all()


def test_strips_grow_no_faster_than_levels():
    """Every level over another one adds as much as the first one that does."""
    strips = [counted(SIMILAR[:n], 1e-3) for n in (1, 2, 3, 4, 8)]
    assert (np.diff(strips) > 0).all()
    third, last = strips[2] - strips[1], (strips[4] - strips[3]) / 4
    assert last <= 2 * third and strips[4] <= 6_000
    # and little is added by levels whose friction hardly counts, at a tight tolerance too
    tight = [counted(SIMILAR[:n], 1e-6) for n in (3, 4, 8)]
    assert tight[2] - tight[1] <= 2 * (tight[1] - tight[0]) and tight[2] <= 30_000


@pytest.mark.parametrize("rtol", [1e-3, 1e-8])
def test_a_family_that_goes_further_is_the_same(rtol):
    """Up to the strips asked for, whatever else is in the batch."""
    V, D, top = np.array([1e-4, 1e-2]), HEIGHT * np.array([0.1, 0.4]), np.array([0.6, 2.0]) * HEIGHT
    columns = LevelBatch(SOFT, NONE, LEVEL, "continuous", "unloading", V, top)
    floors = 1e-3 * columns.scales
    friction, accuracy = np.full(2, rtol * floors[1]), np.full(2, 1e-2 * rtol)
    slow = np.zeros(2, int)

    def means(columns, top):
        known = with_family(columns, top, friction[: columns.size], False)
        return level_means(known.at(slow, D), accuracy).values

    near, far = means(columns, top), means(columns.at(slow[:1], top[1:]), top[1:])
    assert (np.abs(near - far) <= rtol * (np.abs(far) + floors)).all()
    with pytest.raises(SolverError, match="beyond its family"):
        means(columns.at(slow[:1], top[1:]), 0.01 * HEIGHT * np.ones(1))


def test_strips_in_closed_form_that_are_not_certified_are_searched_for(monkeypatch):
    scene = {"material": SOFT, "adhesion": NONE, "levels": SIMILAR[:2], "pressure": 100.0, "velocity": 1e-3, "rtol": 1e-4}
    known = hystrip.solve(**scene)
    monkeypatch.setattr(hystrip.orbit.nonadhesive, "_ROUNDING", -1.0)
    found = hystrip.solve(**scene)
    assert found.tau == pytest.approx(known.tau, abs=float(found.tau_error + known.tau_error)) and found.tau != known.tau


@pytest.mark.parametrize("pressure", [1e-8, 1.0])
def test_no_level_is_asked_for_strips_beyond_its_family(monkeypatch, pressure):
    """A low level over steep ones: where these would part a law no pressure reaches."""
    levels = [hystrip.Level(1e-5, 1e-9), hystrip.Level(1e-6, 1e-6), hystrip.Level(3e-7, 1e-6)]
    monkeypatch.setattr(hystrip.level.averages, "average", None)
    r = hystrip.solve(SOFT, NONE, levels, pressure=pressure, velocity=1e-2, rtol=1e-2)
    assert r.converged and r.mu > 0


@pytest.mark.filterwarnings("error::RuntimeWarning", "ignore::hystrip.ConvergenceWarning")
@pytest.mark.parametrize("h", [0.0, 5e-324, 1e-200, HEIGHT])
def test_levels_without_height_and_out_of_contact_are_no_warning(h):
    """Next to nothing is divided by next to nothing, at D below, at and above the plane."""
    level = hystrip.Level(LENGTH, h)
    s = hystrip.solve_level(SOFT, NONE, level, V=1e-3, D=[-1e-6, 0.0, 3e-6], rtol=1e-3)
    assert s.p_mean[0] == 0 and s.p_mean[1] == 0 and s.p_mean[2] == pytest.approx(K * (3e-6 - 0.75 * h), rel=0.05)
    r = hystrip.solve(SOFT, NONE, [LEVEL, level], pressure=100.0, velocity=1e-3, rtol=1e-3)
    assert r.mu > 0 and "nan" not in str(r.summary()).lower()


@pytest.mark.parametrize("material", MATERIALS.values(), ids=MATERIALS)
def test_contact_is_that_at_the_pressure_met(material):
    """Penetrations are looked for to seven digits of the pressure; what is left is taken up by slopes, contact's too."""
    point = {"V": 2e-3, "edge": "constitutive", "rtol": 1e-9}
    at = hystrip.solve_level(material, NONE, LEVEL, D=[2e-7, 4e-7, 1.3e-6], **point)
    found = hystrip.solve_level(material, NONE, LEVEL, pressure=at.p_mean, **point)
    assert np.all(np.abs(found.contact_fraction - at.contact_fraction) <= 1e-9 * (at.contact_fraction + 1e-3))


@pytest.mark.parametrize("material", ["elastic", "far apart"])
@pytest.mark.parametrize("rtol", [1e-2, 1e-6])
def test_next_to_nothing_touches_like_paraboloids_at_rest(material, rtol):
    """At V = 0 crests are paraboloids, ``p = K D^2/(2 pi h)`` and contact ``D/(pi h)``, but for a share ``d/4`` and ``3 d/8`` of
    these, d = D/h. Beside a load whose strips err by more than that, contact is still no less than none and within its
    estimate."""
    p = np.append(10.0 ** np.arange(-18, -7.0), 700.0)
    found = hystrip.solve_level(MATERIALS[material], NONE, LEVEL, V=0.0, pressure=p, edge="constitutive", rtol=rtol)
    contact, least = found.contact_fraction[:-1], np.sqrt(2 * p[:-1] / (np.pi * K * HEIGHT))
    assert contact.min() >= 0
    assert np.all(np.abs(contact - least * (1 + np.pi / 4 * least)) <= found.error_estimate[2, :-1] + 0.1 * least**2)
    assert rtol > 1e-3 or np.abs(contact / least - 1)[4:].max() <= 1e-3


def test_a_layer_next_to_the_valley_shows_in_the_estimate_of_contact():
    """Fast, without T_sigma, contact is tiny but next to the valley, where it becomes complete within 1e-4 of the cell: its
    coefficients pass through zero where those of 32 nodes end."""
    point = {"V": 1e4, "pressure": 712.5, "edge": "constitutive"}
    exact, found = (hystrip.solve_level(MATERIALS["Kelvin-Voigt"], NONE, LEVEL, rtol=rtol, **point) for rtol in (1e-9, 1e-6))
    assert abs(found.contact_fraction - exact.contact_fraction) <= found.error_estimate[2] <= 1e-9


def test_errors_of_a_law_hardly_cancel_where_all_pressures_are_alike():
    """Level 1 is all but flat: level 2 rubs as it does by itself."""
    material, V = hystrip.StandardLinearSolid(K, T_EPS, T_EPS / 23.681215471342103), 1.391699627313431e-05
    levels = [hystrip.Level(1.28e-4, 1.28e-17), hystrip.Level(6.384586179760462e-06, 1e-7)]
    p = hystrip.friction_law(material, NONE, levels[1], V=V, rtol=1e-3).p_sat * np.arange(1, 60) / 60
    both = hystrip.solve(material, NONE, levels, pressure=p, velocity=V, rtol=1e-3)
    alone = hystrip.solve(material, NONE, levels[1:], pressure=p, velocity=V, rtol=1e-8)
    assert both.converged.all() and (both.tau_error <= 1e-3 * both.tau).all()
    assert (np.abs(both.tau - alone.tau) <= both.tau_error + alone.tau_error).all()


@pytest.mark.parametrize("name", MATERIALS)
def test_next_to_saturation_a_level_is_all_but_saturated(name):
    """What is left of strips in partial contact, a part of the surface like the root of the distance to saturation, was known by
    half the digits: friction was up to 5e-8 off."""
    material, V = MATERIALS[name], 1e-3
    how = {"velocity": V, "edge": closure(material), "rtol": 1e-10, "skip": False}
    full = hystrip.solve(material, NONE, LEVEL, penetration=1.0, **{**how, "skip": True})
    p_sat, before = full.p_sat[()], 1 - np.array([0.0, 2.3e-16, 1e-15, 1e-14, 1e-12, 1e-10])
    D_sat = p_sat / K + LEVEL.mean_plane
    by_depth = hystrip.solve(material, NONE, LEVEL, penetration=D_sat * before, **how)
    by_load = hystrip.solve(material, NONE, LEVEL, pressure=p_sat * before, **how)
    for found in (by_depth, by_load):
        assert np.abs(found.tau - full.tau).max() <= 1e-12 * (full.tau + 1e-3 * K * HEIGHT**2 / LENGTH)
        assert np.abs(found.contact_fraction - 1).max() <= 1e-3
        assert (np.diff(found.contact_fraction) <= 4e-16).all()
    assert np.abs(by_depth.pressure - (p_sat - K * D_sat * (1 - before))).max() <= 1e-12 * p_sat

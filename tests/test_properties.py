"""What holds for every strip: order of branches, order in D, scaling, and independence of the company in a batch."""

import numpy as np
import pytest
import scenes
from hypothesis import given, settings
from hypothesis import strategies as st

import hystrip

EDGES, BRANCHES = ("continuous", "constitutive"), ("unloading", "loading")
ARRAYS = ("p_mean", "tau_mean", "contact_fraction", "adhesion_fraction", "regime", "a", "b", "c", "d")
#: fractions are known to about this, except next to a fold, where they still cannot overtake each other
ROUNDING = 1e-9

exponent = lambda low, high: st.floats(low, high, allow_subnormal=False).map(lambda e: 10.0**e)  # noqa: E731
edges, branches = st.sampled_from(EDGES), st.sampled_from(BRANCHES)
few = settings(max_examples=40, deadline=None, derandomize=True, database=None)


@st.composite
def groups(draw):
    """alpha, beta, p_0/(K A), delta_0/A; one strip in eight without adhesion, one in eight without instantaneous response."""
    beta = draw(exponent(-3, 3))
    alpha = draw(st.one_of(*[st.just(0.0)], *[exponent(-6, 0)] * 7)) * beta
    p_0 = draw(st.one_of(st.just(0.0), *[exponent(-3, 2)] * 7))
    return alpha, beta, p_0, draw(exponent(-3, 1))


def depths(alpha, beta, p_0, delta_0, parts):
    """Penetrations over A from below any adhesion (part 0) to above saturation (part 1)."""
    low = -delta_0 - p_0 - beta - 1
    high = 2 + np.hypot(1, beta) / np.hypot(1, alpha)
    return low + (high - low) * np.asarray(parts)


def strip(alpha, beta, p_0, delta_0, D, edge, branch, length=1.0, height=1.0, stiffness=1.0, rate=1.0):
    """A strip from its groups; the last four change the units. ``length`` scales x, ``height`` the profile."""
    material = hystrip.StandardLinearSolid(stiffness, beta / rate, alpha / rate)
    adhesion = hystrip.Dugdale(p_0=p_0 * (stiffness * height), delta_0=delta_0 * height)
    return hystrip.solve_strip(
        material, adhesion, l=2 * np.pi * length, A=height, D=np.asarray(D) * height, V=length * rate, edge=edge, branch=branch
    )


@few
@given(groups(), edges, st.lists(st.floats(0, 1), min_size=8, max_size=8))
def test_unloading_is_at_least_as_engaged_as_loading(group, edge, parts):
    D = depths(*group, parts)
    more, less = (strip(*group, D, edge, branch) for branch in BRANCHES)
    assert (more.contact_fraction + more.adhesion_fraction >= less.contact_fraction + less.adhesion_fraction - ROUNDING).all()


@few
@given(groups(), edges, branches, st.lists(st.floats(0, 1), min_size=12, max_size=12))
def test_the_deeper_the_more_engaged(group, edge, branch, parts):
    s = strip(*group, depths(*group, sorted(parts)), edge, branch)
    assert (np.diff(s.contact_fraction + s.adhesion_fraction) >= -ROUNDING).all()
    assert (np.diff(s.contact_fraction) >= -ROUNDING).all()


@few
@given(groups(), edges, branches, st.lists(st.floats(0, 1), min_size=12, max_size=12))
def test_pressure_rises_by_no_more_than_a_foundation_at_rest_has(group, edge, branch, parts):
    """By ``K`` times the penetration: its mean is that of w, which rises by no more than the profile, and falls where strips are
    engaged."""
    D = depths(*group, sorted(parts))
    s = strip(*group, D, edge, branch)
    assert (np.diff(s.p_mean) <= np.diff(D) + 1e-12 * (1 + np.abs(D).max() + group[2])).all()


@few
@given(groups(), edges, branches, st.floats(0, 1), st.tuples(*[st.integers(-40, 40)] * 4))
def test_units_play_no_part(group, edge, branch, part, powers):
    """Powers of two: the dimensionless groups stay the same to the last bit, and so does the solution in its own units."""
    length, height, stiffness, rate = units = [2.0**power for power in powers]
    D = depths(*group, part)
    s, scaled = strip(*group, D, edge, branch), strip(*group, D, edge, branch, *units)
    pressure = stiffness * height
    assert s.regime == scaled.regime
    for name, unit in {"p_mean": pressure, "tau_mean": pressure * height / length, **dict.fromkeys("abcd", length)}.items():
        found, known = getattr(scaled, name) / unit, getattr(s, name)
        assert found == pytest.approx(known, rel=1e-11, abs=1e-12 * (1 + group[2]), nan_ok=True), name
    for name in ("contact_fraction", "adhesion_fraction"):
        assert getattr(scaled, name) == pytest.approx(getattr(s, name), rel=0, abs=1e-12)


@settings(few, max_examples=6)
@given(st.integers(0, 2**32 - 1), edges, branches, st.sampled_from([scenes.moderate, scenes.extreme]))
def test_a_batch_is_the_same_as_its_strips_one_by_one(seed, edge, branch, draw):
    scene = draw(np.random.default_rng(seed), 25)
    together = scenes.solve(scene, edge, branch)
    backwards = scenes.solve(scenes.take(scene, slice(None, None, -1)), edge, branch)
    for i in range(25):
        alone = scenes.solve(scenes.take(scene, i), edge, branch)
        for name in ARRAYS:
            value = getattr(alone, name)
            for other in (getattr(together, name)[i], getattr(backwards, name)[24 - i]):
                same = value == other if name == "regime" else value.tobytes() == other.tobytes()
                assert same, (name, scenes.line(scene, i, edge, branch))


@pytest.mark.parametrize("draw", [scenes.moderate, scenes.extreme])
@pytest.mark.parametrize("edge", EDGES)
def test_a_large_batch_is_the_same_as_its_parts(edge, draw):
    """Strips next to their folds, for which the search has to be asked, are among so many."""
    n = 1500
    scene = draw(np.random.default_rng(77), n)
    for branch in BRANCHES:
        together = scenes.solve(scene, edge, branch)
        for part in (slice(0, 700), slice(700, 720), slice(720, n)):
            alone = scenes.solve(scenes.take(scene, part), edge, branch)
            for name in ARRAYS:
                assert getattr(alone, name).tobytes() == getattr(together, name)[part].tobytes(), (name, part)

"""Laws of the level below over the contact of strips, against adaptive quadrature of a law known in closed form."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.integrate import quad

import hystrip
from hystrip.level import lower_levels
from hystrip.level.branches import Errors, Piece, graded, rising
from hystrip.level.law import Laws, merged
from hystrip.level.lower_levels import _CANCELLED as CANCELLED
from hystrip.level.lower_levels import LowerLevelLaws
from hystrip.level.segment import segments_of
from hystrip.level.strips import LevelBatch
from hystrip.numerics.chebyshev import coefficients, lobatto

SLS = hystrip.StandardLinearSolid(K=1e9, T_eps=1e-2, T_sigma=1e-4)
WEAK = hystrip.Dugdale(gamma=2.5e-5, delta_0=1e-8)
LARGE = hystrip.Level(l=10e-6, h=1e-6)

#: its pressure steps where contact begins, and may fall from there
NO_RELAXATION = hystrip.StandardLinearSolid(K=1e9, T_eps=1e-2, T_sigma=0.0)
TWO_TIMES = hystrip.Prony(1e9, [5e10, 4e10], [1e-4, 1e-3])
#: pull-off, a jump, and saturation
BREAKS = np.array([-800.0, 2500.0, 8000.0])
SCALES = np.array([1e5, 1.0, 1.0, np.inf])
RTOL = 1e-7


def _lower(share, rest):
    """Like a root where the level lets go."""
    return 1e4 * (1 + np.sqrt(share))


def _upper(share, rest):
    """Like a root on the way to saturation."""
    return 5e4 * (2 - np.sqrt(rest))


def friction(p):
    share = [np.clip((p - low) / (high - low), 0.0, 1.0) for low, high in zip(BREAKS[:-1], BREAKS[1:], strict=True)]
    law = [_lower(share[0], 1 - share[0]), _upper(share[1], 1 - share[1])]
    return np.select([p < BREAKS[0], p < BREAKS[1], p < BREAKS[2]], [0.0, *law], 1e5)


def constant(error):
    """Errors that are the same everywhere, (q,)."""
    return Errors(np.zeros(1), error[None])


def _piece(low, high, law):
    t = lobatto(64)
    share, rest = graded(t), graded(1 - t)
    values = np.stack((low + (high - low) * share, law(share, rest), share, rest), axis=1)
    return Piece(low, high, coefficients(values), constant(np.zeros(4)))


def _laws(segments, saturated, pull_off=BREAKS[0], p_sat=BREAKS[2]):
    return Laws([segments], *np.array([[pull_off], [p_sat]]), np.array([saturated]), np.full(1, np.inf), np.zeros(1, int), True)


def table():
    pieces = [_piece(BREAKS[0], BREAKS[1], _lower), _piece(BREAKS[1], BREAKS[2], _upper)]
    segments = segments_of([part for row in rising(pieces) for part in row], np.full((2, 4), [1e-8, 1e-8, 1e-13, 1e-13]))
    return _laws(segments, [BREAKS[2], 1e5, 1.0, 0.0])


@pytest.fixture(scope="module")
def carry():
    return LowerLevelLaws(table(), RTOL, SCALES)


def _solved(V, material=SLS, edge="continuous", branch="unloading", shares=(0.2, 0.6, 2.0, 10.0)):
    D = np.repeat(np.array(shares) * LARGE.h, 8)
    columns = LevelBatch(material, WEAK, LARGE, edge, branch, np.full(D.size, V), D)
    return columns, np.tile(np.linspace(0.0, 2.8, 8), len(shares))


def _by_quadrature(contact, row):
    p = lambda phase: float(contact.pressure(np.array([row]), np.array([phase]))[0])  # noqa: E731
    top, first, last = contact.top[row], contact.b[row], contact.a[row]
    total = 0.0
    for a, b in ((first, top), (top, last)):
        cuts = [a, b]
        for level in BREAKS:
            if contact.p_peak[row] > level:
                cuts += [float(x[0]) for x in contact.passes(np.array([row]), np.array([level])) if a < x[0] < b]
        cuts = np.unique(cuts)
        for low, high in zip(cuts[:-1], cuts[1:], strict=True):
            # a root at either end becomes smooth
            inner = lambda t, low=low, high=high: friction(p(low + (high - low) * np.sin(t) ** 2)) * np.sin(2 * t)  # noqa: E731
            total += (high - low) * quad(inner, 0.0, np.pi / 2, epsabs=1e-6, epsrel=1e-11, limit=200)[0]
    return total / (2 * np.pi)


@pytest.mark.parametrize("material", [SLS, NO_RELAXATION, TWO_TIMES], ids=["one time", "none", "several"])
@pytest.mark.parametrize("V", [2e-3, 5e-3])
def test_friction_of_a_law_over_a_contact(carry, V, material, monkeypatch):
    columns, theta = _solved(V, material)
    strips = columns.solve(np.arange(columns.size), theta)
    index, contact = strips.touching
    got = carry.over_contact(strips, np.zeros(columns.size, int))
    assert index.size > 12 and contact.full.any() and not contact.full.all()
    assert not np.delete(got, index, axis=0).any()
    for row in range(0, index.size, 3):
        true, (value, *_, error) = _by_quadrature(contact, row), got[index[row]]
        # where the law is constant nothing is missed but rounding
        assert abs(value - true) <= error + 1e-14 * abs(true)
        assert error <= RTOL * (abs(true) + 1e-3 * SCALES[0])
    # where nodes are too few bounds count in full, whatever is left of those of sums that converged
    monkeypatch.setattr(lower_levels, "_NODES", (8,))
    coarse, errors = replace(carry, rtol=0.0), []
    for share in (0.0, 1.0):
        monkeypatch.setattr(lower_levels, "_SUMMED", share)
        errors.append(coarse.over_contact(strips, np.zeros(columns.size, int))[:, -1])
    assert errors[0].max() > 0 and np.array_equal(*errors)


@pytest.mark.parametrize("branch", ["unloading", "loading"])
def test_what_a_strip_carries_does_not_depend_on_those_beside_it(carry, branch):
    columns, theta = _solved(2e-3, branch=branch)
    every = np.arange(columns.size)
    together = carry.over_contact(columns.solve(every, theta), np.zeros(columns.size, int))
    assert np.count_nonzero(together[:, 0]) > 12
    for k in every:
        alone = carry.over_contact(columns.solve(every[k : k + 1], theta[k : k + 1]), np.zeros(1, int))
        assert np.array_equal(alone[0], together[k])


def test_fractions_of_a_law_over_a_contact_are_as_good(carry):
    """Contact and adhesion add up to one wherever the law is between pull-off and saturation, and beyond."""
    columns, theta = _solved(2e-3)
    strips = columns.solve(np.arange(columns.size), theta)
    got = carry.over_contact(strips, np.zeros(columns.size, int))
    index, contact = strips.touching
    over = np.flatnonzero(contact.p_peak > BREAKS[0])
    up, down = contact.passes(over, np.full(over.size, BREAKS[0]))
    wide = np.zeros(index.size)
    wide[over] = (down - up) / (2 * np.pi)
    assert np.allclose(got[index, 1] + got[index, 2], wide, rtol=1e-11, atol=0)


@pytest.mark.parametrize("T_sigma", [0.0, 1e-7])
def test_where_pressure_right_after_entry_passes_a_jump_carried_friction_has_a_kink(T_sigma):
    material, theta, memory = (
        hystrip.StandardLinearSolid(1e9, 1e-2, T_sigma),
        np.linspace(0.05, 3.1, 201),
        LARGE.k * 2e-3 * T_sigma,
    )
    D = np.full(201, 0.4 * LARGE.h)
    columns = LevelBatch(material, WEAK, LARGE, "continuous", "unloading", np.full(201, 2e-3), D)
    index, contact = columns.solve(np.arange(201), theta).touching
    p = contact.entered(np.full(index.size, 5 * memory))
    law = _stepwise(0.5 * (np.nanmin(p) + np.nanmax(p)), 1e4, 6e4)
    columns = replace(columns, carry=LowerLevelLaws(law, RTOL, SCALES), group=np.zeros(201, int))
    (kink,) = columns.kinks(theta, theta[None])
    beside = kink + np.linspace(-0.06, 0.06, 31)
    bends = np.abs(np.diff(columns.evaluate(np.arange(31), beside)[1][:, 4], 2))
    assert abs(bends.argmax() - 14) < 8 and bends.max() > 10 * np.median(bends)
    assert np.isnan(replace(columns, carry=None).kinks(theta, theta[None])).all()


def test_rounding_does_not_decide_which_contacts_pass_a_break_where_all_begin(carry):
    columns, theta = _solved(2e-3)
    strips = columns.solve(np.arange(columns.size), theta)
    index, contact = strips.touching
    begins = np.flatnonzero(np.abs(contact.p_entry / WEAK.p_0 + 1) < 1e-10)
    assert begins.size > 3
    law = replace(carry, laws=SimpleNamespace(breaks=np.array([[np.median(contact.p_entry[begins])]])))
    passed = law.passed(strips, np.zeros(columns.size, int))[0][index[begins]]
    assert np.unique(passed).size == 1


def _stepwise(at, low, high, known_to=(0.0, 0.0)):
    """A law that is ``low`` up to the pressure ``at`` and ``high`` from there to saturation; how well its pressures and frictions
    are said to be known."""
    error = np.array([*known_to, 0.0, 0.0])
    pieces = [
        _piece(BREAKS[0], at, lambda share, rest: low + 0 * share),
        _piece(at, BREAKS[2], lambda share, rest: high + 0 * share),
    ]
    segments = segments_of([part for row in rising(pieces) for part in row], np.full((2, 4), 1e-9))
    segments = [replace(s, errors=constant(error)) for s in segments]
    return _laws(segments, [BREAKS[2], high, 1.0, 0.0])


def _carried(law, V=2e-3, material=SLS, entered=-np.inf):
    columns, theta = _solved(V, material, shares=(0.2, 0.6))
    strips = columns.solve(np.arange(columns.size), theta)
    law = LowerLevelLaws(law, RTOL, SCALES)
    index, contact = strips.touching
    inside = (contact.p_peak > BREAKS[1] + 500) & (contact.p_peak < BREAKS[2]) & (contact.p_entry > entered)
    assert inside.sum() >= 3
    return law.over_contact(strips, np.zeros(columns.size, int))[index[inside]]


def test_what_a_law_was_cut_below_is_in_the_error():
    """Cut so low that nothing of it is left, a law carries nothing as far as is known."""
    whole = _stepwise(BREAKS[1], 0.0, 6e4)
    cut = replace(whole, segments=[[]], pull_off=whole.p_sat, top=BREAKS[1:2])
    one, other = _carried(whole), _carried(cut)
    assert not other[:, 0].any() and (one[:, 0] > 10.0).all()
    assert (one[:, 0] <= 1.001 * other[:, -1]).all()


def test_a_law_that_is_but_cut_is_not_stretched_to_saturation():
    """On a contact next to pull-off a law counts for little, and may end anywhere: cut at 11 Pa as well as saturated at 87 Pa."""
    adhesion = hystrip.Dugdale(p_0=0.365812, delta_0=6.06193e-7)
    levels = [hystrip.Level(l=1e-5, h=6.99935e-7), hystrip.Level(l=3.13101e-6, h=3.66892e-8)]
    options = {"velocity": 2.58436e-4, "branch": "loading", "rtol": 1e-2}
    result = hystrip.solve(NO_RELAXATION, adhesion, levels, pressure=-0.1806204848, **options)
    # to 1e-6
    assert np.abs(result.tau_by_level[1] - 3.0227e-7) <= result.tau_error


def test_segments_of_a_law_are_merged_where_a_smooth_one_is_as_good():
    law, p = _stepwise(BREAKS[1], 2e4, 2.0005e4), np.linspace(BREAKS[0], BREAKS[2], 999)[1:-1]
    for rtol, count in ((1e-2, 1), (1e-3, 2)):
        one = merged(law, np.array([rtol]), np.array([[0.0, 0.0, np.inf, np.inf]]))
        assert len(one.segments[0]) == count
        added = one.segments[0][0].errors.most[1] - law.segments[0][0].errors.most[1]
        moved = np.abs(one(np.zeros(p.size, int), p) - law(np.zeros(p.size, int), p))
        assert moved[:, 1].max() <= added <= 0.2 * rtol * 2e4


def test_a_law_errs_by_what_the_means_next_to_a_pressure_err_by():
    """One mean of a piece is known to 50 Pa, all others to 0.5 Pa: so is friction next to it and elsewhere, and that of a merged
    segment, too."""
    low, high = 0.0, 100.0
    bounds = np.outer((0.5, 50.0, 0.5), np.ones(4))
    piece = replace(_piece(low, high, lambda share, rest: 2.0 + share), errors=Errors(np.array([0.3, 0.4, 0.5]), bounds))
    ((branch,),) = rising([piece])
    assert branch.errors_by_pressure().at == pytest.approx(100 * graded(piece.errors.at), rel=1e-9)
    upper = replace(branch, t_low=0.45, p_low=float(piece.values(np.array([0.45]))[0, 0]))
    assert upper.errors_by_pressure().at == pytest.approx([upper.p_low, upper.p_low, 50.0], rel=1e-9)
    segments = segments_of([branch], np.full((1, 4), 1e-9))
    other = replace(segments[0], p_low=100.0, p_high=200.0, errors=constant(np.full(4, 7.0)))
    one = replace(segments[0], p_high=200.0, errors=segments[0].errors.then(replace(other.errors, at=np.array([100.0]))))
    p = np.array([0.1, branch.errors_by_pressure().at[1], 60.0, 99.0])
    for law, expected in (([segments[0]], 0.5), ([one], np.interp(60.0, [50.0, 100.0], [0.5, 7.0]))):
        laws = _laws(law, [200.0, 3.0, 1.0, 0.0], low, law[-1].p_high)
        _, errors, _ = laws.smooth(np.zeros(4, int), np.zeros(4, int), p[None])
        assert errors[0, 0, :3] == pytest.approx([0.5, 50.0, expected], rel=0.02)
    assert errors[0, 0, 3] == pytest.approx(np.interp(99.0, [50.0, 100.0], [0.5, 7.0]), rel=0.02)


def test_pressures_about_a_smooth_joint_of_a_law_are_alike():
    """Their parameters are at the far end of one segment and at the near end of the next: they span little of either."""
    law = _stepwise(0.0, 2e4, 2e4)
    low, high = (replace(s, inner_high=k == 0, inner_low=k == 1) for k, s in enumerate(law.segments[0]))
    p = np.array([[1e-9 * BREAKS[0]], [1e-9 * BREAKS[2]]])
    _, _, span = replace(law, segments=[[low, high]]).smooth(np.zeros(1, int), np.zeros(1, int), p)
    assert 0 < span[0] < 0.02


def test_a_misplaced_jump_of_a_law_is_in_the_error():
    """A break that is known to 20 Pa may stand 20 Pa further on."""
    one, other = _carried(_stepwise(BREAKS[1], 2e4, 6e4, (20.0, 0.0))), _carried(_stepwise(BREAKS[1] + 20, 2e4, 6e4))
    moved = np.abs(one[:, 0] - other[:, 0])
    assert (moved > 1.0).all() and (moved <= 1.02 * one[:, -1]).all()


def test_a_misplaced_jump_that_is_passed_at_exit_only_is_in_the_error():
    """Where the pressure steps at entry it passes what lies below only as contact ends. Pull-off is half as large a jump."""
    entered, at = -300.0, -400.0
    laws = _stepwise(at, 2e4, 6e4, (20.0, 0.0)), _stepwise(at + 20, 2e4, 6e4)
    one, other = (_carried(law, 8e-3, NO_RELAXATION, entered) for law in laws)
    moved = np.abs(one[:, 0] - other[:, 0])
    assert (moved > 1.0).all() and (moved <= 1.02 * one[:, -1]).all() and (one[:, -1] <= 1.6 * moved).all()


def test_the_error_of_a_law_is_in_the_error_of_what_it_carries():
    """A friction that is known to 500 Pa may be higher by 500 Pa everywhere."""
    one, other = _carried(_stepwise(BREAKS[1], 2e4, 6e4, (0.0, 500.0))), _carried(_stepwise(BREAKS[1], 2.05e4, 6.05e4))
    moved = np.abs(one[:, 0] - other[:, 0])
    assert (moved > 10.0).all() and (moved * CANCELLED <= 1.02 * one[:, -1]).all()


def test_the_error_of_a_law_counts_in_full_where_all_pressures_are_alike():
    """Level 1, in complete contact, presses level 2 with 3.3 to 6.7 kPa, much of a piece of its law; or, all but flat, with 5 kPa
    everywhere: there nothing cancels."""
    law = LowerLevelLaws(_stepwise(BREAKS[1], 2e4, 6e4, (0.0, 500.0)), RTOL, SCALES)

    def known(h):
        level = hystrip.Level(l=10e-6, h=h)
        D = np.full(1, 5e3 / SLS.K + level.mean_plane)
        columns = LevelBatch(SLS, WEAK, level, "continuous", "unloading", np.full(1, 1e-4), D)
        strips = columns.solve(np.zeros(5, int), np.linspace(0.0, 1.0, 5))
        assert strips.touching[1].full.all()
        return law.over_contact(strips, np.zeros(5, int))[:, -1]

    assert (known(1e-12) >= 500 * (1 - 1e-9)).all() and (known(2e-6) < 250).all()


@pytest.mark.parametrize(
    ("T_sigma", "p_0", "delta_0", "wavelength", "p", "V", "rtol", "alone"),
    [
        # level 2 alone, to 1e-9 and 1e-12
        (0.0, 43.15, 2.957e-8, 3.783e-7, -13.95, 1.5103e-4, 1e-3, 3.36881438942),
        (1.54858676e-4, 377.7835, 1.176366975e-9, 3.17245766e-7, 130.0, 5.4955185e-4, 3e-5, 13.86374639092),
    ],
)
def test_errors_of_a_law_hardly_cancel_where_all_pressures_are_alike(T_sigma, p_0, delta_0, wavelength, p, V, rtol, alone):
    """Level 1 is all but flat: level 2 rubs as it does by itself. Were errors to cancel, the second would be ten times off."""
    material, adhesion = hystrip.StandardLinearSolid(1e9, 1e-2, T_sigma), hystrip.Dugdale(p_0=p_0, delta_0=delta_0)
    flat, small = hystrip.Level(20 * wavelength, 2e-12 * wavelength), hystrip.Level(wavelength, 1e-7)
    both = hystrip.solve(material, adhesion, [flat, small], pressure=[p], velocity=V, rtol=rtol)
    assert both.converged and abs(both.tau - alone) <= both.tau_error <= 1e-2


def test_what_is_not_known_of_a_law_s_pressure_is_in_its_friction_where_all_pressures_are_alike():
    """Level 1 is all but flat; next to pull-off a piece of the law knows friction well and pressure hardly: at 1e-6 mu was
    15 times further off than asked for, and 28 times than said."""
    material = hystrip.StandardLinearSolid(K=1e9, T_eps=1e-2, T_sigma=1e-2 / 7.948075624775758)
    adhesion = hystrip.Dugdale(p_0=94.53252706081016, delta_0=3.715280806142321e-10)
    small = hystrip.Level(3.2884997848164375e-07, 1e-7)
    how = {"pressure": [-14.38, -14.4, -13.94, 27.0], "velocity": 4.796594702211885e-05}
    both = hystrip.solve(material, adhesion, [hystrip.Level(6.58e-6, 6.58e-19), small], rtol=1e-6, **how)
    # level 2 alone, at 1e-10
    alone = [0.57495783009826, 0.55661120704103, 0.7513745050937, 7.594618879819]
    assert both.converged.all() and (abs(both.tau - alone) <= both.tau_error).all()


def test_the_error_of_a_law_is_no_less_than_that_of_its_segments():
    law = hystrip.friction_law(SLS, WEAK, hystrip.Level(500e-9, 100e-9), V=1e-3, rtol=1e-3)
    assert law.error_estimate >= max(s.errors.most[1] for s in law._laws.segments[0]) > 0


def test_fractions_of_the_lower_levels_are_no_less_than_zero():
    """All but saturated: the law of the third level, interpolated, gives an adhesion fraction of -3e-16."""
    K = 1369963.4496905643
    material = hystrip.Prony(K, [0.10671975900294922 * K], [3.889377206419892e-06])
    sizes = (5.0876284e-05, 6.704480e-06), (2.5438142e-05, 5.594428e-06), (7.631442695366798e-06, 9.753850800240305e-08)
    levels, adhesion = [hystrip.Level(*size) for size in sizes], hystrip.Dugdale(p_0=4.3731, delta_0=9.06779e-06)
    result = hystrip.solve(
        material, adhesion, levels, pressure=2.16, velocity=0.54878, edge="constitutive", branch="loading", rtol=1e-6
    )
    for fractions in (result.contact_by_level, result.adhesion_by_level):
        assert (fractions >= 0).all() and (fractions <= 1).all()

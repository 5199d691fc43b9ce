"""Pressures next to those at which a law jumps, as at pull-off: a coarse accuracy must not decide the side."""

import numpy as np
import pytest

import hystrip
from hystrip.level.branches import Errors, Piece, branches_of
from hystrip.level.strips import AT_JUMP
from hystrip.level.walk import Walk

K, LEVEL = 1e9, hystrip.Level(l=1e-5, h=1e-6)
SLS, KELVIN_VOIGT, PRONY = hystrip.StandardLinearSolid, hystrip.KelvinVoigt, hystrip.Prony
#: material, p_0, delta_0, V, edge, branch, pressures on either side of a jump, accuracy, and friction there, known to 1e-8 of
#: itself (0: pulled off), by a solution to 1e-8 and by the law that is had from the whole curve; of some no friction was told
CASES = {
    "unloading to a part of the curve that comes back": (
        PRONY(K, [348680209.16754144, 1792146260.405797], [1e-3, 1e-1]), 589.0130472211182, 3.3980009401062786e-07,
        0.04216064865263931, "constitutive", "unloading", -113.57727 + np.array([-1e-4, 1.75e-4]), 1e-2,
        [0.5238608158, 0.2309216086],
    ),
    "pull-off": (
        SLS(K, 1e-2, 1.788234019699544e-06), 2433.448772540675, 3.1790295306435897e-07,
        0.009092285485940288, "continuous", "unloading", -1358.3363 + np.array([-1e-3, 7e-5]), 1e-2,
        [0.0, 17.906573254],
    ),
    "the least pressure that loading comes from": (
        KELVIN_VOIGT(K, 1e-2), 1807.3982292672977, 1.6821666038986525e-06,
        0.0008324823074798203, "continuous", "loading", -1344.06931 + np.array([-1e-2, -1e-3, 6e-5, 1e-3]), 2.5e-3,
        [0.0, 0.0, 72.0205525838, 72.0206559785],
    ),
}  # fmt: skip


@pytest.mark.parametrize("case", CASES)
def test_the_side_of_a_jump_is_told(case):
    material, p_0, delta_0, V, edge, branch, p, rtol, tau = CASES[case]
    adhesion, given = hystrip.Dugdale(p_0=p_0, delta_0=delta_0), {"pressure": p, "velocity": V, "edge": edge, "branch": branch}
    found = hystrip.solve(material, adhesion, LEVEL, rtol=rtol, **given)
    assert found.converged.all() and found.pulled_off.tolist() == [known == 0 for known in tau]
    assert (np.abs(found.tau - tau) <= found.tau_error + 1e-8 * np.array(tau)).all()
    # both sides are among them
    assert np.ptp(tau) > 0.1 * max(tau)


@pytest.mark.parametrize(
    ("T_sigma", "gamma", "delta_0", "l", "h", "at", "friction", "contact"),
    [
        # from 2e-7 of the pressure below to as much above, at 1e-9
        (0.0, 5.86279e-6, 9.43265e-8, 2.49582e-5, 6.43917e-7, {"V": 0.146625}, 0.1731447836, 1.7856071696e-3),
        (1.16883e-6, 9.21103e-10, 3.54872e-10, 2.18417e-6, 1.03317e-7, {"V": 2.86623e-4, "edge": "constitutive"},
         6.8088858965e-3, 1.312819366e-3),
    ],
)  # fmt: skip
def test_an_error_next_to_a_jump_is_what_the_other_side_is_off_by(T_sigma, gamma, delta_0, l, h, at, friction, contact):  # noqa: E741
    """Within 1e-9 of the pressure at which gaps open it is not told whether strips have jumped: the error was all friction of one
    side, which may be less than that of the other."""
    material, adhesion, level = SLS(K, 1e-2, T_sigma), hystrip.Dugdale(gamma=gamma, delta_0=delta_0), hystrip.Level(l, h)
    opens = h - adhesion.p_0 / K - delta_0
    jumps = hystrip.solve_level(material, adhesion, level, D=opens + np.array([-1e-9, 1e-9]) * h, **at)
    p = jumps.p_mean[1] * (1 + np.array([-1e-9, 1e-9]))
    with pytest.warns(hystrip.ConvergenceWarning):
        found = hystrip.solve_level(material, adhesion, level, pressure=p, rtol=1e-8, **at)
    assert not found.converged.any()
    for jump, error in zip((friction, contact), found.error_estimate[1:3], strict=True):
        assert (error >= 0.99 * jump).all() and (error <= 1.1 * jump).all()


def test_where_contact_all_but_closes_averages_tell_which_branch_carries_a_pressure():
    """Some strips come close to losing contact, and mean pressure bends sharply there along y: sums missed 2.5e-5 Pa of it, 200
    times what they said, and a pressure 2.3e-6 Pa below a dip was said to be on it, with 0.3908 Pa of friction."""
    material, adhesion = (
        SLS(K, 1e-2, 1.5122786546939078e-06),
        hystrip.Dugdale(gamma=4.806060960164323e-07, delta_0=9.704358378849795e-09),
    )
    level, at = hystrip.Level(l=1.8708285097690374e-06, h=8.755778795581583e-08), {"V": 0.0052029126350622125}
    found = hystrip.solve_level(material, adhesion, level, pressure=-0.6011017983362583, rtol=2.9e-6, **at)
    there = hystrip.solve_level(material, adhesion, level, D=found.D, rtol=1e-9, **at)
    assert found.converged and there.p_mean == pytest.approx(found.p_mean, abs=1e-8)
    assert found.tau_mean == pytest.approx(there.tau_mean, rel=1e-6)


def _begun(unloading, p, rough):
    """A walk to ``p``, at last known to 1e-8 Pa, whose whole way is being looked at."""
    return Walk(0, unloading, p, rough, 1e-8, [], goal=rough)


@pytest.mark.parametrize("unloading", [True, False])
def test_at_a_jump_itself_either_side_may_be_meant(unloading):
    """A curve from 1 to 2 Pa, known to 1e-8: 1 Pa less 1e-6 is not on it, 1 Pa to the last digits is, or is not."""
    piece = Piece(0.0, 1.0, np.array([[1.5, 1.5], [0.5, 0.5]]), Errors(np.array([0.5]), np.full((1, 2), 1e-8)))
    (row,) = branches_of([[piece]], unloading)
    for p, told, why in ((1 - 1e-6, False, ""), (1 - 1e-9, True, AT_JUMP), (1 + 1e-9, True, AT_JUMP), (1 + 1e-6, True, "")):
        walk = _begun(unloading, p, 1e-8)
        walk.advance([piece], row, False)
        assert (walk.root is not None) is told and walk.undecided == why
        assert not told or walk.root.D == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("left", [[], [(1.0, 2.0)]])
def test_where_its_way_ends_loading_carries_the_pressure(left):
    """A curve from 1 to 2 Pa, known to 1e-8: to 1e-9 Pa above its end, if that is where its way ends, or else behind it."""
    piece = _line(0.0, 1.0, 1e-8)
    walk = Walk(0, False, 2 + 1e-9, 1e-8, 1e-8, left, goal=1e-8)
    walk.advance([piece], branches_of([[piece]], False)[0], False)
    assert walk.arrived is not bool(left) and (left or walk.root.D == pytest.approx(1.0)) and not walk.undecided


@pytest.mark.parametrize("p", [1.998, 2.002])
def test_a_curve_that_may_turn_back_where_branches_meet_is_asked_for_again(p):
    """From 1 Pa up to 2.003 at D = 1, and from 2 Pa on above: either errors of 0.01 Pa, or a turn."""
    known = Errors(np.array([0.5]), np.full((1, 2), 1e-2))
    flags = {"inner_low": True, "inner_high": True}
    pieces = [
        Piece(D, D + 1, np.array([[c] * 2, [half] * 2]), known, **flags) for D, c, half in ((0, 1.5015, 0.5015), (1, 2.5, 0.5))
    ]
    (row,) = branches_of([pieces], True)
    for goal, again in ((1e-2, True), (1e-8, False)):
        walk = _begun(True, p, goal)
        walk.advance(pieces, row, False)
        assert (walk.now is not None) is again and (walk.root is None) is again and not walk.undecided


def _line(low, bottom, error):
    """A piece from ``low`` on, over 1 m and 1 Pa, known to ``error``."""
    return Piece(low, low + 1, np.array([[bottom + 0.5] * 2, [0.5] * 2]), Errors(np.array([0.5]), np.full((1, 2), error)))


def test_a_pressure_that_may_be_on_the_last_of_several_branches_is_asked_for_again():
    """From 1 Pa up and, after a jump, from 3 up: 0.995 Pa, where 0.01 Pa are not known."""
    walk, pieces = _begun(True, 0.995, 1e-2), [_line(0.0, 1.0, 1e-6), _line(1.0, 3.0, 1e-6)]
    walk.advance(pieces, branches_of([pieces], True)[0], False)
    assert walk.root is None and walk.now[:2].ravel().tolist() == [0.0, 1.0] and walk.goal == pytest.approx(3e-4)


@pytest.mark.parametrize(("gap", "why"), [(1e-10, ""), (1e-8, AT_JUMP)])
def test_across_what_is_left_out_as_narrow_a_curve_goes_on(gap, why):
    """Two branches meet at 2 Pa but for 1e-9 Pa, beside a part of the way that was not looked at."""
    walk, pieces = (
        Walk(0, True, 2 + 0.5e-9, 1e-8, 1e-8, [], narrow=1e-9, goal=1e-8),
        [_line(0.0, 1.0, 1e-8), _line(1 + gap, 2 + 1e-9, 1e-8)],
    )
    walk.advance(pieces, branches_of([pieces], True)[0], False)
    assert walk.undecided == why and walk.root.D == pytest.approx(1.0)


@pytest.mark.parametrize(("bottom", "again"), [(1.006, True), (1.1, False)])
def test_a_later_part_is_known_as_well_as_its_pressures_ask_for(bottom, again):
    """One part ends 1e-6 Pa above the pressure. The next one, rough at first, counts for nothing unless it errs by that much."""
    walk = Walk(0, True, 1 - 1e-6, 1e-2, 1e-8, [(-1.0, 0.0)])
    walk.goal, first = 1e-8, _line(0.0, 1.0, 1e-9)
    walk.advance([first], branches_of([[first]], True)[0], False)
    assert walk.now is None and not walk.arrived
    walk.waiting, walk.goal = [], walk.rough
    behind = _line(-1.0, bottom, 1e-6)
    walk.advance([behind], branches_of([[first, behind]], True)[0], False)
    assert (walk.now is not None) is again and walk.root is None
    assert not again or (walk.now[:2].ravel().tolist() == [-1.0, 0.0] and walk.goal == pytest.approx(3e-4))


@pytest.mark.parametrize("unloading", [True, False])
@pytest.mark.parametrize(("off", "met"), [(0.0, True), (0.01, False)])
def test_what_lies_behind_where_a_pressure_is_met_waits_until_it_is_not(unloading, off, met):
    """A curve jumps from 2 - 0.0025 Pa at D = 1 to 2 + 0.0025 Pa at D = 1.5. Next to that end of the piece that is met first,
    known to 0.01 Pa and ``off`` by as much, or not, either piece may carry a pressure."""
    side = 1 if unloading else -1

    def piece(D, p, error):
        known = Errors(np.array([0.5]), np.full((1, 2), error))
        return Piece(D, D + 1, np.array([[p + 0.5 * np.sign(p - 2)] * 2, [0.5, 0.5]]), known)

    first, behind = (piece(0.75 + 0.75 * at, 2 + 0.0025 * at, 1e-2) for at in (side, -side))
    walk, found = _begun(unloading, 2 + 0.005 * side, 1e-2), [first, behind]
    for one in (first, behind) if not met else (first,):
        walk.advance(found, branches_of([[*walk.known, *found]], unloading)[0], False)
        assert walk.root is None and walk.now[:2].ravel().tolist() == [one.low, one.high]
        found = [piece(first.low, 2 + (0.0025 + off) * side, 1e-6)]
    if met:
        walk.advance(found, branches_of([[*walk.known, *found]], unloading)[0], False)
        assert walk.now is None and first.low < walk.root.D < first.high


def test_a_pressure_that_is_not_told_from_a_turn_is_not_met_there():
    """Next to pull-off an average that errs by more than the pressure misses sent the search to the turn, from where it did not
    come back."""
    material = hystrip.StandardLinearSolid(K=1e9, T_eps=1e-2, T_sigma=1.5658004136844694e-05)
    of = material, hystrip.Dugdale(gamma=3.8780701487999996e-08, delta_0=1.12176e-08), hystrip.Level(l=1e-5, h=6.50664e-8)
    options = {"V": 3.31875e-5, "edge": "constitutive", "pressure": -0.19795806322507023}
    level = hystrip.solve_level(*of, **options, rtol=1e-3)
    # to 1e-8
    assert abs(level.tau_mean - 4.2952077102e-4) <= level.error_estimate[1]

"""The benchmark's competitors solve the same problem, so that their errors are theirs; and its arithmetic of ratios."""

import sys
from pathlib import Path

import numpy as np
import pytest

import hystrip

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "tools"))

from peers import equal_strips, march, scripted  # noqa: E402
from timing import report  # noqa: E402
from timing.claims import time_at  # noqa: E402
from timing.scene import Row, Scene  # noqa: E402

MATERIAL = hystrip.StandardLinearSolid(K=1e9, T_eps=1e-2, T_sigma=1e-4)
WEAK, NONE = hystrip.Dugdale(gamma=2.5e-5, delta_0=1e-8), hystrip.Dugdale(gamma=0)
SMALL = hystrip.Level(l=500e-9, h=100e-9)
V = 7e-4


@pytest.mark.parametrize("adhesion", [WEAK, NONE], ids=["adhesive", "bare"])
def test_the_march_ends_on_the_unloading_orbits(adhesion):
    D, strips = 2e-8, 4
    exact = hystrip.solve_level(MATERIAL, adhesion, SMALL, V=V, D=D, strips=strips)
    tau, unsettled = march.friction(MATERIAL, adhesion, SMALL, D, V, strips, 1e-7)
    assert unsettled == 0 and 0 < exact.contact_fraction < 1
    assert tau == pytest.approx(float(exact.tau_mean), rel=1e-6)


@pytest.mark.parametrize("adhesion", [WEAK, NONE], ids=["adhesive", "bare"])
def test_the_script_takes_no_root_that_is_no_solution(adhesion):
    """Each strip started from the one before, downwards as for a table: the way that led it into the valley."""
    theta = np.pi * (np.arange(15) + 0.5) / 15
    script = scripted.Script(MATERIAL, adhesion, SMALL, V)
    for D in np.linspace(3e-7, -5e-8, 12):
        means = np.array([script.strip(t, D)[:2] for t in theta])
        s = hystrip.solve_strip(MATERIAL, adhesion, l=SMALL.l, A=SMALL.amplitude(theta), D=D - SMALL.drop(theta), V=V)
        scale = (MATERIAL.K * SMALL.h + adhesion.p_0) * np.array([1, SMALL.h / SMALL.l])
        assert (np.abs(means - np.transpose([s.p_mean, s.tau_mean])) <= 1e-4 * scale).all()  # its trapezoid
    assert script.failures == 0


def test_script_and_kernels_make_the_same_of_the_same_strips():
    """Two levels, laws, the second term of Eq. 13: written twice, with the same strips."""
    levels = [hystrip.Level(l=10e-6, h=1e-6), SMALL]
    by_kernels = equal_strips.friction(MATERIAL, WEAK, levels, 100.0, 5e-2, 20, 60)
    by_script, strips, failures = scripted.friction(MATERIAL, WEAK, levels, 100.0, 5e-2, 20, 60)
    assert strips > 0 and failures == 0
    assert by_script == pytest.approx(by_kernels, rel=2e-2)


def _row(seconds, error):
    return Row("scene", "method", "setting", 1, 1, seconds, error)


@pytest.mark.parametrize("points", [1, 4, 5, 10, 100, 200, None])
def test_every_sample_has_points_at_which_errors_are_looked_at(points):
    scene = Scene("scene", MATERIAL, (WEAK,), (SMALL,), np.zeros(200), np.arange(200.0), 1e-6, (), looked_at=5)
    index, looked_at = scene.spread(points), scene.spread(scene.looked_at)
    assert np.isin(looked_at, index).sum() == min(points or 5, 5) and np.unique(index).size == index.size >= min(
        points or 200, 200
    )


def test_time_at_an_error():
    rows = [_row(1.0, 1e-1), _row(100.0, 1e-3), _row(50.0, 1e-1), _row(10.0, 1e-2)]
    assert time_at(rows, 10**-1.5) == pytest.approx((10**0.5, False))
    assert time_at(rows, 1e-5) == pytest.approx((1e4, True))
    assert time_at(rows[:1], 1e-5) is None


def test_only_what_stands_between_the_marks_is_replaced(tmp_path):
    readme = tmp_path / "README.md"
    readme.write_text(f"before\n{report.BEGIN}\nold\n{report.END}\nafter\n")
    report.put("new\n", readme)
    assert readme.read_text() == f"before\n{report.BEGIN}\nnew\n{report.END}\nafter\n"
    readme.write_text("no marks\n")
    with pytest.raises(SystemExit, match="missing"):
        report.put("new\n", readme)
    assert readme.read_text() == "no marks\n"


def test_a_method_not_done_in_time_is_said_to_be():
    rows = [_row(2e-3, 1e-5), Row("scene", "other", "slow", 1, 0, float("nan"), float("nan"), 0, 0)]
    text = report.table(rows)
    assert "| scene (1) | method | 1 | 2 | 2 | 2 |  |  |  | 1e-05 |  |" in text and "none done in time" in text

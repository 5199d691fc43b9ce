"""The margin of saturated adhesion has the sign that the regimes say, and a zero where they change."""

import numpy as np
import scenes
from scipy.optimize import brentq

import hystrip
from hystrip.solver import foundation_of

ENGAGED = ("c", "ac", "a")


def margin(scene):
    material = hystrip.StandardLinearSolid(scene["K"], scene["T_eps"], scene["T_sigma"])
    flat = foundation_of(material).flat(scene["l"].shape)
    return flat.cling_margin(*(scene[name] for name in ("l", "A", "D", "V", "p_0", "delta_0")))


def test_sign_is_that_of_the_regime():
    for draw in (scenes.extreme, scenes.moderate):
        scene = draw(np.random.default_rng(11), 4000)
        found = margin(scene)
        adhesive = scene["p_0"] > 0
        assert np.all(np.isnan(found[~adhesive]))
        known = adhesive & np.isfinite(found)
        assert known.sum() > 0.95 * adhesive.sum()
        engaged = np.isin(scenes.solve(scene, "continuous", "unloading").regime, ENGAGED)
        scale = scene["A"] + np.abs(scene["D"]) + scene["delta_0"] + scene["p_0"] / scene["K"]
        clear = known & (np.abs(found) > 1e-12 * scale)
        assert np.array_equal(found[clear] > 0, engaged[clear])
        assert 200 < engaged[clear].sum() < clear.sum() - 200


def test_zero_is_where_the_regime_changes():
    material, adhesion = hystrip.StandardLinearSolid(1e9, 1e-2, 1e-4), hystrip.Dugdale(p_0=2e3, delta_0=1e-8)
    strip = {"l": 5e-7, "A": 5e-8, "V": 1e-3}
    one = {name: np.array([value]) for name, value in strip.items()}
    at = lambda D: foundation_of(material).cling_margin(one["l"], one["A"], np.array([D]), one["V"], 2e3, 1e-8)[0]  # noqa: E731
    regime = lambda D: hystrip.solve_strip(material, adhesion, D=D, **strip).regime[()]  # noqa: E731
    low, high = 0.0, 4e-6
    assert (regime(low), regime(high)) == ("acaf", "c")
    change = brentq(at, low, high, xtol=1e-22)
    assert (regime(change * (1 - 1e-9)), regime(change * (1 + 1e-9))) == ("acaf", "ac")

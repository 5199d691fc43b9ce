"""The 60 strips of the reference: every regime, both closures and branches, many with coexisting orbits.

Natural scales: ``K A + p_0`` for the mean pressure, ``k A`` times that for friction.
"""

import json
from pathlib import Path

import numpy as np
import pytest

import hystrip

STRIPS = json.loads((Path(__file__).parent / "data" / "strips.json").read_text())


@pytest.mark.parametrize("case", STRIPS, ids=[f"{i}-{c['sequence']}-{c['edge']}-{c['branch']}" for i, c in enumerate(STRIPS)])
def test_strip(case):
    material = hystrip.StandardLinearSolid(case["K"], case["T_eps"], case["T_sigma"])
    adhesion = hystrip.Dugdale(p_0=case["p_0"], delta_0=case["delta_0"])
    inputs = {name: case[name] for name in ("l", "A", "D", "V", "edge", "branch")}
    s = hystrip.solve_strip(material, adhesion, **inputs)
    scale = case["K"] * case["A"] + case["p_0"]
    slope = 2 * np.pi / case["l"] * case["A"]
    assert s.regime == case["sequence"]
    assert abs(s.p_mean - case["p_mean"]) <= 1e-8 * (abs(case["p_mean"]) + 1e-3 * scale)
    assert abs(s.tau_mean - case["tau_mean"]) <= 1e-8 * (abs(case["tau_mean"]) + 1e-3 * slope * scale)
    assert abs(s.contact_fraction - case["contact_fraction"]) <= 1e-8
    assert abs(s.adhesion_fraction - case["adhesion_fraction"]) <= 1e-8


def test_the_reference_has_every_regime_and_coexisting_orbits():
    assert len(STRIPS) == 60
    assert {case["sequence"] for case in STRIPS} == {"c", "ac", "acaf", "afc", "cf", "af", "a", "f"}
    assert {(case["edge"], case["branch"]) for case in STRIPS} == {
        (edge, branch) for edge in ("continuous", "constitutive") for branch in ("unloading", "loading")
    }
    assert sum(len(case["coexisting"]) > 1 for case in STRIPS) >= 10

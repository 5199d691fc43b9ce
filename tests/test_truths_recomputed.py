"""A few dozen of the stored truths, and of the stored marches, computed again with the oracle, to the last stored digit."""

import json

import marches
import numpy as np
import pytest
from oracle import march
from truths import columns

ROWS = np.random.default_rng(3).choice(columns()["l"].size, 40, replace=False)


@pytest.mark.parametrize("row", ROWS)
def test_truth(row):
    t = {name: values[row] for name, values in columns().items()}
    inputs = {name: float(t[name]) for name in ("T_eps", "T_sigma", "V", "l", "D", "p_0", "delta_0")}
    found = march.solve_si(K=1, A=1, **inputs, edge=t["edge"], branch=t["branch"])
    assert found.sequence == t["sequence"]
    for name in ("p_mean", "tau_mean", "contact_fraction", "adhesion_fraction"):
        assert float(getattr(found, name)) == t[name]
    for name in "abcd":
        assert float(found.edges.get(name, np.nan)) == pytest.approx(t[name], rel=0, abs=0, nan_ok=True)


#: by number of times: of fifteen one takes as long as all others
MARCHES = sorted(marches.STORED, key=len)[:: len(marches.STORED) // 15]


@pytest.mark.parametrize("of", MARCHES, ids=range(len(MARCHES)))
def test_march(of):
    assert marches.computed(*json.loads(of)) == marches.STORED[of]

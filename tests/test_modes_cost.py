"""Work on a strip by the number of relaxation times; ``tools/modes_cost.py`` measures the time."""

import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parents[1] / "tools"))

import modes_cost


@pytest.mark.parametrize("wide", [False, True], ids=["near 1", "wide"])
def test_steps_grow_slower_than_the_number_of_times(wide):
    """Each costs in proportion to the number of times: the march may not need many more of them as well."""
    one, two, three = (modes_cost.cost(n, wide, 120, times=1) for n in (1, 2, 3))
    assert one[2] == two[2] == three[2] == 0
    assert one[1] < two[1] < 2 * one[1] and two[1] < three[1] < 3 * one[1]

"""Changes of a code along a line: found by halving, by a height that passes zero, or by an equation."""

import numpy as np
import pytest

from hystrip.level.changes import Changes, locate_changes


class Line:
    """Codes 0, 1, ... between the ``places``, and as height how far x is above the first of them; counts what is asked."""

    def __init__(self, *places, height=True):
        self.places, self.height, self.asked = np.array(places), height, 0

    def __call__(self, line, x):
        self.asked += x.size
        codes = np.searchsorted(self.places, x)
        heights = np.tanh(3 * (x - self.places[0]))[:, None] if self.height else np.empty((x.size, 0))
        return codes, heights, np.zeros((x.size, 4)), x[:, None] ** 2


def _none(changes):
    return np.empty(0, int), np.empty(0)


def _located(line, width, equation=_none, checked=False):
    ends = [v[None] for v in line(np.zeros(2, int), np.array([0.0, 1.0]))]
    line.asked = 0
    return locate_changes(line, equation, Changes(np.zeros(1, int), np.zeros(1), np.ones(1), *ends), np.full(1, width), checked)


@pytest.mark.parametrize("place", [1e-3, 0.1, 0.37, 0.999])
@pytest.mark.parametrize("height", [True, False])
def test_a_change_is_bracketed(place, height):
    line = Line(place, height=height)
    found, halved = _located(line, 1e-12)
    assert found.low[0] <= place <= found.high[0] and found.high[0] - found.low[0] <= 1e-12
    assert found.codes.tolist() == [[0, 1]] and halved == line.asked
    # what is known at the ends belongs to them
    assert np.array_equal(found.values[0, :, 0], [found.low[0] ** 2, found.high[0] ** 2])
    assert line.asked < 20 if height else line.asked <= 41


def test_two_changes_in_one_bracket_are_told_apart():
    found, _ = _located(Line(0.3, 0.3001), 1e-9)
    assert found.codes.tolist() == [[0, 1], [1, 2]]
    assert np.allclose(found.low, [0.3, 0.3001], atol=2e-9) and (found.low[1:] >= found.high[:-1]).all()


def test_what_an_equation_tells_is_not_asked():
    line = Line(0.37)
    found, halved = _located(line, 1e-12, lambda changes: (np.arange(changes.size), np.full(changes.size, 0.37)))
    assert found.low[0] == found.high[0] == 0.37 and halved == line.asked == 0
    assert found.codes.tolist() == [[0, 1]]


def test_neighbouring_numbers_end_it():
    found, _ = _located(Line(0.37, height=False), 0.0)
    assert found.high[0] - found.low[0] <= 4 * np.finfo(float).eps


def test_equations_may_tell_of_several_places_in_one_bracket():
    line = Line(0.3, 0.6)
    found, _ = _located(line, 1e-12, lambda changes: (np.zeros(2, int), np.array([0.6, 0.3])))
    assert line.asked == 0 and found.low.tolist() == found.high.tolist() == [0.3, 0.6]


def test_a_third_regime_next_to_what_an_equation_tells_is_found():
    line = Line(0.3, 0.3001)
    told = lambda changes: (np.flatnonzero(changes.high - changes.low > 0.5), np.full(1, 0.3001))  # noqa: E731
    found, _ = _located(line, 1e-9, told, checked=True)
    assert found.codes.tolist() == [[0, 1], [1, 2]]
    assert np.allclose(found.low, [0.3, 0.3001], atol=2e-9)

"""Changes of a code along a line: found by dividing, or by an equation."""

import numpy as np
import pytest

from hystrip.level.changes import Changes, locate_changes


class Line:
    """Codes 0, 1, ... between the ``places``; counts what is asked."""

    def __init__(self, *places):
        self.places, self.asked = np.array(places), 0

    def __call__(self, line, x):
        self.asked += x.size
        codes = np.searchsorted(self.places, x)
        return codes, x[:, None] ** 2, np.empty((x.size, 0)), np.zeros((x.size, 4))


def _none(changes):
    return np.empty(0, int), np.empty(0), np.empty(0, bool)


def _sure(count):
    return np.zeros(count, bool)


def _located(line, width, equation=_none):
    ends = [v[None] for v in line(np.zeros(2, int), np.array([0.0, 1.0]))]
    line.asked = 0
    return locate_changes(line, equation, Changes(np.zeros(1), np.ones(1), np.zeros(1, int), *ends), np.full(1, width))


@pytest.mark.parametrize("place", [1e-3, 0.1, 0.37, 0.999])
def test_a_change_is_bracketed(place):
    line = Line(place)
    found, halved = _located(line, 1e-12)
    assert found.low[0] <= place <= found.high[0] and found.high[0] - found.low[0] <= 1e-12
    assert found.codes.tolist() == [[0, 1]] and halved == line.asked
    # what is known at the ends belongs to them
    assert np.array_equal(found.values[0, :, 0], [found.low[0] * found.low[0], found.high[0] * found.high[0]])
    # a third each time: 3^26 > 1e12
    assert line.asked <= 2 * 26


def test_two_changes_in_one_bracket_are_told_apart():
    found, _ = _located(Line(0.3, 0.3001), 1e-9)
    assert found.codes.tolist() == [[0, 1], [1, 2]]
    assert np.allclose(found.low, [0.3, 0.3001], atol=2e-9) and (found.low[1:] >= found.high[:-1]).all()


def test_what_an_equation_tells_is_not_asked():
    line = Line(0.37)
    found, halved = _located(
        line, 1e-12, lambda changes: (np.arange(changes.size), np.full(changes.size, 0.37), _sure(changes.size))
    )
    assert found.low[0] == found.high[0] == 0.37 and halved == line.asked == 0
    assert found.codes.tolist() == [[0, 1]]


def test_neighbouring_numbers_end_it():
    found, _ = _located(Line(0.37), 0.0)
    assert found.high[0] - found.low[0] <= 4 * np.finfo(float).eps


def test_equations_may_tell_of_several_places_in_one_bracket():
    line = Line(0.3, 0.6)
    found, _ = _located(line, 1e-12, lambda changes: (np.zeros(2, int), np.array([0.6, 0.3]), _sure(2)))
    assert line.asked == 0 and found.low.tolist() == found.high.tolist() == [0.3, 0.6]


def test_a_place_beyond_the_bracket_is_its_end():
    # rounding of an equation next to a crest; the panel that ends there would else come back as wide as it was
    for place in (-1e-11, 1 + 1e-11):
        equation = lambda changes, place=place: (np.arange(changes.size), np.full(changes.size, place), _sure(changes.size))  # noqa: E731
        found, _ = _located(Line(0.99), 1e-12, equation)
        assert found.low[0] == found.high[0] == round(place)


def test_a_third_regime_next_to_what_an_equation_tells_is_found():
    line = Line(0.3, 0.3001)

    def told(changes):
        wide = np.flatnonzero(changes.high - changes.low > 0.5)
        return wide, np.full(wide.size, 0.3001), np.ones(wide.size, bool)

    found, _ = _located(line, 1e-9, told)
    assert found.codes.tolist() == [[0, 1], [1, 2]]
    assert np.allclose(found.low, [0.3, 0.3001], atol=2e-9)

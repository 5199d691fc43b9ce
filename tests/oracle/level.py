"""Means of a level from strips that are marched from event to event, summed over y by a rule of its own.

Nothing is shared with the library: transitions of the sequence of zones are bisected, and each part between two of them is summed
by Gauss and Legendre over ``theta = middle - half cos(pi t)``, which takes the square roots at its ends.
"""

from dataclasses import dataclass

import numpy as np

from .march import solve_si

#: strips at which sequences are looked at first, and digits that they are marched with
_LOOKS, DIGITS = 48, 30
#: nodes of each part, doubled until its sum stays the same to the accuracy asked
_NODES = (12, 24, 48, 96)


@dataclass(frozen=True)
class LevelMeans:
    """Mean pressure and friction, Pa, contact and adhesion fraction, (4,), and how much they changed when nodes were doubled
    last."""

    values: np.ndarray
    change: np.ndarray


def level_means(K, T_eps, T_sigma, V, l, h, D, p_0, delta_0, edge, branch, rtol):  # noqa: E741
    """Means at the penetration ``D`` (m) of the level's crests, to ``rtol`` of ``|value| + 1e-3 scale`` each. Raises
    ``ArithmeticError`` if a strip, or the sum over a part, cannot be had."""
    solved = {}

    def strip(theta):
        if theta not in solved:
            A, drop = h / 4 * (1 + np.cos(theta)), h / 2 * (1 - np.cos(theta))
            found = solve_si(K, T_eps, T_sigma, V, l, A, D - drop, p_0, delta_0, edge, branch, DIGITS)
            means = (found.p_mean, found.tau_mean, found.contact_fraction, found.adhesion_fraction)
            solved[theta] = found.sequence, np.array([float(v) for v in means])
        return solved[theta]

    pressure = K * h + p_0
    floor = 1e-3 * np.array((pressure, pressure * h / l, 1.0, 1.0))
    total, change = np.zeros(4), np.zeros(4)
    # so close that what lies between a transition and its bracket does not tell
    for low, high in _parts(strip, int(np.ceil(np.log2(1 / rtol))) + 4):
        last = None
        for n in _NODES:
            x, weights = np.polynomial.legendre.leggauss(n)
            t = 0.5 * (1 + x)
            theta = 0.5 * (low + high) - 0.5 * (high - low) * np.cos(np.pi * t)
            slope = 0.5 * np.pi * (high - low) * np.sin(np.pi * t)
            now = (0.5 * weights * slope) @ np.array([strip(float(v))[1] for v in theta]) / np.pi
            moved = np.full(4, np.inf) if last is None else np.abs(now - last)
            if (moved <= 0.1 * rtol * (np.abs(now) + floor)).all():
                break
            last = now
        else:
            raise ArithmeticError(f"the strips between {low} and {high} could not be summed to {rtol:g}: {moved}")
        total, change = total + now, change + moved
    return LevelMeans(total, change)


def _parts(strip, halvings):
    """Intervals of theta in which all strips seen have one sequence of zones; transitions are bracketed by so many halvings."""
    looks = [float(v) for v in np.pi * (np.arange(_LOOKS) + 0.5) / _LOOKS]
    ends = [0.0]
    for low, high in zip(looks[:-1], looks[1:], strict=True):
        ends += _transitions(strip, low, high, halvings)
    return list(zip(ends, [*ends[1:], float(np.pi)], strict=True))


def _transitions(strip, low, high, halvings):
    if strip(low)[0] == strip(high)[0]:
        return []
    middle = 0.5 * (low + high)
    if halvings == 0:
        return [middle]
    return _transitions(strip, low, middle, halvings - 1) + _transitions(strip, middle, high, halvings - 1)

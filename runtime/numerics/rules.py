"""Sums by rules with more and more nodes, for many integrals at once, with errors extrapolated from their changes.

Of a sequence whose changes fall by a ratio r the last member misses its last change times r/(1 - r): Aitken's process (Brezinski
& Redivo Zaglia, "Extrapolation Methods", 1991, section 2.3). Rules grow by half or more, so sums that converge geometrically do
better than that, and those that converge by a power of the nodes do as well. A change may be small by chance, as where an
integrand has a layer or a kink; r is therefore the largest over all quantities, which share their singularities.
"""

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

#: how much more is feared than the last change times r: 1/(1 - r) up to r = 2/3
_SAFE = 3.0
#: r of a first change, and the share of the roughest quantity's first change, both relative, that every other one is taken to
#: have at least
_UNKNOWN, _SHARED = 0.5, 0.1


def by_rules(
    sums: Callable[[np.ndarray, Any], np.ndarray],
    rules: Sequence,
    goal: np.ndarray,
    fastest: float,
    at_once: bool = False,
    relative: np.ndarray | float = 0.0,
) -> tuple[np.ndarray, np.ndarray]:
    """Sums (m, q) by as many of the ``rules`` as it takes for an error of ``goal + relative |sum|``, (m, q) and (m, 1), and the
    errors (m, q): from the third rule on, or from the second ``at_once``. No r less than ``fastest`` is believed.

    ``sums(rows, rule)`` returns those of the rows by a rule."""
    left, (out, errors) = np.arange(len(goal)), np.zeros((2, *goal.shape))
    relative = np.broadcast_to(relative, (len(goal), 1))
    old = change = None
    for rule in rules:
        if not left.size:
            break
        new = sums(left, rule)
        old, last, change = new, change, None if old is None else np.abs(new - old)
        miss = _left(new, change, last, fastest, at_once)
        done = (miss <= goal[left] + relative[left] * np.abs(new)).all(axis=1) | (rule == rules[-1])
        out[left[done]], errors[left[done]] = new[done], miss[done]
        left, old, change = left[~done], old[~done], None if change is None else change[~done]
    return out, errors


def extrapolated(change: np.ndarray, ratio: np.ndarray) -> np.ndarray:
    """What sums miss whose last ``change`` is this and in this ``ratio`` to the one before."""
    return _SAFE * change * ratio


def _left(sums, change, last, fastest: float, at_once: bool):
    """Error of ``sums`` (m, q) whose last ``change`` and the one before, ``last``, are these, or None."""
    if last is not None:
        change = np.maximum(change, fastest * last)
        ratio = np.divide(change, last, out=np.ones_like(change), where=last > change)
        return extrapolated(change, ratio.max(axis=1, keepdims=True))
    if change is None or not at_once:
        return np.full_like(sums, np.inf)
    # alone it may be small by chance: all quantities change where one does
    roughest = np.divide(change, np.abs(sums), out=np.zeros_like(change), where=sums != 0).max(axis=1, keepdims=True)
    return extrapolated(np.maximum(change, _SHARED * roughest * np.abs(sums)), _UNKNOWN)

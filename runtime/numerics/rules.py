"""Sums by rules with more and more nodes, for many integrals at once, with errors from their changes."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

#: the fastest that changes are believed to fall
_FASTEST = 0.25
#: share of the roughest quantity's first change, both relative, that every other one is taken to have at least
_SHARED = 0.1


class Changes:
    """What sums by finer and finer rules change, and so what the last one may miss. A change that is small by chance,
    as they are where an integrand has a layer or a kink, is not believed; ``sure``: how much more than a change is
    feared; ``pace``: no more than this is believed to be gained from rule to rule; ``fastest``: nor are changes to
    fall faster."""

    def __init__(self, sure: float, at_once: bool = False, pace: float = 1.0, fastest: float = _FASTEST):
        self.sure, self.at_once, self.pace, self.fastest = sure, at_once, pace, fastest
        self.sums, self.change = None, None

    def after(self, sums: np.ndarray) -> np.ndarray:
        """Error of the ``sums`` (m, q) by the next rule; of the first change nothing is concluded, unless it is
        believed ``at_once``."""
        if self.sums is None:
            self.sums = sums
            return np.full_like(sums, np.inf)
        change, last = np.abs(sums - self.sums), self.change
        self.sums, self.change = sums, change
        if last is None and self.at_once:
            # alone it may be small by chance: all quantities change where one does
            roughest = np.divide(change, np.abs(sums), out=np.zeros_like(change), where=sums != 0).max(axis=1, keepdims=True)
            return self.sure * np.maximum(change, _SHARED * roughest * np.abs(sums))
        if last is None:
            return np.full_like(sums, np.inf)
        pace = np.divide(change, last, out=np.ones_like(change), where=last > change)
        return self.sure * np.maximum(change, self.fastest * last) * np.maximum(pace, self.pace)

    def keep(self, which: np.ndarray) -> None:
        """Go on with the rows ``which``."""
        self.sums = self.sums[which]
        self.change = None if self.change is None else self.change[which]


def by_rules(
    sums: Callable[[np.ndarray, Any], np.ndarray], rules: Sequence, goal: np.ndarray, changes: Changes
) -> tuple[np.ndarray, np.ndarray]:
    """Sums (m, q or more) by as many of the ``rules`` as it takes for an error of ``goal`` (m, q), and the errors (m, q).

    ``sums(rows, rule)`` returns those of the rows by a rule; the quantities after the first q are taken as they are."""
    left, q = np.arange(len(goal)), goal.shape[1]
    out, errors = np.zeros(goal.shape), np.zeros(goal.shape)
    for rule in rules:
        new = sums(left, rule)
        if new.shape[1] > out.shape[1]:
            out = np.zeros((len(goal), new.shape[1]))
        miss = changes.after(new[:, :q])
        done = (miss <= goal[left]).all(axis=1) | (rule == rules[-1])
        out[left[done]], errors[left[done]] = new[done], miss[done]
        left = left[~done]
        if not left.size:
            break
        changes.keep(~done)
    return out, errors

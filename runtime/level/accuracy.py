"""What is asked of the means of a level beside ``rtol``: of columns, or of an interval of a curve over penetration."""

from __future__ import annotations

from dataclasses import dataclass, fields, replace

import numpy as np

#: part of an interval's error above which that of a half says that means are in error, not the interpolant; and how much finer
#: they are made then, and at most; and how much more than the errors of means is not missed for their sake
_STALLED, _FINER, _FINEST, _AMPLIFIED = 0.5, 0.1, 1e-3, 1e3


@dataclass(frozen=True)
class Accuracy:
    """Numbers, or arrays (n,) with one for each column.

    ``friction``: Pa, that the accuracy of any friction may be relative to as well as to its own size, for it adds to others.
    ``fractions``: what errors of fractions are relative to, where it is for pressure and friction that averages are made: 1, or
    more where the pressures are rare; None where fractions count as much. ``coarser``: by so much an interval may err more than
    what is asked of its column; ``means``: by so much finer its means are than usual; ``missed``: error over goal of what it is a
    half of. ``loads``: pressures are sums of what is nowhere negative, and given: their errors are relative to them alone.
    """

    friction: np.ndarray | float = 0.0
    fractions: np.ndarray | float | None = None
    coarser: float = 1.0
    means: float = 1.0
    missed: float = np.inf
    loads: bool = False

    def at(self, index: np.ndarray) -> Accuracy:
        """Of the columns ``index``."""
        arrays = {f.name: getattr(self, f.name) for f in fields(self) if isinstance(getattr(self, f.name), np.ndarray)}
        return replace(self, **{name: values[index] for name, values in arrays.items()})

    @property
    def frictional(self) -> bool:
        """Whether it is for pressure and friction that averages are made."""
        return self.fractions is not None

    def floors(self, scales: np.ndarray, frictions: np.ndarray, fractions: list[int], n: int) -> np.ndarray:
        """What is added to the size of each quantity of n columns where an accuracy is relative, (n, q): a thousandth of its
        natural scale, ``scales`` (q,), or more in the columns ``frictions`` and ``fractions``."""
        floors = np.tile(1e-3 * scales, (n, 1))
        if self.frictional:
            floors[:, fractions] = np.broadcast_to(self.fractions, n)[:, None]
        if self.loads:
            floors[:, 0] = 0.0
        floors[:, frictions] = np.maximum(floors[:, frictions], np.broadcast_to(self.friction, n)[:, None])
        return floors

    def within(self, intervals: list[Accuracy], index: np.ndarray) -> Accuracy:
        """What this asks of means in the intervals ``index`` (n,): errors beside a share of a friction, or of all surface, are no
        larger where an interval may be coarser."""
        coarser = np.array([i.coarser for i in intervals])[index]
        fractions = np.array([i.fractions or 1.0 for i in intervals])[index] / coarser if self.frictional else None
        return Accuracy(self.friction / coarser, fractions)

    def relaxed(self, coarser: float, fractions: float) -> Accuracy:
        """As coarse as that, or as it is."""
        return replace(self, coarser=max(self.coarser, coarser), fractions=max(self.fractions or 1.0, fractions))

    def after(self, missed: float, blurred: float) -> Accuracy:
        """For the halves of what ``missed`` its goal by that factor: with finer means where dividing did not help, and what they
        err, over the goal, may be why (``blurred``)."""
        stalled = _STALLED * self.missed < missed < _AMPLIFIED * blurred
        return replace(self, missed=missed, means=max(_FINER * self.means, _FINEST) if stalled else self.means)

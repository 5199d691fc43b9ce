"""Functions of one variable on nested nodes that are doubled: many parts of lines at once, each on its own number of nodes."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from .quadrature import interior_nodes, interleaved


@dataclass
class Stage:
    """Parts of lines (a record of arrays) on the interior ones of ``n`` nodes, and what is ``known`` there, (parts, nodes, ...)
    each; empty for those that were not looked at yet, whose nodes are the first."""

    parts: Any
    n: int
    known: tuple[np.ndarray, ...] = ()

    def take(self, which) -> Stage:
        return Stage(self.parts.take(which), self.n, tuple(v[which] for v in self.known))


def sampled(
    stages: Sequence[Stage],
    places: Callable[[Any, np.ndarray], np.ndarray],
    evaluate: Callable[[Any, np.ndarray], Sequence[np.ndarray]],
) -> list[Stage]:
    """The stages on their first nodes, or on twice as many of which every other one is known, all of one evaluation.

    ``places(parts, t)``: where the parameters ``t`` (nodes,) in [0, 1] are, (parts, nodes). ``evaluate(parts, x)`` returns arrays
    (m, ...) of what is at ``x`` (m,) of ``parts`` (m,)."""
    sizes = [2 * s.n if s.known else s.n for s in stages]
    x = [places(s.parts, interior_nodes(n)[:: 2 if s.known else 1]) for s, n in zip(stages, sizes, strict=True)]
    parts = [s.parts.take(np.repeat(np.arange(v.shape[0]), v.shape[1])) for s, v in zip(stages, x, strict=True)]
    answers, out, stop = evaluate(parts[0].joined(parts), np.concatenate([v.ravel() for v in x])), [], 0
    for stage, n, v in zip(stages, sizes, x, strict=True):
        start, stop = stop, stop + v.size
        known = [answer[start:stop].reshape(*v.shape, *answer.shape[1:]) for answer in answers]
        if stage.known:
            known = [interleaved(*pair) for pair in zip(known, stage.known, strict=True)]
        out.append(Stage(stage.parts, n, tuple(known)))
    return out

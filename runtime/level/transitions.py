"""Where a code changes along a line: all changes between points whose codes differ, by multisection."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

_POINTS = 1024


@dataclass(frozen=True)
class Transitions:
    """Brackets [low, high] of single changes of code, arrays (m,), with the line each lies on; sorted along every line."""

    line: np.ndarray
    low: np.ndarray
    high: np.ndarray


def locate(
    codes_at: Callable[[np.ndarray, np.ndarray], np.ndarray],
    line: np.ndarray,
    low: np.ndarray,
    high: np.ndarray,
    code_low: np.ndarray,
    code_high: np.ndarray,
    width: np.ndarray,
) -> Transitions:
    """Narrow every bracket to ``width`` (m,); where a third code shows up in between, its transitions are found too.

    ``codes_at(line, x)`` gives the codes at points; ``code_low``, ``code_high`` those at the ends of the brackets.
    """
    found = []
    state = [line, low, high, code_low, code_high, width]
    for _ in range(80):
        narrow = state[2] - state[1] <= state[5]
        found.append([v[narrow] for v in state[:3]])
        state = [v[~narrow] for v in state]
        line, low, high, code_low, code_high, width = state
        if not line.size:
            break
        # many points at once where there are few brackets: rounds, not strips, are what costs then
        m = int(np.clip(_POINTS // line.size, 1, 15))
        x = low[:, None] + (high - low)[:, None] * np.arange(1, m + 1) / (m + 1)
        codes = codes_at(np.repeat(line, m), x.ravel()).reshape(x.shape)
        points = np.concatenate((low[:, None], x, high[:, None]), axis=1)
        codes = np.concatenate((code_low[:, None], codes, code_high[:, None]), axis=1)
        row, node = np.nonzero(codes[:, 1:] != codes[:, :-1])
        state = [line[row], points[row, node], points[row, node + 1], codes[row, node], codes[row, node + 1], width[row]]
    else:
        found.append(state[:3])
    line, low, high = (np.concatenate(parts) for parts in zip(*found, strict=True))
    order = np.lexsort((low, line))
    return Transitions(line[order], low[order], high[order])

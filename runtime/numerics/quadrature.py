"""Functions of one variable on nested nodes that are doubled, and Clenshaw-Curtis sums on these of an interval whose ends may be
like square roots, with an error from the decay of coefficients.

``x = low + width (3 t^2 - 2 t^3)``: what starts or ends like a square root in x is smooth in t, and a polynomial in x stays one
in t. The ends are no nodes: the weight vanishes there, so that nothing need be known of what happens on them.

Sums by rules with more and more nodes are followed until they are good enough (``by_rules``), with errors from their changes. Of
a sequence whose changes fall by a ratio r the last member misses its last change times r/(1 - r): Aitken's process (Brezinski &
Redivo Zaglia, "Extrapolation Methods", 1991, section 2.3). Rules grow by half or more, so sums that converge geometrically do
better than that, and those that converge by a power of the nodes do as well. A change may be small by chance, as where an
integrand has a layer or a kink; r is therefore the largest over all quantities, which share their singularities.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np

from .chebyshev import coefficients, fall_ratio, lobatto, shared_size
from .rounding import EPS

#: fastest pace believed of coefficients, by number of nodes, and of those that fall more slowly at the end than before, as where
#: there is a layer; and the slowest that is told apart from a slower one
_FASTEST, _LAYERED, _SLOWEST = {8: 0.45, 16: 0.42, 32: 0.65}, 0.65, 0.97
#: number of nodes from which on coefficients are many; up to it and from it on, the ratio of the last coefficients to the middle
#: ones below which they surely fall geometrically
_MANY, _GEOMETRIC = 16, (0.15, 0.05)
#: ratio of them above which they may fall by a power only, and how much more than by that of the last ones the next may count
_POWER, _TURNS = 0.2, 2.5
#: how much more is feared than what is left at the pace of coefficients; share of the noise below which they show no pace
_SAFE, _QUIET = 1.5, 0.01
#: share of its size by which a constant is taken to change: quotients by less would overflow
_NOTHING = 1e-290
#: how much more is feared than the last change times r: 1/(1 - r) up to r = 2/3; r of a first change, and the share of the
#: roughest quantity's first change, both relative, that every other one is taken to have at least
_AITKEN, _UNKNOWN, _SHARED = 3.0, 0.5, 0.1


def interleaved(outer: np.ndarray, inner: np.ndarray) -> np.ndarray:
    """What is had at nested nodes (m, nodes, ...), in order: those of ``outer``, one more, lie around those of ``inner``."""
    out = np.empty((inner.shape[0], inner.shape[1] + outer.shape[1], *inner.shape[2:]), inner.dtype)
    out[:, 0::2], out[:, 1::2] = outer, inner
    return out


def mapped(t):
    """Where parameter t in [0, 1] lies in its interval, as a share of it."""
    return t * t * (3 - 2 * t)


def mapped_slope(t):
    """Derivative of ``mapped``."""
    return 6 * t * (1 - t)


@lru_cache
def gauss(n: int) -> tuple[np.ndarray, np.ndarray]:
    """Nodes and weights of Gauss and Legendre on [0, 1]."""
    x, w = np.polynomial.legendre.leggauss(n)
    return 0.5 * (x + 1), 0.5 * w


def interior_nodes(n: int) -> np.ndarray:
    """Interior Clenshaw-Curtis nodes on (0, 1)."""
    return lobatto(n)[1:-1]


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
    """The stages on their first nodes, or on twice as many, of which every other one is known: all in one evaluation.

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


@lru_cache
def mapped_weights(n: int) -> np.ndarray:
    """Clenshaw-Curtis weights at the interior nodes, times the derivative of ``mapped`` (zero at both ends)."""
    # Chebyshev polynomials of even order j have the mean 1/(1 - j^2), the others none
    means = 1 / (1 - np.arange(0, n + 1, 2) ** 2)
    return means @ coefficients(np.eye(n + 1))[::2, 1:-1] * mapped_slope(interior_nodes(n))


@lru_cache
def _second_kind(n: int) -> np.ndarray:
    """Matrix from values at ``interior_nodes(n)`` to coefficients of Chebyshev polynomials of the second kind, (n - 1, n - 1)."""
    angle = np.arange(1, n) * np.pi / n
    return (2 / n) * np.sin(np.outer(np.arange(1, n), angle)) * np.sin(angle)


@lru_cache
def _changes(n: int) -> np.ndarray:
    """Weights of the changes of sums over n nodes from half of them to all, and from a quarter to half, (2, n - 1)."""
    sums = np.zeros((3, n - 1))
    for row, k in zip(sums, (1, 2, 4), strict=True):
        row[k - 1 :: k] = mapped_weights(n // k)
    return sums[:2] - sums[1:]


def _runs(n: int) -> tuple[int, int]:
    """How many of the last coefficients of n nodes are looked at: so many that those of a singularity inside, which come and go,
    are not all small; and so few that they come of nothing but what falls slowest."""
    return (max(5, n // 5), 4) if n > 8 else (3, 3)


@lru_cache
def _left(n: int, turning: bool) -> tuple[np.ndarray, np.ndarray]:
    """What the sum misses of a quantity whose coefficients are ``rho^j``, over the largest of the last ones it shows, and the
    ratios by which it shows how fast they fall: that of the last ones to those before; or rho itself, where the coefficients are
    told from the middle on and may turn from order to order (``turning``), ``rho^j exp(i psi j)``, as near a singularity inside.

    Order j has the integral ``m(j) = -3/(j (j^2 - 4))``, zero for even j. At the nodes orders ``2 n - j`` and ``2 n + j`` look
    like j but for a sign: where coefficients fall slowly and don't turn, as where an end has a layer, most of it cancels.
    """
    rho = np.linspace(_FASTEST.get(n, 0.8), _SLOWEST, 64)
    psi = np.linspace(0, np.pi, 33) if turning else np.zeros(1)
    z = (rho[:, None] * np.exp(1j * psi)).reshape(-1, 1)
    # the sum of m(j) z^j over odd j, by partial fractions
    odd = np.arctanh(z)
    exact = (0.75 * odd - 0.375 * (z**2 * odd - z) - 0.375 * (odd - z) / z**2)[:, 0]
    values = z / (1 - 2 * z * np.cos(np.arange(1, n) * np.pi / n) + z**2)
    c = np.abs(_second_kind(n) @ values.T)
    missed = np.abs(values @ mapped_weights(n) - exact) / _last(c, _runs(n)[0 if turning else 1])
    shown = rho if turning else _last(c, _step(n)) / _last(c, _step(n), _step(n))
    return shown, np.maximum.accumulate(missed.reshape(rho.size, -1).max(axis=1))


def _step(n: int) -> int:
    """So many of the last coefficients are held against as many before."""
    return max(2, n // 10)


def _last(c: np.ndarray, size: int, skipped: int = 0) -> np.ndarray:
    """Largest of the last ``size`` coefficients (n - 1, ...), but for the ``skipped`` ones behind them."""
    end = len(c) - skipped
    return c[end - size : end].max(axis=0)


def sum_errors(values: np.ndarray, noise: np.ndarray, layered: np.ndarray) -> np.ndarray:
    """Error of the sums over nodes, per width, (p, q), of ``values`` (p, n - 1, q); ``noise`` (p, q): changes that don't matter;
    ``layered`` (q,): what may be a layer next to an end, of which few nodes see next to nothing.

    The last coefficients say how much is left, and their pace how fast it falls: the one since the middle, or the one among the
    last, which is slower where a layer next to an end is all that is left. Where coefficients fall geometrically the second is
    believed, and the geometric mean of both where it is the smaller one, which may be chance; elsewhere the larger. A run of
    coefficients may be small by chance, where they come and go: no error is less than sums on half and a quarter of the nodes
    tell, there at the pace of sums that converge geometrically, elsewhere at that of any (``extrapolated``).
    """
    n = values.shape[1] + 1
    # nodes first and intervals last: largest ones are had fastest so
    transformed = np.concatenate((_second_kind(n), _changes(n))) @ values
    c, values = (np.ascontiguousarray(np.moveaxis(v, 0, 2)) for v in (transformed, values))
    # what is rounding says nothing of the singularities
    largest = np.abs(values).max(axis=0)
    c = np.maximum(np.abs(c) - 16 * EPS * largest, 0.0)
    c, (change, before) = c[:-2], c[-2:]
    noise = noise.T
    amplitude = c[1:].max(axis=0) + noise + np.finfo(float).tiny + _NOTHING * largest
    shape = (c / amplitude).max(axis=1)
    many, few = _runs(n)
    step = _step(n)
    # against three in the middle, of which one may be small by chance
    ratio = fall_ratio(_last(shape, many), shape[n // 2 - 3 : n // 2].max(axis=0))
    since = ratio ** (1 / (0.5 * (n + 1 - many)))
    recent = fall_ratio(_last(c, step), _last(c, step, step) + _QUIET * noise)
    recent = np.maximum(recent, fall_ratio(_last(shape, step), _last(shape, step, step)))
    since = np.where(recent > since**step, np.maximum(since, _LAYERED), since)
    size = shared_size(_last(c, many), _last(shape, many), amplitude)
    first = size * np.interp(since, *_left(n, True))
    second = shared_size(_last(c, few), _last(shape, few), amplitude) * np.interp(recent, *_left(n, False))
    sure = (ratio < _GEOMETRIC[int(n >= _MANY)]) & ((n >= _MANY) | ~layered[:, None])
    doubtful = _SAFE * np.maximum(first, second)
    # as those of a kink may fall: by a power, and coming and going; so the next ones by as much as these
    slow = np.where(ratio > _POWER, np.maximum(doubtful, _TURNS * size * ratio), doubtful)
    fall = fall_ratio(change, before)
    # where sums fall geometrically what is left is in the square of that ratio to the last change
    least = np.where(sure, change * fall**2, extrapolated(change, fall))
    return np.maximum(least, np.where(sure, _SAFE * np.sqrt(np.maximum(first, second) * second), slow)).T


def by_rules(
    sums: Callable[[np.ndarray, Any], np.ndarray],
    rules: Sequence,
    goal: np.ndarray,
    relative: np.ndarray,
    fastest: float,
    at_once: bool = False,
) -> tuple[np.ndarray, np.ndarray]:
    """Sums (m, q) by as many of the ``rules`` as it takes for an error of ``goal + relative |sum|``, (m, q) and (m, 1), and the
    errors (m, q): from the third rule on, or from the second ``at_once``. No r less than ``fastest`` is believed.

    ``sums(rows, rule)`` returns those of the rows by a rule."""
    left, (out, errors) = np.arange(len(goal)), np.zeros((2, *goal.shape))
    old = change = None
    for rule in rules:
        if not left.size:
            break
        new = sums(left, rule)
        old, last, change = new, change, None if old is None else np.abs(new - old)
        miss = _missed(new, change, last, fastest, at_once)
        done = (miss <= goal[left] + relative[left] * np.abs(new)).all(axis=1) | (rule == rules[-1])
        out[left[done]], errors[left[done]] = new[done], miss[done]
        left, old, change = left[~done], old[~done], None if change is None else change[~done]
    return out, errors


def extrapolated(change: np.ndarray, ratio: np.ndarray) -> np.ndarray:
    """What sums miss whose last ``change`` is this and in this ``ratio`` to the one before."""
    return _AITKEN * change * ratio


def _missed(sums, change, last, fastest: float, at_once: bool):
    """Error of ``sums`` (m, q) whose last ``change`` and the one before, ``last``, are these, or None."""
    if last is not None:
        change = np.maximum(change, fastest * last)
        # what doesn't change at all says nothing
        ratio = np.divide(change, last, out=(change > 0).astype(float), where=last > change)
        return extrapolated(change, ratio.max(axis=1, keepdims=True))
    if change is None or not at_once:
        return np.full_like(sums, np.inf)
    # alone it may be small by chance: all quantities change where one does
    roughest = np.divide(change, np.abs(sums), out=np.zeros_like(change), where=sums != 0).max(axis=1, keepdims=True)
    return extrapolated(np.maximum(change, _SHARED * roughest * np.abs(sums)), _UNKNOWN)

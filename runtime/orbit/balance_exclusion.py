"""Proof by the balance of one period (``balance``) that a strip has no orbit before some onset, or none with an onset at all.

If l is an orbit or a march, suppose that there is an orbit with an earlier onset.

* From there to l every onset leads to the end of adhesion, as it does for both, and contact, where l has none, is lost by
  grazing, with no excess pressure: so r is continuous. It is positive just before l. Where it last vanishes before l it does not
  fall: there is an orbit y before l at which the slope of the map is not below one.
* Contact is longer in y than in l, adhesion ends later, and it ends where free flow leads on to y itself. So (``sensitivity``)

      log T'(y) <= log(1 + s_x/F(y)) + log(1 + s_c/M(c)) - 2 pi/beta - (a - b) L/alpha,

  a and b those of l, equal where it has no contact; which is negative unless F or M is smaller at y than some number each, that
  is unless y lies before a phase known in closed form. There the balance decides.

Where it does not for a whole interval of xi the interval is divided.
"""

import numpy as np

from .balance import Reference, arc_versine, at_rest, balance_bound, beside, versine
from .groups import ROUNDING, Cycle
from .march import TWO_PI, Orbit
from .sensitivity import fading, onset_margin, release_margin

#: what the bound loses over an interval, in p_0 times its width; by how much finer than that asks for it is divided, into how
#: many parts at most, and how often
_LOSS, _AMPLY, _MOST, _ROUNDS = 2.1, 1.5, 12, 8


def first(kernel, cycle: Cycle, known: Orbit, start, end) -> tuple[np.ndarray, np.ndarray]:
    """Which of the ``known`` orbits or marches, r >= 0, have no orbit before them; and the evaluations spent on each.

    ``start``, ``end``: no onset lies before, and adhesion does not end after.
    """
    proven, spent = np.zeros(cycle.size, bool), np.zeros(cycle.size)
    index = np.flatnonzero(known.x <= 0)
    if index.size:
        cycle, known, start, end = cycle.among(index), known.take(index), start[index], end[index]
        without = np.flatnonzero(np.isnan(known.b))
        known.b[without], known.a[without] = 0.0, 0.0  # contact at the crest, of no length
        with np.errstate(all="ignore"):
            suspects = np.maximum(_suspects(kernel, cycle, known), -known.x)
            reference = beside(kernel, cycle, known, end)
            latest = np.maximum(-start, suspects)
            proven[index], spent[index] = _excluded(kernel, reference, suspects, latest)
    return proven, spent


def exclude_out_of_reach(kernel, cycle: Cycle) -> tuple[np.ndarray, np.ndarray]:
    """Which cycles of strips out of reach, ``D <= -delta_0``, that cannot stay engaged are proven to have no orbit with an onset;
    and the evaluations spent on each."""
    none = np.zeros(cycle.size, bool)
    with np.errstate(all="ignore"):
        reference = at_rest(kernel, cycle)
        held = _held_best(cycle)
        open_ = np.flatnonzero(balance_bound(kernel, reference, held, held) > 0)
        part, crest, spent = reference.take(open_), np.zeros(open_.size), np.ones(cycle.size)
        none[open_], used = _excluded(kernel, part, crest, crest + np.pi)
    spent[open_] += used
    return none, spent


def _held_best(cycle: Cycle):
    """About the onset, less its sign, from which a strip out of reach is held best: a step of Newton on a foundation that stands
    still in a gap. Nineteen of twenty strips of which nothing can be proven show it there."""
    s = cycle.strips
    sine, cosine, glassy = np.sin(1.0), np.cos(1.0), s.L * s.beta / s.alpha
    a = np.arccos(np.minimum(cosine + s.delta_0, 1.0))
    weight = np.pi + glassy * a
    slope = cosine * weight + glassy * sine**2 / np.sin(a)
    return np.clip(1.0 - (sine * weight - cycle.release_step) / slope, 0.0, np.pi)


def _suspects(kernel, cycle: Cycle, known: Orbit):
    """The phase -x before which an orbit y must lie by its slope; that of the known one where nothing is known."""
    s = cycle.strips
    F, M = onset_margin(kernel, cycle, known.x), release_margin(kernel, cycle, known.c)
    onset, release = cycle.onset_step, cycle.release_step
    at_onset, at_release = np.log1p(onset / F), np.log1p(release / M)
    share = fading(cycle, known.a - known.b) * (1 - ROUNDING) / (at_onset + at_release)
    fits = (F > 0) & (M > 0) & (share > 1)
    least_F, least_M = (
        gain / np.expm1(np.minimum(share * log, 700.0)) for gain, log in ((onset, at_onset), (release, at_release))
    )
    arc = kernel.forcing_arc(s.delta_0 - least_F, s.D, s.beta)[1] - cycle.centre
    last = cycle.centre + TWO_PI - kernel.forcing_arc(s.p_0 + s.delta_0 + least_M, s.D, s.beta)[1]
    # free flow from the end of adhesion, over no longer a way than from the known one
    w_c = kernel.profile(last, s.D) + s.delta_0 + cycle.jump
    free = known.x + TWO_PI - known.c
    later = arc_versine(versine(last) - cycle.jump - np.maximum(w_c * kernel.decay_loss(free, s.beta), 0.0) - s.noise())
    # it leads on to x, which moves with c by no less than where M is least and F is greatest
    F = np.where(known.x < cycle.centre, F, onset_margin(kernel, cycle, cycle.centre))
    moved = (last - known.c) * (least_M + release) / F * kernel.decay(free, s.beta) - known.x
    later = np.where(known.r == 0, np.maximum(later, moved), later)
    return np.where(fits, np.minimum(arc, later), -known.x)


def _excluded(kernel, reference: Reference, lo, hi) -> tuple[np.ndarray, np.ndarray]:
    """Where no orbit has an onset between -hi and -lo, and the evaluations spent on each.

    Over an interval the bound loses as much as engagement grows, which tells how fine a part that fails has to be divided, or
    that it cannot succeed.
    """
    n = lo.size
    proven, spent = np.ones(n, bool), np.zeros(n)
    index, part, parts = np.arange(n), reference, None
    for _ in range(_ROUNDS):
        if parts is not None:
            pieces = np.repeat(np.arange(index.size), parts)
            place = np.arange(pieces.size) - np.repeat(np.cumsum(parts) - parts, parts)
            index, width = index[pieces], ((hi - lo) / parts)[pieces]
            lo = lo[pieces] + place * width
            hi, part = lo + width, reference.take(index)
        spent += np.bincount(index, minlength=n)
        left = balance_bound(kernel, part, lo, hi)
        open_ = np.flatnonzero(~(left > 0))
        if not open_.size:
            return proven, spent
        index, lo, hi, left = index[open_], lo[open_], hi[open_], left[open_]
        loss = _LOSS * reference.cycle.strips.p_0[index] * (hi - lo)
        proven[index[~(left + loss > 0)]] = False
        going = np.flatnonzero(proven[index])
        if not going.size:
            return proven, spent
        index, lo, hi, loss = index[going], lo[going], hi[going], loss[going]
        parts = _parts(loss, left[going] + loss)
    proven[index] = False
    return proven, spent


def _parts(loss, least):
    """Into how many parts to divide an interval over which the bound loses so much, from about ``least``."""
    return np.minimum(np.ceil(_AMPLY * loss / least), _MOST).astype(int)

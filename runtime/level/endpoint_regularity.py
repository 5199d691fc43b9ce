"""Ends of intervals of penetration at which a level's means are smooth enough for nodes to stand less closely.

Means end like square roots of D, or nearly so, where the crest lets go or where a zone of it vanishes whose ends are free. An
orbit that is engaged all along goes on smoothly up to the penetration at which it breaks an inequality, and so does one without
contact up to where its gap closes; and where nothing is seen to change the interval is simply cut. This is a guess by what is met
on both sides: where it is wrong the curve converges slowly, and is divided.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..orbit.regimes import CODE
from .interval import Interval
from .strips import LevelBatch

#: distance from an end on both sides at which strips are looked at, as a share of the interval
_BESIDE = 1e-9
_ENGAGED = np.array([CODE["c"], CODE["ac"], CODE["a"]])
_STEADY = np.array([CODE["c"], CODE["a"]])


def with_endpoint_regularity(columns: LevelBatch, intervals: list[Interval]) -> list[Interval]:
    """The intervals, with ``smooth_low`` and ``smooth_high`` where they seem so."""
    ends = [(k, high) for k, i in enumerate(intervals) for high in (False, True) if not (i.inner_high if high else i.inner_low)]
    if not ends:
        return intervals
    which, high = np.array([k for k, _ in ends]), np.array([high for _, high in ends])
    low_D, high_D = (np.array([getattr(i, name) for i in intervals])[which] for name in ("low", "high"))
    at, aside = np.where(high, high_D, low_D), np.where(high, -_BESIDE, _BESIDE) * (high_D - low_D)
    D = np.tile(np.stack((at + aside, at - aside), axis=1).ravel(), 2)
    column = np.tile(np.repeat(np.array([i.column for i in intervals])[which], 2), 2)
    theta = np.repeat((0.0, np.pi), 2 * which.size)
    (crest, beyond_crest), (edge, beyond_edge) = np.moveaxis(
        columns.at(column, D).codes(np.arange(D.size), theta).reshape(2, -1, 2), 2, 1
    )
    n = len(CODE)
    # what is carried goes over no break of its law
    own, own_edge = crest // n == beyond_crest // n, edge // n == beyond_edge // n
    crest, beyond_crest, edge, beyond_edge = (codes % n for codes in (crest, beyond_crest, edge, beyond_edge))
    no_contact = (crest == CODE["af"]) & (beyond_crest == CODE["acaf"])
    whole = own & ((crest == beyond_crest) | np.isin(crest, _ENGAGED) | no_contact)
    whole &= own_edge & ((edge == beyond_edge) | np.isin(edge, _STEADY) & np.isin(beyond_edge, _STEADY))
    out = list(intervals)
    for k, upper in zip(which[whole], high[whole], strict=True):
        out[k] = replace(out[k], **{"smooth_high" if upper else "smooth_low": True})
    return out

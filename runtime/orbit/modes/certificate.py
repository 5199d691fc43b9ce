"""What a strip with several times must satisfy before it is returned.

The ordered iteration has enclosed the extremal orbit between two states; the boundary equations have been solved to
rounding. What is left to show is that the solved edges are an orbit of the strip, are enclosed, and are stable. The
first is shown by marching one turn from the orbit's own state: every event must be met first, in order, where the edges
say.
"""

from __future__ import annotations

import numpy as np

from .march import TWO_PI, march
from .polish import arguments
from .problem import ModeStrips

#: agreement of the edges with the march, beyond what rounding leaves uncertain
_AGREE = 1e-7
#: near a fold the radius of the return map approaches one like the square root of the distance; rounding blurs it
_STABLE = 1e-6


def marched(kernel, sequence: str, s: ModeStrips, edges: np.ndarray, allowed: np.ndarray) -> np.ndarray:
    """Whether a turn from the first edge meets just the other edges, in order, within ``allowed``; edges (k, N) in the
    order met."""
    z = getattr(kernel, f"state_{sequence}")(*edges, *arguments(s))
    first = edges[0]
    period = march(kernel, s, np.ones(s.size, bool), z, first)
    close = lambda found, edge: np.abs(found - edge) <= allowed  # noqa: E731
    back = ~(period.onset < first + TWO_PI - allowed)
    if sequence == "ac":
        # started at b itself, where rounding may place the point on either side
        again = ~(period.entry < first + TWO_PI - allowed) | close(period.entry, first)
        return ~period.lost & close(period.exit, edges[1]) & (period.releases == 0) & again & (period.contacts <= 2)
    ok = ~period.lost & back & close(period.release, edges[-1]) & (period.releases == 1)
    if sequence == "af":
        return ok & (period.contacts == 0)
    ok &= close(period.exit, edges[-2])
    if sequence == "acaf":
        return ok & close(period.entry, edges[1]) & (period.contacts == 1)
    # snapped in: contact from the start on, or once more at the very end
    return ok & ((period.contacts == 0) | (period.entry >= first + TWO_PI - allowed) | close(period.entry, first))


def stable(kernel, sequence: str, s: ModeStrips, edges: np.ndarray) -> np.ndarray:
    """Spectral radius of the return map at most one: true of both extremal orbits."""
    matrix = getattr(kernel, f"return_map_{sequence}")(*edges, *arguments(s))
    matrix = np.moveaxis(np.broadcast_to(matrix, (s.modes, s.modes, s.size)), -1, 0)
    good = np.isfinite(matrix).all(axis=(1, 2))
    radius = np.abs(np.linalg.eigvals(np.where(good[:, None, None], matrix, 0.0))).max(axis=1)
    return good & (radius <= 1 + _STABLE)


def enclosed(edges: np.ndarray, lower: np.ndarray, upper: np.ndarray, allowed: np.ndarray) -> np.ndarray:
    """Every edge lies between those of the two states that enclose the extremal orbit."""
    low, high = np.minimum(lower, upper) - allowed, np.maximum(lower, upper) + allowed
    return np.all((edges >= low) & (edges <= high), axis=0)

"""Changes of variable that make functions smooth which end like roots.

With ``x = low + width share(t)`` and strengths p at the ends, the distance of x from either end is like the distance of t to
the power p. So what ends like ``x^(1/p)`` in x is smooth in t. Strengths are powers of two: 1 (a regular end), 2 (square root),
4 (a square root with other half powers next to it, or nearly ``x log x``; a fourth root), 8. The map of strength 2 is the
parabola ``t^2`` towards one end and the cubic ``t^2 (3 - 2 t)`` towards both; higher strengths repeat it. Polynomials keep
polynomials polynomials, and these have inverses in closed form. Compare Sidi, "A new variable transformation for numerical
integration" (in "Numerical Integration IV", 1993), and section 2.12 of Davis & Rabinowitz, "Methods of Numerical Integration"
(1984).
"""

import numpy as np

_SIN_60 = 0.5 * np.sqrt(3)
STRENGTHS = (1, 2, 4, 8)


def share(t: np.ndarray, low, high) -> np.ndarray:
    """Share of an interval below the parameter ``t`` in [0, 1]; strengths ``low`` and ``high`` (ints, or arrays (m,) along the
    first axis of t)."""
    return _by_strengths(_share, t, low, high)


def slope(t: np.ndarray, low, high) -> np.ndarray:
    """Derivative of ``share`` by t."""
    return _by_strengths(_slope, t, low, high)


def parameter(part: np.ndarray, low, high) -> np.ndarray:
    """The t in [0, 1] at which ``share`` is ``part`` in [0, 1]."""
    return _by_strengths(_parameter, part, low, high)


def _by_strengths(function, x, low, high):
    x = np.asarray(x, float)
    if np.ndim(low) == 0 and np.ndim(high) == 0:
        return function(x, *_levels(int(low), int(high)))
    kinds = np.broadcast_arrays(low, high, np.empty(x.shape[0]))[:2]
    key = 16 * kinds[0] + kinds[1]
    first = key.flat[0] if key.size else 0
    if (key == first).all():
        return function(x, *_levels(*divmod(int(first), 16))) if key.size else x.copy()
    out = np.empty_like(x)
    for kind in np.unique(key):
        rows = key == kind
        out[rows] = function(x[rows], *_levels(*divmod(int(kind), 16)))
    return out


def _levels(low: int, high: int) -> tuple[int, int]:
    """How often the map of strength 2 is applied towards either end."""
    if low not in STRENGTHS or high not in STRENGTHS:
        raise ValueError(f"strengths of ends have to be among {STRENGTHS}, not {low}, {high}")
    return low.bit_length() - 1, high.bit_length() - 1


def _share(t, low, high):
    for level in range(max(low, high), 0, -1):
        if low >= level and high >= level:
            t = t * t * (3 - 2 * t)
        else:
            t = t * t if low >= level else t * (2 - t)
    return t


def _slope(t, low, high):
    rise = np.ones_like(t)
    for level in range(max(low, high), 0, -1):
        if low >= level and high >= level:
            rise, t = rise * 6 * t * (1 - t), t * t * (3 - 2 * t)
        elif low >= level:
            rise, t = rise * 2 * t, t * t
        else:
            rise, t = rise * 2 * (1 - t), t * (2 - t)
    return rise


def _parameter(part, low, high):
    for level in range(1, max(low, high) + 1):
        if low >= level and high >= level:
            # the cubic's root by its trigonometric form, without cancellation towards 0
            third = 2 / 3 * np.arctan2(np.sqrt(part), np.sqrt(1 - part))
            part = np.minimum(np.sin(0.5 * third) ** 2 + _SIN_60 * np.sin(third), 1.0)
        elif low >= level:
            part = np.sqrt(part)
        else:
            part = part / (1 + np.sqrt(1 - part))
    return part

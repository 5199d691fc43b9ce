"""Adhesion across the gap."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, overload

import numpy as np

from ..errors import InputError
from .checks import LARGEST, SMALLEST, broadcast, numbers

if TYPE_CHECKING:
    from ..typing import Numbers


class Dugdale:
    """Dugdale adhesion: traction ``-p_0`` for ``0 < gap <= delta_0``, zero beyond (Eq. 2), ``gamma = p_0 delta_0`` (Eq. 3).

    Give two of the three, the third follows; ``gamma=0`` or ``p_0=0`` alone means no adhesion.

    Parameters
    ----------
    gamma : energy of adhesion, N/m, >= 0
    p_0 : adhesive traction, Pa, >= 0
    delta_0 : range of the adhesion, m, > 0 where there is adhesion

    Scalars or arrays that broadcast. Raises ``InputError`` for values outside these ranges, or if not exactly two fix the law.

    >>> Dugdale(gamma=2.5e-5, delta_0=1e-8).p_0
    2500.0
    >>> Dugdale(gamma=2.5e-5, p_0=2500.0).delta_0
    1e-08
    """

    __slots__ = ("gamma", "p_0", "delta_0")

    # a number, or an array where it was given arrays
    gamma: Any
    p_0: Any
    delta_0: Any

    @overload
    def __init__(self, gamma: Numbers, delta_0: Numbers | None = None, p_0: None = None) -> None: ...
    @overload
    def __init__(self, gamma: Numbers, *, p_0: Numbers) -> None: ...
    @overload
    def __init__(self, *, p_0: Numbers, delta_0: Numbers | None = None) -> None: ...
    def __init__(self, gamma: Numbers | None = None, delta_0: Numbers | None = None, p_0: Numbers | None = None):
        given = {"gamma": gamma, "p_0": p_0, "delta_0": delta_0}
        units = {"gamma": "N/m", "p_0": "Pa", "delta_0": "m"}
        values = {n: numbers(f"adhesion.{n}", v, units[n], 0) for n, v in given.items() if v is not None}
        broadcast(**{f"adhesion.{n}": v for n, v in values.items()})
        if set(values) == {"gamma", "p_0"}:
            values["delta_0"] = _range(values["gamma"], values["p_0"])
        elif len(values) == 3 or "delta_0" in values and len(values) == 1 or not values:
            shown = {n: v for n, v in given.items() if v is not None}
            raise InputError("adhesion", shown, "two of the three: gamma (N/m), p_0 (Pa), delta_0 (m)")
        value = values["gamma" if "gamma" in values else "p_0"]
        delta = values.get("delta_0", np.zeros(value.shape))
        if "delta_0" not in values and value.any():
            raise InputError("adhesion.delta_0", None, "a finite number > 0 (m), since there is adhesion")
        value, delta = np.broadcast_arrays(value, delta)
        if ((value > 0) & (delta == 0)).any():
            raise InputError("adhesion.delta_0", 0.0, "a finite number > 0 (m), since there is adhesion")
        p = np.broadcast_to(values["p_0"], value.shape) if "p_0" in values else _traction(value, delta)
        self._set("p_0", p)
        self._set("delta_0", delta)
        self._set("gamma", value if "gamma" in values else p * delta)

    def _set(self, name, value):
        object.__setattr__(self, name, float(value) if np.ndim(value) == 0 else np.asarray(value))

    def __setattr__(self, name, value):
        raise AttributeError(f"Dugdale is immutable: {name} cannot be set")

    def __reduce__(self):
        return rebuild, (self.gamma, self.p_0, self.delta_0)

    def __repr__(self):
        # of gamma and p_0 the one from which the other follows to the last digit
        one = "gamma" if np.array_equal(_quotient(self.gamma, self.delta_0), self.p_0) else "p_0"
        return f"Dugdale({one}={getattr(self, one)!r}, delta_0={self.delta_0!r})"

    def _key(self):
        return (np.asarray(self.p_0).tobytes(), np.asarray(self.delta_0).tobytes())

    def __eq__(self, other):
        return isinstance(other, Dugdale) and self._key() == other._key()

    def __hash__(self):
        return hash(self._key())


def _quotient(gamma: Any, by: Any) -> np.ndarray:
    """``gamma`` over one of its factors, which gives the other; zero without adhesion."""
    with np.errstate(over="ignore", under="ignore"):  # refused by name
        return np.divide(gamma, by, out=np.zeros(np.shape(gamma)), where=np.greater(by, 0))


def _traction(gamma: np.ndarray, delta: np.ndarray) -> np.ndarray:
    """``gamma/delta_0``, Pa; zero without adhesion."""
    p = _quotient(gamma, delta)
    beyond = p > LARGEST
    if beyond.any():
        raise InputError("adhesion.gamma", float(gamma[beyond].flat[0]), f"gamma/delta_0 must be a traction up to {LARGEST:g} Pa")
    return p


def _range(gamma: np.ndarray, p_0: np.ndarray) -> np.ndarray:
    """``gamma/p_0``, m; zero without adhesion."""
    gamma, p_0 = np.broadcast_arrays(gamma, p_0)
    one = (gamma > 0) != (p_0 > 0)
    if one.any():
        allowed = "gamma = p_0 delta_0: both zero, or both above zero"
        raise InputError("adhesion.gamma, adhesion.p_0", (float(gamma[one].flat[0]), float(p_0[one].flat[0])), allowed)
    delta = _quotient(gamma, p_0)
    beyond = (delta > LARGEST) | ((delta < SMALLEST) & (gamma > 0))
    if beyond.any():
        allowed = f"gamma/p_0 must be a range from {SMALLEST:g} to {LARGEST:g} m"
        raise InputError("adhesion.gamma", float(gamma[beyond].flat[0]), allowed)
    return delta


def rebuild(gamma: Any, p_0: Any, delta_0: Any) -> Dugdale:
    """An equal law, to the bit: unpickled, or read from a file."""
    law = object.__new__(Dugdale)
    for name, value in (("gamma", gamma), ("p_0", p_0), ("delta_0", delta_0)):
        law._set(name, value)
    return law

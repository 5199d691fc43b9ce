"""Adhesion across the gap."""

from __future__ import annotations

import numpy as np

from ..errors import InputError
from .checks import LARGEST, broadcast, numbers


class Dugdale:
    """Dugdale adhesion: traction ``-p_0`` for ``0 < gap <= delta_0``, zero beyond (Eq. 2), ``gamma = p_0 delta_0`` (Eq. 3).

    Give two of the three; ``gamma=0`` or ``p_0=0`` alone means no adhesion.

    Parameters
    ----------
    gamma : energy of adhesion, N/m, >= 0
    p_0 : adhesive traction, Pa, >= 0
    delta_0 : range of the adhesion, m, > 0 where there is adhesion

    Scalars or arrays that broadcast. Raises ``InputError`` for values outside these ranges, or if not exactly two fix the law.

    >>> Dugdale(gamma=2.5e-5, delta_0=1e-8).p_0
    2500.0
    """

    __slots__ = ("gamma", "p_0", "delta_0")

    def __init__(self, gamma=None, delta_0=None, p_0=None):
        given = {"gamma": gamma, "p_0": p_0, "delta_0": delta_0}
        units = {"gamma": "N/m", "p_0": "Pa", "delta_0": "m"}
        values = {n: numbers(f"adhesion.{n}", v, units[n], 0) for n, v in given.items() if v is not None}
        broadcast(**{f"adhesion.{n}": v for n, v in values.items()})
        strength = [n for n in ("gamma", "p_0") if n in values]
        if len(strength) != 1:
            shown = {n: v for n, v in given.items() if v is not None}
            raise InputError("adhesion", shown, "either gamma (N/m) or p_0 (Pa), with delta_0 (m)")
        name = strength[0]
        value = values[name]
        delta = values.get("delta_0")
        if delta is None:
            if value.any():
                raise InputError("adhesion.delta_0", None, "a finite number > 0 (m), since there is adhesion")
            delta = np.zeros(value.shape)
        value, delta = np.broadcast_arrays(value, delta)
        if ((value > 0) & (delta == 0)).any():
            raise InputError("adhesion.delta_0", 0.0, "a finite number > 0 (m), since there is adhesion")
        with np.errstate(over="ignore"):  # refused below, by name
            p = np.divide(value, delta, out=np.zeros(value.shape), where=delta > 0) if name == "gamma" else value
        beyond = p > LARGEST
        if beyond.any():
            allowed = f"gamma/delta_0 must be a traction up to {LARGEST:g} Pa"
            raise InputError("adhesion.gamma", float(value[beyond].flat[0]), allowed)
        self._set("p_0", p)
        self._set("delta_0", delta)
        self._set("gamma", value if name == "gamma" else p * delta)

    def _set(self, name, value):
        object.__setattr__(self, name, float(value) if np.ndim(value) == 0 else np.asarray(value))

    def __setattr__(self, name, value):
        raise AttributeError(f"Dugdale is immutable: {name} cannot be set")

    def __reduce__(self):
        return _rebuild, (self.p_0, self.delta_0)

    def __repr__(self):
        return f"Dugdale(gamma={self.gamma!r}, delta_0={self.delta_0!r})"

    def _key(self):
        return (np.asarray(self.p_0).tobytes(), np.asarray(self.delta_0).tobytes())

    def __eq__(self, other):
        return isinstance(other, Dugdale) and self._key() == other._key()

    def __hash__(self):
        return hash(self._key())


def _rebuild(p_0, delta_0):
    return Dugdale(p_0=p_0, delta_0=delta_0)

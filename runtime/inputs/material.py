"""The viscoelastic foundation."""

from __future__ import annotations

from dataclasses import dataclass, field, fields
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from ..errors import InputError
from .checks import broadcast, numbers
from .shift import Shift, check_shift, factors_at

if TYPE_CHECKING:
    from ..typing import Floats, Numbers


def as_call(material: Any) -> str:
    """A material as the call that makes it, without what is not given: two that differ look different."""
    given = {each.name: getattr(material, each.name) for each in fields(material) if each.init}
    return f"{type(material).__name__}({', '.join(f'{key}={value!r}' for key, value in given.items() if value is not None)})"


@dataclass(frozen=True, eq=False)
class StandardLinearSolid:
    """Foundation with one relaxation time: ``w + T_eps w_t = (p + T_sigma p_t)/K`` (Eq. 1).

    Parameters
    ----------
    K : relaxed stiffness per area, Pa/m, > 0 (``p = K w`` at rest; the printed paper calls it a compliance)
    T_eps : retardation time, s, >= T_sigma
    T_sigma : relaxation time, s, >= 0; zero is the Kelvin-Voigt foundation
    shift : how it changes with temperature, a :class:`hystrip.WLF` or :class:`hystrip.Arrhenius`, or None

    Scalars or arrays that broadcast. Raises ``InputError`` for a value outside these ranges.

    >>> float(StandardLinearSolid(K=1e9, T_eps=1e-2, T_sigma=1e-4).K_glassy)
    100000000000.0
    """

    # a float, or an array where it was given arrays
    K: Any
    T_eps: Any
    T_sigma: Any
    shift: Shift | None = field(default=None, kw_only=True)

    __repr__ = as_call

    if TYPE_CHECKING:

        def __init__(self, K: Numbers, T_eps: Numbers, T_sigma: Numbers, *, shift: Shift | None = None) -> None: ...

    def __post_init__(self) -> None:
        check_shift(self.shift)
        K = numbers("material.K", self.K, "Pa/m", 0, strict=True)
        T_eps = numbers("material.T_eps", self.T_eps, "s", 0)
        T_sigma = numbers("material.T_sigma", self.T_sigma, "s", 0)
        broadcast(**{"material.K": K, "material.T_eps": T_eps, "material.T_sigma": T_sigma})
        above = np.broadcast_arrays(T_sigma > T_eps, T_sigma, T_eps)
        if above[0].any():
            sigma, eps = (float(a[above[0]].flat[0]) for a in above[1:])
            raise InputError("material.T_sigma", sigma, f"a number from 0 to T_eps = {eps:g} (s)")
        for name, value in (("K", K), ("T_eps", T_eps), ("T_sigma", T_sigma)):
            object.__setattr__(self, name, float(value) if value.ndim == 0 else value)

    @cached_property
    def J(self) -> Floats:
        """Instantaneous compliance times K, ``T_sigma/T_eps``; 1 for an elastic foundation (both times zero)."""
        T_eps, T_sigma = np.broadcast_arrays(self.T_eps, self.T_sigma)
        return np.divide(T_sigma, T_eps, out=np.ones(T_eps.shape), where=T_eps > 0)

    @cached_property
    def L(self) -> Floats:
        """``1 - J = (T_eps - T_sigma)/T_eps``, without the cancellation of the difference."""
        T_eps, T_sigma = np.broadcast_arrays(self.T_eps, self.T_sigma)
        return np.divide(T_eps - T_sigma, T_eps, out=np.zeros(T_eps.shape), where=T_eps > 0)

    @property
    def K_glassy(self) -> Floats:
        """Glassy stiffness ``K T_eps/T_sigma``, Pa/m; inf for Kelvin-Voigt."""
        J = self.J
        return np.divide(self.K, J, out=np.full(np.broadcast_shapes(J.shape, np.shape(self.K)), np.inf), where=J > 0)

    def at_wavelength(self, l: Any) -> StandardLinearSolid:  # noqa: E741 - the paper's symbol
        """The foundation under a level of wavelength ``l``, m: this one, which is local."""
        return self

    def at_temperature(self, temperature: float) -> StandardLinearSolid:
        """The foundation at a temperature, K, as its ``shift`` has it. Raises ``InputError`` where it has none."""
        a_T, b_T = factors_at(self.shift, temperature)
        return StandardLinearSolid(self.K * b_T, self.T_eps * a_T, self.T_sigma * a_T)

    def _key(self):
        return (type(self), *(np.asarray(v).tobytes() for v in (self.K, self.T_eps, self.T_sigma)), self.shift)

    def __eq__(self, other):
        return isinstance(other, StandardLinearSolid) and self._key() == other._key()

    def __hash__(self):
        return hash(self._key())


@dataclass(frozen=True, eq=False)
class KelvinVoigt(StandardLinearSolid):
    """Foundation without instantaneous compliance: ``K (w + T_eps w_t) = p``; the standard linear solid with ``T_sigma = 0``.

    Pressure steps where contact begins; there is no snap-in, and the two edge closures are one.

    Parameters
    ----------
    K : relaxed stiffness per area, Pa/m, > 0
    T_eps : retardation time, s, >= 0
    shift : as for :class:`hystrip.StandardLinearSolid`

    Scalars or arrays that broadcast. Raises ``InputError`` for a value outside these ranges.

    >>> import hystrip
    >>> hystrip.KelvinVoigt(K=1e9, T_eps=1e-2)
    KelvinVoigt(K=1000000000.0, T_eps=0.01)
    """

    T_sigma: Any = field(default=0.0, init=False)

    __repr__ = as_call

    if TYPE_CHECKING:

        def __init__(self, K: Numbers, T_eps: Numbers, *, shift: Shift | None = None) -> None: ...

    def at_temperature(self, temperature: float) -> KelvinVoigt:
        """The foundation at a temperature, K, as its ``shift`` has it. Raises ``InputError`` where it has none."""
        a_T, b_T = factors_at(self.shift, temperature)
        return KelvinVoigt(self.K * b_T, self.T_eps * a_T)

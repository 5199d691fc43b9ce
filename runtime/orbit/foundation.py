"""A material with its generated solver, as levels and strips use it."""

from __future__ import annotations

from types import ModuleType
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

from ..inputs.half_space import HalfSpace
from ..inputs.material import StandardLinearSolid
from .materials import kernel_of, reduced

if TYPE_CHECKING:
    from .contact import Contact
    from .nonadhesive import Waves
    from .solved import Solved


class Foundation(Protocol):
    """A material with its generated solver: all that levels and strips ask of it. Arrays flat, (N,), SI unless said otherwise."""

    kernel: ModuleType
    K: Any
    longest_time: float  # longest retardation time, s
    lossiest_rate: float  # rate at which Im K* is greatest, 1/s; inf where it only grows

    def flat(self, shape) -> Foundation:
        """The same for strips of this shape, flattened: array parameters are broadcast to it."""

    def solve(self, l, A, D, V, p_0, delta_0, edge: str, branch: str) -> tuple[Solved, Any, dict]:  # noqa: E741
        """Solve strips: ``Solved`` (dimensionless), the dimensionless strips, and the scales back to SI.

        ``edge`` has passed ``check_edge``. Raises ``SolverError`` for a strip that could not be certified."""

    def fields(self, strips, solved, phase) -> tuple[np.ndarray, np.ndarray]:
        """Dimensionless pressure and gap at a phase of each strip."""

    def boundary_arguments(self, rate, D, p_0, delta_0, edge: str) -> tuple:
        """What the generated boundary equations take after the edges, for strips at ``rate = k V``, 1/s, the rest
        dimensionless."""

    def fold(self, sequence: str, edges, arguments: tuple) -> np.ndarray:
        """Of orbits of a ``sequence`` with a free part: zero at a fold, with a change of sign."""

    def release(self, edges, arguments: tuple) -> np.ndarray:
        """Of orbits that are engaged all along, with ``edges`` b, a: positive where they would be released, zero at the end."""

    def closing(self, edges, arguments: tuple) -> np.ndarray:
        """Of orbits without contact, with ``edges`` d, c: negative where their gap would close, zero at the end."""

    def peak(self, sequence: str, edges, arguments: tuple, pressure) -> np.ndarray:
        """Of orbits of a ``sequence`` with contact: positive where their greatest pressure is above ``pressure``."""

    def waves(self, rate: np.ndarray) -> Waves:
        """Strips without adhesion at the rates ``k V`` (N,), 1/s."""

    def contact(self, strips, solved: Solved, scales: dict, index: np.ndarray) -> Contact:
        """Contact of the solved strips ``index``, as ``solve`` returned them."""

    def modulus_ratio(self, rate) -> np.ndarray:
        """``|K*(i rate)|/K``."""

    def saturation_pressure(self, p_0, l, h, V) -> np.ndarray:  # noqa: E741
        """Nominal pressure from which a level is in saturated contact when unloading, Pa."""

    def saturation_penetration(self, p_0, l, h, V) -> np.ndarray:  # noqa: E741
        """Penetration at that pressure, m."""

    def saturation_friction(self, l, h, V) -> np.ndarray:  # noqa: E741
        """Friction of a level in saturated contact, Pa."""

    def surely_saturated(self, p_0, l, h, V) -> np.ndarray:  # noqa: E741
        """A penetration above which every strip of a level has no orbit but saturated contact, m."""


def foundation_of(material) -> Foundation:
    """The material under one level, with its solver; with one time it is the standard linear solid, however it is written."""
    if isinstance(material, HalfSpace):
        raise TypeError("a half-space has a foundation for each level: give its at_wavelength(l)")
    material = reduced(material)
    if isinstance(material, StandardLinearSolid):
        from .single import SingleTime

        return SingleTime(kernel_of(material), material)
    from .modes.foundation import ManyTimes

    return ManyTimes(kernel_of(material), material)

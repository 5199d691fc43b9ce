"""A material with its generated solver, as levels and strips use it."""

from ..inputs.half_space import HalfSpace
from ..inputs.material import StandardLinearSolid
from ..inputs.materials import kernel_of, reduced
from .abstract_foundation import Foundation


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

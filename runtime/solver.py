"""Which generated solver belongs to a material."""

from __future__ import annotations

from types import ModuleType


def kernel_of(material) -> ModuleType:
    """Generated module that solves ``material``."""
    from hystrip.generated import standard_linear_solid

    return standard_linear_solid

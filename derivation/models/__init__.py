"""The viscoelastic models that ship with the derivation, one file each."""

from .standard_linear_solid import STANDARD_LINEAR_SOLID

MODELS = (STANDARD_LINEAR_SOLID,)

__all__ = ["MODELS", "STANDARD_LINEAR_SOLID"]

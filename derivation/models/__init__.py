"""The viscoelastic models that ship with the derivation, one file each."""

from .generalised import GENERALISED, prony_model
from .kelvin_voigt import KELVIN_VOIGT
from .operators import operator_model
from .standard_linear_solid import STANDARD_LINEAR_SOLID

MODELS = (STANDARD_LINEAR_SOLID, KELVIN_VOIGT, GENERALISED)

__all__ = [
    "GENERALISED",
    "KELVIN_VOIGT",
    "MODELS",
    "STANDARD_LINEAR_SOLID",
    "operator_model",
    "prony_model",
]

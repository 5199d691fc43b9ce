"""Derivation of the strip solver: a viscoelastic model in, verified and emitted NumPy out.

The stages, each a function from one frozen dataclass to the next:
model -> strip -> flows -> jumps -> zones, events -> saturated, level, regimes -> averages, energy, stability -> conditions,
multilevel -> emit -> certify -> pages. A quantity is derived by one function, whose docstring shows the equation and
the paper's number ("Eq. 13") and whose checks stand under it; :mod:`.check` says what a check is, :mod:`.exact` what zero is.

A model given by its Prony series, with any number of relaxation times, goes through the same stages in :mod:`.modes`.
"""

from . import required as required  # first
from .check import Check, DerivationError, Derived
from .derive import derive
from .drift import Drift, check
from .folder import generated_folder, stored_bounds
from .model import Model, Parameter, Roots, Series
from .models import GENERALISED, KELVIN_VOIGT, MODELS, STANDARD_LINEAR_SOLID, load_model, operator_model, prony_model
from .outcome import Derivation
from .pages.publish import AuditError, audit
from .regenerate import CertificateError, regenerate

__all__ = [
    "GENERALISED",
    "KELVIN_VOIGT",
    "MODELS",
    "STANDARD_LINEAR_SOLID",
    "AuditError",
    "CertificateError",
    "Check",
    "Derivation",
    "DerivationError",
    "Derived",
    "Drift",
    "Model",
    "Parameter",
    "Roots",
    "Series",
    "audit",
    "check",
    "derive",
    "generated_folder",
    "load_model",
    "operator_model",
    "prony_model",
    "regenerate",
    "stored_bounds",
]

"""Derivation of the strip solver: a viscoelastic model in, verified and emitted NumPy out.

The stages, each a function from one frozen dataclass to the next:
model -> strip -> flows -> jumps -> zones, events -> saturated, level, regimes -> averages, energy, stability -> conditions,
multilevel, stack -> emit -> certify -> pages. A quantity is derived by one function, whose docstring shows the equation and
the paper's number ("Eq. 13") and whose checks stand under it; :mod:`.check` says what a check is, :mod:`.exact` what zero is.
"""

from .check import Check, DerivationError, Derived
from .derive import Derivation, derive
from .drift import CertificateError, Drift, check, generated_folder, regenerate, stored_bounds
from .model import Model, Parameter
from .models import MODELS, STANDARD_LINEAR_SOLID
from .pages.publish import AuditError, audit

__all__ = [
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
    "audit",
    "check",
    "derive",
    "generated_folder",
    "regenerate",
    "stored_bounds",
]

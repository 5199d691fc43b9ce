"""Which pipeline a model goes through: that for one relaxation time, or that for its Prony series."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from types import ModuleType

from .certify import Certificate, certify
from .derive import STAGES, Derivation, derive
from .model import Model
from .modes.certificates import certify_modes, measured_names
from .modes.derive import STAGES as STAGES_OF_MODES
from .modes.derive import ModesDerivation, derive_modes

AnyDerivation = Derivation | ModesDerivation
Progress = Callable[[str], None]


def stages_of(model: Model) -> tuple[str, ...]:
    """Names of the stages that :func:`derive_any` reports."""
    return STAGES_OF_MODES if model.series else STAGES


def derive_any(model: Model, progress: Progress | None = None) -> AnyDerivation:
    """Derive and verify everything that follows from a model; raises :class:`DerivationError` for an inadmissible one."""
    return derive_modes(model, progress) if model.series else derive(model, progress)


def certificates_of(derivation: AnyDerivation, solver: ModuleType) -> Iterator[Certificate]:
    """Measure every function of a derivation as ``solver`` computes it."""
    if isinstance(derivation, ModesDerivation):
        return certify_modes(derivation, solver)
    return certify(derivation, solver)


def certified_names(derivation: AnyDerivation) -> list[str]:
    """Names of the functions that have a certificate."""
    if isinstance(derivation, ModesDerivation):
        return measured_names(derivation)
    return [kernel.formula.name for kernel in derivation.kernels]

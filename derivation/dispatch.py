"""Which pipeline a model goes through: that for one relaxation time, or that for its Prony series."""

from __future__ import annotations

from collections.abc import Callable

from .derive import STAGES, Derivation, derive
from .membership import require_member
from .model import Model
from .modes.derive import STAGES as STAGES_OF_MODES
from .modes.derive import ModesDerivation, derive_modes

AnyDerivation = Derivation | ModesDerivation
Progress = Callable[[str], None]


def stages_of(model: Model) -> tuple[str, ...]:
    """Names of the stages that :func:`derive_any` reports."""
    return STAGES_OF_MODES if model.series else STAGES


def derive_any(model: Model, progress: Progress | None = None) -> AnyDerivation:
    """Derive and verify everything that follows from a model; raises :class:`DerivationError` for an inadmissible one."""
    require_member(model)
    return derive_modes(model, progress) if model.series else derive(model, progress)

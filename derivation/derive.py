"""The derivation of a model: from the paper's operators, of one relaxation time, or from a Prony series of any number."""

from types import ModuleType

from . import one_time
from .membership import require_member
from .model import Model
from .modes import several_times
from .outcome import Derivation, Progress


def stages_of(model: Model) -> int:
    """How many stages :func:`derive` reports."""
    return _stages(model).STAGES


def derive(model: Model, progress: Progress | None = None) -> Derivation:
    """Derive and verify everything that follows from a model; raises :class:`DerivationError` for an inadmissible one.

    ``progress`` is called after each stage.
    """
    require_member(model)
    return _stages(model).derive(model, progress)


def _stages(model: Model) -> ModuleType:
    """The list of stages that a model goes through."""
    return several_times if model.series else one_time

"""The derivation of a model: from the paper's operators, of one relaxation time, or from a Prony series of any number."""

from . import one_time
from .membership import require_member
from .model import Model
from .modes import several_times
from .outcome import Derivation


def derive(model: Model) -> Derivation:
    """Derive and verify everything that follows from a model; raises :class:`DerivationError` for an inadmissible one."""
    require_member(model)
    return (several_times if model.series else one_time).derive(model)

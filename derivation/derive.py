"""Deriving models: from the paper's operators, of one relaxation time, or from a Prony series of any number."""

from collections.abc import Callable, Iterable, Iterator
from typing import TypeVar

from hystrip.errors import InputError

from . import one_time
from .membership import require_member
from .model import Model
from .models import MODELS, require_names
from .modes import several_times
from .outcome import Derivation

Report = Callable[[int, int], None]
Item = TypeVar("Item")


def derive(model: Model) -> Derivation:
    """Derive and verify everything that follows from a model; raises :class:`DerivationError` for an inadmissible one."""
    require_names((model,))
    require_member(model)
    return (several_times if model.series else one_time).derive(model)


def derivations_of(models: Iterable[Model] | None, report: Report | None) -> tuple[Derivation, ...]:
    """Those of ``models``, or of the models that ship; their names must be free.

    Raises :class:`hystrip.InputError` unless there is a model.
    """
    chosen = MODELS if models is None else tuple(models) if isinstance(models, Iterable) else ()
    if not chosen:
        raise InputError("models", models, "at least one hystrip.derivation.Model in a list, or None for those that ship")
    require_names(chosen)
    return tuple(reported(map(derive, chosen), report, len(chosen)))


def reported(items: Iterable[Item], report: Report | None, total: int) -> Iterator[Item]:
    """The ``total`` items; ``report``, if any, is called with (done, total) as each is made."""
    for done, item in enumerate(items, start=1):
        if report is not None:
            report(done, total)
        yield item

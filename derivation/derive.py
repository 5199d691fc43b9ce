"""Deriving models: from the paper's operators, of one relaxation time, or from a Prony series of any number."""

from collections.abc import Callable, Iterable, Iterator
from typing import TypeVar

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
    require_member(model)
    return (several_times if model.series else one_time).derive(model)


def derivations_of(models: Iterable[Model] | None, report: Report | None) -> tuple[Derivation, ...]:
    """Those of ``models``, or of the models that ship; their names must be free."""
    chosen = tuple(models) if models is not None else MODELS
    require_names(chosen)
    return tuple(reported(map(derive, chosen), report, len(chosen)))


def reported(items: Iterable[Item], report: Report | None, total: int) -> Iterator[Item]:
    """The ``total`` items; ``report``, if any, is called with (done, total) as each is made."""
    for done, item in enumerate(items, start=1):
        if report is not None:
            report(done, total)
        yield item

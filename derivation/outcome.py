"""What the derivation of a model comes to: its stages, the kernels to emit, and every verified quantity."""

from collections.abc import Iterator
from dataclasses import dataclass, fields, is_dataclass
from typing import Any

from .check import Derived
from .kernel import Kernel
from .model import Model
from .paper.record import Comparison


@dataclass(frozen=True)
class Derivation:
    """Everything derived for one model. ``sections`` holds the kernels to emit; ``steps`` every verified quantity."""

    kind: str  # "one_time" or "several_times": which list of stages
    model: Model
    stages: tuple[Any, ...]
    regimes: tuple[Any, ...]
    sections: tuple[tuple[str, tuple[Kernel, ...]], ...]
    displayed: dict[str, str]  # by step: what is said of its LaTeX, read back and compared
    comparisons: tuple[Comparison, ...] = ()  # of the paper's equations; none for another foundation
    composed: tuple[Any, ...] = ()  # regimes with edges whose functions are put together from kernels, for several times
    whole: tuple[Kernel, ...] = ()  # what the functions of the template have to come to

    @property
    def steps(self) -> tuple[Derived, ...]:
        """Every derived quantity once, in the order of the derivation."""
        return tuple({id(record): record for record in records(self.stages)}.values())

    @property
    def kernels(self) -> tuple[Kernel, ...]:
        return tuple(kernel for _, kernels in self.sections for kernel in kernels)


def records(value: Any) -> Iterator[Derived]:
    """Every derived quantity in what a stage made."""
    if isinstance(value, Derived):
        yield value
    elif isinstance(value, (tuple, list)):
        for item in value:
            yield from records(item)
    elif is_dataclass(value) and not isinstance(value, type):
        for item in fields(value):
            yield from records(getattr(value, item.name))

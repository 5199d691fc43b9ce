"""Every emitted function of a model with n modes is measured, one after the other."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from ...certify import Certificate
from ..derive import ModesDerivation
from .kernels import measure
from .regimes import measure_regimes, regime_names
from .whole import measure_whole, whole_names


def certify_modes(derivation: ModesDerivation, solver: Any) -> Iterator[Certificate]:
    """Measure every function of the emitted module, as ``solver`` computes it."""
    yield from measure_whole(derivation, solver)
    for kernel in derivation.kernels:
        yield measure(kernel, derivation.law, solver)
    yield from measure_regimes(derivation, solver)


def measured_names(derivation: ModesDerivation) -> list[str]:
    """Names of the functions that :func:`certify_modes` measures."""
    return [*whole_names(derivation), *(kernel.formula.name for kernel in derivation.kernels), *regime_names(derivation)]

"""Every emitted function of a derivation is measured, one after the other."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from types import ModuleType

from ..model import Model
from ..outcome import Derivation
from .material import NAME, measure_material
from .measure import COUNTS, Certificate, measure
from .regimes import measure_regimes, regime_names


def modes_of(model: Model) -> Sequence[int]:
    """The numbers of relaxation times at which a model is measured; none for a foundation with a single time."""
    if model.series is None:
        return ()
    return COUNTS if model.modes is None else (model.modes,)


def certificates_of(derivation: Derivation, solver: ModuleType) -> Iterator[Certificate]:
    """Measure every function of a derivation as ``solver`` computes it."""
    modes = modes_of(derivation.model)
    if derivation.model.stated:
        yield measure_material(derivation.model, derivation.model.series, solver, modes)
    for kernel in (*derivation.whole, *derivation.kernels):
        yield measure(kernel, solver, modes)
    yield from measure_regimes(derivation.composed, derivation.kernels, solver, modes)


def certified_names(derivation: Derivation) -> list[str]:
    """Names of the functions that have a certificate.

    Not among them is material_modes of a model given by operators, whose times are roots of polynomials as badly conditioned
    as the user's parameters make them; nor prony of a bare dashpot, whose modulus is infinite.
    """
    stated = [NAME] if derivation.model.stated else []
    kernels = [kernel.formula.name for kernel in (*derivation.whole, *derivation.kernels)]
    return [*stated, *kernels, *regime_names(derivation.composed)]

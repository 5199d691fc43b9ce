"""Every emitted function of a derivation is measured, one after the other."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from types import ModuleType

from ..derive import Derivation
from ..modes.derive import ModesDerivation
from .material import NAME, measure_material
from .measure import MODES, Certificate, measure
from .regimes import measure_regimes, regime_names
from .whole import whole_kernels


def modes_of(derivation: Derivation | ModesDerivation) -> Sequence[int]:
    """The numbers of relaxation times at which a derivation is measured; none for a foundation with a single time."""
    if isinstance(derivation, Derivation):
        return ()
    return MODES if derivation.model.modes is None else (derivation.model.modes,)


def certificates_of(derivation: Derivation | ModesDerivation, solver: ModuleType) -> Iterator[Certificate]:
    """Measure every function of a derivation as ``solver`` computes it."""
    modes = modes_of(derivation)
    kernels = derivation.kernels
    if isinstance(derivation, ModesDerivation):
        if derivation.model.stated:
            yield measure_material(derivation.model, derivation.model.series, solver, modes)
        kernels = (*whole_kernels(derivation), *kernels)
    for kernel in kernels:
        yield measure(kernel, solver, modes)
    if isinstance(derivation, ModesDerivation):
        yield from measure_regimes(derivation.regimes, derivation.kernels, solver, modes)


def certified_names(derivation: Derivation | ModesDerivation) -> list[str]:
    """Names of the functions that have a certificate.

    Not among them is material_modes of a model given by operators, whose times are roots of polynomials as badly conditioned
    as the user's parameters make them; nor prony of a bare dashpot, whose modulus is infinite.
    """
    names = [kernel.formula.name for kernel in derivation.kernels]
    if isinstance(derivation, ModesDerivation):
        stated = [NAME] if derivation.model.stated else []
        names = [
            *stated,
            *(kernel.formula.name for kernel in whole_kernels(derivation)),
            *names,
            *regime_names(derivation.regimes),
        ]
    return names

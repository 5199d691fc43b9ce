"""Every emitted function of a derivation is measured, one after the other."""

from collections.abc import Iterator, Sequence
from functools import cache, partial
from types import ModuleType
from typing import Any

import mpmath

from ..kernel import Kernel
from ..model import Model
from ..modes.emit import KINDS
from ..modes.symbols import OF_STRIP
from ..outcome import Derivation
from ..sequences import Row
from .composition import Composition
from .grid import drawn
from .material import NAME, measure_material
from .measure import COUNTS, DIGITS, Certificate, grid, measure
from .reference import Reference

POINTS = 8
AGREED_UP_TO = 2  # modes; how derivatives are put together does not depend on their number


def modes_of(model: Model) -> Sequence[int]:
    """The numbers of relaxation times at which a model is measured; none for a foundation with a single time."""
    if model.series is None:
        return ()
    return COUNTS if model.modes is None else (model.modes,)


def certificates_of(derivation: Derivation, solver: ModuleType) -> Iterator[Certificate]:
    """Measure every function of a derivation as ``solver`` computes it."""
    modes = modes_of(derivation.model)
    if derivation.model.stated:
        yield measure_material(derivation.model, solver, modes)
    for kernel in (*derivation.whole, *derivation.kernels):
        yield measure(kernel, solver, modes)
    yield from measure_regimes(derivation.composed, derivation.kernels, solver, modes)


def certified_names(derivation: Derivation) -> list[str]:
    """Names of the functions that have a certificate.

    Not among them is material_modes of a model given by operators, whose times are roots of polynomials as badly conditioned
    as the user's parameters make them.
    """
    stated = [NAME] if derivation.model.stated else []
    kernels = [kernel.formula.name for kernel in (*derivation.whole, *derivation.kernels)]
    return [*stated, *kernels, *(f"{kind}_{regime.sequence}" for regime in derivation.composed for kind in KINDS)]


def measure_regimes(
    regimes: Sequence[Row], kernels: Sequence[Kernel], solver: Any, modes: Sequence[int], points: int = POINTS
) -> Iterator[Certificate]:
    """Measure every function of ``regimes``, which have edges, against the derived zones put together.

    Raises :class:`DerivationError` where a derivative, as the emitted functions put it together, is not that of the zones.
    """
    exact = {kernel.formula.name: kernel.exact for kernel in kernels}
    blocks = cache(lambda name: Reference(exact[name]))
    for regime in regimes:
        args = (*regime.edges, *OF_STRIP)
        found = {kind: Certificate(f"{kind}_{regime.sequence}", args) for kind in KINDS}
        dashpots = False if regime.sequence == "afc" else None  # a snap into contact needs an instantaneous compliance
        with mpmath.workdps(DIGITS):
            for count, index in grid(modes, points):
                for narrow in (False, True):
                    seed = f"{regime.sequence} {index}{' narrow' * narrow}"
                    point = drawn(args, seed, count, dashpots=dashpots, narrow=narrow)
                    truth = Composition(regime, blocks, point).functions(agreed=count <= AGREED_UP_TO and index < 1)
                    for kind, certificate in found.items():
                        certificate.see(partial(point.called, solver, certificate.name, args), truth[kind], point.shown())
        yield from found.values()

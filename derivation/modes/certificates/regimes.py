"""The functions of every regime with edges, against the derived zones put together."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import mpmath
import numpy as np

from ...certify import Certificate
from ...symbols import D, delta_0, p_0
from ..derive import ModesDerivation
from .composition import BLOCKS, Composition
from .inputs import RegimeInputs
from .reference import DIGITS, Reference
from .worst import Worst

KINDS = ("state", "passages", "residual", "jacobian", "return_map", "means")
POINTS = 12
MANY = 4  # modes, from which a point of the reference costs so much that half as many do


def regime_names(derivation: ModesDerivation) -> list[str]:
    """Names of the functions that :func:`measure_regimes` measures."""
    return [f"{kind}_{regime.sequence}" for regime in derivation.regimes if regime.edges for kind in KINDS]


def measure_regimes(derivation: ModesDerivation, solver: Any, points: int | None = None) -> Iterator[Certificate]:
    """Measure every function of every regime with edges, as ``solver`` computes it.

    Raises :class:`DerivationError` where a derivative, as the emitted functions put it together, is not that of the zones.
    """
    law = derivation.law
    points = points or (POINTS if law.modes < MANY else POINTS // 2)
    with mpmath.workdps(DIGITS):
        blocks = {k.formula.name: Reference(k.exact, law.modes) for k in derivation.kernels if k.formula.name in BLOCKS}
    for regime in derivation.regimes:
        if not regime.edges:
            continue
        worst = {kind: Worst(f"{kind}_{regime.sequence}") for kind in KINDS}
        with mpmath.workdps(DIGITS):
            for index in range(points):
                inputs = RegimeInputs(law, regime, f"{regime.sequence} {index}")
                truth = Composition(regime, blocks, inputs.exact, law.modes).functions()
                given = [inputs.given[symbol] for symbol in regime.edges]
                parameters = (inputs.given[p_0], inputs.given[delta_0], inputs.given[D])
                for kind in KINDS:
                    with np.errstate(all="raise", under="ignore"):
                        found = getattr(solver, f"{kind}_{regime.sequence}")(*given, inputs.modes(solver), *parameters)
                    worst[kind].see(found, truth[kind], inputs.shown())
        for kind in KINDS:
            yield worst[kind].certificate()

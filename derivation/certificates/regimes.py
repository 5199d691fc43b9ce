"""The functions of every regime with edges on a foundation with modes, against the derived zones put together."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import cache, partial
from typing import Any

import mpmath

from ..kernel import Kernel
from ..modes.regimes import ModeRegime
from ..modes.symbols import OF_STRIP
from .composition import Composition
from .grid import drawn
from .measure import DIGITS, Certificate, points_at
from .reference import Reference

KINDS = ("state", "passages", "residual", "residual_and_jacobian", "return_map", "means")
POINTS = 8
AGREED_UP_TO = 2  # modes; how derivatives are put together does not depend on their number


def regime_names(regimes: Sequence[ModeRegime]) -> list[str]:
    """Names of the functions that :func:`measure_regimes` measures."""
    return [f"{kind}_{regime.sequence}" for regime in regimes for kind in KINDS]


def measure_regimes(
    regimes: Sequence[ModeRegime], kernels: Sequence[Kernel], solver: Any, modes: Sequence[int], points: int = POINTS
) -> Iterator[Certificate]:
    """Measure every function of ``regimes``, which have edges, as ``solver`` computes it.

    Raises :class:`DerivationError` where a derivative, as the emitted functions put it together, is not that of the zones.
    """
    exact = {kernel.formula.name: kernel.exact for kernel in kernels}
    blocks = cache(lambda name: Reference(exact[name]))
    for regime in regimes:
        args = (*regime.edges, *OF_STRIP)
        found = {kind: Certificate(f"{kind}_{regime.sequence}", args) for kind in KINDS}
        with mpmath.workdps(DIGITS):
            for count in modes:
                for index in range(points_at(count, points)):
                    # a snap into contact needs an instantaneous compliance
                    point = drawn(args, f"{regime.sequence} {index}", count, dashpots=False if regime.sequence == "afc" else None)
                    truth = Composition(regime, blocks, point).functions(agreed=count <= AGREED_UP_TO and index < 1)
                    given = [point.argument(symbol, solver) for symbol in args]
                    for kind in KINDS:
                        function = partial(getattr(solver, f"{kind}_{regime.sequence}"), *given)
                        found[kind].see(function, truth[kind], point.shown())
        yield from found.values()

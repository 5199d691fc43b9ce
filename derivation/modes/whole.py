"""What the functions of the template come to that stand beside the zones: the modes of a strip, and of the material."""

from __future__ import annotations

import sympy as sp

from ..functions import Formula
from ..kernel import Kernel
from ..symbols import K, alpha, beta
from .symbols import J_0, J, S, enter, eta, leave, m, share

kV = sp.Symbol("kV", nonnegative=True)


def whole_kernels(springs: bool) -> tuple[Kernel, ...]:
    """Their exact values. ``springs``: every branch has one."""
    passing = (*(kV * time for time in (alpha, beta, eta)), S, J, J_0, enter, leave, share)
    prony, retardation = (K / S, alpha), (J_0 / K, J / K, beta)
    return (
        Kernel(Formula("at_speed", (m, kV), passing), passing, None),
        *([Kernel(Formula("prony", (K, m), prony), prony, None, moving=True, springs=True)] if springs else []),
        Kernel(Formula("retardation", (K, m), retardation), retardation, None),
    )

"""The surface of one level (Eq. 4) and what a strip at y sees of it (Eq. 8). SI."""

import sympy as sp

from .integral import integral
from .symbols import D, D_level, h, k, l, s, x, y

HEIGHT = h - h / 4 * (sp.cos(k * x) + 1) * (sp.cos(k * y) + 1)
"""Eq. 4: f(x, y), how far the rigid surface stands back from its crest."""

AMPLITUDE = h / 4 * (1 + sp.cos(k * y))
"""Eq. 8: A(y)."""

PENETRATION = D_level - h / 2 * (1 - sp.cos(k * y))
"""Eq. 8: D_j(y), the strip's own penetration."""


RIGID = D - 1 + sp.cos(s)
"""What a strip sees of the surface, u(s), with lengths in A and s = -k x; see the step "strip profile"."""

WAVE = {k: 2 * sp.pi / l}
"""The wave number by the wavelength."""


def mean_over_wave(quantity: sp.Expr, along: sp.Symbol) -> sp.Expr:
    """Mean over one wavelength along x or y."""
    return integral(quantity, along, 0, 2 * sp.pi / k) * k / (2 * sp.pi)


def mean_over_cell(quantity: sp.Expr) -> sp.Expr:
    """Mean over one wavelength both ways."""
    return mean_over_wave(mean_over_wave(quantity, x), y)

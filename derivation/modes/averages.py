"""Means of a strip with n modes (Eq. 11): the integrals of the zones, summed."""

from __future__ import annotations

import sympy as sp

from ..check import Derived, derived
from .states import J_j, p, summed, w
from .symbols import J_0


def means_of_a_strip() -> Derived:
    r"""Eq. 11: The mean pressure is computed as the mean of w, equal to it on a closed orbit, because that sum holds
    no large terms that cancel; the friction is the work of p on the profile, zone by zone. Adhesion counts in both.

    .. math:: \bar p = \frac{1}{2\pi}\oint p\,ds = \frac{1}{2\pi}\oint w\,ds,\qquad \bar\tau = \frac{1}{2\pi}\oint p\,u'\,ds
    """
    z_j = sp.Symbol("z_j", real=True)
    checks = [
        summed(
            "d/ds sum beta_j z_j = p - w, and that sum is periodic: mean p = mean w on a closed orbit",
            J_j * p - z_j,
            [(p, (J_j, 1 - J_0)), (-1, (z_j, w - J_0 * p))],
            p - w,
            over={J_j, z_j},
        )
    ]
    return derived(
        means_of_a_strip,
        p - w,
        checks,
        emitted=tuple(f"means_{sequence}" for sequence in ("acaf", "afc", "af", "ac")),
    )

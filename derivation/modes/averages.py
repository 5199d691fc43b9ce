"""Means of a strip with n modes (Eq. 10): the integrals of the zones, summed."""

from __future__ import annotations

import sympy as sp

from ..check import REPRODUCED, Derived, derived
from .identity import vanishes
from .law import Law
from .symbols import J_0, J, numbered, z


def strip_means(law: Law) -> Derived:
    r"""Eq. 10, over one period of s:

    .. math:: \bar p = \frac1{2\pi}\oint p\,ds = \frac1{2\pi}\oint w\,ds,\qquad \bar\tau = \frac1{2\pi}\oint p\,u'\,ds
    """
    name = "means of a strip"
    p = sp.Symbol("p", real=True)
    states = [numbered(z, j) for j in range(law.modes)]
    w = law.values[J_0] * p + sp.Add(*states)
    # beta_j z_j' = J_j p - z_j: what p - w leaves over a period is the change of sum beta_j z_j, which is periodic.
    rates = [law.values[(J, j)] * p - state for j, state in enumerate(states)]
    checks = [
        vanishes(name, "p - w = d/ds sum beta_j z_j: mean p = mean w on a closed orbit", [p - w - sp.Add(*rates)], law.modes)
    ]
    return derived(
        strip_means,
        p - w,
        name=name,
        statement="The mean pressure is computed as the mean of w, equal to it on a closed orbit, because that sum "
        "holds no large terms "
        "that cancel; the friction is the work of p on the profile, zone by zone. Adhesion counts in both.",
        latex=r"\bar p = \frac{1}{2\pi}\oint p\,ds = \frac{1}{2\pi}\oint w\,ds,\qquad \bar\tau = \frac{1}{2\pi}\oint p\,u'\,ds",
        checks=checks,
        paper="Eq. 10",
        status=REPRODUCED,
        emitted=tuple(f"means_{sequence}" for sequence in ("acaf", "afc", "af", "ac", "a", "f")),
    )

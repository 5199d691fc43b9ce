"""Persson's theory of contact and rubber friction for the waves of a few levels (J. Chem. Phys. 115, 3840, 2001).

Waves come in one by one, the longest first. The stress that all waves up to q would have in complete contact has the variance
``sigma^2(q)``; of the area ``P(q) = erf(p/(sqrt(2) sigma))`` is in contact, and each wave rubs on the part that is in contact
when it is seen. Nothing here knows of single asperities: a wave counts by its spectrum alone.
"""

from math import sqrt

import numpy as np
from scipy.special import erf


def waves(levels):
    """(wavenumber, its part along the sliding, mean square height) of the waves of Eq. 4, the longest first."""
    found = []
    for level in levels:
        square = (level.h / 4) ** 2
        found += [(level.k, level.k, square / 2), (level.k, 0.0, square / 2), (sqrt(2) * level.k, level.k, square / 4)]
    return sorted(found)


def friction(material, levels, pressure, velocity):
    """Friction coefficient and contact fraction at velocities (n,), m/s, of a ``hystrip.HalfSpace`` without adhesion."""
    V = np.asarray(velocity, float)
    times, moduli = np.array(material.times), np.array(material.moduli)
    variance, tau = np.zeros(V.shape), np.zeros(V.shape)
    for q in sorted({size for size, _, _ in waves(levels)}):
        # waves of one length are seen together
        together = [(along, square) for size, along, square in waves(levels) if size == q]
        stiffness = []
        for along, _ in together:
            x = 1j * np.multiply.outer(along * V, times)
            stiffness.append((material.E + (x / (1 + x)) @ moduli) / (1 - material.nu**2) * q / 2)
        variance = variance + sum(np.abs(K) ** 2 * square for K, (_, square) in zip(stiffness, together, strict=True))
        contact = erf(pressure / np.sqrt(2 * variance))
        tau = tau + contact * sum(along * K.imag * square for K, (along, square) in zip(stiffness, together, strict=True))
    return tau / pressure, contact

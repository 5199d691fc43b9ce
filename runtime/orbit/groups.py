"""A batch of strips in dimensionless form: everything that a period of sliding needs, and nothing else."""

from dataclasses import dataclass

import numpy as np

from ..numerics.rounding import EPS
from .batch import Batch

TWO_PI = 2 * np.pi
#: rounding of a sum of a few terms, in the largest of them
ROUNDING = 64 * EPS


@dataclass(frozen=True, slots=True)
class Strips(Batch):
    """Dimensionless groups of a batch of strips, each an array of shape (n,).

    Lengths are divided by the amplitude A, pressures by K A. ``alpha = k V T_sigma``, ``beta = k V T_eps``,
    ``J = T_sigma/T_eps`` (instantaneous compliance times K), ``L = 1 - J``; ``chi`` is 0 under the continuous and 1
    under the constitutive closure. ``snaps``: the step of w at the adhesion onset closes the whole gap, ``J_0 p_0 >= delta_0``
    under the constitutive closure; as the amplitude has no part in it, it is decided in SI.
    """

    alpha: np.ndarray
    beta: np.ndarray
    J: np.ndarray
    L: np.ndarray
    p_0: np.ndarray
    delta_0: np.ndarray
    D: np.ndarray
    chi: np.ndarray
    snaps: np.ndarray

    @property
    def arguments(self) -> tuple:
        """What the kernel's functions of a regime take after the edges."""
        return self.alpha, self.beta, self.J, self.L, self.p_0, self.delta_0, self.D, self.chi

    def noise(self) -> np.ndarray:
        """What rounding may change in a displacement, (n,): every bound keeps this distance."""
        return ROUNDING * (1 + np.abs(self.D) + self.p_0 + self.delta_0)


@dataclass(frozen=True, slots=True)
class Cycle(Batch):
    """One period that starts at an onset of contact or adhesion, as constants of the march; arrays of shape (n,).

    Attributes:
        strips: the groups the march uses (the bare problem of an always adhering strip has them shifted).
        direct: contact starts at the onset itself: no adhesion before it (snap-in, or no adhesion at all).
        bare: no adhesion: contact ends to free where the pressure vanishes.
        gap_on: gap just after the onset. q_on: excess pressure ``p + p_0`` just after a direct onset.
        jump: step of w where adhesion ends, ``chi J p_0``.
        onset_step, release_step: of the load that drives the gap or the excess pressure, where adhesion (or, direct, contact)
            begins and where adhesion ends.
        centre: phase where the forcing H is largest; half_d, half_b, half_c: half widths of the arcs in which H
            exceeds ``-delta_0``, ``-p_0`` and ``-p_0 - delta_0``.
    """

    strips: Strips
    direct: np.ndarray
    bare: np.ndarray
    gap_on: np.ndarray
    q_on: np.ndarray
    jump: np.ndarray
    onset_step: np.ndarray
    release_step: np.ndarray
    centre: np.ndarray
    half_d: np.ndarray
    half_b: np.ndarray
    half_c: np.ndarray

    @property
    def touched(self) -> np.ndarray:
        """Where every orbit with an onset meets contact (``orbit_bounds``)."""
        return self.strips.D > -self.jump


def arc_versine(height):
    """Phase where ``1 - cos`` is this much, at most pi."""
    return 2 * np.arcsin(np.sqrt(np.minimum(np.maximum(0.5 * height, 0.0), 1.0)))


def snaps_in(step, delta_0) -> np.ndarray:
    """Where a ``step`` of w by ``J_0 p_0`` closes the gap ``delta_0``, in whatever unit; what is equal but for rounding does."""
    return (step > 0) & (step >= delta_0 * (1 - ROUNDING))


def adhesive_cycle(kernel, strips: Strips) -> Cycle:
    """Cycle of a strip that is free once per period and meets adhesion (or snaps into contact) at its onset."""
    direct, bare = strips.snaps, np.zeros(strips.size, bool)
    p_0, delta_0, J, L = strips.p_0, strips.delta_0, strips.J, strips.L
    gap, release_step = kernel.adhesive_onset(p_0, delta_0, J, L, strips.chi)
    excess, snap = kernel.snap_onset(p_0, delta_0, np.where(direct, J, 1.0), L)
    gap_on, q_on = np.where(direct, 0.0, gap), np.where(direct, np.maximum(excess, 0.0), 0.0)
    jump, onset_step = strips.chi * J * p_0, np.where(direct, snap, release_step)
    centre, halves = kernel.forcing_arc(np.array([delta_0, p_0, p_0 + delta_0]), strips.D, strips.beta)
    return Cycle(strips, direct, bare, gap_on, q_on, jump, onset_step, release_step, centre, *halves)


def bare_cycle(kernel, strips: Strips) -> Cycle:
    """Cycle of a strip without adhesion, or of one whose gap always adheres.

    The foundation law is unchanged when ``p_0`` is added to both w and p: a strip that adheres in the whole gap is the
    strip without adhesion at penetration ``D + p_0/K``, its pressure lowered by ``p_0``.
    """
    zero = np.zeros(strips.size)
    shifted = Strips(strips.alpha, strips.beta, strips.J, strips.L, zero, zero, strips.D + strips.p_0, strips.chi, strips.snaps)
    centre, half = kernel.forcing_arc(zero, shifted.D, shifted.beta)
    yes = np.ones(strips.size, bool)
    return Cycle(shifted, yes, yes, zero, zero, zero, zero, zero, centre, half, half, half)

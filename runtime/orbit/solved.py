"""Solutions of a batch, and how certified orbits are written into them."""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from ..numerics.rounding import EPS
from .batch import Batch
from .chain import EDGES
from .groups import Strips
from .march import TWO_PI, Orbit
from .regimes import CODE, EQUATIONS

UNDECIDED = -1
#: distances in roundings of D at which a strip on the end of a branch is settled
_SHIFTS = (8, 64, 512)


@dataclass(slots=True)
class Solved(Batch):
    """Solutions of a batch, arrays of shape (n,): regime code (``regimes.CODE``), edges as phases (NaN where absent),
    dimensionless means and fractions, which strips passed their certificate, and which an orbit was searched for."""

    code: np.ndarray
    d: np.ndarray
    b: np.ndarray
    a: np.ndarray
    c: np.ndarray
    p_mean: np.ndarray
    tau_mean: np.ndarray
    contact_fraction: np.ndarray
    adhesion_fraction: np.ndarray
    certified: np.ndarray
    searched: np.ndarray

    @classmethod
    def empty(cls, n: int) -> "Solved":
        nan = [np.full(n, np.nan) for _ in range(8)]
        return cls(np.full(n, UNDECIDED, np.int8), *nan, np.zeros(n, bool), np.zeros(n, bool))


def groups(s: Strips) -> tuple:
    """Dimensionless groups in the order in which the kernel's regime functions take them."""
    return s.alpha, s.beta, s.J, s.L, s.p_0, s.delta_0, s.D, s.chi


class Record:
    """Writes what is certain about the strips of a batch, of whatever foundation, into ``solved``; ``arguments`` of some of them:
    what the kernel's functions of a regime take after the edges."""

    def __init__(self, kernel, strips, arguments=groups):
        self.kernel, self.strips, self.arguments = kernel, strips, arguments
        self.solved = Solved.empty(strips.size)

    def saturated_contact(self, index) -> None:
        p_mean, tau_mean = self.kernel.means_c(*self.arguments(self.strips.among(index)))
        self.constant(index, "c", p_mean, tau_mean, 1.0, 0.0)

    def constant(self, index, sequence: str, p_mean, tau_mean, contact: float, adhesion: float) -> None:
        """A regime without edges."""
        out = self.solved
        out.code[index], out.certified[index] = CODE[sequence], True
        out.p_mean[index], out.tau_mean[index] = p_mean, tau_mean
        out.contact_fraction[index], out.adhesion_fraction[index] = contact, adhesion

    def orbits(self, index, sequence: str, orbit: Orbit) -> None:
        """Certified orbits that all have the same sequence of zones."""
        if not index.size:
            return
        out = self.solved
        out.code[index], out.certified[index] = CODE[sequence], True
        means = getattr(self.kernel, f"means_{EQUATIONS[sequence]}")
        out.p_mean[index], out.tau_mean[index] = means(*edges_of(sequence, orbit), *self.arguments(self.strips.among(index)))
        contact = np.clip(np.where(np.isnan(orbit.b), 0.0, orbit.a - orbit.b) / TWO_PI, 0.0, 1.0)  # a - b is rounded
        adhesion = {"cf": 0.0, "ac": 1 - contact}.get(sequence)
        out.contact_fraction[index] = contact
        out.adhesion_fraction[index] = (orbit.c - orbit.x) / TWO_PI - contact if adhesion is None else adhesion
        out.b[index], out.a[index] = orbit.b, orbit.a
        if sequence not in ("ac", "cf"):
            out.c[index] = orbit.c
            if sequence != "afc":
                out.d[index] = orbit.x


def edges_of(sequence: str, orbit: Orbit) -> np.ndarray:
    """Unknown edges of the regime's boundary equations, (k, n)."""
    return np.array([getattr(orbit, edge) for edge in EDGES[sequence]])


def orbit_of(sequence: str, edges: np.ndarray) -> Orbit:
    """The periodic orbit with these edges, (k, n) in the order of ``edges_of``."""
    absent = np.full(edges.shape[1], np.nan)
    places = {"acaf": (0, 1, 2, 3), "afc": (0, 0, 1, 2), "af": (0, None, None, 1), "ac": (0, 0, 1, 1), "cf": (0, 0, 1, 1)}
    x, b, a, c = (absent if place is None else edges[place] for place in places[sequence])
    return Orbit(x.copy(), b.copy(), a.copy(), c.copy(), np.zeros(x.size, bool), np.zeros(x.size))


def settle(solve: Callable, strips, solved: Solved, unloading: bool) -> None:
    """Decide strips that sit on the end of a branch to the last bits, where the tests of its two sides contradict each other.

    Which side they belong to is below the rounding of the inputs. They get the solution a few roundings of D further along the
    way their branch is followed: the unloading orbit is continuous towards larger D, the loading orbit towards smaller.
    """
    for roundings in _SHIFTS:
        index = np.flatnonzero(~solved.certified)
        if not index.size:
            return
        these = strips.take(index)
        shift = roundings * EPS * (1 + np.abs(these.D) + these.p_0 + these.delta_0)
        again = solve(replace(these, D=these.D + (shift if unloading else -shift)))
        again.searched |= solved.searched[index]
        good = np.flatnonzero(again.certified)
        solved.put(index[good], again.take(good))

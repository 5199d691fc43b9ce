"""Solutions of a batch, and how certified orbits are written into them."""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from ..numerics.rounding import EPS
from .batch import Batch
from .groups import TWO_PI
from .march import Orbit
from .regimes import CODE, EQUATIONS

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
        return cls(np.full(n, -1, np.int8), *nan, np.zeros(n, bool), np.zeros(n, bool))


class Record:
    """Writes what is certain about the strips of a batch, of whatever foundation, into ``solved``."""

    def __init__(self, kernel, strips):
        self.kernel, self.strips = kernel, strips
        self.solved = Solved.empty(strips.size)

    def saturated_contact(self, index) -> None:
        p_mean, tau_mean = self.kernel.means_c(*self.strips.among(index).arguments)
        self.constant(index, "c", p_mean, tau_mean, 1.0, 0.0)

    def saturated_adhesion(self, index) -> None:
        self.constant(index, "a", *self.kernel.means_a(*self.strips.among(index).arguments), adhesion=1.0)

    def constant(self, index, sequence: str, p_mean=0.0, tau_mean=0.0, contact: float = 0.0, adhesion: float = 0.0) -> None:
        """A regime without edges."""
        out = self.solved
        out.code[index], out.certified[index] = CODE[sequence], True
        out.p_mean[index], out.tau_mean[index] = p_mean, tau_mean
        out.contact_fraction[index], out.adhesion_fraction[index] = contact, adhesion

    def orbits(self, index, sequence: str, orbit: Orbit, certified=slice(None)) -> None:
        """Those of the orbits that are ``certified``, which all have the same sequence of zones."""
        index, orbit = index[certified], orbit[certified]
        if not index.size:
            return
        out = self.solved
        out.code[index], out.certified[index] = CODE[sequence], True
        means = getattr(self.kernel, f"means_{EQUATIONS[sequence]}")
        out.p_mean[index], out.tau_mean[index] = means(*orbit.edges(sequence), *self.strips.among(index).arguments)
        contact = np.clip(np.where(np.isnan(orbit.b), 0.0, orbit.a - orbit.b) / TWO_PI, 0.0, 1.0)  # a - b is rounded
        adhesion = {"cf": 0.0, "ac": 1 - contact}.get(sequence)
        out.contact_fraction[index] = contact
        out.adhesion_fraction[index] = (orbit.c - orbit.x) / TWO_PI - contact if adhesion is None else adhesion
        out.b[index], out.a[index] = orbit.b, orbit.a
        if sequence not in ("ac", "cf"):
            out.c[index] = orbit.c
            if sequence != "afc":
                out.d[index] = orbit.x


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

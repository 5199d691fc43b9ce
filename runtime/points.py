"""What is solved at points of velocity and load."""

from __future__ import annotations

import warnings
from dataclasses import dataclass, fields
from typing import TYPE_CHECKING

import numpy as np

from .errors import ConvergenceWarning

if TYPE_CHECKING:
    from .level.strips import WorkCounters


@dataclass
class Points:
    """Results at points (velocity, load), arrays (n,) and (levels, n), SI; ``error`` of the friction, ``p_error`` of ``p``: none
    where that was given."""

    D: np.ndarray
    p: np.ndarray
    tau: np.ndarray
    contact: np.ndarray
    adhesion: np.ndarray
    error: np.ndarray
    p_error: np.ndarray
    closed_form: np.ndarray
    pulled_off: np.ndarray

    @classmethod
    def unknown(cls, levels: int, n: int) -> Points:
        """So many points of which nothing is known yet."""
        nothing, by_level, none = np.zeros(n), np.zeros((levels, n)), np.zeros(n, bool)
        return cls(
            D=np.full(n, np.nan),
            p=nothing,
            tau=by_level,
            contact=by_level.copy(),
            adhesion=by_level.copy(),
            error=nothing.copy(),
            p_error=nothing.copy(),
            closed_form=none,
            pulled_off=none.copy(),
        )

    def improve(self, index: np.ndarray, finer: Points, surely: np.ndarray) -> None:
        """Put the points ``finer`` (k,) in the place of those at ``index`` (k,) that err by more or are ``surely`` (k,) worse."""
        better = np.flatnonzero((finer.error < self.error[index]) | surely)
        for f in fields(self):
            getattr(self, f.name)[..., index[better]] = getattr(finer, f.name)[..., better]

    def extend(self, tau: np.ndarray) -> None:
        """Add levels below that are saturated wherever the last one touches, with the frictions ``tau`` (more levels, n), Pa."""
        touching = self.contact[-1:]
        self.error = self.error + np.where(self.closed_form, 0.0, tau.sum(axis=0))
        self.tau = np.concatenate((self.tau, touching * tau))
        self.contact = np.concatenate((self.contact, np.broadcast_to(touching, tau.shape)))
        self.adhesion = np.concatenate((self.adhesion, np.zeros(tau.shape)))


def warn_unconverged(converged: np.ndarray, rtol: float, work: WorkCounters, **of: np.ndarray) -> None:
    """Warn, where the caller was called, of points that are not ``converged``; ``of`` (n,): their load, then their velocity."""
    lost = np.flatnonzero(~converged)
    if lost.size:
        first = ", ".join(f"{name} {values[lost[0]]:g}" for name, values in of.items())
        reason = work.reason(list(of.values())[-1][lost[0]])
        missed = f"{lost.size} of {converged.size} points did not converge to rtol = {rtol:g}"
        warnings.warn(f"{missed}; the first: {first}: {reason} (see error_estimate)", ConvergenceWarning, stacklevel=3)

"""What is solved at points of velocity and load."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from dataclasses import dataclass, fields

import numpy as np

from .errors import ConvergenceWarning


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

    @property
    def of_unknown_mu(self) -> np.ndarray:
        """Where the pressure, that of a penetration, may be zero for all that is known, (n,): mu may be anything there."""
        return (self.p != 0) & (self.p_error >= np.abs(self.p))

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


def warn_unconverged(converged: np.ndarray, rtol: float, reason: Callable[[int], str], **of: np.ndarray) -> None:
    """Warn, where the caller was called, of points that are not ``converged``; ``of`` (n,): their load and velocity. ``reason``:
    why one did not."""
    lost = np.flatnonzero(~converged)
    if lost.size:
        first = ", ".join(f"{name} {values[lost[0]]:g}" for name, values in of.items())
        missed = f"{lost.size} of {converged.size} points did not converge to rtol = {rtol:g}"
        warnings.warn(f"{missed}; the first: {first}: {reason(lost[0])} (see error_estimate)", ConvergenceWarning, stacklevel=3)

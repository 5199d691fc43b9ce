"""Greatest pressure in the contact of a strip, and where: over the width of the contact."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...numerics.chebyshev import coefficients, evaluate_each, lobatto
from ...numerics.quadrature import mapped
from ...orbit.foundation import Foundation

#: widths, and looks at each contact
_WIDTHS, _LOOKS = 16, 33
#: the least share of the period that a contact is looked at
_LEAST = 1e-6


@dataclass(frozen=True)
class Peaks:
    """Strips of velocities (G,) as far as the share ``top`` (G,) of their period in contact: ``series`` (G, n + 1, 2),
    of the greatest pressure, K A, over that share, and of its place, a share of the contact from the entry."""

    top: np.ndarray
    series: np.ndarray

    def part(self, which: slice) -> Peaks:
        """The velocities ``which`` alone."""
        return Peaks(self.top[which], self.series[which])

    def at(self, group: np.ndarray, share: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Greatest pressures and their places in contacts that are the ``share`` (m, nodes) of the period, those of row
        i at the velocity ``group[i]``."""
        x = np.clip(2 * share / self.top[group, None] - 1, -1.0, 1.0)
        values = evaluate_each(self.series[group], x)
        return share * np.maximum(values[:, :, 0], 0.0), np.clip(values[:, :, 1], 0.0, 1.0)


def peaks_of(foundation: Foundation, rate: np.ndarray, top: np.ndarray) -> tuple[Peaks, int]:
    """Peaks at the rates k V (G,) up to widths that are the share ``top`` (G,) of the period; and how many strips that
    took."""
    share = np.clip(top[:, None] * lobatto(_WIDTHS), _LEAST, 1 - _LEAST)
    greatest, place = peak(foundation, np.repeat(rate, _WIDTHS + 1), share.ravel())
    samples = np.stack((greatest.reshape(share.shape) / share, place.reshape(share.shape)), axis=2)
    return Peaks(top, coefficients(samples)), share.size


def peak(foundation: Foundation, rate: np.ndarray, share: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Greatest pressure, K A, in contacts that are the ``share`` (N,) of their period at the rates k V (N,), and its place:
    from looks at them that are closest at either end."""
    waves = foundation.waves(rate)
    pressure = waves.pressure(waves.orbits(2 * np.pi * share, means=False))
    t = np.linspace(0, 1, _LOOKS)
    looks = pressure(np.broadcast_to(mapped(t), (share.size, _LOOKS)))
    # the vertex of the parabola through the highest look and those next to it
    rows, highest = np.arange(share.size), np.clip(looks.argmax(axis=1), 1, _LOOKS - 2)
    before, at, after = (looks[rows, highest + k] for k in (-1, 0, 1))
    bend = before + after - 2 * at
    offset = np.divide(0.5 * (before - after), bend, out=np.zeros_like(bend), where=bend < 0)
    vertex = mapped(np.clip(t[highest] + offset * t[1], 0.0, 1.0))
    return np.maximum(pressure(vertex[:, None])[:, 0], looks.max(axis=1)), vertex

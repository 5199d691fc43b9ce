"""Greatest pressure in the contact of a strip, and where: over the width of the contact."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from hystrip.solver import Foundation

from ..chebyshev import lobatto
from .family import coefficients_over, evaluated
from .orbit import Wave
from .pressure import ContactPressure

#: widths, and looks at each contact
_WIDTHS, _LOOKS = 16, 24


@dataclass(frozen=True)
class Peaks:
    """Strips of velocities (G,) as far as the share ``top`` (G,) of their period in contact: ``series`` (G, n + 1, 2),
    of the greatest pressure, K A, and of its place, a share of the contact from the entry."""

    top: np.ndarray
    series: np.ndarray

    def part(self, which: slice) -> Peaks:
        """The velocities ``which`` alone."""
        return Peaks(self.top[which], self.series[which])

    def at(self, group: np.ndarray, share: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Greatest pressures and their places in contacts that are the ``share`` (m, nodes) of the period, those of row
        i at the velocity ``group[i]``."""
        x = np.clip(2 * share / self.top[group, None] - 1, -1.0, 1.0)
        values = evaluated(self.series[group], x)
        return np.maximum(values[:, :, 0], 0.0), np.clip(values[:, :, 1], 0.0, 1.0)


def peaks_of(foundation: Foundation, rate: np.ndarray, top: np.ndarray) -> tuple[Peaks, int]:
    """Peaks at the rates k V (G,) up to widths that are the share ``top`` (G,) of the period; and how many strips that took."""
    share = top[:, None] * lobatto(_WIDTHS)[1:]
    width = 2 * np.pi * np.clip(share, 1e-9, 1 - 1e-9)
    wave = Wave(foundation, np.repeat(rate, _WIDTHS))
    pressure = ContactPressure(wave, wave.orbits(width.ravel(), means=False))
    place = np.linspace(0, 1, _LOOKS)
    looks = pressure.at(np.broadcast_to(place, (width.size, _LOOKS)))
    # the vertex of the parabola through the highest look and those next to it
    rows, highest = np.arange(width.size), np.clip(looks.argmax(axis=1), 1, _LOOKS - 2)
    before, at, after = (looks[rows, highest + k] for k in (-1, 0, 1))
    bend = before + after - 2 * at
    offset = np.divide(0.5 * (before - after), bend, out=np.zeros_like(bend), where=bend < 0)
    vertex = np.clip(place[highest] + offset / (_LOOKS - 1), 0.0, 1.0)
    greatest = np.maximum(pressure.at(vertex[:, None])[:, 0], looks.max(axis=1))
    found = np.stack((greatest, vertex), axis=1).reshape(rate.size, _WIDTHS, 2)
    # what touches the least has no pressure
    ended = np.concatenate((np.stack((np.zeros(rate.size), found[:, 0, 1]), axis=1)[:, None], found), axis=1)
    return Peaks(top, coefficients_over(ended)), width.size

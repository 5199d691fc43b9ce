"""Rms height of a measured surface over wavelength, with the bands and levels that stand for it."""

from typing import Any

import numpy as np

from .style import COLUMN, OKABE_ITO, axes, styled

_PER_DECADE = 8


@styled
def roughness_levels(found: Any, scan: Any) -> Any:
    """Draw a :class:`hystrip.roughness.RoughnessLevels` over the spectrum of its :class:`hystrip.roughness.Scan`.

    Returns
    -------
    matplotlib Figure
    """
    q, variance = scan.spectrum()
    wavelengths = 2 * np.pi / q.max(axis=0)
    low, high = np.log10(wavelengths.min()), np.log10(wavelengths.max())
    edges = np.logspace(low, high + 1e-9, max(int(_PER_DECADE * (high - low)), 2) + 1)
    binned, _ = np.histogram(wavelengths, edges, weights=variance)
    rms = np.sqrt(binned)
    panel = axes(COLUMN, 0.75 * COLUMN)
    panel.stairs(np.where(rms > 0, rms, np.nan), edges, color="0.3", label=f"scan, {_PER_DECADE} parts per decade")
    for edge in np.unique(found.bands):
        panel.axvline(edge, color="0.6", linestyle=":", linewidth=0.7, zorder=0)
    for number, (level, height) in enumerate(zip(found.levels, found.rms_height, strict=True), start=1):
        panel.plot(level.l, height, "o", color=OKABE_ITO[0], markersize=4, label="levels" if number == 1 else None)
        panel.annotate(str(number), (level.l, height), xytext=(4, 3), textcoords="offset points", fontsize=7, color=OKABE_ITO[0])
    for band, height in zip(found.bands, found.rms_height, strict=True):
        panel.plot(band, [height, height], color=OKABE_ITO[0], linewidth=0.8)
    panel.set_xscale("log")
    panel.set_yscale("log")
    # what rounding leaves between the waves of a perfect surface is not worth decades of axis
    shown = rms[rms > 1e-4 * rms.max()]
    panel.set_ylim(0.5 * shown.min(), 2.5 * max(rms.max(), found.rms_height.max()))
    panel.set_xlim(edges[0], edges[-1])
    panel.set_xlabel("wavelength (m)")
    panel.set_ylabel("rms height (m)")
    panel.figure.legend(loc="outside upper center", ncols=2)
    return panel.figure

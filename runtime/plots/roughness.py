"""Rms height of a measured surface over wavelength, and of the levels that stand for it."""

from typing import Any

import numpy as np

from .style import COLUMN, OKABE_ITO, axes, styled

_PER_DECADE = 8


@styled
def roughness_levels(found: Any, scan: Any) -> Any:
    """Draw a :class:`hystrip.roughness.RoughnessLevels` over the spectrum of its :class:`hystrip.roughness.Scan`, as a matplotlib
    Figure.

    Both show the root mean square height of an eighth of a decade: that of a level is spread evenly over its band.
    """
    q, variance = scan.spectrum()
    wavelengths = 2 * np.pi / q.max(axis=0)
    low, high = np.log10(wavelengths.min()), np.log10(wavelengths.max()) + 1e-9
    edges = 10 ** (high - np.arange(np.ceil(_PER_DECADE * (high - low)) + 1) / _PER_DECADE)[::-1]
    binned, _ = np.histogram(wavelengths, edges, weights=variance)
    rms = np.sqrt(binned)
    panel = axes(COLUMN, 0.75 * COLUMN)
    panel.stairs(np.where(rms > 0, rms, np.nan), edges, color="0.3", label="scan")
    for edge in np.unique(found.bands):
        panel.axvline(edge, color="0.6", linestyle=":", linewidth=0.7, zorder=0)
    spread = found.rms_height / np.sqrt(_PER_DECADE * np.log10(found.bands[:, 0] / found.bands[:, 1]))
    for number, (level, band, height) in enumerate(zip(found.levels, found.bands, spread, strict=True), start=1):
        panel.plot(band, [height, height], color=OKABE_ITO[0], linewidth=0.8)
        panel.plot(level.l, height, "o", color=OKABE_ITO[0], markersize=4)
        panel.annotate(str(number), (level.l, height), xytext=(4, 3), textcoords="offset points", fontsize=7, color=OKABE_ITO[0])
    panel.plot([], [], "o-", color=OKABE_ITO[0], markersize=4, linewidth=0.8, label="levels, spread over their bands")
    panel.set_xscale("log")
    panel.set_yscale("log")
    # what rounding leaves between the waves of a perfect surface is not worth decades of axis
    shown = rms[rms > 1e-4 * rms.max()]
    panel.set_ylim(0.5 * shown.min(), 2.5 * max(rms.max(), spread.max()))
    panel.set_xlim(edges[0], edges[-1])
    panel.set_xlabel("wavelength (m)")
    panel.set_ylabel(f"rms height of 1/{_PER_DECADE} decade (m)")
    panel.figure.legend(loc="outside upper center", ncols=2)
    return panel.figure

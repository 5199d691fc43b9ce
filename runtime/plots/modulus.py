"""Storage and loss modulus over frequency: measured, and of the fitted series."""

from typing import Any

import numpy as np

from .style import COLUMN, DASHES, OKABE_ITO, axes, styled


@styled
def fitted_modulus(series: Any, data: Any, points: int = 400) -> Any:
    """Draw a :class:`hystrip.dma.PronySeries`, at ``points`` frequencies, over the :class:`hystrip.dma.DynamicModulus` that it
    was fitted to, as a matplotlib Figure."""
    panel = axes(COLUMN, 0.8 * COLUMN)
    omega = np.geomspace(data.omega[0], data.omega[-1], points)
    fitted, f = series.modulus(omega), omega / (2 * np.pi)
    measured = data.omega / (2 * np.pi)
    kind = series.kind
    mark = {"markersize": 2.6, "markerfacecolor": "none", "markeredgewidth": 0.6, "linestyle": "none"}
    for values, line, color, dash, marker, label in (
        (data.storage, fitted.real, OKABE_ITO[0], "-", "o", f"storage ${kind}'$"),
        (data.loss, fitted.imag, OKABE_ITO[1], DASHES[0], "^", f"loss ${kind}''$"),
    ):
        seen = values > 0  # a loss of zero has no place on a logarithmic axis
        panel.plot(measured[seen], values[seen], marker=marker, color=color, **mark)
        panel.plot(f, line, color=color, linestyle=dash, label=label)
    panel.plot([], [], marker="o", color="0.3", label="measured", **mark)
    panel.set_xscale("log")
    panel.set_yscale("log")
    inside = [rate for time in series.times if f[0] <= (rate := 1 / (2 * np.pi * time)) <= f[-1]]
    tick = {"marker": "|", "color": "0.3", "markersize": 5, "linestyle": "none", "label": r"$1/(2\pi\tau_j)$"}
    panel.plot(inside, np.full(len(inside), 0.03), transform=panel.get_xaxis_transform(), **tick)
    panel.set_xlim(f[0], f[-1])
    panel.set_xlabel("frequency $f$ (Hz)")
    panel.set_ylabel(f"modulus ${kind}$ (Pa)")
    panel.legend(loc="best")
    return panel.figure

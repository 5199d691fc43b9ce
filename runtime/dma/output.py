"""A fitted series as rows of a table, and as the ``[material]`` of a scene."""

from __future__ import annotations

from typing import Any

import numpy as np

from .modulus import DynamicModulus
from .series import PronySeries


def rows(series: PronySeries, data: DynamicModulus) -> dict[str, np.ndarray]:
    """Measured and fitted moduli, one row for each frequency."""
    fitted, kind = series.modulus(data.omega), series.kind
    return {
        "f [Hz]": data.omega / (2 * np.pi),
        f"{kind}_stor [Pa]": data.storage,
        f"{kind}_loss [Pa]": data.loss,
        f"{kind}_stor fitted [Pa]": fitted.real,
        f"{kind}_loss fitted [Pa]": fitted.imag,
    }


def material_table(series: PronySeries, length: float, source: str) -> tuple[dict[str, Any], str]:
    """Keys of the ``[material]`` table, and a comment that says where they are from."""
    low, high = series.band
    comment = (
        f"Fitted to {source}, {low:.4g} to {high:.4g} Hz: residuals {100 * series.rms_storage:.2g} % rms in storage, "
        f"{100 * series.rms_loss:.2g} % in loss modulus.\nStiffness per area is modulus over {length:.4g} m."
    )
    if len(series.times) == 1:
        solid = series.standard_linear_solid(length)
        return {"model": "standard_linear_solid", "K": solid.K, "T_eps": solid.T_eps, "T_sigma": solid.T_sigma}, comment
    if len(series.times) > 3:
        n = len(series.times)
        comment += f"\nhystrip has solvers for 2 and 3 times: for {n}, `hystrip regenerate` a model of so many and name its"
        comment += '\nfolder here: solver = "..."'
    each = series.foundation(length)
    return {"model": "prony", "K": each.K, "moduli": each.moduli, "times": each.times}, comment

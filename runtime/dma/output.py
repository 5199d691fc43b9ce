"""A fitted series as rows of a table, and as the ``[material]`` of a scene."""

from __future__ import annotations

import textwrap
from typing import TYPE_CHECKING, Any

import numpy as np

from ..inputs.half_space import HalfSpace
from ..inputs.shift import WLF
from .modulus import DynamicModulus
from .series import PronySeries

if TYPE_CHECKING:
    from ..inputs.prony import Prony
    from ..inputs.shift import Shift


SHEAR = "The moduli are shear moduli, G; Young's modulus is E = 2 (1 + nu) G."


def rows(series: PronySeries, data: DynamicModulus) -> dict[str, np.ndarray]:
    """Measured and fitted moduli, one row for each frequency."""
    fitted, kind = series.modulus(data.omega), series.kind
    return {
        "f [Hz]": data.frequency,
        f"{kind}_stor [Pa]": data.storage,
        f"{kind}_loss [Pa]": data.loss,
        f"{kind}_stor fitted [Pa]": fitted.real,
        f"{kind}_loss fitted [Pa]": fitted.imag,
    }


def material_tables(
    material: HalfSpace | Prony, series: PronySeries, source: str, length: float | None
) -> tuple[dict[str, dict[str, Any]], str]:
    """The ``[material]`` table and those below it by their names, and a comment that says where they are from."""
    comment = f"Fitted to {source}:\n" + "\n".join(textwrap.wrap(f"{series.quality}.", 110))
    if isinstance(material, HalfSpace):
        own: dict[str, Any] = {"kind": "half-space", "E": material.E, "nu": material.nu}
        if series.kind == "G":
            comment += f"\nE = 2 (1 + nu) G, with nu = {material.nu:.4g}."
    else:
        own = {"model": "prony", "K": material.K}
        comment += f"\nStiffness per area is modulus over {length:.4g} m."
        if series.kind == "G":
            comment += f"\n{SHEAR}"
    tables = {"material": own | {"moduli": material.moduli, "times": material.times}}
    if material.shift is not None:
        tables["material.shift"] = shift_table(material.shift)
    if series.fit is not None:
        tables["material.fit"] = {"edges": series.fit.edges, "rms": [float(f"{each:.3g}") for each in series.fit.rms]}
    return tables, comment


def shift_table(shift: Shift) -> dict[str, Any]:
    """Keys of ``[material.shift]``."""
    own = {"C_1": shift.C_1, "C_2": shift.C_2} if isinstance(shift, WLF) else {"E_a": shift.E_a}
    return {"model": type(shift).__name__, **own, "T_ref": shift.T_ref, "vertical": shift.vertical}

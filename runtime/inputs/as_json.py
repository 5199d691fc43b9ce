"""Materials, adhesion and levels as JSON: every number with all its digits."""

from __future__ import annotations

import json
import os
from dataclasses import asdict
from typing import TYPE_CHECKING

from ..errors import InputError
from ..loading import solver_key
from .adhesion import Dugdale, rebuild
from .fitted import FittedBand
from .half_space import HalfSpace
from .material import KelvinVoigt, StandardLinearSolid
from .model import ModelMaterial
from .prony import Prony
from .shift import WLF, Arrhenius
from .surface import Level

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ..loading import Solver
    from .materials import Material

#: constructor arguments of each model, but for the solver
_ARGUMENTS = {
    KelvinVoigt: ("K", "T_eps"),
    StandardLinearSolid: ("K", "T_eps", "T_sigma"),
    Prony: ("K", "moduli", "times"),
    HalfSpace: ("E", "nu", "moduli", "times"),
}

#: what a material may carry
_PARTS = {"WLF": WLF, "Arrhenius": Arrhenius, "FittedBand": FittedBand}


def material_text(material: Material) -> str:
    """The material as JSON: ``model`` and its parameters; for a solver of one's own its folder and the hash of its code."""
    if isinstance(material, ModelMaterial):
        described = {"model": material.kernel.MODEL, **material.given}
        folder = os.path.dirname(str(material.kernel.__file__))
        return json.dumps({**described, "solver": {"folder": folder, "key": solver_key(folder)}})
    described = {"model": type(material).__name__}
    described |= {name: getattr(material, name) for name in _ARGUMENTS[type(material)]}
    for name in ("shift", "fit"):
        part = getattr(material, name, None)
        if part is not None:
            described[name] = {"kind": type(part).__name__, **asdict(part)}
    solver = getattr(material, "solver", None)
    if solver is not None:
        described["solver"] = {"folder": str(solver.folder), "key": solver_key(solver.folder)}
    return json.dumps(described)


def material_of(text: str, solver: Solver | None) -> Material:
    """The material of :func:`material_text`. Raises InputError unless ``solver`` is the one it was solved with."""
    described = json.loads(text)
    model, wanted = described.pop("model"), described.pop("solver", None)
    for name in ("shift", "fit"):
        if name in described:
            part = described[name]
            described[name] = _PARTS[part.pop("kind")](**part)
    if wanted is not None:
        if solver is None:
            how = f"solver=hystrip.load_solver({wanted['folder']!r}): the material was solved with that code, which would run"
            raise InputError("solver", None, how)
        if solver_key(solver.folder) != wanted["key"]:
            raise InputError("solver", str(solver.folder), f"the code of {wanted['folder']} as it was when the result was solved")
        known = {kind.__name__ for kind in _ARGUMENTS}
        if model not in known:
            return solver.material(model, **described)
        described["solver"] = solver
    return next(kind for kind in _ARGUMENTS if kind.__name__ == model)(**described)


def adhesion_text(adhesion: Dugdale) -> str:
    """The adhesion as JSON."""
    return json.dumps({name: getattr(adhesion, name) for name in ("gamma", "p_0", "delta_0")})


def adhesion_of(text: str) -> Dugdale:
    """The adhesion of :func:`adhesion_text`."""
    return rebuild(**json.loads(text))


def levels_text(levels: Sequence[Level]) -> str:
    """Levels as JSON."""
    return json.dumps([{"l": level.l, "h": level.h} for level in levels])


def levels_of(text: str) -> tuple[Level, ...]:
    """The levels of :func:`levels_text`."""
    return tuple(Level(**each) for each in json.loads(text))

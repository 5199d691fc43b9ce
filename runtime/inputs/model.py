"""A material of a solver that a user has generated."""

from __future__ import annotations

from types import ModuleType
from typing import Any

import numpy as np

from ..errors import InputError
from .checks import numbers
from .material import StandardLinearSolid


class ModelMaterial:
    """Foundation whose model is that of a loaded solver; made by ``Solver.material``. Immutable.

    ``kernel``: the generated module; ``given``: its parameters; ``K``: relaxed stiffness, Pa/m; ``modes``: the
    kernel's ``Modes`` in seconds with a trailing axis of length one (single values only).
    """

    __slots__ = ("kernel", "given", "K", "modes")

    def __init__(self, kernel: ModuleType, given: dict[str, Any]):
        known = kernel.MATERIAL
        for name in given:
            if name not in known:
                raise InputError(f"material.{name}", given[name], f"parameters of {kernel.MODEL}: {', '.join(known)}")
        values = {}
        for name, (unit, _) in known.items():
            if name not in given:
                wanted = f"a value ({unit}) for every parameter of {kernel.MODEL}: {', '.join(known)}"
                raise InputError(f"material.{name}", None, wanted)
            array = numbers(f"material.{name}", given[name], unit)
            count = kernel.MODES or len(np.atleast_1d(given.get(kernel.MODE_PARAMETERS[0], ())))
            shape = (count,) if name in kernel.MODE_PARAMETERS else ()
            if array.shape != shape:
                wanted = f"{count} numbers, one for each relaxation time" if shape else "a single number"
                raise InputError(f"material.{name}", given[name], f"{wanted} ({unit})")
            values[name] = array
        K, modes = modes_of(kernel, {name: v[..., None] for name, v in values.items()})
        shown = {name: tuple(map(float, v)) if v.ndim else float(v) for name, v in values.items()}
        if modes.J_0[0] == 0 and np.count_nonzero(modes.eta) > 1:
            allowed = (
                "several relaxation times with a spring in every branch: an instantaneous compliance above 0 "
                "(with one time it may be 0)"
            )
            raise InputError("material", shown, allowed)
        for name, value in (("kernel", kernel), ("given", shown), ("K", float(np.ravel(K)[0])), ("modes", modes)):
            object.__setattr__(self, name, value)

    @property
    def single(self) -> StandardLinearSolid | None:
        """The standard linear solid that this is with at most one branch at work: Kelvin-Voigt where that has no
        spring; else None."""
        at_work = np.flatnonzero(self.modes.eta[:, 0])
        if at_work.size > 1:
            return None
        T_eps, T_sigma = (float(times[at_work, 0].sum()) for times in (self.modes.beta, self.modes.alpha))
        return StandardLinearSolid(self.K, T_eps, T_sigma)

    def at_wavelength(self, l: Any) -> ModelMaterial:  # noqa: E741 - the paper's symbol
        """The foundation under a level of wavelength ``l``, m: this one, which is local."""
        return self

    def at_temperature(self, temperature: float) -> ModelMaterial:
        """Refused: which of its parameters are times, and which moduli, is the model's own affair."""
        raise InputError("temperature", temperature, f"None: what it does to {self.kernel.MODEL} is not known")

    def __setattr__(self, name, value):
        raise AttributeError(f"a material is immutable: {name} cannot be set")

    def __repr__(self):
        return f"{self.kernel.MODEL}({', '.join(f'{name}={value!r}' for name, value in self.given.items())})"

    def __eq__(self, other):
        return isinstance(other, ModelMaterial) and self.kernel is other.kernel and self.given == other.given

    def __hash__(self):
        return hash((self.kernel.MODEL, tuple(self.given.items())))


def modes_of(kernel: ModuleType, values: dict[str, np.ndarray]) -> tuple[np.ndarray, Any]:
    """``kernel.material_modes`` with its refusals as ``InputError``: K and the ``Modes`` in seconds."""
    try:
        K, modes = kernel.material_modes(**values)
    except ValueError as error:
        shown = {name: np.ravel(v).tolist() for name, v in values.items()}
        raise InputError("material", shown, f"an admissible material: {error}") from None
    one = lambda a: a[..., None] if np.ndim(modes.J_0) == 0 else a  # noqa: E731
    return np.asarray(K), type(modes)(*(one(np.asarray(a, float)) for a in modes))

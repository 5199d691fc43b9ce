"""Solvers that ``hystrip regenerate`` has written outside the package."""

import copyreg
import hashlib
import importlib
import importlib.util
import os
import sys
from pathlib import Path
from types import ModuleType
from typing import Any

from .errors import InputError
from .files import path_of
from .inputs.model import ModelMaterial

#: version of the interface of emitted solvers that this runtime speaks
INTERFACE = 1


class Solver:
    """A loaded solver folder: ``models`` maps names to generated modules."""

    def __init__(self, folder: Path, models: dict[str, ModuleType]):
        self.folder, self.models = folder, models

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Solver) and self.models == other.models

    def __hash__(self) -> int:
        return hash(self.folder)

    def __reduce__(self) -> Any:
        return _same, _origin(self.kernel(min(self.models)))

    def __repr__(self) -> str:
        return f"Solver({str(self.folder)!r}, models={sorted(self.models)})"

    def material(self, model: str | None = None, /, **parameters: Any) -> ModelMaterial:
        """Material of one of the models (of the only one by default) with its parameters in SI.

        They have the names of ``kernel.MATERIAL``.

        Raises ``InputError`` for an unknown model or a parameter that is missing, unknown or inadmissible.
        """
        return ModelMaterial(self.kernel(model), parameters)

    def kernel(self, model: str | None = None) -> ModuleType:
        """The module of a model, or of the only one."""
        if model is None and len(self.models) == 1:
            return next(iter(self.models.values()))
        if model not in self.models:
            raise InputError("model", model, f"a model of the solver {str(self.folder)!r}: {', '.join(sorted(self.models))}")
        return self.models[model]

    def prony_kernel(self, times: int) -> ModuleType:
        """The module that solves a Prony series of so many times."""
        from hystrip.generated import generalised

        wanted = generalised.MATERIAL, generalised.MODE_PARAMETERS  # with their units: another model may have the same names
        fits = [m for m in self.models.values() if m.MODES in (None, times) and (m.MATERIAL, m.MODE_PARAMETERS) == wanted]
        if not fits:
            has = ", ".join(f"{m.MODEL} ({m.MODES})" for m in self.models.values())
            wanted = f"a solver for a Prony series of {times} different times; this one has {has}"
            raise InputError("material.solver", str(self.folder), wanted)
        return fits[0]


def load_solver(folder: str | os.PathLike[str]) -> Solver:
    """Load a solver that ``hystrip regenerate my_model.py --out folder`` has written. Its code is run.

    Raises ``InputError`` if the folder holds no solver, or one for another version of the interface; it says how to regenerate.
    """
    written = "a folder that `hystrip regenerate my_model.py --out FOLDER` has written"
    given = path_of(folder, "solver", written)
    try:
        path = given.resolve()
        init = path / "__init__.py"
        found = init.is_file()
    except (OSError, RuntimeError):  # no path that the system can have; a circle of links
        found = False
    if not found:
        is_other = "; this is a pipe or a device" if given.exists() and not (given.is_dir() or given.is_file()) else ""
        raise InputError("solver", str(folder), written + is_other)
    again = "run `hystrip regenerate my_model.py --out FOLDER` again"
    name = f"_hystrip_solver_{solver_key(path)[:16]}_{hashlib.sha256(str(path).encode()).hexdigest()[:8]}"
    try:
        package = _imported(name, init)
        models = {model: importlib.import_module(f"{name}.{model}") for model in package.MODELS}
    except InputError:
        raise
    except Exception as error:  # whatever a folder of code can do wrong
        raise InputError("solver", str(folder), f"a solver that loads ({type(error).__name__}: {error}); {again}") from None
    for model, module in models.items():
        version = getattr(module, "INTERFACE", None)
        if version != INTERFACE:
            wanted = f"a solver for interface {INTERFACE} of this hystrip; {model} was emitted for {version}: {again}"
            raise InputError("solver", str(folder), wanted)
    # what a material of the solver is made by
    usable = {model: module for model, module in models.items() if hasattr(module, "material_modes")}
    if not usable:
        has = ", ".join(models) or "none"
        raise InputError("solver", str(folder), f"a solver of a model with relaxation times; it has {has}")
    return Solver(path, usable)


def solver_key(folder: str | os.PathLike[str] | None) -> str:
    """Hash of the code in a solver's folder; empty without one."""
    if folder is None:
        return ""
    files = sorted(Path(folder).glob("*.py"))
    return hashlib.sha256(b"".join(file.name.encode() + file.read_bytes() for file in files)).hexdigest()


def _origin(kernel: ModuleType) -> tuple[str, str]:
    """The folder of a loaded module and its package, whose name has the hash of the code in it."""
    return str(Path(kernel.__file__ or "").parent), kernel.__package__ or ""


def _same(folder: str, package: str) -> Solver:
    """Unpickled: the solver in a folder if its code is still the same, else ``InputError``."""
    solver = load_solver(folder)
    if solver.kernel(min(solver.models)).__package__ != package:
        raise InputError("solver", folder, "a solver with the code that this was made with; it was changed since")
    return solver


def _same_material(folder: str, package: str, model: str, given: dict[str, Any]) -> ModelMaterial:
    return _same(folder, package).material(model, **given)


def _pickled(material: ModelMaterial) -> Any:
    return _same_material, (*_origin(material.kernel), material.kernel.__name__.rpartition(".")[2], material.given)


copyreg.pickle(ModelMaterial, _pickled)


def _imported(name: str, init: Path) -> ModuleType:
    if name in sys.modules:
        return sys.modules[name]
    spec = importlib.util.spec_from_file_location(name, init, submodule_search_locations=[str(init.parent)])
    package = importlib.util.module_from_spec(spec)
    sys.modules[name] = package
    try:
        spec.loader.exec_module(package)
    except BaseException:
        del sys.modules[name]
        raise
    return package

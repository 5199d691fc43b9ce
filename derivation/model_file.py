"""A user's model: a Python file that declares ``MODEL``, or several as ``MODELS``."""

import keyword
import os
import runpy
from collections.abc import Iterable
from pathlib import Path

from .check import DerivationError
from .model import Model

STEP = "model file"
TAKEN = ("stable", "modes", "audit", "certificates")  # files that stand beside the emitted solvers


def load_model(path: str | os.PathLike[str]) -> tuple[Model, ...]:
    """The models that a file declares. The file is run: it is code of whoever names it.

    Raises :class:`FileNotFoundError`, and :class:`DerivationError` for a file that does not run or declares no model that
    can be emitted.
    """
    file = Path(path)
    if not file.is_file():
        raise FileNotFoundError(f"no model file {file}")
    try:
        found = runpy.run_path(str(file))
    except DerivationError:
        raise
    except Exception as problem:
        raise DerivationError(STEP, f"{file} runs ({type(problem).__name__}: {problem})") from problem
    declared = found.get("MODELS") or found.get("MODEL")
    if declared is None:
        raise DerivationError(STEP, f"{file} declares MODEL, or MODELS, such as MODEL = prony_model('my_rubber', modes=5)")
    models = tuple(declared) if isinstance(declared, (tuple, list)) else (declared,)
    require_names(models)
    return models


def require_names(models: Iterable[object]) -> None:
    """Raise an error unless every model can be the name of a module, and no two are the same."""
    seen: set[str] = set()
    for model in models:
        if not isinstance(model, Model):
            raise DerivationError(STEP, f"a model is a hystrip.derivation.Model, not {type(model).__name__}")
        name = model.name
        if (
            not (name.isidentifier() and name.isascii() and name == name.lower())
            or keyword.iskeyword(name)
            or name.startswith("_")
        ):
            raise DerivationError(
                STEP, f"the name of a model is a lower-case Python name without leading underscore, not {name!r}"
            )
        if name in TAKEN or name in seen:
            raise DerivationError(STEP, f"the name {name!r} is free: {', '.join((*TAKEN, *sorted(seen)))} are taken")
        seen.add(name)

"""The models that a file on the command line declares, and what is wrong with one as an error that names it."""

from pathlib import Path
from typing import Any

from ..errors import InputError
from .signals import Terminated


def models_of(model: Path | None) -> Any:
    """The models of a file, which is run; None, for those of hystrip, without one.

    Raises ``InputError`` for what declares none.
    """
    import hystrip.derivation

    if model is None:
        return None
    try:
        models = hystrip.derivation.load_model(model)
    except FileNotFoundError:
        raise InputError("MODEL", str(model), "a Python file that declares MODEL") from None
    except hystrip.derivation.DerivationError as error:
        raise InputError("MODEL", str(model), f"a file that declares an admissible model: {error}") from None
    except SystemExit as end:
        if isinstance(end, Terminated):
            raise
        raise InputError("MODEL", str(model), "a file that declares MODEL and does not end the process (sys.exit)") from None
    if models == ():
        raise InputError("MODEL", str(model), "a file that declares at least one model")
    return models

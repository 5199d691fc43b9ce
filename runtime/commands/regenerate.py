"""``hystrip regenerate``: derive and emit a solver: the package's own anew, or that of a user's model."""

import gc
from pathlib import Path

import typer

from .options import out_option
from .output import say


def command(
    model: Path = typer.Argument(None, help="A file that declares MODEL (its code is run); without it, the models of hystrip."),
    out: Path = out_option("Folder to write into; without it (and MODEL), the installed package's own.", default=None),
) -> None:
    """Derive a solver with SymPy, certify and emit it.

    The folder is used with hystrip.load_solver(...), or in a scene as [material] solver. Needs the extra `regenerate`.
    """
    from ..errors import HystripError, InputError
    from ..files import refuse_unwritable, remove_left_folders
    from .model_file import models_of
    from .progress import progress

    if model is not None and out is None:
        raise InputError("out", None, "a folder for the solver of your model")
    import hystrip.derivation
    import hystrip.generated

    folder = out if out is not None else Path(hystrip.generated.__file__).parent
    refuse_unwritable(folder, "out")
    remove_left_folders(folder)
    models = models_of(model)
    try:
        hystrip.derivation.stored_bounds(folder)
    except (ValueError, TypeError, KeyError, AttributeError):
        allowed = "a new folder, or one whose certificates.json is as `hystrip regenerate` writes it"
        raise InputError("out", str(folder), allowed) from None
    # a short-lived process that makes millions of small expressions: looking for cycles among them is a good part of its time
    gc.set_threshold(500_000, 20, 20)
    try:
        with progress("deriving and certifying") as report:
            hystrip.derivation.regenerate(folder, models=models, progress=report)
    except hystrip.derivation.DerivationError as error:
        failure = InputError("MODEL", str(model), f"an admissible model: {error}") if model else HystripError(str(error))
        raise failure from None
    except FileExistsError as error:
        raise InputError("out", str(folder), f"a folder that is new or holds a solver: {error}") from None
    except hystrip.derivation.CertificateError as error:
        raise HystripError(str(error)) from None
    say(f"wrote {folder}")

"""``hystrip check``: is the checked-in solver, or one of your own, what the derivation emits?"""

from pathlib import Path

import typer

from .output import say


def command(
    model: Path = typer.Argument(None, help="The file that your solver was regenerated from (its code is run)."),
    folder: Path = typer.Option(None, "--folder", help="The folder of that solver; without it (and MODEL), the installed one."),
) -> None:
    """Compare a generated solver with a fresh one.

    Byte by byte; exits with 1 if they differ, or if a step does not verify, and names it. The bounds of its functions are
    measured by `hystrip regenerate`. Needs the extra `regenerate`.
    """
    from ..errors import InputError
    from .model_file import models_of
    from .progress import progress

    if model is not None and folder is None:
        raise InputError("--folder", None, "the folder of the solver of your model")
    if folder is not None and model is None:
        raise InputError("MODEL", None, "the file that the solver in --folder is from")
    import hystrip.derivation

    if folder is not None and not (folder / "certificates.json").is_file():
        raise InputError("--folder", str(folder), "a folder that `hystrip regenerate` wrote")
    models = models_of(model)
    try:
        with progress("deriving") as report:
            drift = list(hystrip.derivation.check(folder, models=models, progress=report))
    except hystrip.derivation.DerivationError as problem:
        say(f"hystrip: {problem}", err=True)
        raise typer.Exit(1) from None
    for record in drift:
        say(str(record))
    if drift:
        say(f"{len(drift)} generated file(s) differ from the derivation", err=True)
        raise typer.Exit(1)
    say("the generated files are what the derivation emits")

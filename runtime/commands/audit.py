"""``hystrip audit``: where every formula comes from, how it was verified, where it is computed."""

from pathlib import Path

import typer

from .options import out_option
from .output import say


def command(out: Path = out_option("Folder to write into; without it, the installed package's own.", default=None)) -> None:
    """Derive, verify, and write the audit pages.

    Pages for a browser, and JSON. Exits with 1, and names the step, if one does not verify. Needs the
    extras `regenerate` and `plot`.
    """
    from ..errors import InputError
    from ..extras import require
    from ..files import refuse_unwritable, remove_left_folders
    from .progress import progress

    require("matplotlib", "plot", "drawing the audit's examples")
    import hystrip.derivation
    import hystrip.generated

    from .measurements.measured import measured

    folder = out if out is not None else Path(hystrip.generated.__file__).parent / "audit"
    refuse_unwritable(folder, "out")
    remove_left_folders(folder)
    if (folder / "index.html").exists() and not (folder / "measured.json").exists():
        raise InputError("out", str(folder), "another folder: index.html in it was not written by `hystrip audit`")
    try:
        with progress("auditing") as report:
            hystrip.derivation.audit(folder, progress=report, measure=measured)
    except (hystrip.derivation.DerivationError, hystrip.derivation.AuditError) as problem:
        say(f"hystrip: {problem}", err=True)
        raise typer.Exit(1) from None
    say(f"wrote {folder / 'index.html'}")

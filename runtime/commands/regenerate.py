"""``hystrip regenerate``: derive and emit the solver anew."""

from __future__ import annotations

from pathlib import Path

import typer


def command(
    out: Path = typer.Option(None, "--out", help="Folder to write into; without it, the installed package's own."),
) -> None:
    """Derive the solver with SymPy and emit it.

    Needs the extra `regenerate`.
    """
    from hystrip.commands.derivation import needed
    from hystrip.commands.progress import progress
    from hystrip.files import refuse_unwritable

    needed("regenerating")
    import hystrip.derivation
    import hystrip.generated

    folder = out if out is not None else Path(hystrip.generated.__file__).parent
    refuse_unwritable(folder, "--out")
    with progress("deriving") as report:
        hystrip.derivation.regenerate(folder, progress=report)
    typer.echo(f"wrote {folder}")

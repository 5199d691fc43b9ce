"""What commands say: text that cannot steer the terminal, whatever titles, keys and file names hold."""

from collections.abc import Iterable
from pathlib import Path

import typer

from ..errors import printable


def say(text: str, err: bool = False) -> None:
    """Print lines of text on standard output, or on standard error."""
    typer.echo("\n".join(printable(line, limit=100_000) for line in text.split("\n")), err=err)


def say_written(paths: Iterable[Path]) -> None:
    """Say which files were written, each on a line of its own, whatever its name holds."""
    for path in paths:
        typer.echo(f"wrote {printable(str(path), limit=100_000)}")

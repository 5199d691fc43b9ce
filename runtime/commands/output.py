"""What commands say: text that cannot steer the terminal, whatever titles, keys and file names hold."""

import typer

from ..errors import printable


def say(text: str, err: bool = False) -> None:
    """Print lines of text on standard output, or on standard error."""
    typer.echo("\n".join(printable(line, limit=100_000) for line in text.split("\n")), err=err)

"""Arguments of functions, under the names of the options that they were given by, and the option that several commands have."""

import contextlib
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import typer

from ..errors import InputError
from ..scene.errors import SceneError


@contextlib.contextmanager
def as_options(options: Mapping[str, str]) -> Iterator[None]:
    """Have an ``InputError`` about an argument, but for keys of a scene, name its option: ``options``, argument -> option."""
    try:
        yield
    except InputError as error:
        if error.field not in options or isinstance(error, SceneError):
            raise
        raise InputError(options[error.field], error.value, error.allowed) from None


def out_option(help: str, default: Path | None = Path("hystrip-out")) -> Any:
    """The option ``--out``, a folder."""
    return typer.Option(default, "--out", parser=_folder, help=help)


def _folder(text: str) -> Path:
    if not text:  # as a variable of the shell that is not set leaves it: not the current folder without a word
        raise typer.BadParameter("got ''; allowed: the path of a folder")
    return Path(text)

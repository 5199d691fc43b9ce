"""``hystrip init``: a commented scene to start from."""

from __future__ import annotations

from pathlib import Path

import typer

from .output import say


def command(
    path: Path = typer.Argument(Path("scene.toml"), help="The file to write."),
    force: bool = typer.Option(False, "--force", help="Replace the file if it exists."),
) -> None:
    """Write a commented starter scene."""
    from importlib import resources

    from ..errors import InputError
    from ..files import refuse_unwritable, write_text

    if path.is_dir():
        raise InputError("PATH", str(path), "the path of a file to write; this is a folder")
    if path.exists() and not force:
        raise InputError("PATH", str(path), "a file that does not exist yet, or --force to replace it")
    if not path.parent.is_dir():
        raise InputError("PATH", str(path), "a file in a folder that exists")
    refuse_unwritable(path.parent, "PATH")
    template = resources.files("hystrip") / "scenes" / "starter.toml"
    write_text(path, template.read_text(encoding="utf-8"))
    say(f"wrote {path}; try: hystrip solve {path}")

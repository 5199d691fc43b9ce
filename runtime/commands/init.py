"""``hystrip init``: a commented scene to start from, or a whole example."""

import os
import shlex
from pathlib import Path

import typer

from .output import say, say_written


def command(
    path: Path = typer.Argument(None, help="The file to write [scene.toml]; of an example the folder [its name]."),
    example: str = typer.Option(
        None, "--example", help="Write the files of an example: rubber, a tread compound on a rough road."
    ),
    force: bool = typer.Option(False, "--force", help="Replace what exists."),
) -> None:
    """Write a commented starter scene, or the files of an example."""
    if example is not None:
        _example(example, path, force)
        return
    from importlib import resources

    from ..errors import InputError
    from ..files import refuse_unwritable, write_text

    path = Path("scene.toml") if path is None else path
    if path.is_dir():
        raise InputError("PATH", str(path), "the path of a file to write; this is a folder")
    if os.path.lexists(path) and not force:
        raise InputError("PATH", str(path), "a file that does not exist yet, or --force to replace it")
    if not path.parent.is_dir():
        raise InputError("PATH", str(path), "a file in a folder that exists")
    refuse_unwritable(path.parent, "PATH")
    template = resources.files("hystrip") / "scenes" / "starter.toml"
    write_text(path, template.read_text(encoding="utf-8"))
    say(f"wrote {path}; try: hystrip solve {shlex.quote(str(path))}")


def _example(name: str, folder: Path | None, force: bool) -> None:
    from ..errors import InputError
    from ..example import rubber
    from ..files import Outputs, refuse_unwritable

    if name != "rubber":
        raise InputError("--example", name, "rubber")
    folder = Path(name) if folder is None else folder
    refuse_unwritable(folder, "PATH")
    files = rubber()
    there = [each for each in files if os.path.lexists(folder / each)]
    if there and not force:
        raise InputError("PATH", str(folder), f"a folder without {', '.join(there)}, or --force to replace them")
    with Outputs(folder) as outputs:
        for each, text in files.items():
            outputs.path(each).write_text(text, encoding="utf-8", newline="\n")
    say_written(folder / each for each in files)
    say(
        f"now: cd {shlex.quote(str(folder))}\n"
        "     hystrip master raw.csv --vertical\n"
        "     hystrip fit rubber.csv --nu 0.49 --scene scene.toml\n"
        "     hystrip levels scan.txt --count 3 --scene hystrip-out/rubber.fitted.toml\n"
        "     hystrip solve hystrip-out/scan.levels.toml --summary"
    )

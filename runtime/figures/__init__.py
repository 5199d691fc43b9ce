"""Figures 3 to 7 of the paper, one module each: ``data`` solves and returns a table, ``paint`` draws it."""

import importlib
import itertools
import os
from collections.abc import Callable, Sequence
from pathlib import Path

from ..errors import InputError
from ..files import path_of, refuse_unwritable
from ..origins import outputs_from, refuse_other_origin

_SOURCE = "hystrip figures"
FIGURES = ("fig3", "fig4", "fig5", "fig6", "fig7")


def draw(
    only: Sequence[str] | None, out: str | os.PathLike[str], progress: Callable[[int, int], None] | None = None
) -> list[Path]:
    """Solve and draw the figures in ``only`` (all if empty) into a folder: PNG, SVG and CSV of each; returns the files.

    Raises InputError for a name that is not one of :data:`FIGURES`.
    """
    from ..plots.style import save
    from ..tables import about_version, write_csv

    names = list(dict.fromkeys(only or FIGURES))
    for name in names:
        if name not in FIGURES:
            raise InputError("only", name, ", ".join(FIGURES))
    folder, of = path_of(out, "out", "a folder"), {name: [f"{name}.{kind}" for kind in ("csv", "png", "svg")] for name in names}
    refuse_unwritable(folder, "out")
    refuse_other_origin(folder, [*itertools.chain(*of.values())], _SOURCE)
    if progress:
        progress(0, len(names))
    for done, name in enumerate(names, start=1):
        module = importlib.import_module(f"hystrip.figures.{name}")
        table = module.data()
        with outputs_from(_SOURCE, folder, of[name]) as files:
            write_csv(files.path(f"{name}.csv"), table, [*about_version(), f"figure: {(module.__doc__ or name).splitlines()[0]}"])
            figure = module.paint(table)
            for kind in ("png", "svg"):
                save(figure, files.path(f"{name}.{kind}"))
        if progress:
            progress(done, len(names))
    return [folder / each for each in itertools.chain(*of.values())]

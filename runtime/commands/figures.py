"""``hystrip figures``: Figures 3 to 7 of the paper."""

from pathlib import Path

import typer

from .options import as_options, out_option
from .output import say_written


def command(
    only: list[str] = typer.Argument(None, help="Which ones, such as fig3 fig6; all without any."),
    out: Path = out_option("Folder for the pictures and their data.", default=Path("hystrip-figures")),
) -> None:
    """Draw the paper's Figures 3 to 7.

    PNG, SVG, and the data of each as CSV.
    """
    from ..extras import require
    from ..figures import draw
    from .progress import progress

    require("matplotlib", "plot", "drawing")
    with as_options({"only": "figures"}), progress("figures") as report:
        written = draw(only, out, report)
    say_written(written)

"""``hystrip solve``: friction of one scene, as a table, a CSV and a picture."""

from pathlib import Path

import typer

from .options import out_option
from .output import say, say_written


def command(
    scene: str = typer.Argument(help="A scene file (TOML), or the name of a built-in scene such as paper_fig6."),
    out: Path = out_option("Folder for the results."),
    plot: bool = typer.Option(True, help="Draw mu over velocity, or over the load (PNG)."),
    table: bool = typer.Option(True, help="Print the table."),
    netcdf: bool = typer.Option(False, "--netcdf", help="Write the labelled results as netCDF too (extra `dataset`)."),
    summary: bool = typer.Option(False, "--summary", help="Say where the friction comes from."),
    allow_solver: bool = typer.Option(False, "--allow-solver", help="Run the code of a solver that the scene names."),
) -> None:
    """Solve a scene: friction over velocity.

    Writes a CSV and, for more than one point, a picture of the friction with the share of every level.
    """
    import numpy as np

    from ..extras import require
    from ..files import refuse_unwritable, write_netcdf
    from ..origins import outputs_from, refuse_other_origin
    from ..scene import load_scene
    from ..summary import special_points
    from ..tables import about_result, friction_rows, write_csv
    from .progress import progress

    case = load_scene(scene, allow_solver=allow_solver)
    draws = plot and np.unique(case.load[1]).size * np.unique(case.velocity).size > 1
    # What can fail without the work fails before it.
    if draws:
        require("matplotlib", "plot", "drawing (or give --no-plot)")
    if netcdf:
        require("xarray", "dataset", "writing netCDF")
        require("h5netcdf", "dataset", "writing netCDF")
    refuse_unwritable(out, "out")
    names = [f"{case.name}.{suffix}" for suffix in ("csv", *["nc"] * netcdf, *["png"] * draws)]
    refuse_other_origin(out, names, case.source)
    with progress(case.title or case.name) as report:
        result = case.solve(progress=report)
    columns = friction_rows(result)
    with outputs_from(case.source, out, names) as files:
        write_csv(files.path(f"{case.name}.csv"), columns, about_result(result, case.title or case.name))
        if netcdf:
            write_netcdf(result.to_dataset(), files.path(f"{case.name}.nc"))
        if draws:
            from ..plots import save

            save(result.plot(), files.path(f"{case.name}.png"))
    if table:
        from .terminal import show_friction

        show_friction(case, columns)
    if summary:
        say(result.summary())
    else:
        for note in [*result.notes, *special_points(result)]:
            say(f"note       {note}")
    say_written(out / name for name in names)

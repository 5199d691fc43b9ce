"""``hystrip sweep``: a scene over all its lists and ranges."""

from pathlib import Path

import typer

from .options import as_options, out_option
from .output import say, say_written

_OPTIONS = {each: f"--{each}" for each in ("over", "batch", "workers", "scheduler")} | {
    "workers, executor, scheduler": "--workers, --scheduler"
}  # fmt: skip


def command(
    scene: str = typer.Argument(help="A scene file (TOML) in which any quantity may be a list or a range."),
    over: list[str] = typer.Option(
        None,
        "--over",
        help="KEY=VALUES swept too, values as in a scene: --over 'material.times[0]=[1e-3, \"2 ms\"]'; may be repeated.",
    ),
    out: Path = out_option("Folder for the results; run again with the same to go on."),
    workers: int = typer.Option(1, "--workers", help="Local processes."),
    scheduler: str = typer.Option(None, "--scheduler", help="Address of a Dask scheduler, such as tcp://host:8786."),
    batch: int = typer.Option(None, "--batch", help="Points solved and stored together [the scene's, or a few seconds of work]."),
    plot: bool = typer.Option(False, "--plot", help="Draw mu and contact over the swept quantity of most values (PNG)."),
    netcdf: bool = typer.Option(False, "--netcdf", help="Write the labelled results as netCDF too (extra `dataset`)."),
    restart: bool = typer.Option(False, "--restart", help="Delete what an earlier sweep left in the folder."),
    allow_solver: bool = typer.Option(False, "--allow-solver", help="Run the code of a solver that the scene names."),
) -> None:
    """Solve a scene over all its lists and ranges.

    Every combination of them is solved. Results go to disk as they come: after Ctrl-C, a crash or a kill the same
    command goes on where it was. A point that cannot be solved is recorded with its reason.
    """
    from ..extras import require
    from ..files import write_netcdf
    from ..origins import outputs_from, refuse_other_origin
    from ..scene.load import parse_toml, scene_text
    from ..sweeps import sweep
    from ..sweeps.over import over_of
    from ..sweeps.plan import is_half_space
    from .progress import progress
    from .signals import Terminated

    if netcdf:
        require("xarray", "dataset", "writing netCDF")
        require("h5netcdf", "dataset", "writing netCDF")
    if plot:
        require("matplotlib", "plot", "drawing")
    text, name = scene_text(scene)
    more = [*[f"{name}.sweep.nc"] * netcdf, *[f"{name}.sweep.png"] * plot]
    refuse_other_origin(out, more, scene)
    swept = over_of(over, is_half_space(parse_toml(text))) if over else {}
    try:
        with progress("sweeping", rate=True) as report, as_options(_OPTIONS):
            done = sweep(
                scene, over=swept, out=out, workers=workers, scheduler=scheduler, batch=batch,
                restart=restart, allow_solver=allow_solver, progress=report,
            )  # fmt: skip
    except (KeyboardInterrupt, Terminated):
        say("hystrip: finished batches are kept; the same command goes on from there", err=True)
        raise
    if more:
        with outputs_from(scene, out, more) as files:
            if netcdf:
                write_netcdf(done.to_dataset(), files.path(more[0]))
            if plot:
                from ..plots import save

                save(done.plot(), files.path(more[-1]))
    again = f", {done.kept} of {done.kept + done.solved} batches from before" if done.kept else ""
    say(f"{done.plan.size} points{again}")
    for note in done.notes:
        say(f"note       {note}")
    if done.failed:
        first = next(iter(done.failed.values()))
        say(f"{len(done.failed)} points failed; the column 'failed' says why, the first: {first}", err=True)
    say_written([done.path, *(out / name for name in more)])
    if len(done.failed) == done.plan.size:
        raise typer.Exit(1)

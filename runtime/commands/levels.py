"""``hystrip levels``: from a measured surface to the levels of a scene."""

from pathlib import Path

import typer

from .options import as_options, out_option
from .output import say, say_written

_OPTIONS = {each: f"--{each}" for each in ("count", "ratio", "wavelength", "longest", "shortest")} | {
    "count, ratio, edges": "--count, --ratio", "longest, shortest": "--longest, --shortest"
}  # fmt: skip


def command(
    surface: Path = typer.Argument(help="A measured surface, in any format that SurfaceTopography reads."),
    count: int = typer.Option(
        None,
        "--count",
        help="Number of bands, of equal width on a logarithmic scale; each that has any roughness gives a level [2].",
    ),
    ratio: float = typer.Option(None, "--ratio", help="Or the ratio of the wavelengths that bound a band."),
    longest: str = typer.Option(
        None, "--longest", help='Longest wavelength, such as "20 um" [half the scan; periodic: all of it].'
    ),
    shortest: str = typer.Option(None, "--shortest", help='Shortest wavelength, such as "0.1 um" [four points].'),
    wavelength: str = typer.Option(
        "gradient", "--wavelength", help="gradient: a level keeps the rms gradient of its band; centre: it stands in the middle."
    ),
    channel: str = typer.Option(None, "--channel", help="Name of the channel [the file's default]."),
    unit: str = typer.Option(None, "--unit", help="Unit of what the file states no unit of: heights, lengths or both."),
    size: list[float] = typer.Option(
        None,
        "--size",
        help="Length of the scan in that unit, once for each direction (along rows of text first), if the file lacks it.",
    ),
    height_factor: float = typer.Option(
        None,
        "--height-factor",
        help="What heights are multiplied with to be in their unit, such as 1e-3 for nm with --unit um.",
    ),
    scene: str = typer.Option("starter", "--scene", help="The scene whose levels are replaced [that of `hystrip init`]."),
    pressure: str = typer.Option(None, "--pressure", help='Nominal pressure of the scene, such as "0.2 MPa" [that of SCENE].'),
    title: str = typer.Option(None, "--title", help="Title of the scene."),
    out: Path = out_option("Folder for the results."),
    plot: bool = typer.Option(True, help="Draw the spectrum with the levels (PNG)."),
    allow_solver: bool = typer.Option(False, "--allow-solver", help="Run the code of a solver that the scene names."),
) -> None:
    """Make levels from a measured surface.

    Each level has the rms height and the rms gradient of the surface in its band of wavelengths. Writes a scene that
    holds them: SCENE with its own replaced. Needs the extra `roughness`.
    """
    from ..extras import require
    from ..files import refuse_unwritable
    from ..origins import outputs_from, refuse_other_origin
    from ..roughness import levels_of, read_surface
    from ..scene.edit import with_levels, with_settings, with_solver_seen_from
    from ..scene.errors import located
    from ..scene.load import scene_text
    from .quantities import quantity
    from .scene_options import left_to_the_user, settings

    if plot:
        require("matplotlib", "plot", "drawing (or give --no-plot)")
    limits = {"longest": quantity(longest, "m", "--longest"), "shortest": quantity(shortest, "m", "--shortest")}
    given = settings(scene, quantity(pressure, "Pa", "--pressure"), title, f"Surface of {surface.name}")
    refuse_unwritable(out, "out")
    names = [f"{surface.stem}.{part}" for part in ("levels.toml", *["spectrum.png"] * plot)]
    refuse_other_origin(out, names, surface)
    with located(scene):
        text = with_solver_seen_from(out, with_settings(scene_text(scene)[0], given), scene)
        # what is wrong with the scene is said before the work
        with_levels(text, [{"l": 1.0, "h": 1.0}], folder=out, allow_solver=allow_solver)
    scan = read_surface(surface, channel=channel, unit=unit, sizes=tuple(size) if size else None, height_factor=height_factor)
    with as_options(_OPTIONS):
        found = levels_of(scan, count=count, ratio=ratio, wavelength=wavelength, **limits)
    ends = f"{found.bands.max():.4g} to {found.bands.min():.4g} m"
    comment = f"Made from {surface.name}, wavelengths {ends}: rms height and gradient of each band."
    with located(scene):
        levels = [{"l": each.l, "h": each.h} for each in found.levels]
        text = with_levels(text, levels, comment, folder=out, allow_solver=allow_solver)
    with outputs_from(surface, out, names) as files:
        files.path(names[0]).write_text(text, encoding="utf-8", newline="\n")
        if plot:
            from ..plots import roughness_levels, save

            save(roughness_levels(found, scan), files.path(names[1]))
    say("\n".join([scan.report(), found.report(), *left_to_the_user(scene, "levels")]))
    say_written(out / name for name in names)

"""``hystrip show``: look into a scene: its levels, and pictures of its contact."""

from pathlib import Path

import typer

from .options import out_option
from .output import say, say_written


def command(
    scene: str = typer.Argument(help="A scene file (TOML), or the name of a built-in scene such as paper_fig6."),
    map: bool = typer.Option(False, "--map", help="Draw the pressure over the cell of a level, contact and adhesion outlined."),
    strip: str = typer.Option(
        None, "--strip", help='Draw the strip of level 1 at this y, such as "2.5 um": pressure, profile, stresses.'
    ),
    loop: bool = typer.Option(False, "--loop", help="Draw the loop of pressure over penetration, with pull-off."),
    level: int = typer.Option(1, "--level", help="Which level, 1 the largest."),
    pressure: str = typer.Option(None, "--pressure", help="At this nominal pressure [the scene's, the first of them]."),
    velocity: str = typer.Option(None, "--velocity", help="At this sliding velocity [the scene's, the middle one]."),
    out: Path = out_option("Folder for the pictures."),
    allow_solver: bool = typer.Option(False, "--allow-solver", help="Run the code of a solver that the scene names."),
) -> None:
    """Look into a scene at one pressure and one velocity.

    Prints where the friction comes from there; draws what is asked for.
    """
    from ..errors import InputError
    from ..extras import require
    from ..files import refuse_unwritable
    from ..origins import outputs_from, refuse_other_origin
    from ..scene import load_scene
    from .at import point_of
    from .quantities import quantity

    case = load_scene(scene, allow_solver=allow_solver)
    if not 1 <= level <= len(case.levels):
        raise InputError("--level", level, f"the number of a level, 1 to {len(case.levels)}")
    if strip is not None and level > 1:
        raise InputError("--level", level, "1 with --strip: lower levels rub along it")
    wanted = {"map": map, "strip": strip is not None, "loop": loop}
    names = {kind: f"{case.name}.{kind}{f'_{level}' if level > 1 else ''}.png" for kind in wanted if wanted[kind]}
    if names:
        require("matplotlib", "plot", "drawing")
        refuse_unwritable(out, "out")
    y = quantity(strip, "m", "--strip") or 0.0
    refuse_other_origin(out, [*names.values()], case.source)
    result = point_of(case, pressure, velocity)
    if result.pulled_off and (map or strip is not None):
        allowed = f"one at which there is contact to draw: at {float(result.velocity):g} m/s the surface is pulled off"
        raise InputError("pressure" if pressure is None else "--pressure", float(result.pressure), allowed)
    drawn = result.contact_map(0, level) if map else None
    if names:
        from ..plots import save

        with outputs_from(case.source, out, [*names.values()]) as files:
            for kind, name in names.items():
                figure = drawn.plot() if drawn is not None and kind == "map" else result.plot(kind, at=0, level=level, y=y)
                save(figure, files.path(name))
    say(result.summary())
    if drawn is not None:
        say(f"drawn      {drawn!r}")
    say_written(out / name for name in names.values())

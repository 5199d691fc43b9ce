"""``hystrip fit``: from DMA data to a material."""

from __future__ import annotations

from pathlib import Path

import typer

from .output import say


def command(
    data: Path = typer.Argument(
        help="CSV of frequency, storage and loss modulus: a row of names (f, E_stor, E_loss), a row of units."
    ),
    length: str = typer.Option(
        None,
        "--length",
        help='Modulus over this is the stiffness per area, such as "2 mm", a layer\'s thickness; writes a scene.',
    ),
    terms: int = typer.Option(None, "--terms", help="So many relaxation times, placed where they fit best."),
    per_decade: float = typer.Option(None, "--per-decade", help="Or so many in each decade of the data [1]."),
    low: float = typer.Option(None, "--low", help="Lowest frequency to fit [Hz]."),
    high: float = typer.Option(None, "--high", help="Highest frequency to fit [Hz]."),
    temperature_set: str = typer.Option(None, "--set", help="Of raw data at several temperatures, the rows of this set."),
    scene: str = typer.Option("starter", "--scene", help="The scene whose material is replaced [that of `hystrip init`]."),
    out: Path = typer.Option(Path("hystrip-out"), "--out", help="Folder for the results."),
    plot: bool = typer.Option(True, help="Draw the fit (PNG)."),
) -> None:
    """Fit relaxation times to DMA data: a material.

    Non-negative least squares of the relative residuals of storage and loss modulus; says how well it fits.
    Writes measured and fitted moduli as CSV, a picture, and with --length a scene that holds the material: SCENE with
    its own replaced.
    """
    from ..dma import fit_prony, read_dma
    from ..dma.output import material_table, rows
    from ..extras import require
    from ..files import Outputs, refuse_unwritable
    from ..scene.edit import with_material, with_setting
    from ..scene.errors import located
    from ..scene.load import scene_text
    from ..tables import about_version, write_csv
    from .origin import record_origin, refuse_other_origin
    from .quantities import metres

    if plot:
        require("matplotlib", "plot", "drawing (or give --no-plot)")
    over = metres(length, "--length")
    measured = read_dma(data, temperature_set)
    refuse_unwritable(out, "--out")
    names = [f"{data.stem}.{each}" for each in ("fit.csv", *["fitted.toml"] * (over is not None), *["fit.png"] * plot)]
    refuse_other_origin(out, names, data)
    about = [*about_version(), f"data: {data.name}"]
    measured = measured.between(low, high)
    series = fit_prony(measured, per_decade=per_decade, terms=terms)
    files = {f"{data.stem}.fit.csv": lambda path: write_csv(path, rows(series, measured), about)}
    if over is not None:
        with located(scene):
            text = with_material(scene_text(scene)[0], *material_table(series, over, data.name))
            if len(series.times) > 1:  # the other closure does not determine the edges of such a material
                text = with_setting(text, "edge", "constitutive")
        files[f"{data.stem}.fitted.toml"] = lambda path: path.write_text(text, encoding="utf-8", newline="\n")
    if plot:
        from ..plots import fitted_modulus, save

        files[f"{data.stem}.fit.png"] = lambda path: save(fitted_modulus(series, measured), path)
    with Outputs(out) as outputs:
        for name, write in files.items():
            write(outputs.path(name))
        record_origin(outputs, names, data)
    say(series.report())
    for name in files:
        say(f"wrote {out / name}")

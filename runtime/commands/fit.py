"""``hystrip fit``: from DMA data to a material."""

import warnings
from pathlib import Path
from typing import Any
from urllib.parse import quote

import typer

from .options import as_options, out_option
from .output import say, say_written

_OPTIONS = {each: f"--{each}" for each in ("accuracy", "terms", "length", "decimal", "low", "high", "shear")} | {
    "per_decade": "--per-decade", "material.nu": "--nu", "temperature_set": "--set", "frequencies": "--low, --high",
    "accuracy, terms, per_decade, times": "--accuracy, --terms, --per-decade"
}  # fmt: skip


def command(
    data: Path = typer.Argument(
        help="Table of frequency, storage and loss modulus (or tan delta): a row of names, units in them or in the row below."
    ),
    nu: float = typer.Option(
        None, "--nu", help="Poisson ratio: write a scene with the half-space of this modulus, a stiffness for each level."
    ),
    length: str = typer.Option(
        None,
        "--length",
        help='Or modulus over this is the stiffness per area of all levels, such as "2 mm", a layer\'s thickness.',
    ),
    accuracy: float = typer.Option(None, "--accuracy", help="As few relaxation times as fit to this rms [0.02]."),
    terms: int = typer.Option(None, "--terms", help="Or so many relaxation times, 1 to 40, placed where they fit best."),
    per_decade: float = typer.Option(None, "--per-decade", help="Or so many in each decade of the data."),
    shear: bool = typer.Option(False, "--shear", help="Moduli whose names do not say it are shear moduli, G."),
    low: float = typer.Option(None, "--low", help="Lowest frequency to fit [Hz]."),
    high: float = typer.Option(None, "--high", help="Highest frequency to fit [Hz]."),
    temperature_set: str = typer.Option(None, "--set", help="Of raw data at several temperatures, the rows of this set."),
    decimal: str = typer.Option(None, "--decimal", help='"." or ",", for a file that can be read both ways.'),
    scene: str = typer.Option("starter", "--scene", help="The scene whose material is replaced [that of `hystrip init`]."),
    pressure: str = typer.Option(None, "--pressure", help='Nominal pressure of the scene, such as "0.2 MPa" [that of SCENE].'),
    title: str = typer.Option(None, "--title", help="Title of the scene."),
    out: Path = out_option("Folder for the results."),
    plot: bool = typer.Option(True, help="Draw the fit (PNG)."),
) -> None:
    """Fit relaxation times to DMA data: a material.

    Non-negative least squares of the relative residuals of storage and loss modulus; says how well it fits.
    Writes measured and fitted moduli as CSV, a picture, and with --nu or --length a scene that holds the material: SCENE
    with its own replaced. A master curve of `hystrip master` brings its temperature shift along.
    """
    from ..dma import FitWarning, fit_prony, read_dma
    from ..dma.output import SHEAR, rows
    from ..dma.read import read_shift
    from ..errors import InputError, printable
    from ..extras import require
    from ..files import refuse_unwritable
    from ..inputs.checks import number
    from ..inputs.fitted import POOR
    from ..inputs.half_space import HalfSpace
    from ..origins import outputs_from, refuse_other_origin
    from ..tables import about_version, write_csv
    from .quantities import quantity
    from .scene_options import STARTER, left_to_the_user, settings

    if plot:
        require("matplotlib", "plot", "drawing (or give --no-plot)")
    if nu is not None and length is not None:
        raise InputError("--nu, --length", (nu, length), "one of the two: a half-space, or one stiffness for all levels")
    over = quantity(length, "m", "--length")
    writes_scene = nu is not None or over is not None
    source, stem = data.name, data.stem
    if temperature_set is not None:  # the results of one set do not take the place of another's
        source, stem = f"{source}, set {printable(temperature_set)}", f"{stem}.{quote(temperature_set, safe=' ')}"
    given = settings(scene if writes_scene else "", quantity(pressure, "Pa", "--pressure"), title, f"Rubber of {source}")
    with as_options(_OPTIONS):
        if nu is not None:
            HalfSpace(E=1.0, nu=nu, moduli=[1.0], times=[1.0])  # what is wrong with nu is said before the work
        if over is not None:
            number("length", over, "m", 0, strict=True)
        measured, shift = read_dma(data, temperature_set, decimal, shear), read_shift(data)
    refuse_unwritable(out, "out")
    text = _checked(scene, given, shift, source) if writes_scene else ""
    names = [f"{stem}.{each}" for each in ("fit.csv", *["fitted.toml"] * writes_scene, *["fit.png"] * plot)]
    refuse_other_origin(out, names, data)
    about = [*about_version(), f"data: {source}"]
    with warnings.catch_warnings(), as_options(_OPTIONS | {"data": str(data)}):
        warnings.simplefilter("ignore", FitWarning)  # said below, with everything else about the fit
        measured = measured.between(low, high)
        series = fit_prony(measured, accuracy=accuracy, per_decade=per_decade, terms=terms)
    if writes_scene:
        text = _with_fitted(text, scene, series, shift, nu, over, source)
    with outputs_from(data, out, names) as files:
        write_csv(files.path(names[0]), rows(series, measured), about)
        if writes_scene:
            files.path(names[1]).write_text(text, encoding="utf-8", newline="\n")
        if plot:
            from ..plots import fitted_modulus, save

            save(fitted_modulus(series, measured), files.path(names[-1]))
    for line in measured.columns:
        say(f"read       {line}")
    say(series.report())
    if over is not None and series.kind == "G":
        say(f"note       stiffness per area is G over the length. {SHEAR}")
    if series.rms > POOR:
        say(f"note       poor fit: {series.quality}")
    if not writes_scene and (title, pressure, scene) != (None, None, STARTER):
        say("note       no scene is written, of which --scene, --pressure and --title are: it takes --nu or --length")
    for note in left_to_the_user(scene if writes_scene else "", "material"):
        say(note)
    say_written(out / name for name in names)


def _checked(scene: str, given: dict[str, Any], shift: Any, source: str) -> str:
    """The text of ``scene`` with the settings ``given``; what is wrong with it, with a material of this kind, is said here."""
    from ..dma.output import shift_table
    from ..errors import InputError
    from ..scene.edit import with_material, with_settings
    from ..scene.errors import located
    from ..scene.load import parse_toml, scene_text

    stands_in: dict[str, Any] = {"material": {"kind": "half-space", "E": 1.0, "nu": 0.5, "moduli": [1.0], "times": [1.0]}}
    if shift is not None:
        stands_in["material.shift"] = shift_table(shift)
    with located(scene):
        text = with_settings(scene_text(scene)[0], given)
        temperature = parse_toml(text).get("temperature")
        if shift is None and temperature is not None:
            allowed = f"none: {source} states no shift with temperature, which a master curve of `hystrip master` does"
            raise InputError("temperature", temperature, allowed)
        with_material(text, stands_in)
    return text


def _with_fitted(text: str, scene: str, series: Any, shift: Any, nu: float | None, length: Any, source: str) -> str:
    """The ``text`` of ``scene`` with the material of the fitted ``series``: half-space of ``nu``, or moduli over a ``length``."""
    from ..dma.output import material_tables
    from ..scene.edit import with_material, with_settings
    from ..scene.errors import located

    material = series.half_space(nu, shift) if nu is not None else series.material(length, shift)
    # the other closure does not determine the edges of a material of several times
    edge = {"edge": "constitutive"} if len(series.times) > 1 else {}
    tables, comment = material_tables(material, series, source, length)
    with located(scene):
        return with_material(with_settings(text, edge), tables, comment)

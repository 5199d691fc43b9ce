"""``hystrip master``: isotherms become one master curve."""

from pathlib import Path

import typer

from .options import as_options, out_option
from .output import say, say_written

_OPTIONS = {"T_ref": "--reference", "law": "--law", "decimal": "--decimal", "shear": "--shear"}


def command(
    data: Path = typer.Argument(help="Table of temperature, frequency, storage and loss modulus at several temperatures."),
    reference: str = typer.Option(
        None,
        "--reference",
        help='Temperature of the master curve, within the measured ones, such as "25 degC" [of the isotherm nearest to 20 degC].',
    ),
    law: str = typer.Option("best", "--law", help="Law of the shift factors: WLF, Arrhenius, or best, the nearer of the two."),
    vertical: bool = typer.Option(False, "--vertical", help="Shift moduli too."),
    decimal: str = typer.Option(None, "--decimal", help='"." or ",", for a file that can be read both ways.'),
    shear: bool = typer.Option(False, "--shear", help="Moduli whose names do not say it are shear moduli, G."),
    out: Path = out_option("Folder for the results."),
    plot: bool = typer.Option(True, help="Draw isotherms, master curve and shift factors (PNG)."),
) -> None:
    """Make one master curve of isotherms.

    Finds the shift factors at which all temperatures lie on one smooth curve, and the law that they follow. Writes the
    curve (`hystrip fit` reads it, with its shift), the factors, and a picture.
    """
    from ..dma import master_curve, read_isotherms
    from ..dma.read import shift_remark
    from ..extras import require
    from ..files import refuse_unwritable
    from ..origins import outputs_from, refuse_other_origin
    from ..tables import about_version, write_csv
    from .quantities import quantity

    if plot:
        require("matplotlib", "plot", "drawing (or give --no-plot)")
    T_ref = quantity(reference, "K", "--reference")
    with as_options(_OPTIONS):
        isotherms = read_isotherms(data, decimal, shear)
    refuse_unwritable(out, "out")
    names = [f"{data.stem}.{part}" for part in ("master.csv", "shifts.csv", *["master.png"] * plot)]
    refuse_other_origin(out, names, data)
    with as_options(_OPTIONS):
        found = master_curve(isotherms, T_ref=T_ref, law=law, vertical=vertical)
    curve, kind = found.data, found.data.kind
    points = {"f [Hz]": curve.frequency, f"{kind}_stor [Pa]": curve.storage, f"{kind}_loss [Pa]": curve.loss}
    factors = {
        "T [K]": found.temperatures,
        "a_T": found.a_T,
        "relative standard error of a_T": found.a_T_error,
        "a_T of the law": found.shift.factor(found.temperatures),
        "b_T": found.b_T,
        "relative standard error of b_T": found.b_T_error,
    }
    about = [*about_version(), f"data: {data.name}", shift_remark(found.shift)]
    if vertical:
        about.append(f"standard error of the vertical exponent: {found.vertical_error:.2g}")
    with outputs_from(data, out, names) as files:
        write_csv(files.path(names[0]), points, about)
        write_csv(files.path(names[1]), factors, about)
        if plot:
            from ..plots import save
            from ..plots.master import master_curve as draw

            save(draw(found), files.path(names[2]))
    for line in curve.columns:
        say(f"read       {line}")
    say(found.report())
    say_written(out / name for name in names)

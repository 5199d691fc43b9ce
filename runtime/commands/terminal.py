"""The table that a person reads on a terminal."""

from typing import Any

import numpy as np

from ..scene import Scene


def show_friction(scene: Scene, columns: dict[str, np.ndarray]) -> None:
    """Print load (if it varies), velocity, mu, and every level's part of mu with its share in per cent."""
    from rich.console import Console
    from rich.table import Table
    from rich.text import Text

    from ..errors import printable

    load_name, load = scene.load
    levels = range(1, len(scene.levels) + 1)
    # the title is text, whatever stands in brackets in it
    table = Table(title=Text(printable(scene.title or scene.name)), title_justify="left", title_style="bold")
    load_column = next(iter(columns))
    if load.ndim:
        table.add_column(load_column, justify="right", overflow="fold")
    for heading in ("V [m/s]", "mu", *(f"level {level}" for level in levels), "error of mu"):
        table.add_column(heading, justify="right", overflow="fold")  # a number cut short would be another number
    for row in range(len(columns["mu"])):
        at = {name: values[row] for name, values in columns.items()}
        cells = [f"{at[load_column]:.4g}"] if load.ndim else []
        cells += [f"{at['velocity [m/s]']:.4g}", _number(at["mu"])]
        cells += [_part(at[f"mu of level {level}"], at[f"share of level {level}"]) for level in levels]
        table.add_row(*cells, _error(at["error estimate of mu"]))
    # Wide enough for every column also where the output is no terminal: a file has no width to fit into.
    console = Console()
    console.print(table) if console.is_terminal else Console(width=max(100, 24 * (3 + len(scene.levels)))).print(table)
    if not load.ndim:
        unit = "Pa" if load_name == "pressure" else "m"
        print(f"nominal {load_name} {float(load):g} {unit}, edge {scene.edge}, branch {scene.branch}")


def _number(value: Any) -> str:
    return "-" if np.isnan(value) else f"{value:.4f}" if 1e-3 <= abs(value) < 1e4 or value == 0 else f"{value:.3e}"


def _error(value: Any) -> str:
    return "-" if np.isnan(value) else f"{value:.0e}" if value else "exact"


def _part(value: Any, share: Any) -> str:
    return _number(value) if np.isnan(share) else f"{_number(value)} ({100 * share:3.0f} %)"

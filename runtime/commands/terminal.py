"""The table that a person reads on a terminal."""

from typing import Any

import numpy as np

from ..scene import Scene
from ..tables import LOAD_UNITS


def show_friction(scene: Scene, columns: dict[str, np.ndarray]) -> None:
    """Print load (if it varies), velocity, mu, and every level's part of mu with its share in per cent."""
    from rich.console import Console
    from rich.table import Table
    from rich.text import Text

    from ..errors import printable

    load_name, load = scene.load
    levels = range(1, len(scene.levels) + 1)
    # title and headings are text, whatever stands in brackets in them, as [m/s] does
    table = Table(title=Text(printable(scene.title or scene.name)), title_justify="left", title_style="bold")
    load_column = next(iter(columns))
    if load.ndim:
        table.add_column(Text(load_column), justify="right", overflow="fold")
    for heading in ("V [m/s]", "mu", *(f"level {level}" for level in levels), "error of mu"):
        table.add_column(Text(heading), justify="right", overflow="fold")  # a number cut short would be another number
    for row in range(len(columns["mu"])):
        at = {name: values[row] for name, values in columns.items()}
        cells = [f"{at[load_column]:.4g}"] if load.ndim else []
        cells += [f"{at['velocity [m/s]']:.4g}", _number(at["mu"])]
        cells += [_part(at[f"mu of level {level}"], at[f"share of level {level}"]) for level in levels]
        table.add_row(*cells, _error(at["error estimate of mu"]))
    # Wide enough for every column also where the output is no terminal: a file has no width to fit into.
    console = Console()
    console.print(table) if console.is_terminal else Console(width=max(100, 24 * (3 + len(scene.levels)))).print(table)
    said = [] if load.ndim else [f"{load_name} {float(load):g} {LOAD_UNITS[load_name]}"]
    said += [] if scene.temperature is None else [f"temperature {scene.temperature:g} K"]
    print(", ".join([*said, f"edge {scene.edge}", f"branch {scene.branch}"]))


def _number(value: Any) -> str:
    """With four digits that count, small numbers too."""
    return "-" if np.isnan(value) else f"{value:#.4g}".rstrip(".") if value else "0"


def _error(value: Any) -> str:
    return "-" if np.isnan(value) else f"{value:.0e}" if value else "exact"


def _part(value: Any, share: Any) -> str:
    return _number(value) if np.isnan(share) else f"{_number(value)} ({100 * share:3.0f} %)"

"""One look for all pictures: the width of a journal column, legible, safe for colour-blind readers."""

import os
from typing import Any

from ..errors import InputError
from ..extras import require
from ..files import path_of

COLUMN = 85 / 25.4
"""Width of a journal column [inch]."""

OKABE_ITO = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#F0E442")
"""Okabe and Ito's palette without black, which the totals have, in the order used here."""

DASHES = ((0, (5, 1.5)), (0, (1.2, 1.2)), (0, (5, 1.5, 1.2, 1.5)), (0, (2.5, 1.2)))
"""Line patterns, so that curves differ in grey too."""

_RC = {
    "font.size": 8,
    "axes.labelsize": 8,
    "legend.fontsize": 7,
    "xtick.labelsize": 7,
    "ytick.labelsize": 7,
    "axes.linewidth": 0.6,
    "lines.linewidth": 1.2,
    "xtick.direction": "in",
    "ytick.direction": "in",
    "xtick.top": True,
    "ytick.right": True,
    "legend.frameon": False,
    "svg.fonttype": "none",
    "svg.hashsalt": "hystrip",  # the same drawing is the same file
}


def styled(draw: Any) -> Any:
    """Decorator: run a drawing function under this style, which is fixed when text and lines are created."""
    import functools

    @functools.wraps(draw)
    def wrapper(*arguments: Any, **options: Any) -> Any:
        with require("matplotlib", "plot", "drawing").rc_context(_RC):
            return draw(*arguments, **options)

    return wrapper


def axes(width: float = COLUMN, height: float = 0.75 * COLUMN) -> Any:
    """A new figure's only axes; sizes in inches. No window system is touched."""
    return stacked(1, width, height)[0]


def stacked(count: int, width: float, height: float, **options: Any) -> Any:
    """A new figure's panels, one above the other over the same x, as an array; ``options`` of matplotlib's subplots."""
    figure = require("matplotlib.figure", "plot", "drawing").Figure(figsize=(width, height), layout="constrained")
    return figure.subplots(count, 1, sharex=True, squeeze=False, **options)[:, 0]


@styled
def save(figure: Any, path: str | os.PathLike[str]) -> None:
    """Write a figure; the suffix (``.png``, ``.svg``, ``.pdf``) decides the format. PNG has 300 dots per inch.

    Raises ``InputError`` for what is no figure, and for a suffix of no format.
    """
    if not hasattr(figure, "savefig"):
        raise InputError("figure", figure, "a matplotlib Figure, such as result.plot()")
    target = path_of(path, "path", "a picture to write")
    kind, known = target.suffix[1:].lower(), figure.canvas.get_supported_filetypes()
    if kind and kind not in known:
        raise InputError("path", str(path), f"a name that ends in one of {', '.join(f'.{each}' for each in known)}")
    # A date would make every file differ.
    metadata = {"svg": {"Date": None}, "pdf": {"CreationDate": None}}.get(kind)
    figure.savefig(target, dpi=300, metadata=metadata)

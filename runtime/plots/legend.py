"""A legend above the panels that stands inside the canvas, however many and long its labels are."""

import textwrap
from collections.abc import Sequence
from typing import Any

_MOST_COLUMNS = 3
_MARGIN = 4  # points left free at either side


def legend_above(figure: Any, handles: Sequence[Any], labels: Sequence[str]) -> Any:
    """Put the legend above the panels in as many columns as fit; a label too long for one is wrapped.

    The figure grows by the legend's height, so that the panels keep theirs.
    """
    for wrapped in (None, 44, 36, 28, 20):
        texts = list(labels) if wrapped is None else ["\n".join(textwrap.wrap(each, wrapped)) for each in labels]
        for columns in range(min(_MOST_COLUMNS, len(texts)), 0, -1):
            legend = figure.legend(
                handles, texts, loc="outside upper center", ncols=columns, handlelength=2.2, columnspacing=1.0, handletextpad=0.6
            )
            box = _extent(figure, legend)
            if box.width <= figure.bbox.width - 2 * _MARGIN * figure.dpi / 72:
                figure.set_figheight(figure.get_figheight() + box.height / figure.dpi)
                return legend
            legend.remove()
    return figure.legend(handles, texts, loc="outside upper center", ncols=1)


def _extent(figure: Any, legend: Any) -> Any:
    """What a legend takes, without a layout: there may be no room for it yet."""
    layout = figure.get_layout_engine()
    figure.set_layout_engine("none")
    figure.draw_without_rendering()
    figure.set_layout_engine(layout)
    return legend.get_window_extent()

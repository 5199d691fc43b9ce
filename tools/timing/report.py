"""The table, the picture, and the README's section."""

from __future__ import annotations

import math
from pathlib import Path

from hystrip.files import Outputs, write_text

from . import scenes as s
from .claims import claims, short
from .scene import Row

BEGIN, END = "<!-- benchmark: begin -->", "<!-- benchmark: end -->"
#: the columns of the table
ERRORS = (1e-2, 1e-3, 1e-4, 1e-6, 1e-8, 1e-10)
_COLOURS = {
    s.HERE: "#0072b2",
    s.EQUAL: "#e69f00",
    s.SCRIPT: "#d55e00",
    s.MARCH: "#009e73",
    s.TAMAAS: "#cc79a7",
    s.NUMPY: "#000000",
}


def table(rows: list[Row]) -> str:
    """Markdown: milliseconds a point to get to an error, by scene and method; the cheapest setting that gets there."""
    lines = [
        "| scene (points) | method | solved | " + " | ".join(f"{error:.0e}" for error in ERRORS) + " | best error | failures |",
        "|---|---|---|" + "---|" * (len(ERRORS) + 2),
    ]
    scene = None
    for name, method in dict.fromkeys((row.scene, row.method) for row in rows if not row.scene.startswith("cost over")):
        mine = [row for row in rows if (row.scene, row.method) == (name, method)]
        shown, scene = (f"{name} ({mine[0].points})" if name != scene else ""), name
        done = [row for row in mine if math.isfinite(row.error)]
        solved = sorted({row.solved for row in mine if math.isfinite(row.seconds)})
        if solved and not done:
            continue  # a scene without errors: the findings tell its times
        cells = [min((row.per_point for row in done if row.error <= error), default=None) for error in ERRORS]
        best = f"{min(row.error for row in done):.0e}" if done else "none done in time"
        span = "-".join(str(n) for n in (solved[:1] + solved[1:][-1:]))
        failures = sum(row.failures for row in mine) or ""
        times = " | ".join("" if cell is None else short(cell) for cell in cells)
        lines.append(f"| {shown} | {method} | {span} | {times} | {best} | {failures} |")
    return "\n".join(lines)


def settings(rows: list[Row]) -> str:
    """Markdown: a row for every setting."""
    lines = [
        "| scene | method | setting | solved | ms a point | error | strips | failures |",
        "|---|---|---|---|---|---|---|---|",
    ]
    scene = None
    for row in rows:
        name, scene = (row.scene if row.scene != scene else ""), row.scene
        solved = f"{row.solved} of {row.points}" if row.solved != row.points else f"{row.points}"
        measured = f"{solved} | {short(row.per_point)}" if math.isfinite(row.seconds) else "- | not done in time"
        error = f"{row.error:.0e}" if math.isfinite(row.error) else "-"
        lines.append(
            f"| {name} | {row.method} | {row.setting} | {measured} | {error} | {row.strips or ''} | {row.failures or ''} |"
        )
    return "\n".join(lines)


def text(rows: list[Row]) -> str:
    """The findings and the table."""
    return "\n".join([table(rows), "", *(f"- {claim}" for claim in claims(rows))]) + "\n"


def put(body: str, readme: Path) -> None:
    """Replace what stands between the two marks in ``readme``."""
    old = readme.read_text()
    if BEGIN not in old or END not in old:
        raise SystemExit(f"{readme}: the lines {BEGIN} and {END} are missing")
    head, tail = old[: old.index(BEGIN) + len(BEGIN)], old[old.index(END) :]
    write_text(readme, f"{head}\n{body}{tail}")


def save(rows: list[Row], out: Path) -> None:
    """``out.md`` and ``out.png``."""
    write_text(out.with_suffix(".md"), f"{text(rows)}\n{settings(rows)}\n")
    draw(rows, out.with_suffix(".png"))


def draw(rows: list[Row], path: Path) -> None:
    """Error over time per point, a panel for each scene with errors."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    from matplotlib.ticker import NullFormatter

    rows = [row for row in rows if math.isfinite(row.seconds) and math.isfinite(row.error)]
    names = list(dict.fromkeys(row.scene for row in rows))
    if not names:
        return
    across = min(3, len(names))
    down = -(-len(names) // across)
    figure, axes = plt.subplots(
        down, across, figsize=(3.4 * across, 3.0 * down + 0.5), sharey=True, squeeze=False, layout="constrained"
    )
    for axis, name in zip(axes.flat, names, strict=False):
        for method, colour in _COLOURS.items():
            mine = [row for row in rows if row.scene == name and row.method == method]
            # Tamaas has two settings, so its points do not lie on one line
            style = "o" if method == s.TAMAAS else "o-"
            x, y = [row.per_point for row in mine], [max(row.error, 1e-16) for row in mine]
            axis.loglog(x, y, style, color=colour, label=method if mine else None, lw=1, ms=4)
        axis.set_title(name, fontsize=9)
        axis.set_xlabel("processor time per point [ms]", fontsize=8)
        # a panel of less than a decade would be labelled at every tick
        low, high = axis.get_xlim()
        axis.set_xlim(10 ** math.floor(math.log10(low)), 10 ** math.ceil(math.log10(high)))
        axis.xaxis.set_minor_formatter(NullFormatter())
        axis.grid(alpha=0.3)
    for axis in list(axes.flat)[len(names) :]:
        axis.set_axis_off()
    figure.supylabel("largest relative error of friction", fontsize=9)
    labels = {label: handle for axis in axes.flat for handle, label in zip(*axis.get_legend_handles_labels(), strict=True)}
    figure.legend(labels.values(), labels.keys(), loc="outside lower center", ncols=len(labels), fontsize=8)
    with Outputs(path.parent) as outputs:
        figure.savefig(outputs.path(path.name), dpi=150)
    plt.close(figure)

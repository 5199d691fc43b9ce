"""An example of every regime, drawn with the installed solver."""

import importlib
import io
import re
from collections.abc import Iterable
from textwrap import wrap
from typing import Any

import numpy as np

# Strips by the regime that they show; every model takes those of its regimes.
_strip = {"l": 1e-5, "A": 5e-7, "V": 2e-4, "p_0": 400.0, "delta_0": 3e-7, "branch": "unloading"}
_STRIPS: tuple[dict[str, Any], ...] = (
    {**_strip, "of": "acaf", "D": 2e-7},
    {**_strip, "of": "afc", "delta_0": 6e-8, "V": 4e-4, "D": 5e-7, "edge": "constitutive"},
    {**_strip, "of": "af", "D": -2.5e-7},
    {**_strip, "of": "ac", "D": 6e-7},
    {**_strip, "of": "ac", "p_0": 0.0, "D": 6e-7},
    {**_strip, "of": "c", "D": 1.2e-6},
    {**_strip, "of": "a", "delta_0": 1.2e-6, "D": -4.5e-7},
    {**_strip, "of": "f", "D": -8e-7},
)
# Materials by model; all but Kelvin-Voigt have five times the relaxed stiffness when they are glassy.
MATERIALS: dict[str, dict[str, Any]] = {
    "standard_linear_solid": {"K": 1e9, "T_eps": 1e-2, "T_sigma": 2e-3},
    "kelvin_voigt": {"K": 1e9, "T_eps": 1e-2},
    "generalised": {"K": 1e9, "K_i": (1.5e9, 1.5e9, 1e9), "tau_i": (2e-4, 1.5e-3, 6e-3)},
}
UNITS = {
    "K": "Pa/m", "T_eps": "s", "T_sigma": "s", "K_i": "Pa/m", "tau_i": "s",
    "p_0": "Pa", "delta_0": "m", "l": "m", "A": "m", "D": "m", "V": "m/s",
}  # fmt: skip
SIZE = (6.4, 4.4)  # inches
PATH = re.compile(r' d="[^"]*"')
FINER = re.compile(r"(\.\d\d)\d+")  # digits below a hundredth of a point
UNBROKEN = "\N{NO-BREAK SPACE}"
LINE = 100  # characters of the parameters that fit across
CONTACT, ADHESION = "#f3c9a5", "#c7dcf0"


def scenes(model: str) -> tuple[dict[str, Any], ...]:
    """The strips that show the regimes of a model; under ``continuous`` where that determines them."""
    given = MATERIALS[model]
    edge = "constitutive" if "K_i" in given else "continuous"
    snaps = model != "kelvin_voigt"  # without instantaneous compliance no point snaps into contact
    return tuple({"edge": edge, "model": model, **given, **strip} for strip in _STRIPS if snaps or strip["of"] != "afc")


def material(scene: dict[str, Any]) -> tuple[Any, Any]:
    import hystrip

    adhesion = hystrip.Dugdale(p_0=scene["p_0"], delta_0=scene["delta_0"])
    given = [scene[name] for name in MATERIALS[scene["model"]]]
    if "K_i" in scene:
        return hystrip.Prony(*given), adhesion
    return (hystrip.KelvinVoigt if scene["model"] == "kelvin_voigt" else hystrip.StandardLinearSolid)(*given), adhesion


def solved(scene: dict[str, Any]) -> Any:
    """The strip of a scene."""
    import hystrip

    wanted = {name: scene[name] for name in ("l", "A", "D", "V", "edge", "branch")}
    return hystrip.solve_strip(*material(scene), **wanted)


def missed(scene: dict[str, Any], strip: Any) -> float | None:
    """The most by which the edges of a strip miss the boundary equations that were generated for its model."""
    solver = importlib.import_module(f"hystrip.generated.{scene['model']}")
    sequence = {"cf": "ac"}.get(str(strip.regime), str(strip.regime))
    regime = solver.REGIMES[sequence]
    if not regime["edges"]:
        return None
    k, unit = 2 * np.pi / scene["l"], scene["K"] * scene["A"]
    at = {"a": strip.a, "b": -strip.b, "c": strip.c, "d": -strip.d if sequence != "afc" else -strip.b}
    edges = [k * float(at[name]) for name in regime["edges"]]
    groups = [scene["p_0"] / unit, scene["delta_0"] / scene["A"], scene["D"] / scene["A"]]
    if "T_sigma" in scene:
        J = scene["T_sigma"] / scene["T_eps"]
        turn = k * scene["V"]
        groups = [turn * scene["T_sigma"], turn * scene["T_eps"], J, 1 - J, *groups, float(scene["edge"] == "constitutive")]
    else:
        _, modes = solver.material_modes(**{name: np.asarray(scene[name]) for name in MATERIALS[scene["model"]]})
        groups = [solver.at_speed(modes, k * scene["V"]), *groups]
    return float(np.max(np.abs(regime["residual"](*edges, *groups))))


def picture(scene: dict[str, Any]) -> dict[str, Any]:
    """SVG of surface, profile and pressure over one period, with its caption."""
    import matplotlib
    from matplotlib.figure import Figure

    strip = solved(scene)
    if str(strip.regime) not in (scene["of"], "cf" if scene["of"] == "ac" and not scene["p_0"] else ""):
        raise ValueError(f"{scene['model']}: the strip that should show {scene['of']!r} is {str(strip.regime)!r}")
    length, A, unit = scene["l"], scene["A"], scene["K"] * scene["A"]
    style = {"svg.hashsalt": "hystrip", "svg.fonttype": "none", "font.family": ["DejaVu Sans", "sans-serif"], "font.size": 9}
    with matplotlib.rc_context(style):
        figure = Figure(figsize=SIZE, layout="constrained")
        upper, lower = figure.subplots(2, 1, sharex=True, height_ratios=(3, 2))
        edges = {name: float(getattr(strip, name)) / length for name in "abcd"}
        at = {"a": -edges["a"], "b": edges["b"], "c": -edges["c"], "d": edges["d"]}  # the paper's positions
        x = _points(at.values())
        for axes in (upper, lower):
            _shade(axes, str(strip.regime), at)
        profile = scene["D"] - A * (1 - np.cos(2 * np.pi * x))
        upper.fill_between(x, -profile / A, 99.0, color="#d9d9d9", lw=0)
        upper.plot(x, -profile / A, color="#333333", lw=1.2, label="rigid profile")
        upper.plot(x, -strip.displacement(x * length) / A, color="#b3261e", lw=1.8, label="surface of the foundation")
        upper.set_ylim(*_range(-profile / A, -strip.displacement(x * length) / A))
        upper.set_ylabel("height / A")
        upper.legend(loc="upper right", frameon=True, framealpha=0.9, fontsize=8)
        upper.annotate(
            "", xy=(-0.5, 0.93), xytext=(-0.68, 0.93), xycoords=("data", "axes fraction"), arrowprops={"arrowstyle": "->"}
        )
        upper.text(-0.49, 0.93, "V", transform=upper.get_xaxis_transform(), va="center")
        for n, (name, place) in enumerate(at.items()):
            if np.isfinite(place):
                for axes in (upper, lower):
                    axes.axvline(place, color="#777777", lw=0.7, ls=":")
                label = f"-{name}" if name in "ac" else "b = d" if str(strip.regime) == "afc" else name
                upper.text(
                    place,
                    0.03 + 0.1 * (n // 2),
                    label,
                    transform=upper.get_xaxis_transform(),
                    ha="center",
                    fontsize=10,
                    style="italic",
                    bbox={"facecolor": "white", "edgecolor": "none", "pad": 0.8, "alpha": 0.85},
                )
        lower.axhline(0, color="#777777", lw=0.6)
        pressure = strip.pressure(x * length) / unit
        steps = np.flatnonzero(np.abs(np.diff(pressure)) > 0.2 * (np.ptp(pressure) + 1e-12))
        lower.plot(np.insert(x, steps + 1, x[steps]), np.insert(pressure, steps + 1, np.nan), color="#0b4f9c", lw=1.6)
        lower.margins(y=0.12)
        if np.ptp(pressure) == 0:
            lower.set_ylim(pressure[0] - 1, pressure[0] + 1)
        lower.set_ylabel("pressure / (K A)")
        lower.set_xlabel("x / l")
        lower.set_xlim(-0.75, 0.75)
        figure.suptitle("\n".join(_lines(scene)), fontsize=7.5, color="#454c54")
        stream = io.StringIO()
        figure.savefig(stream, format="svg", metadata={"Date": None, "Creator": None})
    lines = (line.strip() for line in stream.getvalue().splitlines() if not line.lstrip().startswith("<!-- "))
    drawn = PATH.sub(lambda path: FINER.sub(r"\1", path[0]), "\n".join(lines))
    return {"caption": _caption(scene, strip), "svg": drawn, "width": int(SIZE[0] * 96), "height": int(SIZE[1] * 96)}


def _points(edges: Iterable[float]) -> np.ndarray:
    """Where to draw, in units of l: evenly, and on both sides of every edge."""
    near = [edge + shift + side for edge in edges if np.isfinite(edge) for shift in (-1, 0, 1) for side in (-1e-7, 1e-7)]
    return np.unique([x for x in (*np.linspace(-0.75, 0.75, 181), *near) if abs(x) <= 0.75])


def _range(*curves: np.ndarray) -> tuple[float, float]:
    low, high = min(map(np.min, curves)), max(map(np.max, curves))
    return low - 0.35 * (high - low), high + 0.45 * (high - low)


def _shade(axes: Any, regime: str, at: dict[str, float]) -> None:
    """Contact and adhesion zones, in every period that is seen."""
    spans = {
        "acaf": [("b", "d", ADHESION), ("-a", "b", CONTACT), ("-c", "-a", ADHESION)],
        "afc": [("-a", "b", CONTACT), ("-c", "-a", ADHESION)],  # the snap at d is where contact begins: b = d
        "af": [("-c", "d", ADHESION)],
        "ac": [("-a", "b", CONTACT), ("b", "-a+1", ADHESION)],
        "cf": [("-a", "b", CONTACT)],
    }.get(regime)
    if spans is None:
        color = {"c": CONTACT, "a": ADHESION}.get(regime)
        if color:
            axes.axvspan(-0.75, 0.75, color=color, lw=0)
        return
    for first, last, color in spans:
        low, high = (at[name.strip("-").partition("+")[0]] + name.endswith("+1") for name in (first, last))
        for shift in (-1, 0, 1):
            if high + shift > -0.75 and low + shift < 0.75:
                axes.axvspan(max(low + shift, -0.75), min(high + shift, 0.75), color=color, lw=0)


def _lines(scene: dict[str, Any]) -> list[str]:
    """The parameters in lines that fit across a picture, broken between two of them."""
    return wrap(", ".join(each.replace(" ", UNBROKEN) for each in _each(scene)), LINE)


def _each(scene: dict[str, Any]) -> list[str]:
    return [f"{name} = {_number(scene[name])} {unit}" for name, unit in UNITS.items() if name in scene]


def _number(value: float | tuple[float, ...]) -> str:
    return f"({', '.join(f'{each:g}' for each in value)})" if isinstance(value, tuple) else f"{value:g}"


def _caption(scene: dict[str, Any], strip: Any) -> str:
    off = missed(scene, strip)
    met = "" if off is None else f" At these edges the boundary equations, as generated, are off zero by at most {off:.0e}."
    zones = "Orange: contact; blue: adhesion. " if str(strip.regime) != "f" else ""
    return (
        f"{strip.regime_name} ({strip.regime}), {scene['edge']}, {scene['branch']}. {zones}{', '.join(_each(scene))}. "
        f"Mean pressure {float(strip.p_mean):.4g} Pa, mean friction {float(strip.tau_mean):.4g} Pa.{met}"
    )

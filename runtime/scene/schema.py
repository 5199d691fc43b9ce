"""The keys of a scene file. Types, bounds and descriptions stand here once: validation and JSON Schema both use them."""

from typing import Annotated, Any, Literal

from ..extras import require
from .quantity import DIFFERENCE, EXAMPLES

msgspec = require("msgspec", "cli", "reading scenes")
Meta, Struct = msgspec.Meta, msgspec.Struct

Number = float | str


def _swept_meta(description: str, unit: str) -> Any:
    return Meta(
        description=f"{description}: a number in {unit} or text with a unit such as {EXAMPLES[unit]!r} "
        "(for `hystrip sweep` also a list or a range of these)",
        extra={"unit": unit},
        extra_json_schema={"examples": [EXAMPLES[unit]]},
    )


def _range_meta(description: str, unit: str) -> Any:
    return Meta(
        description=f"{description}: a number in {unit}, text with a unit such as {EXAMPLES[unit]!r}, a list of these, "
        'or {start, stop, num, spacing = "linear" | "log"}',
        extra={"unit": unit},
        extra_json_schema={"examples": [EXAMPLES[unit]]},
    )


def _list_meta(description: str, unit: str) -> Any:
    return Meta(
        description=f"{description}: a list of numbers in {unit} or texts with a unit such as {EXAMPLES[unit]!r} "
        "(for `hystrip sweep` any of them a list or a range itself)",
        extra={"unit": unit, "each": True},
    )


def _plain_meta(description: str) -> Any:
    return Meta(description=f"{description} (for `hystrip sweep` also a list or a range)", extra={"unit": "1"})


class Range(Struct, forbid_unknown_fields=True, kw_only=True):
    """`num` values from `start` to `stop`, both included."""

    start: Annotated[Number, Meta(description="first value: a number in SI or text with a unit")]
    stop: Annotated[Number, Meta(description="last value: a number in SI or text with a unit")]
    num: Annotated[int, Meta(ge=2, le=1_000_000, description="an integer from 2 to 1000000, how many values")]
    spacing: Annotated[
        Literal["linear", "log"],
        Meta(description='"linear" (equal steps, the default) or "log" (equal ratios; start and stop > 0)'),
    ] = "linear"


Values = Number | list[Number] | Range
#: values without text: those of no unit
Plain = float | list[float] | Range


class Shift(Struct, forbid_unknown_fields=True, kw_only=True):
    """Time-temperature superposition."""

    model: Annotated[Literal["WLF", "Arrhenius"], Meta(description='"WLF" (C_1, C_2) or "Arrhenius" (E_a)')]
    T_ref: Annotated[Values, _swept_meta("temperature of the moduli and times given", "K")]
    C_1: Annotated[Plain | None, _plain_meta("first constant of WLF, a number > 0")] = None
    C_2: Annotated[Values | None, _swept_meta("second constant of WLF, > 0", DIFFERENCE)] = None
    E_a: Annotated[Values | None, _swept_meta("activation energy, > 0", "J/mol")] = None
    vertical: Annotated[
        Plain,
        _plain_meta(
            "moduli go with (T/T_ref)^vertical: a number from -10 to 10, 0 (the default) not at all, 1 like an ideal rubber"
        ),
    ] = 0.0


class Fit(Struct, forbid_unknown_fields=True, kw_only=True):
    """Where a material was measured, and how well its series fits."""

    edges: Annotated[
        list[float], Meta(description="ascending frequencies that bound the parts of the band, a list of numbers in Hz")
    ]
    rms: Annotated[list[float], Meta(description="rms of the relative residuals in each part, a list of numbers, one fewer")]


class Material(Struct, forbid_unknown_fields=True, kw_only=True):
    """The viscoelastic foundation: a stiffness per area and its times; or a half-space: moduli and times."""

    kind: Annotated[
        Literal["foundation", "half-space"],
        Meta(
            description='"foundation" (the default: one stiffness per area for all levels, of a model) or "half-space" (E, nu, '
            "moduli, times: every level gets the stiffness of its own wavelength); the name of a model stands under model"
        ),
    ] = "foundation"
    model: Annotated[
        Literal["standard_linear_solid", "kelvin_voigt", "prony"] | None,
        Meta(
            description='"standard_linear_solid" (the default: K, T_eps, T_sigma), "kelvin_voigt" (K, T_eps) or "prony" '
            '(K, moduli, times); for a half-space kind = "half-space" in place of a model'
        ),
    ] = None
    E: Annotated[Values | None, _swept_meta("relaxed Young's modulus of a half-space, > 0", "Pa")] = None
    nu: Annotated[
        Values | None, Meta(description="Poisson ratio of a half-space, a number from 0 to 0.5", extra={"unit": "1"})
    ] = None
    K: Annotated[Values | None, _swept_meta("relaxed stiffness per area, > 0", "Pa/m")] = None
    T_eps: Annotated[Values | None, _swept_meta("retardation time, >= T_sigma", "s")] = None
    T_sigma: Annotated[Values | None, _swept_meta("relaxation time, from 0 to T_eps", "s")] = None
    moduli: Annotated[
        list[Values] | None, _list_meta("branch moduli, one for each relaxation time, >= 0 (half-space: in Pa)", "Pa/m")
    ] = None
    times: Annotated[list[Values] | None, _list_meta("relaxation times tau_i, > 0", "s")] = None
    solver: Annotated[
        str | None,
        Meta(
            description="folder of a solver from `hystrip regenerate`, for a prony series of so many times "
            "(from the scene's folder on); its code is run, which has to be allowed"
        ),
    ] = None
    shift: Annotated[Shift | None, Meta(description="a table [material.shift], how times and moduli change with temperature")] = (
        None
    )
    fit: Annotated[
        Fit | None,
        Meta(description="a table [material.fit] from `hystrip fit`: where the material was measured, and how well it fits"),
    ] = None


#: the model of a material of kind half-space
HALF_SPACE = "half-space"
#: the parameters that each model of a material takes
MATERIAL_KEYS = {
    HALF_SPACE: ("E", "nu", "moduli", "times"),
    "standard_linear_solid": ("K", "T_eps", "T_sigma"),
    "kelvin_voigt": ("K", "T_eps"),
    "prony": ("K", "moduli", "times"),
}


class Adhesion(Struct, forbid_unknown_fields=True, kw_only=True):
    """Dugdale adhesion: a constant attraction up to a range. Two of the three are given."""

    gamma: Annotated[Values | None, _swept_meta("energy of adhesion gamma = p_0 delta_0, >= 0", "J/m^2")] = None
    p_0: Annotated[Values | None, _swept_meta("adhesive stress, >= 0", "Pa")] = None
    delta_0: Annotated[Values | None, _swept_meta("range of adhesion, > 0", "m")] = None


class Level(Struct, forbid_unknown_fields=True, kw_only=True):
    """One level of roughness, a double cosine wave."""

    l: Annotated[Values, _swept_meta("wavelength, > 0", "m")]  # noqa: E741 - the paper's name
    h: Annotated[Values, _swept_meta("height from valley to summit, >= 0", "m")]


class Sweep(Struct, forbid_unknown_fields=True, kw_only=True):
    """How `hystrip sweep` combines the lists and ranges of a scene."""

    combine: Annotated[
        Literal["grid", "list"],
        Meta(description='"grid" (every combination, the default) or "list" (all of one length, taken together)'),
    ] = "grid"
    batch: Annotated[
        Annotated[int, Meta(ge=1, le=100_000)] | None,
        Meta(description="an integer from 1 to 100000, points that are solved and stored together "
             "(without it as many as take a few seconds)"),
    ] = None  # fmt: skip


class SceneFile(Struct, forbid_unknown_fields=True, kw_only=True):
    """A hystrip scene. Keys of the scene itself stand above the first [table] of the file."""

    title: Annotated[str, Meta(description="text of at most 200 characters that names the scene", max_length=200)] = ""
    description: Annotated[str, Meta(description="text, anything worth saying about the scene")] = ""
    pressure: Annotated[Values | None, _range_meta("nominal pressure (negative pulls); or give penetration", "Pa")] = None
    penetration: Annotated[Values | None, _range_meta("penetration of level 1, in place of pressure", "m")] = None
    velocity: Annotated[Values, _range_meta("sliding velocity, >= 0", "m/s")]
    temperature: Annotated[Values | None, _swept_meta("temperature, for a material with [material.shift]", "K")] = None
    strips: Annotated[
        Annotated[int, Meta(ge=1, le=1_000_000)] | None,
        Meta(description="an integer from 1 to 1000000: average level 1 over so many equal strips, as the paper does "
             "(without it adaptive panels)"),
    ] = None  # fmt: skip
    edge: Annotated[
        Literal["continuous", "constitutive"],
        Meta(description='"continuous" (the default) or "constitutive", the closure where the pressure steps'),
    ] = "continuous"
    branch: Annotated[
        Literal["unloading", "loading"],
        Meta(description='"unloading" (the default, the most engaged solution) or "loading" (the least engaged)'),
    ] = "unloading"
    rtol: Annotated[
        float, Meta(ge=1e-12, le=0.1, description="a number from 1e-12 to 0.1, the accuracy asked for (default 1e-6)")
    ] = 1e-6
    material: Annotated[Material, Meta(description="a table [material] with K and the times of its model")]
    adhesion: Annotated[Adhesion | None, Meta(description="a table [adhesion]; without one there is no adhesion")] = None
    sweep: Annotated[Sweep | None, Meta(description="a table [sweep] with combine and batch, for `hystrip sweep`")] = None
    levels: Annotated[
        list[Level],
        Meta(
            min_length=1,
            max_length=100,
            description="one [[levels]] table or more, at most 100, each with l and h, the largest first",
        ),
    ]


def json_schema() -> dict[str, Any]:
    """The JSON Schema (draft 2020-12) of a scene file, as plain dicts and lists."""
    schema = msgspec.json.schema(SceneFile)
    parts = schema["$defs"]
    parts["SceneFile"]["oneOf"] = [{"required": ["pressure"]}, {"required": ["penetration"]}]
    parts["Adhesion"] |= {"anyOf": [{"required": ["gamma"]}, {"required": ["p_0"]}], "maxProperties": 2}
    _without_null(schema)
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", "title": "hystrip scene", **schema}


def _without_null(part: Any) -> None:
    """TOML has no null: a key that may be absent is absent."""
    if isinstance(part, list):
        for each in part:
            _without_null(each)
    elif isinstance(part, dict):
        if "anyOf" in part:
            part["anyOf"] = [each for each in part["anyOf"] if each != {"type": "null"}]
        if part.get("default", 0) is None:
            del part["default"]
        for each in part.values():
            _without_null(each)

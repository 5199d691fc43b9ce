"""Scene files: what they may hold, and what is said of those that may not."""

import json
import pickle
import re
import tomllib

import numpy as np
import pytest
from scene_text import ONE_LEVEL

from hystrip.errors import InputError
from hystrip.example import SCENE
from hystrip.scene import BUILTIN, load_scene, parse_scene
from hystrip.scene.edit import with_levels, with_material
from hystrip.scene.errors import SceneError, nearest
from hystrip.scene.quantity import to_si
from hystrip.scene.schema import SceneFile, json_schema
from hystrip.scene.validate import validated


def test_units_and_plain_numbers_give_the_same_scene():
    text = """
pressure = "0.1 kPa"
velocity = "5 mm/s"
[material]
K = "1 GPa/m"
T_eps = "10 ms"
T_sigma = "100 µs"
[adhesion]
gamma = "25 µJ/m²"
delta_0 = "10 nm"
[[levels]]
l = "10 um"
h = "1 μm"
"""
    assert validated(tomllib.loads(text)) == validated(tomllib.loads(ONE_LEVEL))


@pytest.mark.parametrize(
    ("text", "unit", "value"),
    [
        ("10 um", "m", 1e-5),
        ("10um", "m", 1e-5),
        ("10 µm", "m", 1e-5),  # micro sign
        ("10 μm", "m", 1e-5),  # Greek letter mu
        (" .5e1 nm ", "m", 5e-9),
        ("-0.1 kPa", "Pa", -100.0),
        ("1 bar", "Pa", 1e5),
        ("3.6 km/hour", "m/s", 1.0),
        ("25 mN/m", "J/m^2", 0.025),
        ("1e9 N/m^3", "Pa/m", 1e9),
        ("2 kN/m2", "Pa", 2e3),
        ("5 mm·s⁻¹", "m/s", 5e-3),
        ("3 N.m-2", "Pa", 3.0),
    ],
)
def test_quantity_is_the_nearest_float(text, unit, value):
    assert to_si(text, unit, "x") == value


@pytest.mark.parametrize(
    "text",
    [
        "",
        "um",
        "10",
        "0,1 um",
        "10 um um",
        "ten um",
        "10 kg",
        "10 parsnips",
        "10 Um",
        "10 m2",
        "10 m·s⁻¹",
        "10 m9999",
        "1/2 m",
        "10 (m",
        "1e999 m",
    ],
)
def test_quantity_that_is_none(text):
    with pytest.raises(InputError, match="^x: got .*; allowed: .*m"):
        to_si(text, "m", "x")


@pytest.mark.parametrize(
    ("written", "values"),
    [
        ("3", np.array(3.0)),
        ("[3]", np.array([3.0])),
        ('[1, "2 Pa", 5.0]', np.array([1.0, 2.0, 5.0])),
        ("{ start = -1, stop = 1, num = 5 }", np.linspace(-1, 1, 5)),
        ('{ start = "1 Pa", stop = "1 kPa", num = 4, spacing = "log" }', np.geomspace(1, 1000, 4)),
    ],
)
def test_values(written, values):
    given = validated(tomllib.loads(ONE_LEVEL.replace("pressure = 100", f"pressure = {written}")))["pressure"]
    assert given.shape == values.shape
    assert np.array_equal(given, values)


@pytest.mark.parametrize("name", BUILTIN)
def test_builtin_scene(name):
    scene = load_scene(name)
    assert scene.name == name
    assert scene.title
    assert scene.levels


def test_fig6_is_the_paper_s():
    scene = load_scene("paper_fig6")
    assert (scene.material.K, scene.material.T_eps, scene.material.T_sigma) == (1e9, 1e-2, 1e-4)
    assert scene.adhesion.gamma == 2.5e-5 and scene.adhesion.delta_0 == 1e-8
    assert [(level.l, level.h) for level in scene.levels] == [(1e-5, 1e-6), (5e-7, 1e-7)]
    assert scene.pressure == 100 and scene.penetration is None
    assert scene.velocity.shape == (60,) and scene.velocity[0] == 1e-5 and scene.velocity[-1] == 0.1
    assert (scene.edge, scene.branch, scene.rtol) == ("continuous", "unloading", 1e-4)


def test_no_adhesion_table_is_no_adhesion():
    text = ONE_LEVEL[: ONE_LEVEL.index("[adhesion]")] + ONE_LEVEL[ONE_LEVEL.index("[[levels]]") :]
    assert parse_scene(text).adhesion.gamma == 0


def test_any_two_quantities_of_adhesion_give_the_third():
    two = {"gamma": 2.5e-5, "p_0": 2500.0, "delta_0": 1e-8}
    start, stop = ONE_LEVEL.index("gamma"), ONE_LEVEL.index("[[levels]]")
    for left_out in two:
        table = "".join(f"{key} = {value}\n" for key, value in two.items() if key != left_out)
        adhesion = parse_scene(ONE_LEVEL[:start] + table + ONE_LEVEL[stop:]).adhesion
        assert (adhesion.gamma, adhesion.p_0, adhesion.delta_0) == pytest.approx(tuple(two.values()), rel=1e-15)


def test_what_starter_scenes_have_in_remarks_can_be_had():
    table = re.search(r"(?m)^#   \[adhesion\]\n(#   .*\n)+", SCENE)[0]
    adhesion = parse_scene(SCENE.replace(table, table.replace("#   ", ""))).adhesion
    assert (adhesion.gamma, adhesion.p_0, adhesion.delta_0) == (0.05, 5e5, 0.05 / 5e5)
    starter = load_scene("starter").text
    loads = re.findall(r"(?m)^#   ((?:pressure|penetration) = .*)$", starter)
    assert len(loads) == 3
    for load in loads:
        parse_scene(starter.replace("\npressure = 100\n", f"\n{load}\n"))


def test_the_nearest_valid_name_is_offered():
    with pytest.raises(SceneError) as caught:
        parse_scene(ONE_LEVEL.replace("T_sigma", "Tsigma"), source="mine.toml")
    assert "mine.toml: material.Tsigma: unknown key (did you mean 'T_sigma'?)" in str(caught.value)
    assert nearest("KPA", ["kPa", "Pa"]) == "kPa"
    assert nearest("zzz", ["kPa", "Pa"]) is None


def test_a_key_below_a_table_is_told_its_place():
    with pytest.raises(SceneError, match=r"levels\[0\].edge: .*has to stand above the first \[table\]"):
        parse_scene(ONE_LEVEL + 'edge = "constitutive"\n')


def test_errors_survive_pickling():
    error = SceneError("a.b", 3, "less", "too much", "x.toml")
    again = pickle.loads(pickle.dumps(error))
    assert str(again) == str(error) == "x.toml: a.b: too much; allowed: less"


def test_json_schema_names_every_key_and_nothing_that_toml_lacks():
    schema = json.loads(json.dumps(json_schema()))
    assert set(schema["$defs"]["SceneFile"]["properties"]) == set(SceneFile.__struct_fields__)
    assert '"null"' not in json.dumps(schema)
    for part in schema["$defs"].values():
        assert part["additionalProperties"] is False
        assert all(key["description"] for key in part["properties"].values())


def test_nothing_of_a_table_stays_beside_what_is_put_in_its_place():
    """Under a header in quotes, levels were left above the new ones."""
    level = {"l": 1e-6, "h": 1e-7}
    assert len(parse_scene(with_levels(ONE_LEVEL, [level, level])).levels) == 2
    with pytest.raises(SceneError, match="^levels: got .*allowed: a table under its own header"):
        with_levels(ONE_LEVEL.replace("[[levels]]", '[["levels"]]'), [level])
    with pytest.raises(SceneError, match="^material: got .*allowed: a table under its own header"):
        with_material(ONE_LEVEL.replace("[material]", '["material"]'), {"material": {"K": 1e9, "T_eps": 1.0, "T_sigma": 0.0}})

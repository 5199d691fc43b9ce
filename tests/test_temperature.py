"""Temperature: times and moduli shift, and nothing else."""

import pickle
import warnings

import numpy as np
import pytest

import hystrip
from hystrip.dma import DynamicModulus, fit_prony
from hystrip.inputs.shift import ShiftWarning
from hystrip.plausibility import excited_band, notes
from hystrip.scene import parse_scene
from hystrip.tables import about_result

LEVELS = [hystrip.Level(l=1e-3, h=2e-5), hystrip.Level(l=1e-4, h=2e-6)]
WLF = hystrip.WLF(C_1=8.86, C_2=101.6, T_ref=293.15, vertical=1)
ARRHENIUS = hystrip.Arrhenius(E_a=1.2e5, T_ref=293.15)
MATERIALS = [
    hystrip.StandardLinearSolid(1e9, 1e-2, 1e-4, shift=WLF),
    hystrip.KelvinVoigt(1e9, 1e-3, shift=ARRHENIUS),
    hystrip.Prony(1e9, [3e9, 1e10], [1e-3, 1e-5], shift=ARRHENIUS),
    hystrip.HalfSpace(2e6, 0.49, [8e6, 3e7], [1e-3, 1e-5], shift=WLF),
]


@pytest.mark.parametrize("material", MATERIALS, ids=lambda m: type(m).__name__)
def test_a_material_shows_its_shift(material):
    assert "shift=" in repr(material) and eval(repr(material), vars(hystrip) | {"WLF": hystrip.WLF}) == material


@pytest.mark.parametrize("material", MATERIALS, ids=lambda m: type(m).__name__)
def test_friction_at_a_temperature_is_that_at_another_velocity_and_load(material):
    """``E*(omega, T) = b_T E*(a_T omega, T_ref)``: the same contact at V a_T under p/b_T."""
    T, V, p = 313.15, np.array([1e-2, 1.0]), 2e5
    a_T, b_T = float(material.shift.factor(T)), float(material.shift.modulus_factor(T))
    assert a_T < 0.1 and b_T in (1.0, T / 293.15)
    how = {"rtol": 1e-2, "edge": "constitutive"}
    hot = hystrip.solve(material, hystrip.Dugdale(gamma=0), LEVELS, pressure=p, velocity=V, temperature=T, **how)
    same = hystrip.solve(material, hystrip.Dugdale(gamma=0), LEVELS, pressure=p / b_T, velocity=V * a_T, **how)
    assert hot.mu == pytest.approx(same.mu, rel=1e-9) and hot.temperature == T and "at 313.15 K" in hot.summary()
    said = [[line for line in about_result(each) if line.startswith("temperature")] for each in (hot, same)]
    assert said == [["temperature: 313.15 K, at which the material is given"], []]
    assert type(hot.material) is type(material) and material == pickle.loads(pickle.dumps(material))


@pytest.mark.parametrize(("T_ref", "odd"), [(20.0, True), (293.15, False), (528.0, True)])
def test_a_reference_of_no_rubber_is_said(T_ref, odd):
    """20 was meant in degrees Celsius, 528 in Rankine: times would shift by decades without a word."""
    material = hystrip.KelvinVoigt(1e9, 1e-3, shift=hystrip.Arrhenius(E_a=1e3, T_ref=T_ref))
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        hystrip.solve(material, hystrip.Dugdale(gamma=0), LEVELS, pressure=1e4, velocity=1.0, temperature=313.15, rtol=1e-2)
    assert [each.category for each in said] == [ShiftWarning] * odd
    assert all(f"shift.T_ref is {T_ref:g} K" in str(each.message) and each.filename == __file__ for each in said)


@pytest.mark.parametrize(
    ("shift", "temperature", "said"),
    [
        (hystrip.Arrhenius(E_a=120.0, T_ref=293.15), 313.15, "shift.E_a is 120 J/mol; usual are 1000 J/mol and more: .* kJ/mol"),
        (hystrip.Arrhenius(E_a=1e4, T_ref=293.15), 25, "temperature is 25 K; usual are 100 to 473.15 K; degrees have to be"),
    ],
)
def test_units_that_shifts_and_temperatures_hardly_have_are_remarked_on(shift, temperature, said):
    with pytest.warns(ShiftWarning, match=said):
        hystrip.StandardLinearSolid(1e9, 1e-2, 1e-4, shift=shift).at_temperature(temperature)


def test_shift_factors_are_the_textbook_ones():
    T = np.array([283.15, 293.15, 333.15])
    assert np.log10(WLF.factor(T)) == pytest.approx(-8.86 * (T - 293.15) / (101.6 + T - 293.15), abs=1e-14)
    assert np.log(ARRHENIUS.factor(T)) == pytest.approx(1.2e5 / 8.314462618 * (1 / T - 1 / 293.15), abs=1e-14)
    assert WLF.modulus_factor(T) == pytest.approx(T / 293.15) and (ARRHENIUS.modulus_factor(T) == 1).all()


@pytest.mark.parametrize(
    ("call", "field", "allowed"),
    [
        (lambda: hystrip.WLF(C_1=-1, C_2=50, T_ref=293), "shift.C_1", "> 0"),
        (lambda: hystrip.WLF(C_1=8, C_2=50, T_ref=0), "shift.T_ref", "(K)"),
        (lambda: hystrip.Arrhenius(E_a="80", T_ref=293), "shift.E_a", "J/mol"),
        (lambda: hystrip.Arrhenius(E_a=8e4, T_ref=293, vertical=99), "shift.vertical", "-10 to 10"),
        (lambda: WLF.factor(190.0), "temperature", "> 191.55"),
        (lambda: hystrip.Arrhenius(E_a=1e6, T_ref=293).factor(1.0), "temperature", "30 decades"),
        (lambda: MATERIALS[0].at_temperature([300.0, 310.0]), "temperature", "a single number"),
        (lambda: hystrip.Prony(1e9, [1e9], [1.0]).at_temperature(300.0), "temperature", "[material.shift]"),
        (lambda: hystrip.Prony(1e9, [1e9], [1.0], shift=300.0), "material.shift", "a hystrip.WLF"),
        (lambda: hystrip.HalfSpace(1e6, 0.5, fit=0.1), "material.fit", "PronySeries"),
    ],
)
def test_what_cannot_be_shifted_is_refused(call, field, allowed):
    with pytest.raises(hystrip.InputError) as refused:
        call()
    assert refused.value.field == field and allowed in refused.value.allowed, refused.value


SCENE = """
pressure = 1e5
velocity = 1.0
edge = "constitutive"
temperature = "104 °F"
[material]
kind = "half-space"
E = "2 MPa"
nu = 0.49
moduli = ["8 MPa", 3e7]
times = [1e-3, "10 us"]
[material.shift]
model = "WLF"
C_1 = 8.86
C_2 = 101.6
T_ref = "20 degC"
vertical = 1
[material.fit]
edges = [0.01, 1, 1e4]
rms = [0.01, 0.02]
[[levels]]
l = "1 mm"
h = "20 um"
"""


def test_scene_of_a_half_space_at_a_temperature():
    scene = parse_scene(SCENE)
    assert scene.temperature == pytest.approx(313.15, abs=1e-9) and scene.material.shift == WLF
    assert (scene.material.E, scene.material.nu, scene.material.moduli) == (2e6, 0.49, (3e7, 8e6))
    direct = hystrip.solve(
        MATERIALS[3], scene.adhesion, scene.levels, pressure=1e5, velocity=1.0, temperature=313.15, edge="constitutive"
    )
    assert scene.solve().mu == pytest.approx(direct.mu, rel=1e-9)


WRONG = [
    ('kind = "half-space"', 'kind = "halfspace"', 'material.kind: got .*"half-space"'),
    ('kind = "half-space"', 'kind = "half-space"\nmodel = "prony"', 'material.model: got .*none with kind = "half-space"'),
    ('kind = "half-space"', "", 'material.E: a key of another model; allowed: with model.*; E goes with kind = "half-space"'),
    ('kind = "half-space"', 'model = "half_space"', 'material.model: got .half_space.; .*for a half-space kind = "half-space"'),
    ('kind = "half-space"', 'kind = "prony"', "material.kind: got 'prony'; .*the name of a model stands under model"),
    ('kind = "half-space"\nE = "2 MPa"\nnu = 0.49', "K = 1e9", r"material.moduli: .*moduli goes with .*or model = \"prony\""),
    ('E = "2 MPa"', "", "material.E: missing"),
    ('E = "2 MPa"', 'E = "2 MPa/m"', "material.E: .*unit of something else"),
    ('E = "2 MPa"', "E = -2", "material.E: got -2.0"),
    ('E = "2 MPa"', 'E = "2 MPa"\nK = 1e9', "material.K: a key of another model; allowed: with kind"),
    ("nu = 0.49", "", "material.nu: missing"),
    ("nu = 0.49", "nu = 0.6", "material.nu: got 0.6; allowed: a Poisson ratio from 0 to 0.5"),
    ("nu = 0.49", 'nu = "0.49"', "material.nu: got '0.49'"),
    ('"8 MPa"', '"8 MPa/m"', r"material.moduli\[0\]: .*unit of something else"),
    ('"8 MPa"', "-1", r"material.moduli\[0\]: got -1.0; allowed: .*\(Pa\)"),
    ("3e7]", "3e7, 1]", "material.moduli, material.times.*as many|material.moduli.*as many"),
    ('model = "WLF"', 'model = "wlf"', 'material.shift.model: got .*"WLF"'),
    ('model = "WLF"', 'model = "Arrhenius"', "material.shift.C_1: a key of the model WLF"),
    ("C_1 = 8.86", "", "material.shift.C_1: missing"),
    ("C_1 = 8.86", "C_1 = 0", "material.shift.C_1: got 0"),
    ("C_2 = 101.6", 'C_2 = "101.6 degC"', "C_2: got '101.6 degC'; .* or 'delta_degC', since it is a difference of temperatures"),
    ("C_2 = 101.6", 'C_2 = "101.6 °F"', "C_2: got '101.6 °F'; .*; °F is that of a temperature, told from a zero of its own"),
    ("C_2 = 101.6", 'C_2 = "101.6 degRe"', "C_2: got '101.6 degRe'"),
    ("C_2 = 101.6", 'C_2 = "101.6 m"', "C_2: got '101.6 m'; .*unit of something else"),
    ("C_2 = 101.6", "C_2 = true", r"C_2: got True; allowed: second constant of WLF, > 0: a number in K \(difference\)"),
    ('T_ref = "20 degC"', "", "material.shift.T_ref: missing"),
    ('T_ref = "20 degC"', "T_ref = -20", "material.shift.T_ref: got -20"),
    ('T_ref = "20 degC"', 'T_ref = "-300 °C"', "T_ref: got '-300 °C'; allowed: a temperature above absolute zero, -273.15 °C"),
    ('T_ref = "20 degC"', 'T_ref = "-500 degF"', "T_ref: got '-500 degF'; allowed: .* above absolute zero, -459.67 degF"),
    ('T_ref = "20 degC"', 'T_ref = "20 m"', "material.shift.T_ref: .*unit of something else"),
    ('T_ref = "20 degC"', 'T_ref = "20 degRe"', "material.shift.T_ref: got '20 degRe'"),
    ("vertical = 1", "vertical = 11", "material.shift.vertical: got 11"),
    ("vertical = 1", "E_a = 1", "material.shift.E_a: a key of the model Arrhenius"),
    ("edges = [0.01, 1, 1e4]", "edges = [0.01, 1]", "material.fit.rms: .*1 numbers"),
    ("edges = [0.01, 1, 1e4]", "edges = [1, 0.01, 1e4]", "material.fit.edges: .*ascending"),
    ("edges = [0.01, 1, 1e4]", "edges = 3", "material.fit.edges: got 3"),
    ("rms = [0.01, 0.02]", "rms = [0.01, -0.02]", "material.fit.rms: got -0.02"),
    ("rms = [0.01, 0.02]", "", "material.fit.rms: missing"),
    ('temperature = "104 °F"', 'temperature = "-300 °C"', "temperature: got '-300 °C'; allowed: a temperature above"),
    ('temperature = "104 °F"', 'temperature = ["20 °C", "30 °C"]', "temperature: .*`hystrip sweep`"),
    ('temperature = "104 °F"', "temperature = 150", "temperature: got 150"),
    ('edge = "constitutive"', "", "edge: .*several relaxation times"),
]


@pytest.mark.parametrize(("written", "kelvin"), [('"101.6 K"', 101.6), ('"101.6 delta_degC"', 101.6), ('"90 delta_degF"', 50.0)])
def test_a_difference_of_temperatures_may_have_its_unit(written, kelvin):
    assert parse_scene(SCENE.replace("C_2 = 101.6", f"C_2 = {written}")).material.shift.C_2 == kelvin


@pytest.mark.parametrize(("old", "new", "said"), WRONG)
def test_wrong_scenes_are_named(old, new, said):
    with pytest.raises(hystrip.InputError, match=said):
        parse_scene(SCENE.replace(old, new)).solve()


def test_sweep_over_a_shift(run, tmp_path):
    pytest.importorskip("typer")
    (tmp_path / "shift.toml").write_text(SCENE.replace("C_2 = 101.6", "C_2 = [90, 110]"), encoding="utf-8")
    over = {"material.shift.vertical": [-1.0, 1.0], "material.shift.T_ref": [280.0, 293.15]}
    done = hystrip.sweep(tmp_path / "shift.toml", over=over, out=tmp_path / "out")
    assert [axis.name for axis in done.plan.axes] == ["T_ref", "C_2", "vertical"] and done.plan.size == 8
    assert "T_ref (2): 280 .. 293.15 K" in str(done)
    scene = parse_scene(SCENE)
    for row in range(8):
        T_ref, C_2, vertical = (done.columns[name][row] for name in ("T_ref [K]", "C_2 [K]", "vertical [1]"))
        shift = hystrip.WLF(C_1=8.86, C_2=C_2, T_ref=T_ref, vertical=vertical)
        material = hystrip.HalfSpace(2e6, 0.49, [8e6, 3e7], [1e-3, 1e-5], shift=shift)
        one = hystrip.solve(
            material, scene.adhesion, scene.levels, pressure=1e5, velocity=1.0, temperature=313.15, edge="constitutive"
        )
        assert done.columns["mu"][row] == pytest.approx(one.mu, rel=1e-6)
    (tmp_path / "one.toml").write_text(SCENE, encoding="utf-8")
    status, out, err = run("sweep", "one.toml", "--over", "material.shift.C_1=[8, 9]", "--over", 'material.shift.T_ref="0 degC"')
    assert (status, err) == (0, "") and "2 points" in out
    for wrong, said in (
        ('C_2="100 degC"', "C_2"),
        ("E_a=1e5", "one of"),
        ("C_1=[8, -1]", "> 0"),
        ("vertical=[0, 11]", "vertical"),
    ):
        status, out, err = run("sweep", "one.toml", "--over", f"material.shift.{wrong}", "--out", f"out-{said[:3]}")
        assert status != 0 and said in err, wrong


def test_sweep_over_a_poisson_ratio(tmp_path):
    (tmp_path / "nu.toml").write_text(SCENE, encoding="utf-8")
    with pytest.raises(hystrip.InputError, match="material.nu: got 0.6; allowed: a Poisson ratio from 0 to 0.5"):
        hystrip.sweep(tmp_path / "nu.toml", over={"material.nu": [0.3, 0.6]}, out=tmp_path / "out")
    assert not (tmp_path / "out").exists()
    done = hystrip.sweep(tmp_path / "nu.toml", over={"material.nu": [0.3, 0.5]}, out=tmp_path / "out")
    assert "over    nu (2): 0.3 .. 0.5\n" in str(done)


def test_a_look_into_a_scene_is_at_its_temperature(run, tmp_path):
    (tmp_path / "shift.toml").write_text(SCENE, encoding="utf-8")
    status, out, err = run("show", "shift.toml")
    assert (status, err) == (0, "") and out.strip() == parse_scene(SCENE).solve().summary()


def test_temperature_needs_a_shift():
    table = SCENE.index("[material.shift]"), SCENE.index("[material.fit]")
    with pytest.raises(hystrip.InputError, match=r"temperature: .*\[material.shift\]"):
        parse_scene(SCENE[: table[0]] + SCENE[table[1] :]).solve()


def test_plausibility_is_said():
    omega = 2 * np.pi * np.geomspace(1e-2, 1e4, 60)
    x = 1j * omega * 1e-3
    E = 1e6 + 5e6 * x / (1 + x)
    series = fit_prony(DynamicModulus(omega, E.real, E.imag))
    material = series.half_space(0.5)
    assert notes(material, LEVELS, [1e-3, 0.5]) == []
    assert excited_band(LEVELS, [0.0, 1e-3, 0.5]) == pytest.approx((1.0, 5e3)) and excited_band(LEVELS, [0.0]) is None
    (beyond,) = notes(material, LEVELS, [1e-3, 10.0])
    assert "from 1 to 1e+05 Hz, beyond the 0.01 to 1e+04 Hz" in beyond
    odd = [hystrip.Level(0.2, 1e-3), hystrip.Level(1e-6, 4e-7), hystrip.Level(5e-10, 1e-12)]
    said = " ".join(notes(hystrip.StandardLinearSolid(1e9, 1e-2, 1e-4), odd, 1.0))
    for part in ("level 1: a wavelength of 0.2 m", "level 2: h/l = 0.4", "level 3: a wavelength of 5e-10 m"):
        assert part in said
    with pytest.warns(hystrip.dma.FitWarning):
        poor = fit_prony(lambda omega: 1e6 + 1e9 / (1 + (1j * omega * 1e-4) ** -0.4), band=(1e-2, 1e4), terms=1)
    (off,) = notes(poor.half_space(0.5), LEVELS, [1e-3, 0.5])
    assert "% rms off" in off
    assert notes(material, LEVELS, [1e-3, 0.5], 293.15) == []
    (hot,) = notes(material, LEVELS, [1e-3, 0.5], 566.3)
    assert hot.startswith("a temperature of 566.3 K, above 473.15 K")
    (cold,) = notes(material, LEVELS, [1e-3, 0.5], 25.0)
    assert cold.startswith("a temperature of 25 K, below 100 K")
    # shifted to another temperature the fitted band moves with the times
    hot = hystrip.HalfSpace(1e6, 0.5, [5e6], [1e-3], shift=WLF, fit=material.fit).at_temperature(313.15)
    assert hot.fit.high == pytest.approx(1e4 / float(WLF.factor(313.15)))
    result = hystrip.solve(material, hystrip.Dugdale(gamma=0), LEVELS, pressure=1e7, velocity=[1e-3, 10.0])
    assert result.notes == [beyond] and f"note       {beyond}" in result.summary() and "excited    k V" in result.summary()


def test_the_command_line_says_it_once(run, tmp_path):
    pytest.importorskip("typer")
    odd = SCENE.replace('"104 °F"', '"40 °C"').replace('"20 degC"', "20")
    (tmp_path / "odd.toml").write_text(odd, encoding="utf-8")
    status, _, err = run("solve", "odd.toml")
    assert status == 0 and err.count("shift.T_ref is 20 K") == 1


def test_sweep_over_temperature_and_moduli(run, tmp_path):
    pytest.importorskip("typer")
    (tmp_path / "hot.toml").write_text(
        SCENE.replace('"104 °F"', '["20 °C", "40 °C"]').replace("1.0\n", "[1.0, 10.0]\n", 1), encoding="utf-8"
    )
    done = hystrip.sweep(tmp_path / "hot.toml", over={"material.E": [2e6, 3e6]}, out=tmp_path / "out")
    assert done.plan.shape == (2, 2, 2) and [axis.name for axis in done.plan.axes] == ["E", "temperature", "velocity"]
    assert done.plan.points_of_a_call == 2  # of velocities, which come last: the solver takes them together
    scene = parse_scene(SCENE)
    for row in range(8):
        E, V, T = (done.columns[name][row] for name in ("E [Pa]", "velocity [m/s]", "temperature [K]"))
        material = hystrip.HalfSpace(E, 0.49, [8e6, 3e7], [1e-3, 1e-5], shift=WLF)
        one = hystrip.solve(material, scene.adhesion, scene.levels, pressure=1e5, velocity=V, temperature=T, edge="constitutive")
        assert done.columns["mu"][row] == pytest.approx(one.mu, rel=1e-6)
    (tmp_path / "one.toml").write_text(SCENE, encoding="utf-8")
    status, out, err = run("sweep", "one.toml", "--over", 'material.moduli[0]=["8 MPa", 9e6]', "--over", 'temperature="30 degC"')
    assert (status, err) == (0, "") and "2 points" in out
    cold = SCENE[: SCENE.index("[material.shift]")] + SCENE[SCENE.index("[material.fit]") :]
    (tmp_path / "cold.toml").write_text(cold.replace('temperature = "104 °F"\n', ""), encoding="utf-8")
    for key in ("temperature", "material.shift.C_1"):
        status, _, err = run("sweep", "cold.toml", "--over", f"{key}=[300, 310]")
        assert status == 2 and "this one needs a [material.shift]" in err and "did you mean" not in err
    status, _, err = run("sweep", "one.toml", "--over", 'material.moduli[0]=["8 MPa/m"]')
    assert status == 2 and "unit of something else" in err


def test_summary_says_at_which_temperature():
    options = {"pressure": 1e5, "velocity": 1.0, "edge": "constitutive", "rtol": 1e-2}
    level, none = hystrip.Level(l=1e-3, h=2e-5), hystrip.Dugdale(gamma=0)
    assert ", as at T_ref = 293.15 K\n" in hystrip.solve(MATERIALS[3], none, level, **options).summary()
    assert ", at 313.15 K\n" in hystrip.solve(MATERIALS[3], none, level, temperature=313.15, **options).summary()

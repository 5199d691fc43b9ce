"""Wrong inputs of the Python API: each refusal names the field, the value and what is allowed, before any work is done."""

import inspect
import pickle
from dataclasses import is_dataclass

import numpy as np
import pytest
import xarray

import hystrip
import hystrip.scene
from hystrip.multilevel import Surface
from hystrip.orbit import single

MATERIAL = hystrip.StandardLinearSolid(K=1e9, T_eps=1e-2, T_sigma=1e-4)
ADHESION = hystrip.Dugdale(gamma=2.5e-5, delta_0=1e-8)
LEVEL = hystrip.Level(l=500e-9, h=100e-9)
TOO_MANY = {"K": 1e9, "moduli": [1e9] * 41, "times": [1e-3 * 1.2**i for i in range(41)]}
ARRAYS = hystrip.StandardLinearSolid(K=[1e9, 2e9], T_eps=1e-2, T_sigma=1e-4)


def material(**changed):
    return hystrip.StandardLinearSolid(**{"K": 1e9, "T_eps": 1e-2, "T_sigma": 1e-4, **changed})


def strip(**changed):
    given = {"material": MATERIAL, "adhesion": ADHESION, "l": 500e-9, "A": 5e-8, "D": 2e-8, "V": 5e-3, **changed}
    return hystrip.solve_strip(given.pop("material"), given.pop("adhesion"), **given)


def one_level(**changed):
    given = {"material": MATERIAL, "adhesion": ADHESION, "level": LEVEL, "V": 5e-3, "D": 1e-7, **changed}
    return hystrip.solve_level(given.pop("material"), given.pop("adhesion"), given.pop("level"), **given)


def law(**changed):
    given = {"level": LEVEL, "V": 5e-3, **changed}
    return hystrip.friction_law(MATERIAL, ADHESION, given.pop("level"), **given)


def surface(**changed):
    given = {"material": MATERIAL, "adhesion": ADHESION, "levels": [LEVEL], "pressure": 1e6, "velocity": 5e-3, **changed}
    return hystrip.solve(given.pop("material"), given.pop("adhesion"), given.pop("levels"), **given)


class WithUnit:
    """Like a quantity of Pint or Astropy: an array to NumPy, which drops the unit."""

    units = "um"

    def __init__(self, value):
        self.value = value

    def __array__(self, dtype=None, copy=None):
        return np.array(self.value, dtype)

    def __repr__(self):
        return f"{self.value} {self.units}"

    def to(self, units):
        raise NotImplementedError


CASES = [  # the call, what is wrong, the field, and words on the value and on what is allowed
    (material, {"K": 0}, "material.K", "got 0;", "> 0 (Pa/m)"),
    (material, {"K": -1.0}, "material.K", "-1.0", "> 0"),
    (material, {"K": np.nan}, "material.K", "nan", "finite"),
    (material, {"K": np.inf}, "material.K", "inf", "finite"),
    (material, {"K": True}, "material.K", "True", "number"),
    (material, {"K": np.True_}, "material.K", "True", "number"),
    (material, {"K": [1e9, True]}, "material.K", "True", "number"),
    (material, {"K": [[1e9, 2e9], (1e9, np.False_)]}, "material.K", "False", "number"),
    (material, {"K": [np.array([1e9]), np.array([True])]}, "material.K", "True", "number"),
    (material, {"K": "1e9"}, "material.K", "'1e9'", "number"),
    (material, {"K": None}, "material.K", "None", "number"),
    (material, {"K": 1e9 + 1j}, "material.K", "1j", "number"),
    (material, {"K": 10**400}, "material.K", "10000", "finite"),
    (material, {"K": [1e9, -2.0]}, "material.K", "-2.0", "> 0"),
    (material, {"K": [[1.0], [1.0, 2.0]]}, "material.K", "[[1.0], [1.0, 2.0]]", "number"),
    (material, {"T_eps": -1e-2}, "material.T_eps", "-0.01", ">= 0 (s)"),
    (material, {"T_sigma": -1e-4}, "material.T_sigma", "-0.0001", ">= 0 (s)"),
    (material, {"T_sigma": 2e-2}, "material.T_sigma", "0.02", "from 0 to T_eps = 0.01"),
    (material, {"T_eps": [1e-2, 1e-5]}, "material.T_sigma", "0.0001", "from 0 to T_eps = 1e-05"),
    (material, {"K": [1.0, 2.0], "T_eps": [1.0, 2.0, 3.0]}, "material.K, material.T_eps", "(2,), (3,)", "broadcast"),
    (hystrip.Dugdale, {}, "adhesion", "{}", "two of the three"),
    (hystrip.Dugdale, {"delta_0": 1e-8}, "adhesion", "delta_0", "two of the three"),
    (hystrip.Dugdale, {"gamma": 1e-5, "p_0": 1e3, "delta_0": 1e-8}, "adhesion", "p_0", "two of the three"),
    (
        hystrip.Dugdale,
        {"gamma": 1e-5, "p_0": 0.0},
        "adhesion.gamma, adhesion.p_0",
        "(1e-05, 0.0)",
        "both zero, or both above zero",
    ),
    (hystrip.Dugdale, {"gamma": 1e-40, "p_0": 1e30}, "adhesion.gamma", "1e-40", "a range from 1e-40"),
    (hystrip.Dugdale, {"gamma": -1e-5, "delta_0": 1e-8}, "adhesion.gamma", "-1e-05", ">= 0 (N/m)"),
    (hystrip.Dugdale, {"gamma": 1e-5}, "adhesion.delta_0", "None", "> 0 (m)"),
    (hystrip.Dugdale, {"p_0": 1e3, "delta_0": 0.0}, "adhesion.delta_0", "0.0", "> 0 (m)"),
    (hystrip.Dugdale, {"p_0": 1e3, "delta_0": -1e-8}, "adhesion.delta_0", "-1e-08", ">= 0 (m)"),
    (hystrip.Dugdale, {"p_0": [1.0, np.nan], "delta_0": 1e-8}, "adhesion.p_0", "nan", "finite"),
    (hystrip.Dugdale, {"gamma": 1e30, "delta_0": 1e-30}, "adhesion.gamma", "1e+30", "a traction up to 1e+40 Pa"),
    (hystrip.Dugdale, {"p_0": 1e200, "delta_0": 1e200}, "adhesion.p_0", "1e+200", "magnitude up to 1e+40"),
    (hystrip.Level, {"l": 0.0, "h": 1e-7}, "level.l", "0.0", "> 0 (m)"),
    (hystrip.Level, {"l": 1e-6, "h": -1e-7}, "level.h", "-1e-07", ">= 0 (m)"),
    (hystrip.Level, {"l": 1e-6, "h": 1e300}, "level.h", "1e+300", ">= 0 (m) of magnitude up to 1e+40"),
    (hystrip.Level, {"l": 1e-320, "h": 1e-7}, "level.l", "1e-320", "> 0 (m), from 1e-40"),
    (hystrip.Level, {"l": WithUnit(10), "h": 1e-7}, "level.l", "10 um", "without a unit of its own"),
    (hystrip.Level, {"l": [1e-6, 2e-6], "h": 1e-7}, "level.l", "[1e-06, 2e-06]", "single number"),
    (strip, {"material": 1e9}, "material", "1000000000.0", "StandardLinearSolid"),
    (strip, {"adhesion": None}, "adhesion", "None", "gamma=0: no adhesion"),
    (strip, {"l": -1e-6}, "l", "-1e-06", "> 0 (m)"),
    (strip, {"A": -1e-9}, "A", "-1e-09", ">= 0 (m)"),
    (strip, {"D": np.nan}, "D", "nan", "finite number (m)"),
    (strip, {"V": -5e-3}, "V", "-0.005", ">= 0 (m/s)"),
    (strip, {"V": 1e300, "l": 1e-30}, "V", "1e+300", ">= 0 (m/s) of magnitude up to 1e+40"),
    (strip, {"V": [1e-3, 2e-3], "D": [1e-8, 2e-8, 3e-8]}, "D, V", "(3,), (2,)", "broadcast"),
    (strip, {"edge": "sharp"}, "edge", "'sharp'", "'continuous', 'constitutive'"),
    (strip, {"edge": None}, "edge", "None", "'continuous', 'constitutive'"),
    (strip, {"branch": "both"}, "branch", "'both'", "'unloading', 'loading'"),
    (one_level, {"D": None}, "D, pressure", "None", "exactly one"),
    (one_level, {"pressure": 1e6}, "D, pressure", "1000000.0", "exactly one"),
    (one_level, {"level": [LEVEL]}, "level", "Level(l=5e-07", "a hystrip.Level"),
    (one_level, {"material": ARRAYS}, "material.K", "2.e+09", "single number"),
    (one_level, {"strips": 0}, "strips", "0", ">= 1"),
    (one_level, {"strips": True}, "strips", "True", "an integer"),
    (one_level, {"strips": 10.0}, "strips", "10.0", "an integer"),
    (one_level, {"strips": 10, "D": None, "pressure": 1e6}, "strips", "10", "equal strips need D"),
    (one_level, {"rtol": 0.0}, "rtol", "0.0", ">= 1e-12"),
    (one_level, {"rtol": 0.2}, "rtol", "0.2", "1e-12 to 0.1"),
    (law, {"V": [1e-3, 2e-3]}, "V", "0.001", "single number"),
    (law, {"V": 1e300}, "V", "1e+300", "magnitude up to 1e+40"),
    (law, {"V": np.inf}, "V", "inf", ">= 0 (m/s)"),
    (law, {"below": np.nan}, "below", "nan", "finite number (Pa)"),
    (law, {"level": "500 nm"}, "level", "'500 nm'", "a hystrip.Level"),
    (surface, {"levels": []}, "levels", "[]", "at least one"),
    (surface, {"levels": 2}, "levels", "2", "sequence of hystrip.Level"),
    (surface, {"levels": [LEVEL, (1e-6, 1e-7)]}, "levels[1]", "(1e-06, 1e-07)", "a hystrip.Level"),
    (surface, {"pressure": None}, "pressure, penetration", "None", "exactly one"),
    (surface, {"penetration": 1e-7}, "pressure, penetration", "1e-07", "exactly one"),
    (surface, {"pressure": [1e6, np.inf]}, "pressure", "inf", "finite number (Pa)"),
    (surface, {"pressure": None, "penetration": "1 nm"}, "penetration", "'1 nm'", "finite number (m)"),
    (surface, {"velocity": [1e-3, -1e-3]}, "velocity", "-0.001", ">= 0 (m/s)"),
    (surface, {"velocity": [1e-3, 2e-3], "pressure": [1.0, 2.0, 3.0]}, "pressure, velocity", "(3,), (2,)", "broadcast"),
    (surface, {"pressure": 5e-324}, "pressure", "5e-324", "0, or a magnitude from 1e-40 Pa on"),
    (surface, {"pressure": 1e-50, "adhesion": hystrip.Dugdale(gamma=0)}, "pressure", "1e-50", "from 1e-20 Pa on"),
    (surface, {"velocity": 1e300}, "velocity", "1e+300", "magnitude up to 1e+40"),
    (surface, {"velocity": np.longdouble("1e400")}, "velocity", "got", "a finite number >= 0"),
    (surface, {"velocity": np.ma.array([1e-3, 1e20], mask=[0, 1])}, "velocity", "masked_array", "none of them masked"),
    (hystrip.Prony, TOO_MANY, "material.times", "41 different times", "at most 40"),
    (
        hystrip.Prony,
        {"K": 1e9, "moduli": [1e9], "times": [1e-3], "solver": "folder"},
        "material.solver",
        "'folder'",
        "load_solver",
    ),
    (hystrip.load_solver, {"folder": "a\0b"}, "solver", "'a\\x00b'", "hystrip regenerate"),
    (surface, {"adhesion": hystrip.Dugdale(p_0=[1e3, 2e3], delta_0=1e-8)}, "adhesion.p_0", "2000.", "single number"),
    (surface, {"rtol": [1e-3, 1e-4]}, "rtol", "0.001", "single number"),
    (surface, {"rtol": np.nan}, "rtol", "nan", ">= 1e-12"),
    (surface, {"edge": "Continuous"}, "edge", "'Continuous'", "'constitutive'"),
    (surface, {"branch": 1}, "branch", "1", "'loading'"),
    (surface, {"strips": 0}, "strips", "0", "an integer >= 1"),
    (surface, {"strips": 2.5}, "strips", "2.5", "adaptive panels"),
]


IDS = [f"{call.__name__}-{wrong}"[:60] for call, wrong, *_ in CASES]


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize(("call", "wrong", "field", "value", "allowed"), CASES, ids=IDS)
def test_refusal(call, wrong, field, value, allowed):
    with pytest.raises(hystrip.InputError) as refused:
        call(**wrong)
    error, message = refused.value, str(refused.value)
    assert error.field == field
    assert message.startswith(f"{field}: got ") and "\n" not in message
    got, _, may = message.partition("; allowed: ")
    assert value in got + ";" and allowed in may


def test_nothing_is_wrong_with_the_calls_themselves():
    assert np.isfinite([strip().p_mean, one_level(rtol=1e-2).p_mean, surface(rtol=1e-2).mu]).all()


def test_the_faintest_pressure_still_gives_a_friction():
    with np.errstate(all="raise", under="ignore"):
        mu = surface(pressure=[1e-20, 1e-18], velocity=1e-3, adhesion=hystrip.Dugdale(gamma=0)).mu
    assert mu[1] / mu[0] == pytest.approx(10, rel=1e-3)  # contact, and with it mu, grows like the root of a small pressure


def test_friction_that_is_no_number_is_an_error(monkeypatch):
    def spoiled(self, V, load, by_pressure, progress=None):
        points = solved(self, V, load, by_pressure, progress)
        points.tau[0, 1] = np.nan
        return points

    solved = Surface.solve
    monkeypatch.setattr(Surface, "solve", spoiled)
    with pytest.raises(
        hystrip.SolverError, match="1 of 3 points have no finite friction; the first: pressure 2e.06, velocity 0.005"
    ):
        surface(pressure=[1e6, 2e6, 3e6])


def test_a_strip_that_cannot_be_certified_is_named_with_all_that_it_is(monkeypatch):
    def refusing(*of):
        solved = solve_strips(*of)
        solved.certified[1] = False
        return solved

    solve_strips = single.solve_strips
    monkeypatch.setattr(single, "solve_strips", refusing)
    material = hystrip.StandardLinearSolid(K=1e9, T_eps=1e-2, T_sigma=[1e-4, 2e-4, 3e-4])
    named = "l=1e-05, A=1e-07, D=2e-08, V=0.001, K=1000000000.0, T_eps=0.01, T_sigma=0.0002, p_0=2500.0, delta_0=1e-08"
    with pytest.raises(hystrip.SolverError, match=f"^1 of 3 strips .*, strip 1: {named}, edge='continuous', branch='unloading'$"):
        hystrip.solve_strip(material, hystrip.Dugdale(p_0=2.5e3, delta_0=1e-8), l=1e-5, A=1e-7, D=[1e-8, 2e-8, 3e-8], V=1e-3)


def test_an_argument_that_does_not_exist():
    with pytest.raises(TypeError, match="presure"):
        surface(presure=1e6)


def test_a_law_says_how_far_it_reaches():
    known = law(below=0.0, rtol=1e-2)
    with pytest.raises(hystrip.InputError, match="p: got .*; allowed: at most .* Pa"):
        known(2 * abs(known.below) + 1e6)


def test_a_refusal_survives_the_way_between_processes_and_is_a_value_error():
    with pytest.raises(ValueError, match="velocity") as refused:
        surface(velocity=-1)
    again = pickle.loads(pickle.dumps(refused.value))
    assert str(again) == str(refused.value) and again.field == "velocity"


def test_inputs_cannot_be_changed_past_their_checks():
    for owner, name in ((MATERIAL, "K"), (ADHESION, "p_0"), (LEVEL, "h")):
        with pytest.raises(AttributeError):
            setattr(owner, name, -1.0)


def test_a_number_may_be_an_array_of_xarray_without_dimensions_and_angles_a_list():
    one = xarray.DataArray(5e-3)
    assert surface(velocity=one).mu == surface(velocity=5e-3).mu
    assert hystrip.HalfSpace(2e6, 0.5, xarray.DataArray([8e6]), [one]) == hystrip.HalfSpace(2e6, 0.5, [8e6], [5e-3])
    assert (LEVEL.amplitude([0, 1.0]) == LEVEL.amplitude(np.array([0, 1.0]))).all() and LEVEL.drop([0])[0] == 0


def test_adhesion_is_shown_as_the_call_that_makes_it():
    greatest = hystrip.Dugdale(p_0=1e40, delta_0=1.1e-9)  # gamma over delta_0 is a rounding beyond
    for law in (ADHESION, greatest, hystrip.Dugdale(p_0=15300.0, delta_0=3.3e-9), hystrip.Dugdale(gamma=0.05, p_0=5e5)):
        assert eval(repr(law), vars(hystrip)) == law
    assert repr(ADHESION) == "Dugdale(gamma=2.5e-05, delta_0=1e-08)"


HEIGHTS = np.random.default_rng(0).normal(0, 1e-7, 16)
SWITCHES = {  # every parameter of the public interface that is true or false
    "load_scene.allow_solver": lambda given: hystrip.load_scene("paper_fig7", allow_solver=given),
    "parse_scene.allow_solver": lambda given: hystrip.scene.parse_scene("velocity = 1", allow_solver=given),
    "solve.skip": lambda given: surface(skip=given),
    "sweep.restart": lambda given: hystrip.sweep("paper_fig7", restart=given),
    "sweep.allow_solver": lambda given: hystrip.sweep("paper_fig7", allow_solver=given),
    "master_curve.vertical": lambda given: hystrip.dma.master_curve([], vertical=given),
    "read_dma.shear": lambda given: hystrip.dma.read_dma("none.csv", shear=given),
    "read_isotherms.shear": lambda given: hystrip.dma.read_isotherms("none.csv", shear=given),
    "Scan.periodic": lambda given: hystrip.roughness.Scan(HEIGHTS, 1e-5, periodic=given),
}


def test_every_switch_is_one_of_those_below():
    modules = (hystrip, hystrip.dma, hystrip.roughness, hystrip.plots, hystrip.scene)
    public = {getattr(module, name) for module in modules for name in module.__all__}
    found = {
        f"{each.__name__}.{name}"
        for each in public
        if inspect.isfunction(each) or is_dataclass(each)
        for name, parameter in inspect.signature(each).parameters.items()
        if isinstance(parameter.default, bool)
    }
    assert found == set(SWITCHES)


@pytest.mark.parametrize("given", ["no", "", 0, 1, None, np.array([True])], ids=repr)
@pytest.mark.parametrize("switch", SWITCHES)
def test_switches_are_true_or_false(switch, given):
    with pytest.raises(hystrip.InputError, match="allowed: True or False") as refused:
        SWITCHES[switch](given)
    assert refused.value.field.rpartition(".")[2] == switch.rpartition(".")[2]


def test_switches_of_numpy_are_as_good():
    scan = hystrip.roughness.Scan(HEIGHTS, 1e-5, periodic=np.True_)
    assert scan.periodic is True

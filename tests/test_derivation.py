"""The derivation: what it states, that a wrong step is refused by name, and that its kernels agree with an independent march."""

from __future__ import annotations

import importlib
import inspect
import json
import math
import re
from dataclasses import fields, replace
from pathlib import Path

import numpy as np
import pytest
import sympy as sp
from derived_once import altered, derivation, tampered

from hystrip.derivation import STANDARD_LINEAR_SOLID, DerivationError, Model, Parameter, derive
from hystrip.derivation.check import CORRECTED, REPRODUCED, STATUSES, derived, zero
from hystrip.derivation.exact import is_zero
from hystrip.derivation.flows import contact_flow
from hystrip.derivation.functions import flat
from hystrip.derivation.model import inadmissible
from hystrip.derivation.paper.record import numbers
from hystrip.derivation.symbols import (
    D,
    J,
    K,
    L,
    T_eps,
    T_sigma,
    V,
    alpha,
    beta,
    h,
    l,
    p_0,
    p_nominal,
    q_0,
    s,
    s_0,
)
from hystrip.generated import standard_linear_solid as solver

pytestmark = pytest.mark.xdist_group("derivation")

STRIPS = json.loads((Path(__file__).parent / "data" / "strips.json").read_text(encoding="utf-8"))


def step(name: str):
    (found,) = [record for record in derivation().steps if record.name == name]
    return found


def stage(kind: str):
    (found,) = [part for part in flat(derivation().stages) if type(part).__name__ == kind]
    return found


# -- what is stated -----------------------------------------------------------------------------------------------------


def test_every_step_is_verified_and_described() -> None:
    assert len(derivation().steps) > 60
    for record in derivation().steps:
        assert record.checks and record.statement and record.latex and record.status in STATUSES
        assert all(check.outcome in ("exact zero", "holds") for check in record.checks)
        assert (record.status == CORRECTED) == bool(record.correction)


def test_names_of_steps_are_unique() -> None:
    names = [record.name for record in derivation().steps]
    assert len(names) == len(set(names))


def test_every_step_names_the_function_that_derives_it() -> None:
    for record in derivation().steps:
        assert callable(_function(record))


def _function(record):
    module, _, name = record.function.rpartition(".")
    return getattr(importlib.import_module(f"hystrip.derivation.{module}"), name)


def test_the_deriving_function_shows_the_equation_and_the_papers_number() -> None:
    for record in derivation().steps:
        text = inspect.getdoc(_function(record)) or ""
        assert ":math:" in text or ".. math::" in text, record.function
        cited = {int(number) for group in re.findall(r"Eq\. (\d+(?:, \d+)*)", text) for number in group.split(", ")}
        assert set(numbers(record.paper)) <= cited, (record.function, record.paper)


def test_every_emitted_function_belongs_to_a_step() -> None:
    claimed = {name for record in derivation().steps for name in record.emitted}
    emitted = {kernel.formula.name for kernel in derivation().kernels}
    assert emitted == claimed
    assert all(callable(getattr(solver, name)) for name in emitted)


def test_stages_are_frozen() -> None:
    flows = stage("Flows")
    with pytest.raises(AttributeError):
        setattr(flows, fields(flows)[0].name, None)


@pytest.mark.parametrize("equation", range(1, 17))
def test_the_papers_equations_are_there(equation: int) -> None:
    assert any(equation in numbers(record.paper) for record in derivation().steps)


def test_saturated_field_is_equation_15() -> None:
    printed = D - 1 + ((1 + alpha * beta) * sp.cos(s) - (beta - alpha) * sp.sin(s)) / (1 + alpha**2)
    assert sp.simplify(step("saturated_pressure").value - printed) == 0
    assert step("saturated_pressure").status == REPRODUCED


def test_equation_16_is_corrected() -> None:
    true, printed = step("Eq. 16 as printed").value
    right = 3 * sp.pi**2 / 16 * K * V * (T_eps - T_sigma) / p_nominal * h**2 / (l**2 + (2 * sp.pi * V * T_sigma) ** 2)
    assert sp.simplify(true - right) == 0
    assert sp.simplify(printed / true - sp.Rational(16, 3) / h) == 0
    assert step("stack friction").status == CORRECTED


def test_figure_7_peaks() -> None:
    """Three levels, all saturated at 5 MPa: friction coefficient at the peak of each level."""
    length, height = np.array([10e-6, 500e-9, 5e-9]), np.array([1e-6, 100e-9, 5e-9])
    at_peak = length / (2 * math.pi * 1e-4)
    peaks = solver.level_saturation_friction(1e9, 1e-2, 1e-4, length, height, at_peak) / 5e6
    assert peaks == pytest.approx([2.92e-4, 5.83e-5, 1.46e-5], rel=3e-3)
    together = solver.level_saturation_friction(1e9, 1e-2, 1e-4, length, height, at_peak[:, None]).sum(axis=1) / 5e6
    assert together.shape == (3,) and np.all(together > peaks)


def test_a_parabola_gives_the_known_pressure() -> None:
    """The contact flow under another profile: the single parabola of the physics, entered at p = 0 and x = b."""
    strip = stage("Strip")
    parabola = replace(strip, profile=replace(strip.profile, value=D - s**2 / 2))
    x, b, shift, creep = sp.symbols("x b s_shift q", positive=True)
    pressure = contact_flow(parabola).value.subs({q_0: 0, p_0: 0, D: b**2 / 2, s_0: -b, s: -x})
    known = (b**2 - x**2) / 2 + creep * (x + shift - (b + shift) * sp.exp(-(b - x) / shift))
    difference = pressure.subs({alpha: shift, beta: shift + creep}) - known
    assert sp.simplify(sp.expand(difference)) == 0
    field = sp.lambdify(x, known.subs({b: 0.7, shift: 0.1, creep: 0.9}).subs(x, x))
    assert field(-0.31652973) == pytest.approx(0, abs=1e-7)


# -- what is refused ----------------------------------------------------------------------------------------------------

# few of many: tools/mutants_derivation.py has them all, and test_mutants.py has others
TAMPERED = {
    "strip profile": ("surface.py", "RIGID = D - 1 + sp.cos(s)", "RIGID = D - 1 - sp.cos(s)"),
    "contact flow": ("flows.py", "(entry - particular.subs(along, since))", "(entry + particular.subs(along, since))"),
    "closures": ("jumps.py", "step_w = chi * J * step", "step_w = -chi * J * step"),
    "forcing": ("stable.py", "PROFILE(s, D) + beta * PROFILE_SLOPE(s)", "PROFILE(s, D) - beta * PROFILE_SLOPE(s)"),
    "complex modulus": ("saturated.py", "sp.I**n for n, q", "(-sp.I) ** n for n, q"),
}


@pytest.mark.parametrize("name", TAMPERED)
def test_a_changed_sign_is_refused_by_name(name: str, tmp_path: Path) -> None:
    wrong = tampered(tmp_path, *TAMPERED[name])
    with pytest.raises(wrong.DerivationError, match=f"'{name}'") as failure:
        wrong.derive(wrong.STANDARD_LINEAR_SOLID)
    assert failure.value.step == name


# Late steps: run by themselves on what was derived before them.
LATE = {
    "power balance": ("energy.py", "sp.diff(w, s) - beta / L", "sp.diff(w, s) + beta / L"),
    "strip problem": ("conditions.py", "gap_at(onset - 2 * sp.pi / k", "gap_at(onset + 2 * sp.pi / k"),
    "equilibrium": ("multilevel.py", "sum(loads) + p_0", "sum(loads) - p_0"),
    "shift of an event": ("stability.py", "(load_0 + gap_0 - p) * decay", "(load_0 - gap_0 - p) * decay"),
    "zone conditions": ("conditions.py", "gap = AMPLITUDE * displacement - (", "gap = AMPLITUDE * displacement + ("),
    "means over a level": ("multilevel.py", "(mean, number) - over_strips", "(mean, number) + over_strips"),
    "local stress": ("multilevel.py", "(D_level - HEIGHT).subs(x, fixed - V * t)", "(D_level - HEIGHT).subs(x, fixed + V * t)"),
    "local shear": ("multilevel.py", "shear = pressure * slope_x + tau_below", "shear = pressure * slope_x - tau_below"),
    "friction coefficient": (
        "multilevel.py",
        "HEIGHT, x) + friction_of_one.subs(lower)",
        "HEIGHT, x) - friction_of_one.subs(lower)",
    ),
    "least pressure in complete contact": ("level.py", "D - threshold.subs", "D + threshold.subs"),
    "levels in complete contact together": ("level.py", "mean_over_wave(-p * sp.diff", "mean_over_wave(p * sp.diff"),
}


def _late(module, name: str):
    """The step of this name, by a module that derives it."""
    exact = {kernel.formula.name: kernel.exact for kernel in derivation().kernels}
    one, strip = exact["level_saturation_friction"], stage("Strip")
    regimes = [regime for regime in derivation().regimes if regime.edges]
    return {
        "power balance": lambda: module.power_balance(stage("Flows")),
        "strip problem": lambda: module.strip_problem(strip, regimes[0]),
        "equilibrium": lambda: module.equilibrium(regimes[:1]),
        "shift of an event": lambda: module.shift_of_an_event(),
        "zone conditions": lambda: module.zone_conditions(strip.u),
        "means over a level": lambda: module.means_over_a_level(),
        "local stress": lambda: module.local_stress(),
        "local shear": lambda: module.local_shear(),
        "friction coefficient": lambda: module.friction_coefficient(),
        "least pressure in complete contact": lambda: module.least_pressure(
            step("saturation threshold").value, exact["level_saturation_pressure"]
        ),
        "levels in complete contact together": lambda: module.levels_together(strip, one),
    }[name]()


@pytest.mark.parametrize("name", LATE)
def test_a_changed_sign_in_a_late_step_is_refused_by_name(name: str) -> None:
    file, before, after = LATE[name]
    with pytest.raises(DerivationError, match=f"'{name}'") as failure:
        _late(altered(file, before, after), name)
    assert failure.value.step == name
    found = _late(altered(file, before, before), name)  # not refused for being altered
    assert getattr(found, "derived", found).name == name


@pytest.mark.parametrize(
    ("function", "name"), [("dsolve", "instantaneous compliance"), ("integrate", "adhesion law"), ("solve", "jump law")]
)
def test_a_wrong_answer_of_sympy_is_refused(function: str, name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    right = getattr(sp, function)

    def wrong(*args, **options):
        found = right(*args, **options)
        if isinstance(found, sp.Eq):
            return sp.Eq(found.lhs, found.rhs + sp.sin(s) / 7)
        return [2 * part for part in found] if isinstance(found, list) else 2 * found

    monkeypatch.setattr(sp, function, wrong)
    with pytest.raises(DerivationError) as failure:
        derive(STANDARD_LINEAR_SOLID)
    assert failure.value.step == name


def test_zero_is_proven_and_not_guessed() -> None:
    s_1 = sp.Symbol("s_1", real=True)
    assert is_zero(sp.sin(s_0) ** 2 + sp.cos(s_0) ** 2 - 1)
    assert is_zero(sp.cos(s_1) - sp.cos(s_0) + 2 * sp.sin((s_0 + s_1) / 2) * sp.sin((s_1 - s_0) / 2), (s_0, s_1))
    assert is_zero(sp.exp((s_0 - s_1) / alpha) * sp.exp(-(s_0 - s_1) / alpha) - 1, (s_0, s_1))
    assert is_zero(L + J - 1) and is_zero(L * beta - beta + alpha)
    assert not is_zero(sp.Rational(1, 10**40) * sp.sin(s_0))
    assert not is_zero(sp.exp((s_0 - s_1) / alpha) - sp.exp((s_0 - s_1) / beta), (s_0, s_1))
    assert not is_zero(L * beta - beta - alpha)
    # nothing over nothing is not nothing
    for nothing in (alpha * (beta + 1) - alpha * beta - alpha, sp.sin(s_0) ** 2 + sp.cos(s_0) ** 2 - 1):
        assert is_zero(nothing) and not is_zero(nothing / sp.Mul(nothing, beta, evaluate=False)) and not is_zero(alpha / nothing)
        assert not is_zero(1 / (1 + 1 / nothing))
    assert is_zero(1 / (1 / (1 + alpha) + 1 / beta) - beta * (1 + alpha) / (1 + alpha + beta))
    assert not is_zero(1 / (1 / (1 + alpha) + 1 / beta) - beta * (1 - alpha) / (1 + alpha + beta))


def test_a_failing_check_names_its_step() -> None:
    with pytest.raises(DerivationError, match="step 'some step' failed: one is nothing"):
        zero("one is nothing", sp.Integer(1)).verified("some step")
    with pytest.raises(DerivationError, match="has no check"):
        derived(test_a_failing_check_names_its_step, None, [])


def _model(Q, P) -> Model:
    Q, P = (tuple(map(sp.sympify, operator)) for operator in (Q, P))
    return Model("test", "test", STANDARD_LINEAR_SOLID.parameters, Q, P)


@pytest.mark.parametrize(
    ("reason", "Q", "P"),
    [
        ("passive", (1, 1), (1, 2)),  # T_eps < T_sigma
        ("solid-like", (0, 1), (1, 1)),  # a liquid
        ("solid-like", (1, 1), (1,)),
        ("stable", (1, -1), (1, 0)),
        ("stable", (1, 1, 1, 2), (1, 1, 1, 1)),  # positive coefficients, roots on the right
    ],
)
def test_an_inadmissible_model_is_refused_with_the_reason(reason: str, Q: tuple, P: tuple) -> None:
    assert any(text.startswith(reason) for text in inadmissible(_model(Q, P)))
    with pytest.raises(DerivationError, match=reason):
        derive(_model(Q, P))


t = sp.Symbol("t", positive=True)


@pytest.mark.parametrize(
    ("Q", "P", "reason"),
    [
        ((1, T_eps * sp.Symbol("rate") ** sp.Rational(1, 2)), (1 / K, 0), "fractional element"),
        ((1, T_eps * (1 + sp.Function("w")(t) ** 2)), (1 / K, 0), "nonlinear dashpot"),
        ((-7 * sp.Symbol("x"), sp.sin(sp.Symbol("x"))), (1 / K, 0), "depends on x"),
    ],
)
def test_a_model_outside_the_class_is_refused_with_the_reason_and_the_way_out(Q: tuple, P: tuple, reason: str) -> None:
    with pytest.raises(DerivationError, match=f"{reason}.*prony_model"):
        derive(_model(Q, P))


def test_what_belongs_to_operator_model_is_told_so() -> None:
    with pytest.raises(DerivationError, match="belongs to operator_model: its operators are of order 2"):
        derive(_model((1, 3 * T_eps, 2 * T_eps**2), (1 / K, 2 * T_eps / K, T_eps**2 / (2 * K))))
    eta = sp.Symbol("eta", positive=True)
    one = Model("test", "test", (Parameter(K, "K", "Pa/m", ""), Parameter(eta, "eta", "s", "")), (1, eta), (1 / K, 0))
    with pytest.raises(DerivationError, match="belongs to operator_model: it has one relaxation time in parameters of its own"):
        derive(one)


def test_admissible_models_pass() -> None:
    assert not inadmissible(STANDARD_LINEAR_SOLID)
    assert not inadmissible(_model((1, 3), (1, 0)))  # Kelvin-Voigt
    assert not inadmissible(_model((1, 3, 2), (1, 2, sp.Rational(1, 2))))


# -- the emitted kernels against an independent march --------------------------------------------------------------------

ORDER = {"acaf": "acaf", "afc": "caf", "af": "af", "ac": "ca", "cf": "cf"}


def _given(case: dict) -> dict:
    k, unit = 2 * math.pi / case["l"], case["K"] * case["A"]
    return {
        "alpha": k * case["V"] * case["T_sigma"],
        "beta": k * case["V"] * case["T_eps"],
        "J": case["T_sigma"] / case["T_eps"],
        "L": (case["T_eps"] - case["T_sigma"]) / case["T_eps"],
        "p_0": case["p_0"] / unit,
        "delta_0": case["delta_0"] / case["A"],
        "D": case["D"] / case["A"],
        "chi": float(case["edge"] == "constitutive"),
    }


def _edges(zones: tuple, sequence: str) -> list[float]:
    letters = "".join(zone[0] for zone in zones)
    start = (letters * 2).index(ORDER[sequence])
    edges: list[float] = []
    for n in range(len(zones)):
        edge = float(zones[(start + n) % len(zones)][1])
        while edges and edge < edges[-1]:
            edge += 2 * math.pi
        edges.append(edge)
    return edges


def test_kernels_agree_with_the_march() -> None:
    from mpmath import mp
    from oracle.flow import Strip
    from oracle.march import groups
    from oracle.orbits import extremal_orbit

    seen = set()
    for number, case in enumerate(STRIPS):
        given = _given(case)
        sequence = {"cf": "ac"}.get(case["sequence"], case["sequence"])
        regime = solver.REGIMES[sequence]
        edges: list[float] = []
        if regime["edges"]:
            with mp.workdps(30):
                si = [case[name] for name in ("K", "T_eps", "T_sigma", "V", "l", "A", "D", "p_0", "delta_0")]
                orbit = extremal_orbit(Strip(closure=case["edge"], **groups(*si, digits=30)), case["branch"])
            edges = _edges(orbit.zones, case["sequence"])
            scale = 1 + given["p_0"] + given["beta"]
            assert np.max(np.abs(regime["residual"](*edges, **given))) < 1e-14 * scale, number
            if sequence == "ac":
                width = edges[1] - edges[0]
                exponent = -width / given["alpha"] - (2 * math.pi - width) / given["beta"]
                upper, lower = math.exp(exponent), 1.0
            else:
                upper, lower, difference = map(float, regime["onset_slope"](*edges, **given))
                assert difference == pytest.approx(upper - lower, rel=1e-9, abs=1e-12 * abs(lower)), number
            assert upper / lower == pytest.approx(float(orbit.slope), rel=1e-12, abs=1e-29), number
        p_mean, tau_mean = regime["means"](*edges, **given)
        unit, k = case["K"] * case["A"], 2 * math.pi / case["l"]
        scale = abs(case["p_mean"]) + 1e-3 * (unit + case["p_0"])
        assert abs(p_mean * unit - case["p_mean"]) < 1e-11 * scale, number
        scale = abs(case["tau_mean"]) + 1e-3 * k * case["A"] * (unit + case["p_0"])
        assert abs(tau_mean * unit * k * case["A"] - case["tau_mean"]) < 1e-11 * scale, number
        seen.add(case["sequence"])
    assert seen == {"acaf", "afc", "af", "ac", "cf", "c", "a", "f"}

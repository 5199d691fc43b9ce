"""The derivation for several relaxation times: what it proves, what it refuses, and what it writes."""

from __future__ import annotations

import functools
import itertools
import json
import random
from dataclasses import replace
from inspect import getmembers, isfunction
from pathlib import Path

import mpmath
import numpy as np
import pytest
import sympy as sp
from derived_once import derivations, emitted, series_once, tampered  # noqa: F401

from hystrip import InputError
from hystrip.derivation import (
    KELVIN_VOIGT,
    DerivationError,
    Model,
    Parameter,
    Series,
    audit,
    check,
    derive,
    generated_folder,
    load_model,
    operator_model,
    prony_model,
    regenerate,
    stored_bounds,
)
from hystrip.derivation.certificates import certified_names, measure
from hystrip.derivation.certificates.certify import measure_regimes
from hystrip.derivation.certificates.material import measure_material
from hystrip.derivation.emit import emit
from hystrip.derivation.modes.jumps import closures
from hystrip.derivation.modes.material import admissibility, inadmissible_series, prony_series
from hystrip.derivation.modes.states import exact_modes
from hystrip.derivation.modes.symbols import J_0, J, enter, eta, leave, share
from hystrip.derivation.printing import source
from hystrip.derivation.regenerate import AIM
from hystrip.derivation.symbols import K
from hystrip.generated import generalised, kelvin_voigt, modes

pytestmark = [pytest.mark.xdist_group("derivation"), pytest.mark.usefixtures("series_once")]

SOLVERS = {solver.MODEL: solver for solver in (kelvin_voigt, generalised)}


def of(name: str):
    return next(made for made in derivations() if made.model.name == name)


def test_the_number_of_times_takes_no_part_in_the_derivation() -> None:
    """A model for so many times differs from that for any number in what it says and checks of the number alone."""
    made = of("generalised")
    for n in (1, 5, 40):
        lines = [text.splitlines() for text in (emit((replace(made, model=prony_model("generalised", n)),)), emitted())
                 for text in (text["generalised.py"],)]  # fmt: skip
        changed = [one for one, other in zip(*lines, strict=True) if one != other]
        assert any(line == f"MODES = {n}" for line in changed)
        assert all(word in line for line in changed for word in [str(n) if "tau_i" not in line else "MODES"]), changed
    for step in made.steps:
        assert all(check.outcome.startswith(("exact zero", "holds")) for check in step.checks), step.name


@pytest.mark.parametrize("n", [1, 2, 7, 20])
def test_the_modes_are_both_partial_fractions_of_the_law(n: int) -> None:
    """Against the operators as products, at rates of either sign, and the matrices against each other."""
    draw = random.Random(n)
    with mpmath.workdps(80):
        times = list(itertools.accumulate(mpmath.mpf(10) ** draw.uniform(-3, 3) for _ in range(2 * n)))
        found = exact_modes(times[::2], times[1::2])
        for rate in (mpmath.mpf(draw.uniform(-5, 5)) for _ in range(3)):
            ratio = mpmath.fprod((1 + b * rate) / (1 + a * rate) for a, b in zip(times[::2], times[1::2], strict=True))
            series = 1 + sum(e * rate / (1 + a * rate) for e, a in zip(found[eta], times[::2], strict=True))
            chain = found[J_0] + sum(c / (1 + b * rate) for c, b in zip(found[J], times[1::2], strict=True))
            assert abs(series / ratio - 1) < 1e-60 and abs(chain * ratio - 1) < 1e-60
        identity = found[leave] @ found[enter]
        assert np.max(abs(identity - np.eye(n))) < 1e-60
        assert np.max(abs(found[enter].sum(axis=0) - 1)) < 1e-60 and np.max(abs(found[leave].sum(axis=0) - 1)) < 1e-60
        assert np.max(abs(found[share].sum(axis=1) - found[J])) < 1e-60  # dashpots that all follow w = 1, p = 1: z = J
        assert min(found[eta]) > 0 and min(found[J]) > 0 and found[J_0] > 0


def test_continuous_is_refused_with_the_conditions_left_open() -> None:
    assert generalised.CLOSURES == (1,) and kelvin_voigt.CLOSURES == (0, 1)
    for n, claim in ((None, "leaves n - 1 open"), (3, "leaves n - 1 open"), (1, "on one state")):
        (check,) = closures(prony_model("some", n)).checks
        assert check.claim.endswith(claim)


@pytest.mark.parametrize("name", SOLVERS)
def test_steps_carry_equations_and_functions(name: str) -> None:
    made = of(name)
    numbers = " ".join(step.paper for step in made.steps)
    cited = ("1", "2, 3", "4, 8", "5", "6", "7", "9", "10", "11")
    assert all(f"Eq. {number}" in numbers for number in cited)
    assert all(step.checks for step in made.steps)
    emitted = {function for step in made.steps for function in step.emitted}
    missing = {function for function in emitted if not hasattr(SOLVERS[name], function)}
    assert missing <= {"means_afc", "state_afc", "residual_and_jacobian_afc", "return_map_afc"}  # without snap


# those that are refused at once: tools/mutants_derivation.py has the others
CHANGED = [
    ("modes/states.py", "LEAVE = J_j * beta_j", "LEAVE = J_j * alpha_i", "states"),
    ("modes/states.py", "- LEAVE * (beta_j * df_i + f_i)", "- LEAVE * (beta_j * df_i - f_i)", "states"),
    ("modes/states.py", "SHARE = J_j * eta_i", "SHARE = -J_j * eta_i", "states"),
    ("modes/states.py", "NORM = eta_i / (beta_j - alpha_i) ** 2", "NORM = eta_i / (beta_j + alpha_i) ** 2", "partial fractions"),
    ("modes/states.py", "OWN, OTHERS = beta_i - alpha_i,", "OWN, OTHERS = alpha_i - beta_i,", "partial fractions"),
    ("modes/states.py", "BRANCH = eta_i * rate / (1 + alpha_i", "BRANCH = eta_i * rate / (1 - alpha_i", "dimensionless groups"),
    ("modes/material.py", "rate / (1 + tau_i * rate)\n", "rate / (1 - tau_i * rate)\n", "admissibility"),
    ("modes/flows.py", "entry=z_0)", "entry=2 * z_0)", "relaxation flow"),
    ("modes/flows.py", "- eta * sp.diff(u, s), entry=f_0", "+ eta * sp.diff(u, s), entry=f_0", "contact flow"),
    ("modes/jumps.py", "f + alpha * sp.diff(f, s) - eta", "f + alpha * sp.diff(f, s) + eta", "jump law"),
    ("modes/stable.py", "creep - S * f_0 * decay_loss(", "creep + S * f_0 * decay_loss(", "contact_increment"),
]  # fmt: skip


@pytest.mark.parametrize(("file", "before", "after", "step"), CHANGED, ids=[f"{row[3]}-{n}" for n, row in enumerate(CHANGED)])
def test_a_changed_sign_does_not_come_through(tmp_path: Path, file: str, before: str, after: str, step: str) -> None:
    wrong = tampered(tmp_path, file, before, after)
    with pytest.raises(wrong.DerivationError) as caught:
        wrong.derive(wrong.GENERALISED)
    assert caught.value.step == step


# -- certificates -------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", SOLVERS)
def test_functions_stay_below_their_bounds(name: str) -> None:
    """At a few points; all of them are measured by every regeneration."""
    made, solver, bounds = of(name), SOLVERS[name], stored_bounds()[name]
    modes = (2, 6) if made.model.modes is None else (made.model.modes,)
    kernels = (*made.whole, *made.kernels)
    certificates = [measure(kernel, solver, modes, points=6) for kernel in kernels]
    certificates += [measure_material(made.model, solver, modes, points=6)]
    certificates += measure_regimes(made.composed, made.kernels, solver, modes[:1], points=2)
    assert sorted(certificate.name for certificate in certificates) == sorted(bounds)
    for certificate in certificates:
        assert certificate.worst <= bounds[certificate.name], f"{certificate.worst} ulp at {certificate.where}"


@pytest.mark.parametrize("name", SOLVERS)
def test_every_emitted_function_has_a_bound(name: str) -> None:
    emitted = {key for key, each in getmembers(SOLVERS[name], isfunction) if each.__module__ == SOLVERS[name].__name__}
    known = {f"zones_{regime.sequence}" for regime in of(name).composed}  # what is measured are the functions made of them
    assert emitted - set(stored_bounds()[name]) == known
    assert sorted(stored_bounds()[name]) == sorted(certified_names(of(name)))


def test_a_solver_for_any_number_is_measured_from_one_to_thirty() -> None:
    stored = json.loads((generated_folder() / "certificates.json").read_text(encoding="utf-8"))["models"]
    assert stored["generalised"]["modes"] == [1, 2, 3, 5, 8, 30] and stored["kelvin_voigt"]["modes"] == [1]


class Altered:
    """The solver for any number of times, but for what a subclass has of its own."""

    Modes = modes.Modes

    def __getattr__(self, name: str):
        return getattr(generalised, name)


class Still(Altered):
    """A solver that takes the periodic state for fixed while the edges move, and one whose events stay where they are."""

    @staticmethod
    def residual_and_jacobian_ac(b, a, m, p_0, delta_0, D):
        contact, _ = generalised.passages_ac(b, a, m, p_0, delta_0, D)
        rows = ((-generalised.profile_slope(b), 0.0), (contact.change_by_start, contact.change_by_end))
        return generalised.residual_ac(b, a, m, p_0, delta_0, D), rows

    @staticmethod
    def return_map_ac(b, a, m, p_0, delta_0, D):
        contact, gap = generalised.passages_ac(b, a, m, p_0, delta_0, D)
        return modes.product(np.eye(2) - gap.forget, np.eye(2) - contact.forget)


def test_derivatives_that_leave_something_out_are_found_out() -> None:
    made = of("generalised")
    regimes = [regime for regime in made.composed if regime.sequence == "ac"]
    worst = {each.name: each.worst for each in measure_regimes(regimes, made.kernels, Still(), (2,), points=6)}
    assert worst["residual_and_jacobian_ac"] > 1e6 and worst["return_map_ac"] > 1e6
    assert all(each <= AIM for name, each in worst.items() if name not in ("residual_and_jacobian_ac", "return_map_ac"))


def test_a_cancelling_form_is_found_out() -> None:
    class Naive:
        Modes = modes.Modes

        @staticmethod
        def gap_change(s_0, s_1, z_0, p, m):
            return generalised.gap_after(s_0, s_1, z_0, p, 0.0, m) - generalised.gap_after(s_0, s_0, z_0, p, 0.0, m)

    made = of("generalised")
    kernel = next(k for k in made.kernels if k.formula.name == "gap_change")
    assert measure(kernel, Naive(), (2,), points=30).worst > 10 * AIM


class FromZero(Altered):
    """A solver that counts pressures from 0 where nothing is free: what strong adhesion adds to all of them cancels."""

    @staticmethod
    def means_ac(b, a, m, p_0, delta_0, D):
        return modes.means_of(generalised.zones_ac(b, a, m, p_0, delta_0, D), m, p_0, D)


def test_means_that_count_pressures_from_zero_under_strong_adhesion_are_found_out() -> None:
    made = of("generalised")
    regimes = [regime for regime in made.composed if regime.sequence == "ac"]
    worst = {each.name: each.worst for each in measure_regimes(regimes, made.kernels, FromZero(), (1,), points=4)}
    assert worst.pop("means_ac") > 100 * AIM
    assert max(worst.values()) <= AIM


# -- models -------------------------------------------------------------------------------------------------------------------

T_1, T_2, G = sp.symbols("T_1 T_2 G", positive=True)
OF_ONE = (Parameter(G, "G", "Pa/m", "stiffness"), Parameter(T_1, "T_1", "s", "time"), Parameter(T_2, "T_2", "s", "time"))


def test_a_model_given_by_operators_finds_its_times() -> None:
    made = derive(
        operator_model("two_times", OF_ONE, (1, 3 * T_1 + 3 * T_2, T_1 * T_2), (1 / G, (T_1 + T_2) / G, T_1 * T_2 / (2 * G)))
    )
    assert made.model.modes == 2
    draw = random.Random(3)
    for _ in range(10):
        tau = sorted(10 ** draw.uniform(-6, 3) for _ in range(3))
        eta = [10 ** draw.uniform(-3, 3) for _ in range(3)]
        rate = sp.Symbol("rate")
        P = sp.Mul(*(1 + sp.Rational(t) * rate for t in tau))
        Q = sp.cancel(P * (1 + sum(sp.Rational(e) * rate / (1 + sp.Rational(t) * rate) for e, t in zip(eta, tau, strict=True))))
        coefficients = [[float(c) for c in reversed(sp.Poly(operator, rate).all_coeffs())] for operator in (2 * Q, P)]
        stiffness, found = modes.of_operators(*coefficients)
        assert stiffness == 2.0
        # Coefficients rounded to float64 leave the times of a badly conditioned polynomial only so many digits.
        assert np.allclose(found.alpha, tau, rtol=1e-9) and np.allclose(found.eta, eta, rtol=1e-6)


@pytest.mark.parametrize(
    ("Q", "P", "reason"),
    [
        ((0, 1), (1, 1), "solid-like"),
        ((1, 1), (1, 2), "passive"),
        ((1, -1, 1), (1, 1, 1), "stable"),
        ((1, 5, 2), (1, 3, sp.Rational(9, 4)), "passive"),
        ((1, 3, 1), (1, 4, 1), "passive"),
    ],
)
def test_operators_that_make_no_passive_solid_are_refused_with_the_reason(Q, P, reason: str) -> None:
    with pytest.raises(DerivationError, match=rf"model 'bad' is refused: .*{reason}"):
        derive(operator_model("bad", (), Q, P))


@pytest.mark.parametrize("of", ["relaxation", "retardation"])
def test_two_equal_times_of_one_operator_are_a_solid_though_roundings_make_them_complex(of: str) -> None:
    """Half of them were refused by the solver, and at regeneration."""
    draw = random.Random(6)
    for count in (2, 3, 4):
        for _ in range(4):
            K, first = 10 ** draw.uniform(3, 10), 10 ** draw.uniform(-6, 0)
            later = [first * 10 ** (i + draw.uniform(0.1, 0.9)) for i in range(2 * count - 3)]
            w_times, p_times = [first, *later[0::2]], [first, first, *later[1::2]]
            if of == "retardation":
                w_times, p_times = [first, first, *later[1::2]], [first / 3, first, *later[0 : 2 * count - 4 : 2]]
            Q, P = (functools.reduce(np.convolve, ((1.0, time) for time in each), np.ones(1)) for each in (w_times, p_times))
            assert inadmissible_series(operator_model("own", (), Q.tolist(), (P / K).tolist())) == []
            found, series = modes.of_operators(Q, P / K)
            s = 1j / first * np.geomspace(1e-3, 1e8, 9)
            terms = series.eta[:, None] * s / (1 + series.alpha[:, None] * s)
            exact = K * np.prod([(1 + w * s) / (1 + p * s) for w, p in zip(w_times, p_times, strict=True)], axis=0)
            assert found * (1 + terms.sum(axis=0)) == pytest.approx(exact, rel=1e-11)


def test_operators_whose_times_are_equal_but_for_roundings_are_a_solid() -> None:
    """Half of them were refused at regeneration as not passive, while the solver takes the same numbers."""
    draw = random.Random(5)
    for _ in range(8):
        K, *times = (10 ** draw.uniform(low, high) for low, high in ((3, 10), (-4, 2), (-4, 2), (-4, 2)))
        slow, lag = sorted(times[1:])
        for of_w, of_p in (((times[0],), (times[0],)), (times[:2], times[:2]), ((times[0], lag), (times[0], slow))):
            Q, P = (functools.reduce(np.convolve, ((1.0, time) for time in each), np.ones(1)) for each in (of_w, of_p))
            own = operator_model("own", (), Q.tolist(), (P / K).tolist())
            assert inadmissible_series(own) == [] and admissibility(own).checks
            assert modes.of_operators(Q, P / K)[0] == pytest.approx(K, rel=1e-14)
        beyond = operator_model("own", (), (1.0, times[0]), (1 / K, times[0] * (1 + 1e-14) / K))
        assert any("passive" in reason for reason in inadmissible_series(beyond))


@pytest.mark.parametrize(
    ("Q", "P", "reason"),
    [
        ((0.0, 1.0), (1.0, 1.0), "not solid-like"),
        ((1.0, 1.0), (1.0, 2.0), "not passive: between"),
        ((1.0, 3.0, 1.0), (1.0, 1.0, 1.0), "not passive: the relaxation times must be 2 different real numbers"),
        ((1.0, 1.0, 0.0), (1.0, 1.0, 1.0), "not stable"),
    ],
)
def test_numbers_that_make_no_passive_solid_are_refused_with_the_reason(Q, P, reason: str) -> None:
    with pytest.raises(ValueError, match=reason):
        modes.of_operators(Q, P)


def test_a_series_with_a_sign_that_is_not_known_is_refused() -> None:
    unknown = sp.Symbol("K_i", real=True)
    tau = sp.Symbol("tau", positive=True)
    parameters = (*KELVIN_VOIGT.parameters, *(Parameter(each, each.name, "s", "of a branch") for each in (unknown, tau)))
    model = Model("bad", "Bad", parameters, KELVIN_VOIGT.Q, KELVIN_VOIGT.P, series=Series(K, unknown * tau / K, tau))
    with pytest.raises(DerivationError, match="passive: eta_i"):
        derive(model)


def test_a_series_that_is_not_that_of_the_operators_is_refused() -> None:
    """The solver of the series was emitted, and the operators were not looked at."""
    tau, eta = sp.symbols("tau eta", positive=True)
    parameters = tuple(Parameter(symbol, symbol.name, "s", "a parameter") for symbol in (K, eta, tau))
    own = Model("own", "Own", parameters, (sp.Integer(1), eta + tau), (1 / K, tau / K), series=Series(K, eta, tau))
    assert prony_series(own).checks
    for wrong in (
        replace(own, Q=(sp.Integer(1), eta)),
        replace(own, series=Series(K, eta, sp.Integer(0))),
        replace(own, P=(2 / K, tau / K)),
    ):
        with pytest.raises(DerivationError, match="spring and branch are what the operators say"):
            prony_series(wrong)


def test_a_series_in_what_is_no_parameter_is_refused() -> None:
    tau = sp.Symbol("tau", positive=True)
    stated = Series(K, sp.Symbol("q", positive=True) * tau, tau, arrays=(tau,))
    parameters = (KELVIN_VOIGT.parameters[0], Parameter(tau, "tau", "s", "times"))
    with pytest.raises(DerivationError, match="depends on q, which is no parameter"):
        derive(Model("bad", "Bad", parameters, (), (), series=stated))


def test_operators_with_idle_branches_make_a_solid() -> None:
    """Of two in five the equal roots of both operators came out in the wrong order, by a rounding, and were refused."""
    draw = random.Random(7)
    for _ in range(40):
        n = draw.randint(1, 5)
        tau = [10 ** draw.uniform(-5, 1) for _ in range(n)]
        eta = [draw.choice((0.0, 10 ** draw.uniform(-2, 2))) for _ in range(n)]
        P, Q = np.ones(1), np.zeros(n + 1)
        for time in tau:
            P = np.convolve(P, (1.0, time))
        Q += P
        for i in range(n):
            rest = np.array((0.0, eta[i]))
            for time in tau[:i] + tau[i + 1 :]:
                rest = np.convolve(rest, (1.0, time))
            Q += rest
        stiffness, found = modes.of_operators(Q, P)
        for rate in 10.0 ** np.arange(-1, 6):
            exact = 1 + sum(e * 1j * rate / (1 + t * 1j * rate) for e, t in zip(eta, tau, strict=True))
            branches = found.eta * 1j * rate / (1 + found.alpha * 1j * rate)
            assert stiffness * (1 + np.sum(branches)) == pytest.approx(exact, rel=1e-11)


def test_a_constant_of_the_operators_is_emitted_as_numpy_has_it() -> None:
    assert source(sp.E * T_1) == "np.e * T_1" and source(sp.pi) == "np.pi"


# -- a user's model, of which test_packaging makes a solver -------------------------------------------------------------------

FILE = '''\
"""A rubber with any number of relaxation times."""
from hystrip.derivation import prony_model

MODEL = prony_model("my_rubber")
'''


def test_a_folder_of_something_else_is_left_alone(tmp_path: Path) -> None:
    (tmp_path / "thesis.tex").write_text("precious", encoding="utf-8")
    with pytest.raises(FileExistsError, match="holds files, but no solver"):
        regenerate(tmp_path, (KELVIN_VOIGT,))
    with pytest.raises(FileExistsError, match="is a file"):
        regenerate(tmp_path / "thesis.tex", (KELVIN_VOIGT,))
    assert [path.name for path in tmp_path.iterdir()] == ["thesis.tex"]


def test_a_refused_model_leaves_nothing_behind(tmp_path: Path) -> None:
    with pytest.raises(DerivationError):
        regenerate(tmp_path / "out", (operator_model("bad", (), (0, 1), (1, 1)),))
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("x = 1\n", "declares MODEL"),
        ("1/0\n", "ZeroDivisionError"),
        ("MODEL = 3\n", "iterable|Model, not int"),
        ("MODELS = (3,)\n", "Model, not int"),
        (FILE.replace("my_rubber", "My rubber"), "lower-case Python name"),
        (FILE.replace("my_rubber", "stable"), "taken"),
        (FILE.replace("my_rubber", "index"), "taken"),
        (FILE.replace("my_rubber", "measured"), "taken"),
        (FILE.replace('my_rubber")', 'my_rubber", modes=0)'), "at least 1"),
        (FILE.replace('my_rubber")', 'my_rubber", modes=2.5)'), "modes: got 2.5; allowed: an integer"),
        (FILE + "MODELS = (MODEL,)\n", "not both"),
    ],
)
def test_a_file_without_a_model_is_refused(tmp_path: Path, text: str, message: str) -> None:
    file = tmp_path / "my_model.py"
    file.write_text(text, encoding="utf-8")
    with pytest.raises(DerivationError, match=message):
        load_model(file)


def test_a_file_that_imports_everything_declares_its_own_model(tmp_path: Path) -> None:
    file = tmp_path / "my_model.py"
    file.write_text(FILE.replace("import prony_model", "import *"), encoding="utf-8")
    assert [model.name for model in load_model(file)] == ["my_rubber"]


@pytest.mark.parametrize("name", ["tau", "1", "np", "lambda", "G", "__debug__", "\u017f", "model", "fit"])
def test_a_parameter_that_the_solver_could_not_take_is_refused(name: str) -> None:
    """It was emitted, with a body in another name than the argument, and failed where it was used."""
    symbol = T_1 if name in ("tau", "G") else sp.Symbol(name, positive=True)
    parameters = (OF_ONE[0], Parameter(symbol, name, "s", "time"))
    with pytest.raises(DerivationError, match=f"named like its symbol, .*'{name}' of the symbol {symbol}"):
        operator_model("bad", parameters, (1, symbol), (1 / G, 0))


@pytest.mark.parametrize(
    ("Q", "P", "reason"),
    [
        ((1, T_1), (1 / G, T_1 * sp.tanh(T_1)), "sqrt, atan, acos, exp alone; tanh is not"),
        ((1, T_1 * sp.Symbol("rate") ** sp.Rational(1, 2)), (1 / G, 0), "fractional element.*prony_model"),
        ((1, T_1 * sp.Function("w")(sp.Symbol("t"))), (1 / G, 0), "nonlinear dashpot.*prony_model"),
    ],
)
def test_operators_that_no_solver_computes_are_refused_with_the_reason(Q, P, reason: str) -> None:
    with pytest.raises(DerivationError, match=reason):
        derive(operator_model("bad", OF_ONE, Q, P))


def test_symbols_without_a_sign_are_not_called_negative() -> None:
    free = sp.Symbol("T")
    with pytest.raises(DerivationError, match="Q has the coefficient T, which may be negative: .* declared positive") as refusal:
        derive(operator_model("bad", (Parameter(free, "T", "s", "time"), OF_ONE[0]), (1, free), (1 / G, 0)))
    assert "negative coefficient" not in str(refusal.value)


def test_a_missing_file_is_named(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError, match="no model file .*absent.py"):
        load_model(tmp_path / "absent.py")


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: prony_model(5, modes=2), "name: got 5; allowed: a lower-case Python name"),
        (lambda: prony_model("A b"), "name: got 'A b'; allowed: a lower-case Python name"),
        (lambda: prony_model("a", modes=True), "modes: got True; allowed: an integer, at least 1 and at most 40"),
        (lambda: prony_model("a", modes=41), "modes: got 41; allowed: an integer, at least 1 and at most 40"),
        (lambda: prony_model("a", title='a "b"'), "title: got .*; allowed: text of one line without quotation marks"),
        (lambda: operator_model(None, OF_ONE, (1, T_1), (1, 0)), "name: got None; allowed"),
        (lambda: operator_model("a", OF_ONE[0], (1, T_1), (1, 0)), "parameters: got Parameter.*; allowed: a sequence"),
        (lambda: operator_model("a", OF_ONE, 1 + T_1, (1, 0)), "Q: got T_1 . 1; allowed: a sequence of coefficients"),
        (lambda: operator_model("a", OF_ONE, {1, T_1}, (1, 0)), "Q: got .*; allowed: a sequence of coefficients"),
        (lambda: operator_model("a", OF_ONE, (1, "T_1 +"), (1, 0)), "Q.1.: got 'T_1 .'; allowed: a number or a SymPy expr"),
        (lambda: operator_model("a", OF_ONE, (1, T_1), (1, None)), "P.1.: got None; allowed: a number or a SymPy expression"),
        (lambda: load_model(5), "path: got 5; allowed: the path of a model file"),
        (lambda: regenerate("unused", models=[]), r"models: got \[\]; allowed: at least one hystrip.derivation.Model"),
        (lambda: regenerate("unused", models=KELVIN_VOIGT), "models: got Model.*; allowed: at least one"),
        (lambda: regenerate(5), "out_dir: got 5; allowed: the path of a folder"),
        (lambda: regenerate("unused", accept=["a"]), r"accept: got \['a'\]; allowed: a dictionary"),
        (lambda: check(5), "generated: got 5; allowed: the path of a folder"),
        (lambda: check(models=[]), "models: got .*; allowed: at least one"),
        (lambda: audit(""), "out_dir: got ''; allowed: the path of a folder"),
        (lambda: stored_bounds(5), "folder: got 5; allowed: the path of a folder"),
    ],
)
def test_an_argument_that_cannot_be_used_is_named(call, message: str) -> None:
    with pytest.raises(InputError, match=message):
        call()


@pytest.mark.parametrize(
    ("model", "message"),
    [
        (None, "a model is a hystrip.derivation.Model, not NoneType"),
        (replace(KELVIN_VOIGT, name=5), "the name of a model is a lower-case Python name .*, not 5"),
        (replace(KELVIN_VOIGT, title=None), "the title of a model is text of one line .*, not None"),
        (replace(KELVIN_VOIGT, P=None), "P of a model is a tuple, not None"),
        (replace(KELVIN_VOIGT, P=(1 / K, None)), "a coefficient of Q or P is a number or a SymPy expression, not None"),
        (replace(KELVIN_VOIGT, parameters=(replace(OF_ONE[0], meaning='a\n"""'),)), "unit and meaning of a parameter are text"),
    ],
)
def test_what_is_no_model_is_refused_before_it_is_derived(model, message: str) -> None:
    with pytest.raises(DerivationError, match=message):
        derive(model)


def test_bounds_are_read_from_the_path_of_a_folder() -> None:
    assert stored_bounds(str(generated_folder())) == stored_bounds()

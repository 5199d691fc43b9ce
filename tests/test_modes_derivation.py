"""The derivation for several relaxation times: what it proves, what it refuses, and what it writes."""

from __future__ import annotations

import json
import random
from pathlib import Path

import numpy as np
import pytest
import sympy as sp
from derived_once import derivations, tampered

from hystrip.derivation import (
    KELVIN_VOIGT,
    DerivationError,
    Model,
    Parameter,
    Series,
    derive_any,
    load_model,
    operator_model,
    prony_model,
    regenerate,
    stored_bounds,
)
from hystrip.derivation.drift import AIM, SHARES
from hystrip.derivation.modes.certificates import measured_names
from hystrip.derivation.modes.certificates.kernels import measure
from hystrip.derivation.modes.certificates.regimes import measure_regimes
from hystrip.derivation.modes.certificates.whole import measure_whole
from hystrip.derivation.modes.derive import STAGES
from hystrip.derivation.modes.flows import mode_flows
from hystrip.derivation.modes.jumps import closures, jump_law
from hystrip.derivation.modes.law import law
from hystrip.derivation.symbols import K
from hystrip.generated import generalised, kelvin_voigt, modes

SOLVERS = {solver.MODEL: solver for solver in (kelvin_voigt, generalised)}


def of(name: str):
    return next(made for made in derivations() if made.model.name == name)


@pytest.mark.parametrize("n", [1, 2, 3, 4])
def test_every_number_of_times_is_derived_in_the_same_way(n: int) -> None:
    ground = law(prony_model("some", n))
    flows, jump = mode_flows(ground), jump_law(ground)
    for record in (ground.series, ground.weights, ground.states, flows.relaxation, flows.contact, jump):
        assert record.checks and all(check.outcome.startswith(("exact zero", "holds")) for check in record.checks)
    assert any(f"{n} independent conditions on {n} states" in check.claim for check in jump.checks)


def test_continuous_is_refused_with_the_conditions_left_open() -> None:
    assert generalised.CLOSURES == (1,) and kelvin_voigt.CLOSURES == (0, 1)
    (check,) = closures(law(prony_model("some", 3))).checks
    assert check.claim == "w continuous is one condition and leaves 2 of 3 open"


@pytest.mark.parametrize("name", SOLVERS)
def test_steps_carry_equations_and_functions(name: str) -> None:
    made = of(name)
    numbers = " ".join(step.paper for step in made.steps)
    assert all(f"Eq. {number}" in numbers for number in ("1", "2, 3", "4, 6, 8", "5", "10", "11"))
    assert all(step.checks for step in made.steps)
    emitted = {function for step in made.steps for function in step.emitted}
    assert {function for function in emitted if not hasattr(SOLVERS[name], function)} <= {"means_afc"}  # without snap


CHANGED = [
    ("modes/coordinates.py", "applied(enter, i, lag) for i", "applied(leave, i, lag) for i", "states"),
    ("modes/coordinates.py", "times.alpha[k] / viscosities[k]", "times.alpha[k] * viscosities[k]", "states"),
    ("modes/coordinates.py", "compliances[j] * times.beta[j] / diff", "compliances[j] * times.alpha[i] / diff", "states"),
    ("modes/times.py", "Mul(*times.alpha) / sp.Mul(*times.beta)", "Mul(*times.beta) / sp.Mul(*times.alpha)", "partial fractions"),
    ("modes/flows.py", "entry=z_0)", "entry=2 * z_0)", "relaxation flow"),
    ("modes/flows.py", "- eta * sp.diff(u, s), entry=f_0", "+ eta * sp.diff(u, s), entry=f_0", "contact flow"),
    ("modes/jumps.py", "Q[j + m + 1] * steps_w[j] - P[j", "Q[j + m + 1] * steps_w[j] + P[j", "jump law"),
    ("modes/stable.py", "creep - S * f_0 * decay_loss(", "creep + S * f_0 * decay_loss(", "contact_increment"),
    ("modes/stable.py", "PROFILE_SLOPE(s_1) - total(transient +", "PROFILE_SLOPE(s_1) + total(transient +", "contact_passage"),
    ("modes/stable.py", "-total(rates) - PROFILE_SLOPE(s_1)", "-total(rates) + PROFILE_SLOPE(s_1)", "relaxation_passage"),
    ("modes/stable.py", "- back(enter, lost)".replace("- ", "-"), "back(enter, lost)", "contact_passage"),
    ("sequences.py", "d + PERIOD, delta_0 + step, delta_0)", "d + PERIOD, delta_0, delta_0)", "regime afc"),
    ("sequences.py", "p_0 - delta_0 / compliance", "p_0 + delta_0 / compliance", "regime afc"),
    ("modes/saturated.py", "harmonic - eq_15", "harmonic + eq_15", "saturated_overstress"),
    ("modes/levels.py", "u - alpha / eta * harmonic", "u + alpha / eta * harmonic", "carried friction"),
    ("multilevel.py", "one_level.subs(level) + shear", "one_level.subs(level) - shear", "friction coefficient"),
    ("conditions.py", "gap = AMPLITUDE * displacement - (", "gap = AMPLITUDE * displacement + (", "zone conditions"),
    ("modes/averages.py", "[p - w - sp.Add(*rates)]", "[p + w - sp.Add(*rates)]", "means of a strip"),
]  # fmt: skip


@pytest.mark.parametrize(("file", "before", "after", "step"), CHANGED, ids=[f"{row[3]}-{n}" for n, row in enumerate(CHANGED)])
def test_a_changed_sign_does_not_come_through(tmp_path: Path, file: str, before: str, after: str, step: str) -> None:
    wrong = tampered(tmp_path, file, before, after)
    with pytest.raises(wrong.DerivationError) as caught:
        wrong.derive_any(wrong.GENERALISED)
    assert caught.value.step == step


# -- certificates -------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", SOLVERS)
def test_functions_stay_below_their_bounds(name: str) -> None:
    made, bounds = of(name), stored_bounds()[name]
    for kernel in made.kernels:
        certificate = measure(kernel, made.law, SOLVERS[name], points=8)
        assert certificate.worst <= bounds[certificate.name], f"{certificate.worst} ulp at {certificate.where}"
    for certificate in (*measure_whole(made, SOLVERS[name], points=5), *measure_regimes(made, SOLVERS[name], points=3)):
        assert certificate.worst <= bounds[certificate.name], f"{certificate.worst} ulp at {certificate.where}"


@pytest.mark.parametrize("name", SOLVERS)
def test_every_emitted_function_has_a_bound(name: str) -> None:
    emitted = {key for key, each in vars(SOLVERS[name]).items() if getattr(each, "__module__", "") == SOLVERS[name].__name__}
    assert emitted - set(stored_bounds()[name]) <= ({"prony"} if name == "kelvin_voigt" else set())  # a dashpot has no modulus
    assert sorted(stored_bounds()[name]) == sorted(measured_names(of(name)))


class Still:
    """A solver that takes the periodic state for fixed while the edges move, and one whose events stay where they are."""

    Modes = modes.Modes

    def __getattr__(self, name: str):
        return getattr(generalised, name)

    @staticmethod
    def jacobian_ac(b, a, m, p_0, delta_0, D):
        contact, _ = generalised.passages_ac(b, a, m, p_0, delta_0, D)
        return ((-generalised.profile_slope(b), 0.0), (contact.change_by_start, contact.change_by_end))

    @staticmethod
    def return_map_ac(b, a, m, p_0, delta_0, D):
        contact, gap = generalised.passages_ac(b, a, m, p_0, delta_0, D)
        return modes.product(np.eye(3) - gap.forget, np.eye(3) - contact.forget)


def test_derivatives_that_leave_something_out_are_found_out() -> None:
    worst = {each.name: each.worst for each in measure_regimes(of("generalised"), Still(), points=6)}
    assert worst["jacobian_ac"] > 1e6 and worst["return_map_ac"] > 1e6
    assert all(each <= AIM for name, each in worst.items() if name not in ("jacobian_ac", "return_map_ac"))


def test_a_cancelling_form_is_found_out() -> None:
    class Naive:
        Modes = modes.Modes

        @staticmethod
        def gap_change(s_0, s_1, z_0, p, m):
            return generalised.gap_after(s_0, s_1, z_0, p, 0.0, m) - generalised.gap_after(s_0, s_0, z_0, p, 0.0, m)

    made = of("generalised")
    kernel = next(k for k in made.kernels if k.formula.name == "gap_change")
    assert measure(kernel, made.law, Naive(), points=30).worst > 10 * AIM


# -- models -------------------------------------------------------------------------------------------------------------------

T_1, T_2, G = sp.symbols("T_1 T_2 G", positive=True)
OF_ONE = (Parameter(G, "G", "Pa/m", "stiffness"), Parameter(T_1, "T_1", "s", "time"), Parameter(T_2, "T_2", "s", "time"))


def test_a_model_given_by_operators_finds_its_times() -> None:
    made = derive_any(
        operator_model("two_times", OF_ONE, (1, 3 * T_1 + 3 * T_2, T_1 * T_2), (1 / G, (T_1 + T_2) / G, T_1 * T_2 / (2 * G)))
    )
    assert made.model.modes == 2
    draw = random.Random(3)
    for _ in range(30):
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
        derive_any(operator_model("bad", (), Q, P))


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
    model = Model("bad", "Bad", KELVIN_VOIGT.parameters, KELVIN_VOIGT.Q, KELVIN_VOIGT.P, series=Series(K, unknown * tau / K, tau))
    with pytest.raises(DerivationError, match="passive: eta_i"):
        derive_any(model)


# -- a user's model -----------------------------------------------------------------------------------------------------------

FILE = '''\
"""A rubber with any number of relaxation times."""
from hystrip.derivation import prony_model

MODEL = prony_model("my_rubber")
'''


def test_a_model_file_becomes_a_solver_folder(tmp_path: Path) -> None:
    file = tmp_path / "my_model.py"
    file.write_text(FILE, encoding="utf-8")
    seen: list[tuple[int, int]] = []
    folder = tmp_path / "my_solver"
    written = regenerate(folder, load_model(file), progress=lambda done, total: seen.append((done, total)))
    assert [done for done, _ in seen] == list(range(1, seen[-1][1] + 1))
    assert seen[-1][1] == len(STAGES) + SHARES + 2  # certificates are shown as they are made, too
    names = {path.relative_to(folder).as_posix() for path in written}
    assert names >= {
        "__init__.py",
        "stable.py",
        "modes.py",
        "my_rubber.py",
        "certificates.json",
        "audit/index.html",
        "audit/my_rubber.html",
    }
    assert sorted(path.name for path in tmp_path.iterdir()) == ["my_model.py", "my_solver"]
    assert list(json.loads((folder / "certificates.json").read_text(encoding="utf-8"))["models"]) == ["my_rubber"]
    # Nothing but the name tells it from the solver that ships.
    mine, shipped = ((path).read_text(encoding="utf-8") for path in (folder / "my_rubber.py", Path(generalised.__file__)))
    assert mine.replace("my_rubber", "generalised") == shipped


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
        (FILE.replace('my_rubber")', 'my_rubber", modes=0)'), "at least 1"),
    ],
)
def test_a_file_without_a_model_is_refused(tmp_path: Path, text: str, message: str) -> None:
    file = tmp_path / "my_model.py"
    file.write_text(text, encoding="utf-8")
    with pytest.raises(DerivationError, match=message):
        load_model(file)


def test_a_missing_file_is_named(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError, match="no model file .*absent.py"):
        load_model(tmp_path / "absent.py")

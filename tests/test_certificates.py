"""The numbers gate: every emitted function against its SymPy expression at 420 digits, below its stored bound."""

from __future__ import annotations

import inspect
import json
import sys
from pathlib import Path
from types import SimpleNamespace
from typing import ClassVar

import mpmath
import numpy as np
import pytest
from derived_once import derivation, series_once  # noqa: F401

from hystrip.derivation import CertificateError, generated_folder, regenerate, stored_bounds
from hystrip.derivation.certificates import measure
from hystrip.derivation.certificates.grid import drawn
from hystrip.derivation.certificates.measure import DIGITS, grid
from hystrip.derivation.certificates.reference import Reference
from hystrip.derivation.folder import CERTIFICATES
from hystrip.derivation.modes.symbols import OF_STRIP
from hystrip.derivation.regenerate import AIM, bounds_of, require_certified
from hystrip.derivation.symbols import a, b, c, d, p_0
from hystrip.errors import InputError
from hystrip.generated import stable, standard_linear_solid

sys.path.insert(0, str(Path(__file__).parents[1] / "tools"))
from mutants_derivation import beyond_bounds  # noqa: E402

pytestmark = [pytest.mark.xdist_group("derivation"), pytest.mark.usefixtures("series_once")]

NAMES = sorted(stored_bounds()["standard_linear_solid"])


def kernel(name: str):
    return next(kernel for kernel in derivation().kernels if kernel.formula.name == name)


def test_every_emitted_function_has_a_certificate() -> None:
    assert NAMES == sorted(kernel.formula.name for kernel in derivation().kernels)


@pytest.mark.parametrize("name", NAMES)
def test_function_stays_below_its_bound(name: str) -> None:
    certificate = measure(kernel(name), standard_linear_solid, points=25)
    assert certificate.worst <= stored_bounds()["standard_linear_solid"][name], f"{certificate.worst} ulp at {certificate.where}"


def test_bounds_meet_the_aim() -> None:
    models = json.loads((generated_folder() / CERTIFICATES).read_text(encoding="utf-8"))["models"]
    rows = {(model, name): row for model, entry in models.items() for name, row in entry["functions"].items()}
    assert not {name: row for name, row in rows.items() if row["bound"] > AIM and not row.get("why")}


def test_a_cancelling_form_is_found_out() -> None:
    def naive(s_0, s_1):
        return np.cos(s_1) - np.cos(s_0)

    assert measure(kernel("profile_rise"), SimpleNamespace(profile_rise=naive)).worst > 1e6


class Known(Reference):
    """The exact values of one function, computed once: no form changes its points."""

    at: ClassVar[dict] = {}

    def __call__(self, point):
        key = tuple(point.shown().items())
        if key not in self.at:
            self.at[key] = super().__call__(point)
        return self.at[key]


@pytest.mark.parametrize(
    ("before", "after", "least"),
    [
        ("either(\n            2 *", "exchanged(\n            2 *", 100),
        ("-profile_rise(d, c)", "profile_rise(c, d + 2 * np.pi)", 100),
        ("either(\n            2 *", "wide(\n            2 *", 30),
    ],
    ids=["forms exchanged", "one form for any width", "one form for any contact"],
)
def test_a_form_where_the_other_is_due_is_found_out(before: str, after: str, least: float, monkeypatch) -> None:
    """Both are the same in exact arithmetic, and the grid had no point at which the digits tell them apart."""
    text, inside = inspect.getsource(standard_linear_solid.means_acaf), dict(vars(standard_linear_solid))
    inside["exchanged"] = lambda width, short, wide: inside["either"](width, wide, short)
    inside["wide"] = lambda width, short, wide: wide
    assert text.count(before) == 1
    exec(text.replace(before, after), inside)
    monkeypatch.setattr(sys.modules[measure.__module__], "Reference", Known)
    assert measure(kernel("means_acaf"), SimpleNamespace(means_acaf=inside["means_acaf"]), points=80).worst > least * AIM


def test_an_overflow_is_a_failure_that_names_function_and_point() -> None:
    measured = measure(kernel("profile_rise"), SimpleNamespace(profile_rise=lambda s_0, s_1: np.exp(np.float64(1e4))), points=2)
    for stored in ({}, {"standard_linear_solid": {"functions": {"profile_rise": {"bound": 2.0}}}}):
        with pytest.raises(CertificateError, match=r"profile_rise overflows.*'s_0': "):
            bounds_of("standard_linear_solid", [measured], stored, {"standard_linear_solid.profile_rise": "no reason will do"})


def test_a_bound_does_not_grow_by_itself() -> None:
    class Worse:
        def __getattr__(self, name):
            good = getattr(standard_linear_solid, name)
            return (lambda s_0, s_1: good(s_0, s_1) * (1 + 1e-13)) if name == "profile_rise" else good

    stored = {"standard_linear_solid": {"functions": {"profile_rise": {"bound": 2.0}}}}
    measured = [measure(kernel("profile_rise"), Worse())]
    with pytest.raises(CertificateError, match="profile_rise"):
        bounds_of("standard_linear_solid", measured, stored, {})
    rows = bounds_of("standard_linear_solid", measured, stored, {"standard_linear_solid.profile_rise": "a worse sine"})
    assert rows["profile_rise"]["why"] == "a worse sine" and rows["profile_rise"]["bound"] > 2.0


def test_a_function_that_has_no_bound_cannot_be_accepted() -> None:
    require_certified({"standard_linear_solid.profile_rise": "a worse sine"}, [derivation()])
    for key in ("standard_linear_solid.profile_rize", "profile_rise", "kelvin_voigt.profile_rise"):
        with pytest.raises(InputError, match=f"accept: got '{key}'; allowed: .*such as .*standard_linear_solid.profile_rise"):
            require_certified({key: "a worse sine"}, [derivation()])


def test_what_is_accepted_is_held_to_the_functions_before_anything_is_emitted(tmp_path: Path, monkeypatch) -> None:
    monkeypatch.setattr(sys.modules[bounds_of.__module__], "derivations_of", lambda models, progress: (derivation(),))
    with pytest.raises(InputError, match="accept: got 'profile_rise'"):
        regenerate(tmp_path / "out", accept={"profile_rise": "a worse sine"})
    assert not list(tmp_path.iterdir())


EVENTS = {
    "gap": ("gap_after", ("s_0", "s_1", "gap_0", "p", "D", "beta")),
    "excess": ("excess_after", ("s_0", "s_1", "q_0", "p_0", "D", "alpha", "beta", "L")),
}


@pytest.mark.parametrize("kind", EVENTS)
def test_an_event_is_the_function_it_stands_for_even_where_a_zone_begins_without_memory(kind: str) -> None:
    name, arguments = EVENTS[kind]
    start = np.array([-2.0, 0.0, 1.5])
    given = dict.fromkeys(arguments, np.full(3, 0.3)) | {"s_0": start}
    with np.errstate(all="raise", under="ignore"):
        for alpha, beta, L in (
            (0.0, 0.0, 0.5),
            (0.0, 0.0, 0.0),
            (0.0, 3.0, 1.0),
            (3.0, 3.0, 0.0),
            (1e7, 1e9, 0.99),
            (0.0, 1e9, 1.0),
        ):
            given |= {"alpha": np.full(3, alpha), "beta": np.full(3, beta), "L": np.full(3, L)}
            for width in (0.0, 1e-280, 1e-9, 1.0, 6.0):
                given["s_1"] = start + width
                full = [given[argument] for argument in arguments]
                constants = getattr(standard_linear_solid, f"{kind}_entry")(*full[:1], *full[2:])
                value, slope = getattr(standard_linear_solid, f"{kind}_event")(given["s_1"], *constants)
                link = getattr(standard_linear_solid, f"{kind}_link")(*full)
                for got, expected in ((value, getattr(standard_linear_solid, name)(*full)), (value, link[0]), (slope, link[2])):
                    assert np.allclose(got, expected, rtol=1e-13, atol=1e-14 * (1 + beta)), (kind, alpha, beta, width)


EXTREME = [0.0, 5e-324, 1e-308, 1e-160, 1e-9, 1.0, 6.3, 1e9, 1e160, 1e308]


@pytest.mark.parametrize("name", ["decay", "decay_loss", "decay_rate", "decay_mean", "loss_mean", "loss_mean_twice"])
def test_helpers_never_overflow(name: str) -> None:
    tau, T = np.meshgrid([-1.0, *EXTREME], EXTREME)
    with np.errstate(all="raise", under="ignore"):
        values = getattr(stable, name)(tau, T)
    assert np.all(np.isfinite(values))
    if name != "decay_rate":
        assert np.all(np.abs(values) <= 1.0)


def test_helpers_at_their_limits() -> None:
    assert stable.decay(0.0, 0.0) == 1.0 and stable.decay(1e-300, 0.0) == 0.0
    assert stable.decay_loss(0.0, 0.0) == 0.0 and stable.decay_loss(1e-300, 0.0) == -1.0
    assert stable.decay_rate(0.0, 0.0) == 0.0 and stable.decay_rate(1.0, 0.0) == 0.0
    assert stable.decay_mean(0.0, 2.0) == 1.0 and stable.decay_mean(1.0, 0.0) == 0.0
    assert stable.loss_mean(0.0, 2.0) == 0.0 and stable.loss_mean(1.0, 0.0) == 1.0
    assert stable.loss_mean_twice(0.0, 2.0) == 0.0 and stable.loss_mean_twice(1.0, 0.0) == 1.0


def test_degenerate_materials_raise_no_warning() -> None:
    edges = (-2.0, -1.5, 0.5, 1.0)
    cases = [
        (0.0, 0.0, 0.5),
        (0.0, 0.0, 1.0),
        (0.0, 3.0, 0.0),
        (3.0, 3.0, 1.0),
        (0.0, 0.0, 0.0),
        (1e8, 1e9, 0.1),
        (1e200, 1e200, 1.0),
    ]
    with np.errstate(all="raise", under="ignore"):
        for alpha, beta, J in cases:
            for sequence, regime in standard_linear_solid.REGIMES.items():
                if sequence == "afc" and J == 0.0:
                    continue  # a snap into contact needs an instantaneous compliance
                given = (*edges[: len(regime["edges"])], alpha, beta, J, 1.0 - J, 0.3, 0.1, 0.2, 1.0)
                for kind in ("residual", "means", "onset_slope"):
                    if regime[kind] is not None:
                        flat = np.concatenate(
                            [np.ravel(np.asarray(part, dtype=float)) for part in np.atleast_1d(regime[kind](*given))]
                        )
                        assert np.all(np.isfinite(flat)), (sequence, kind, alpha, beta, J)


def test_every_function_that_a_mutant_of_what_is_emitted_gets_wrong_is_named() -> None:
    """Also one that none of the mutants here was written for, and one that is no number."""
    kernels = [each for each in derivation().kernels if each.formula.name in ("profile", "loss", "saturated_pressure", "means_c")]
    bounds, true = stored_bounds()["standard_linear_solid"], vars(standard_linear_solid)
    assert beyond_bounds(kernels, standard_linear_solid, bounds) == ""
    mutated = {"loss": lambda *of: -true["loss"](*of), "means_c": lambda *of: (float("nan"), 0.0)}
    assert beyond_bounds(kernels, SimpleNamespace(**(true | mutated)), bounds) == "certificate of loss, means_c"


@pytest.mark.parametrize("edges", [(d, b, a, c), (d, a, c), (d, c)])
def test_functions_of_zones_of_adhesion_are_measured_with_adhesion(edges: tuple) -> None:
    """All four points of some function were without, for two times, and a wrong sign of the traction had a certificate."""
    with mpmath.workdps(DIGITS):
        for count, index in grid((1, 2, 3, 6), 8):
            assert drawn((*edges, *OF_STRIP), f"{len(edges)} {index}", count).values[p_0] > 0

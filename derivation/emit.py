"""Emission: verified kernels in, the text of the generated files out. Nothing is derived or rearranged here."""

from __future__ import annotations

import hashlib
import subprocess
import sys
from pathlib import Path
from typing import Any

import jinja2
import sympy as sp

from .check import DerivationError
from .modes.emit import template_values, written
from .outcome import Derivation
from .sequences import Row
from .text import function_text, helpers_used

INTERFACE = 1
HERE = Path(__file__).parent
TEMPLATES = {
    "stable": "stable.py.jinja",
    "modes": "modes.py.jinja",
    "model": "model.py.jinja",
    "modes_model": "modes_model.py.jinja",
    "package": "package.py.jinja",
}
PARAMETER_MEANINGS = (
    ("alpha", "k V T_sigma"),
    ("beta", "k V T_eps"),
    ("J", "T_sigma/T_eps, the instantaneous compliance times K"),
    ("L", "1 - J, so that beta - alpha = L beta"),
    ("p_0", "p_0/(K A), the traction of adhesion"),
    ("delta_0", "delta_0/A, its reach"),
    ("D", "D_j/A, the penetration of the strip"),
    ("chi", "what w does where p steps: 0 continuous, 1 constitutive"),
)


def emit(derivations: tuple[Derivation, ...]) -> dict[str, str]:
    """Text of every generated Python file, by its path in the output folder."""
    files = {"stable.py": stable_text()}
    if any(derivation.kind == "several_times" for derivation in derivations):
        files["modes.py"] = _render("modes", "every model with a Prony series")
    for derivation in derivations:
        files[f"{derivation.model.name}.py"] = model_text(derivation)
    files["__init__.py"] = package_text(tuple(derivation.model.name for derivation in derivations))
    return {name: formatted(text) for name, text in sorted(files.items())}


def model_text(derivation: Derivation) -> str:
    model = derivation.model
    template, values, function = KINDS[derivation.kind]
    sections = [
        {"title": title, "functions": [function(kernel.formula, kernel.derived) for kernel in kernels]}
        for title, kernels in derivation.sections
    ]
    return _render(
        template,
        model.name,
        title=model.title,
        model=model.name,
        interface=INTERFACE,
        material=model.parameters,
        sections=sections,
        regimes=[_row(regime) for regime in derivation.regimes],
        **values(derivation),
    )


def _of_one_time(derivation: Derivation) -> dict[str, Any]:
    return {"parameters": PARAMETER_MEANINGS, "helpers": helpers_used(kernel.formula for kernel in derivation.kernels)}


KINDS = {"one_time": ("model", _of_one_time, function_text), "several_times": ("modes_model", template_values, written)}
"""Of each kind of derivation the template, its further values, and a formula as the text of a function."""


def _row(regime: Row) -> dict[str, Any]:
    """A row of the table of regimes, in words; the names of its functions are the template's."""
    return {
        "sequence": regime.sequence,
        "title": regime.title,
        "zones": [(z.kind, *(str(end).replace("*", " ") for end in (z.first, z.last))) for z in regime.zones],
        "edges": [str(edge) for edge in regime.edges],
        "closures": regime.closures,
        "equations": [label for label, _ in regime.equations],
        "admissible": [inequality.code for inequality in regime.admissible],
    }


def stable_text() -> str:
    """The stable helpers; SymPy supplies the series of those that have one."""
    n, x = sp.symbols("n x")
    loss = _alternating(1 - (1 - sp.exp(-n)) / n, n, first=1, step=1, terms=18)
    twice = _alternating(1 - 2 / n * (1 - (1 - sp.exp(-n)) / n), n, first=1, step=1, terms=19)
    sine = _alternating(x - sp.sin(x), x, first=3, step=2, terms=10)
    return _render(
        "stable",
        "every model",
        loss_first=f"{loss[0]}.0",
        loss_divisors=loss[1:],
        twice_first=f"{twice[0]}.0",
        twice_divisors=twice[1:],
        sine_first=f"{sine[0]}.0",
        sine_divisors=sine[1:],
    )


def _alternating(function: sp.Expr, variable: sp.Symbol, first: int, step: int, terms: int) -> list[sp.Integer]:
    """Ratios of neighbouring coefficients of an alternating Taylor series, the first by itself; they must be integers."""
    polynomial = sp.series(function, variable, 0, first + step * terms).removeO()
    coefficients = [polynomial.coeff(variable, first + step * k) for k in range(terms)]
    ratios = [1 / coefficients[0]] + [-a / b for a, b in zip(coefficients, coefficients[1:], strict=False)]
    if not all(ratio.is_Integer and ratio > 0 for ratio in ratios):
        raise DerivationError("stable series", f"{function} alternates with integer ratios", ratios)
    return ratios


def package_text(models: tuple[str, ...]) -> str:
    return _render("package", ", ".join(models), models=models)


def _render(kind: str, concerning: str, **values: Any) -> str:
    environment = jinja2.Environment(
        loader=jinja2.FileSystemLoader(HERE / "templates"),
        undefined=jinja2.StrictUndefined,
        keep_trailing_newline=True,
        autoescape=False,
    )
    template = TEMPLATES[kind]
    values.setdefault("hash", input_hash())
    header = "\n".join(
        (
            "# Generated by `hystrip regenerate`. Do not edit: change the derivation or the template instead.",
            f"# Template: derivation/templates/{template}; model: {concerning}.",
            f"# sympy {sp.__version__}, jinja2 {jinja2.__version__}, ruff {formatter_version()}.",
            f"# Inputs (derivation, templates, models): sha256 {values['hash']}.",
        )
    )
    return environment.get_template(template).render(header=header, **values)


def input_hash() -> str:
    """Hash of everything that the solvers are made from: sources of the derivation, models and templates, not the pages."""
    digest = hashlib.sha256()
    for path in sorted(HERE.rglob("*")):
        parts = path.relative_to(HERE).parts
        if path.suffix in (".py", ".jinja", ".toml") and not {"__pycache__", "pages", "audit"} & set(parts):
            digest.update("/".join(parts).encode() + b"\0" + path.read_bytes().replace(b"\r\n", b"\n") + b"\0")
    return digest.hexdigest()[:32]


def _ruff(*arguments: str, text: str | None = None) -> str:
    command = [sys.executable, "-m", "ruff", *arguments]
    done = subprocess.run(command, input=text, capture_output=True, text=True, check=False, encoding="utf-8")
    if done.returncode:
        raise RuntimeError(f"{' '.join(arguments)}: ruff failed: {done.stderr.strip()}")
    return done.stdout


def formatter_version() -> str:
    from importlib.metadata import version

    return version("ruff")


def formatted(text: str) -> str:
    """The text as the pinned formatter lays it out, independent of any configuration file around."""
    options = ("--isolated", "--line-length", "120", "--target-version", "py311", "--stdin-filename", "generated.py", "-")
    return _ruff("format", *options, text=text)

"""What the audit says of one model: plain data, taken from the objects that the solver is emitted from."""

import hashlib
import inspect
import re
from collections.abc import Iterable, Mapping, Sequence
from importlib.metadata import version
from typing import Any

import sympy as sp

from ..certificates import WORDS as DOMAINS
from ..check import Derived
from ..emit import INTERFACE, PARAMETERS, input_hash
from ..functions import HELPERS, flat, written_out
from ..modes.symbols import J_0
from ..outcome import Derivation
from ..paper.record import SUBJECTS, Comparison, numbers
from ..regime import PERIODIC
from ..sequences import CONTACT, EQUATIONS, Row
from . import places
from .latex import widest
from .misprints import WORDS, misprints

LONG = 130  # operations from which a value is only read in the generated function
PAPER = 108  # characters of a piece too wide for a sheet
STATED = ("regime ", "onset_slope_")  # steps whose equation is the value written out already
TOOLS = ("sympy", "jinja2", "ruff", "latex2mathml")
CLOSURES = {0: "continuous", 1: "constitutive"}
MEANINGS = dict([*EQUATIONS.values(), PERIODIC])

FIRST = {6: "zone conditions", 11: "means over a level", 15: "saturated_pressure"}
"""The step that states an equation, where that is not the first with its number."""


def content(derivation: Derivation, files: Mapping[str, str], certificates: Mapping[str, Any]) -> dict[str, Any]:
    """Everything on a model's page but what is measured. ``files``: the emitted texts; ``certificates``: rows by function."""
    words, module = WORDS[derivation.kind], f"{derivation.model.name}.py"
    method = [*WORDS["method"], words["regime"]]
    steps = {step.name: step for step in derivation.steps}
    computed = places.functions(f"generated/{module}", files[module])
    functions = sorted(name for name in computed if "." not in name)  # and no methods
    helpers = places.functions("generated/stable.py", files["stable.py"])
    deriving = {step.function for step in derivation.steps} | {name for name, _ in method}
    conditions = equations if derivation.kind == "one_time" else events
    regimes = [_regime(regime, conditions(regime), computed) for regime in derivation.regimes]
    return {
        "model": derivation.model.name,
        "title": derivation.model.title,
        "paper": WORDS["paper"],
        "identity": identity(files),
        "fields": words.get("fields", []),
        "parameters": PARAMETERS[derivation.kind],
        "material": [[p.name, p.unit, p.meaning] for p in derivation.model.parameters],
        "equations": papers_equations(steps, derivation.comparisons),
        "misprints": misprints(steps, derivation.kind),
        "small": words.get("small", []),
        "stages": stages(derivation, computed),
        "regimes": regimes,
        "domains": list(DOMAINS.items()),
        "functions": {name: _proven(name, derivation.steps, regimes) for name in functions},
        "certificates": dict(sorted(certificates.items())),
        "method": method,
        "sources": {name: places.deriving(name) for name in sorted(deriving)},
        "generated": computed | helpers,
        "helpers": [_helper(helper) for helper in HELPERS],
        "measured": "measured.json",
    }


def identity(files: Mapping[str, str]) -> dict[str, Any]:
    """What ties page, model and generated files together."""
    return {
        "inputs": input_hash(),
        "interface": INTERFACE,
        "versions": {tool: version(tool) for tool in TOOLS},
        "files": {f"generated/{name}": hashlib.sha256(text.encode()).hexdigest() for name, text in sorted(files.items())},
    }


def papers_equations(steps: Mapping[str, Derived], comparisons: Sequence[Comparison]) -> list[dict[str, Any]]:
    """The contents by equation number; the first of a row's steps is the one that states the equation.

    Without ``comparisons`` (a foundation that is not the paper's) nothing is printed, and the status is that of the steps.
    """
    found = comparisons or [
        Comparison(number, subject, "", (), (), steps[stating].status, "", (stating,))
        for number, subject in SUBJECTS.items()
        for stating in [FIRST.get(number) or next(name for name, step in steps.items() if number in numbers(step.paper))]
    ]
    return [_equation(each, steps) for each in found]


def _equation(comparison: Comparison, steps: Mapping[str, Derived]) -> dict[str, Any]:
    cited = [name for name, step in steps.items() if comparison.number in numbers(step.paper)]
    listed = list(dict.fromkeys(name for name in (*comparison.steps, *cited) if name in steps))
    return vars(comparison) | {"derived": comparison.derived or (steps[listed[0]].latex,), "steps": listed}


def stages(derivation: Derivation, computed: Mapping[str, places.Source]) -> list[dict[str, Any]]:
    """The steps by the module that derives them."""
    found: dict[str, list[dict[str, Any]]] = {}
    known = {step.name for step in derivation.steps}
    for step in derivation.steps:
        row = vars(step) | {
            "value": _values(step),
            "equations": numbers(step.paper),
            "computed_by": [name for name in step.emitted if name in computed],
            "carried_out_by": places.carried_out(step),
            "enters": [name for name in places.ENTERS.get(step.function, ()) if name in known],
            "measured": places.MEASURED.get(step.function, ""),
            "display": derivation.displayed.get(step.name, ""),
        }
        found.setdefault(step.function.rpartition(".")[0], []).append(row)
    return [{"module": module, "title": places.title(module), "steps": rows} for module, rows in found.items()]


def _values(step: Derived) -> list[str]:
    """LaTeX of the derived value, printed by SymPy; empty where it is too long to read or the equation above says as much."""
    parts = [part for part in flat(step.value) if isinstance(part, sp.Basic)]
    if not parts or step.name.startswith(STATED) or sum(sp.count_ops(part) for part in parts) > LONG:
        return []
    texts = [plainly(part) for part in parts]
    if max(map(widest, texts)) > PAPER:
        return []
    plain = step.latex.replace(r"\tfrac", r"\frac")
    return [] if texts == [step.latex] or _unbraced(plain).endswith(f"= {_unbraced(texts[0])}") else texts


def plainly(term: sp.Expr) -> str:
    """LaTeX with helpers and calls written out; a fraction far wider above than below as a product, to be cut."""
    return sp.latex(written_out(term), long_frac_ratio=8)


def _unbraced(latex: str) -> str:
    """Indices of one sign without braces, as one writes them by hand."""
    return re.sub(r"_\{(\w)\}", r"_\1", latex)


def _regime(regime: Row, conditions: list[tuple[str, str]], computed: Iterable[str]) -> dict[str, Any]:
    """A row of the table of regimes."""
    return {
        "sequence": regime.sequence,
        "title": regime.title,
        "zones": [(zone.kind, sp.latex(zone.first), sp.latex(zone.last)) for zone in regime.zones if regime.edges],
        "kind": regime.zones[0].kind,
        "unknowns": [str(edge) for edge in regime.edges],
        "closures": [CLOSURES[closure] for closure in regime.closures],
        "equations": conditions,
        "admissible": [inequality.prose for inequality in regime.admissible],
        "step": regime.derived.name,
        "computed_by": [name for name in computed if name.rpartition("_")[2] == regime.sequence],
    }


def equations(regime: Row) -> list[tuple[str, str]]:
    """Meaning and LaTeX of each boundary equation, for one relaxation time."""
    return [(MEANINGS[label], f"{plainly(term)} = 0") for label, term in regime.equations]


def events(regime: Row) -> list[tuple[str, str]]:
    """Meaning and LaTeX of each boundary equation, for several relaxation times."""
    if not regime.edges:
        return []
    first, last = sp.latex(regime.edges[0]), regime.zones[-1]
    elastic = sp.latex(J_0 * last.load) + " + " if last.load != 0 else ""
    gap = f" - {sp.latex(last.exit)}" if last.exit != 0 else ""
    changes = [rf"{elastic}\sum_j z_j({first}) - u({first}){gap} = 0"]
    for zone in regime.zones[:-1]:
        what = "p" if zone.kind == CONTACT else "g"
        missing = "" if zone.missing == 0 else f"{sp.latex(zone.missing)} + "
        changes.append(rf"{missing}[{what}]_{{{sp.latex(zone.first)}}}^{{{sp.latex(zone.last)}}} = 0")
    return [(meaning, latex) for (_, meaning), latex in zip(regime.equations, changes, strict=True)]


def _proven(name: str, steps: Iterable[Derived], regimes: Iterable[Mapping[str, Any]]) -> list[str]:
    """The steps that prove an emitted function; of one that no step names, that of its regime. Empty for an algorithm."""
    by_regime = [regime["step"] for regime in regimes if name in regime["computed_by"]]
    return [step.name for step in steps if name in step.emitted] or by_regime


def _helper(helper: Any) -> tuple[str, str, str]:
    """Name, arguments and meaning of a function that stands in emitted formulas for itself."""
    taken = list(inspect.signature(helper.meaning).parameters)
    return helper.__name__, ", ".join(taken), sp.latex(helper.meaning(*sp.symbols(taken, positive=True)))

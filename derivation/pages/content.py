"""What the audit says of one model: plain data, taken from the objects that the solver is emitted from."""

import hashlib
import inspect
import re
from collections.abc import Mapping, Sequence
from importlib.metadata import version
from typing import Any

import sympy as sp

from ..certificates import WORDS as DOMAINS
from ..check import Derived
from ..emit import INTERFACE, input_hash
from ..functions import HELPERS, flat
from ..outcome import Derivation
from ..paper.record import SUBJECTS, Comparison
from ..paper.tags import numbers
from ..sequences import Row
from . import places
from .latex import widest
from .misprints import misprints
from .wording import WORDING, WORDS, Wording, plainly

LONG = 130  # operations from which a value is only read in the generated function
PAPER = 108  # characters of a piece too wide for a sheet
STATED = ("regime ", "onset_slope_")  # steps whose equation is the value written out already
TOOLS = ("sympy", "jinja2", "ruff", "latex2mathml")
CLOSURES = {0: "continuous", 1: "constitutive"}

FIRST = {6: ("zone conditions",), 11: ("means over a level",), 15: ("saturated_pressure",)}
"""The step that states an equation, where that is not the first with its number."""


def content(derivation: Derivation, files: dict[str, str], certificates: dict[str, Any]) -> dict[str, Any]:
    """Everything on a model's page but what is measured. ``files``: the emitted texts; ``certificates``: rows by function."""
    own, words = WORDING[derivation.kind](derivation), WORDS.get(derivation.kind, {})
    module = f"{derivation.model.name}.py"
    computed = places.generated(module, files[module])
    helpers = places.generated("stable.py", files["stable.py"])
    functions = {step.function for step in derivation.steps}
    return {
        "model": derivation.model.name,
        "title": derivation.model.title,
        "paper": WORDS["paper"],
        "identity": identity(files),
        "fields": words.get("fields", []),
        "parameters": [list(row) for row in own.parameters],
        "material": [[p.name, p.unit, p.meaning] for p in derivation.model.parameters],
        "equations": equations(derivation.steps, derivation.comparisons),
        "misprints": misprints({step.name: step for step in derivation.steps}, derivation.kind),
        "small": words.get("small", []),
        "stages": stages(derivation.steps, computed, displayed(derivation, own.unread)),
        "regimes": [_regime(regime, own, computed) for regime in derivation.regimes],
        "domains": [list(row) for row in DOMAINS.items()],
        "functions": functions_table(computed, derivation.steps, certificates, own.parts),
        "certificates": {name: dict(sorted(row.items())) for name, row in sorted(certificates.items())},
        "method": WORDS["method"],
        "sources": {name: vars(places.deriving(name)) for name in sorted({*functions, *(name for name, _ in WORDS["method"])})},
        "generated": {name: vars(source) for name, source in (computed | helpers).items()},
        "helpers": helpers_table(helpers),
        "measured": "measured.json",
    }


def identity(files: dict[str, str]) -> dict[str, Any]:
    """What ties page, model and generated files together."""
    return {
        "inputs": input_hash(),
        "interface": INTERFACE,
        "versions": {tool: version(tool) for tool in TOOLS},
        "files": {f"generated/{name}": hashlib.sha256(text.encode()).hexdigest() for name, text in sorted(files.items())},
    }


def equations(steps: tuple[Derived, ...], comparisons: Sequence[Comparison] = ()) -> list[dict[str, Any]]:
    """The contents by equation number; the first of a row's steps is the one that states the equation.

    Without ``comparisons`` (a foundation that is not the paper's) the status is that of the steps.
    """
    compared = {comparison.number: comparison for comparison in comparisons}
    return [_equation(number, steps, compared.get(number)) for number in SUBJECTS]


def _equation(number: int, steps: tuple[Derived, ...], comparison: Comparison | None) -> dict[str, Any]:
    by_name = {step.name: step for step in steps}
    cited = [step.name for step in steps if number in numbers(step.paper)]
    named = comparison.steps if comparison else FIRST.get(number, ())
    listed = list(dict.fromkeys(name for name in (*named, *cited) if name in by_name))
    return {
        "number": number,
        "subject": SUBJECTS[number],
        "status": comparison.status if comparison else by_name[listed[0]].status,
        "printed": comparison.printed if comparison else "",
        "derived": list(comparison.derived or (by_name[listed[0]].latex,)) if comparison else [],
        "checks": [[check.claim, check.outcome] for check in comparison.checks] if comparison else [],
        "correction": comparison.correction if comparison else "",
        "steps": listed,
    }


def displayed(derivation: Derivation, unread: Mapping[str, str]) -> dict[str, str]:
    """What is said of the display of each step: read back and compared, or why there is nothing to compare."""
    read = {name: f"{check.claim}: {check.outcome}" for name, check in derivation.displayed.items()}
    return {name: f"nothing to compare in the display: {what}" for name, what in unread.items()} | read


def stages(steps: tuple[Derived, ...], computed: dict[str, places.Source], displays: Mapping[str, str]) -> list[dict[str, Any]]:
    """The steps by the module that derives them. ``displays``: what is said of the display of each step."""
    found: dict[str, list[dict[str, Any]]] = {}
    known = {step.name for step in steps}
    for step in steps:
        found.setdefault(step.function.rpartition(".")[0], []).append(
            _step(step, computed, known) | {"display": displays.get(step.name, "")}
        )
    return [{"module": module, "title": places.title(module), "steps": steps} for module, steps in found.items()]


def _step(step: Derived, computed: dict[str, places.Source], known: set[str]) -> dict[str, Any]:
    derived_in = places.deriving(step.function)
    return {
        "name": step.name,
        "statement": step.statement,
        "latex": step.latex,
        "value": _values(step),
        "checks": [[check.claim, check.outcome] for check in step.checks],
        "paper": step.paper,
        "equations": numbers(step.paper),
        "status": step.status,
        "correction": step.correction,
        "derived_by": {"function": step.function, "file": derived_in.file, "line": derived_in.line},
        "computed_by": [
            {"function": n, "file": computed[n].file, "line": computed[n].line} for n in step.emitted if n in computed
        ],
        "carried_out_by": [vars(place) for place in places.carried_out(step)],
        "enters": [name for name in places.ENTERS.get(step.function, ()) if name in known],
        "measured": places.MEASURED.get(step.function, ""),
    }


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


def _unbraced(latex: str) -> str:
    """Indices of one sign without braces, as one writes them by hand."""
    return re.sub(r"_\{(\w)\}", r"_\1", latex)


def _regime(regime: Row, own: Wording, computed: dict[str, places.Source]) -> dict[str, Any]:
    """A row of the table of regimes."""
    zones = [] if not regime.edges else [[z.kind, sp.latex(z.first), sp.latex(z.last)] for z in regime.zones]
    names = [f"{kind}_{regime.sequence}" for kind in own.kinds]
    return {
        "sequence": regime.sequence,
        "title": regime.title,
        "zones": zones,
        "kind": regime.zones[0].kind,
        "unknowns": [str(edge) for edge in regime.edges],
        "closures": [CLOSURES[closure] for closure in regime.closures],
        "equations": own.conditions(regime),
        "admissible": [inequality.prose for inequality in regime.admissible],
        "step": regime.derived.name,
        "computed_by": [name for name in names if name in computed],
    }


def functions_table(
    computed: dict[str, places.Source],
    steps: tuple[Derived, ...],
    certificates: dict[str, Any],
    parts: Mapping[str, str],
) -> list[dict[str, Any]]:
    """Every emitted function: derived, by which steps, or an algorithm; its bound in ulp and the domain that was measured.

    ``parts``: functions that only name what others of a step are made of, and that step.
    """
    proven: dict[str, list[str]] = {name: [step] for name, step in parts.items()}
    for step in steps:
        for name in step.emitted:
            proven.setdefault(name, []).append(step.name)
    rows = []
    for name in sorted(computed):
        row = certificates.get(name, {})
        rows.append(
            {
                "function": name,
                "kind": "derived" if name in proven else "algorithm",
                "steps": proven.get(name, []),
                "bound": row.get("bound", ""),
                "points": row.get("points", ""),
                "domain": list(row.get("domain", ())),
                "why": row.get("why", ""),
            }
        )
    return rows


def helpers_table(computed: dict[str, places.Source]) -> list[dict[str, Any]]:
    """The functions that stand in emitted formulas for themselves: what each means, where it is computed."""
    rows = []
    for helper in HELPERS:
        taken = list(inspect.signature(helper.meaning).parameters)
        arguments = sp.symbols(taken, positive=True)
        rows.append(
            {
                "name": f"{helper.__name__}({', '.join(taken)})",
                "meaning": sp.latex(helper.meaning(*arguments)),
                "function": helper.__name__ if helper.__name__ in computed else "",
            }
        )
    return rows

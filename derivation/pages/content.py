"""What the audit says of one model: plain data, taken from the objects that the solver is emitted from."""

from __future__ import annotations

import hashlib
from importlib.metadata import version
from typing import Any

import sympy as sp

from ..check import Derived
from ..derive import Derivation
from ..emit import INTERFACE, PARAMETER_MEANINGS, input_hash
from ..functions import written_out
from ..regime import EQUATIONS, PERIODIC, Regime
from . import paper, sources
from .latex import widest

LONG = 130  # operations from which a value is only read in the generated function
PAPER = 108  # characters of a piece too wide for a sheet
TOOLS = ("sympy", "jinja2", "ruff", "latex2mathml")
MEANINGS = dict([*EQUATIONS.values(), PERIODIC])
CLOSURES = {0: "continuous", 1: "constitutive"}


def content(derivation: Derivation, files: dict[str, str], certificates: dict[str, Any]) -> dict[str, Any]:
    """Everything on a model's page but what is measured. ``files``: the emitted texts; ``certificates``: rows by function."""
    module = f"{derivation.model.name}.py"
    computed = sources.generated(module, files[module])
    return {
        "model": derivation.model.name,
        "title": derivation.model.title,
        "paper": paper.TITLE,
        "identity": identity(files),
        "parameters": [list(row) for row in PARAMETER_MEANINGS],
        "material": [[p.name, p.unit, p.meaning] for p in derivation.model.parameters],
        "equations": paper.equations(derivation.steps),
        "misprints": paper.misprints(derivation.steps),
        "stages": stages(derivation.steps, computed),
        "regimes": [_regime(regime, computed) for regime in derivation.regimes],
        "certificates": {name: dict(sorted(row.items())) for name, row in sorted(certificates.items())},
        "sources": {name: text(sources.deriving(name)) for name in sorted({step.function for step in derivation.steps})},
        "generated": {name: text(source) for name, source in computed.items()},
    }


def identity(files: dict[str, str]) -> dict[str, Any]:
    """What ties page, model and generated files together."""
    return {
        "inputs": input_hash(),
        "interface": INTERFACE,
        "versions": {tool: version(tool) for tool in TOOLS},
        "files": {f"generated/{name}": hashlib.sha256(text.encode()).hexdigest() for name, text in sorted(files.items())},
    }


def stages(steps: tuple[Derived, ...], computed: dict[str, sources.Source]) -> list[dict[str, Any]]:
    """The steps by the module that derives them."""
    found: dict[str, list[dict[str, Any]]] = {}
    for step in steps:
        found.setdefault(step.function.rpartition(".")[0], []).append(_step(step, computed))
    return [{"module": module, "title": sources.title(module), "steps": steps} for module, steps in found.items()]


def _step(step: Derived, computed: dict[str, sources.Source]) -> dict[str, Any]:
    derived_in = sources.deriving(step.function)
    return {
        "name": step.name,
        "statement": step.statement,
        "latex": step.latex,
        "value": _values(step),
        "checks": [[check.claim, check.outcome] for check in step.checks],
        "paper": step.paper,
        "equations": paper.numbers(step.paper),
        "status": step.status,
        "correction": step.correction,
        "derived_by": {"function": step.function, "file": derived_in.file, "line": derived_in.line},
        "computed_by": [
            {"function": n, "file": computed[n].file, "line": computed[n].line} for n in step.emitted if n in computed
        ],
    }


def _values(step: Derived) -> list[str]:
    """LaTeX of the derived value, printed by SymPy; empty where it is too long to read or the equation above says as much."""
    parts = [part for part in _flat(step.value) if isinstance(part, sp.Basic)]
    if not parts or step.name.startswith("regime ") or sum(sp.count_ops(part) for part in parts) > LONG:
        return []
    texts = [sp.latex(written_out(part)) for part in parts]
    if max(map(widest, texts)) > PAPER:
        return []
    return [] if texts == [step.latex] or step.latex.endswith(f"= {texts[0]}") else texts


def _flat(value: Any) -> list[Any]:
    return [part for item in value for part in _flat(item)] if isinstance(value, (tuple, list, sp.Tuple)) else [value]


def _regime(regime: Regime, computed: dict[str, sources.Source]) -> dict[str, Any]:
    zones = [] if not regime.edges else [[z.kind, sp.latex(z.first), sp.latex(z.last)] for z in regime.zones]
    names = [f"{kind}_{regime.sequence}" for kind in ("residual", "jacobian", "means", "onset_slope")]
    return {
        "sequence": regime.sequence,
        "title": regime.title,
        "zones": zones,
        "kind": regime.zones[0].kind,
        "unknowns": [str(edge) for edge in regime.edges],
        "closures": [CLOSURES[closure] for closure in regime.closures],
        "equations": [[MEANINGS[label], f"{sp.latex(written_out(term))} = 0"] for label, term in regime.equations],
        "admissible": list(regime.admissible),
        "step": regime.derived.name,
        "computed_by": [name for name in names if name in computed],
    }


def text(source: sources.Source) -> dict[str, Any]:
    return {"file": source.file, "line": source.line, "text": source.text}

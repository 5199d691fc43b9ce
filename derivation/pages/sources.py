"""Where a step is derived and where it is computed: file, line and text."""

from __future__ import annotations

import ast
import importlib
import inspect
from dataclasses import dataclass

PACKAGE = __name__.rpartition(".pages.")[0]


@dataclass(frozen=True)
class Source:
    file: str
    line: int
    text: str


def deriving(function: str) -> Source:
    """Source of a deriving function, given as ``module.name``, where a module in a folder has a dot in its name."""
    module, _, name = function.rpartition(".")
    lines, first = inspect.getsourcelines(getattr(importlib.import_module(f"{PACKAGE}.{module}"), name))
    return Source(f"derivation/{module.replace('.', '/')}.py", first, "".join(lines).rstrip())


def title(module: str) -> str:
    """First line of a module's docstring."""
    return (
        (importlib.import_module(f"{PACKAGE}.{module}").__doc__ or module).strip().splitlines()[0].rstrip(".").replace("``", "")
    )


def generated(file: str, text: str) -> dict[str, Source]:
    """Source of every function of a generated module, by name."""
    lines = text.splitlines()
    return {
        node.name: Source(f"generated/{file}", node.lineno, "\n".join(lines[node.lineno - 1 : node.end_lineno]))
        for node in ast.parse(text).body
        if isinstance(node, ast.FunctionDef)
    }

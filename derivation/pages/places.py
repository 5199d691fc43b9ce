"""Where a step is derived, where it is computed, and where the runtime carries out what it says: file, line and text.

The latter, and which steps a step enters that no function computes by itself, by the function that derives the step:
``places.toml``. A place is a function of the runtime and a piece of the line that does it. The page quotes the line; one that is
gone, or no longer the only one, is an error that names the step.
"""

import ast
import importlib
import importlib.util
import inspect
import tomllib
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

from ..check import DerivationError, Derived

PACKAGE = __name__.rpartition(".pages.")[0]
_PLACES = tomllib.loads(Path(__file__).with_suffix(".toml").read_text(encoding="utf-8"))
RUNTIME, ENTERS, MEASURED = _PLACES["runtime"], _PLACES["enters"], _PLACES["measured"]


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
        name: Source(f"generated/{file}", node.lineno, "\n".join(lines[node.lineno - 1 : node.end_lineno]))
        for node in ast.parse(text).body
        for name in _names(node)
    }


def _names(node: ast.stmt) -> list[str]:
    """Of a function; of several that are the results of one call."""
    if isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Tuple):
        return [ast.unparse(name) for name in node.targets[0].elts]
    return [node.name] if isinstance(node, ast.FunctionDef) else []


@dataclass(frozen=True)
class Place:
    file: str
    function: str
    text: str


def carried_out(step: Derived) -> list[Place]:
    """The runtime's lines for a step."""
    return [_place(step.name, *where) for where in RUNTIME.get(step.function, ())]


def _place(step: str, file: str, function: str, piece: str) -> Place:
    text, tree = _parsed(file)
    name = function.rpartition(".")[2]
    found = [node for node in ast.walk(tree) if isinstance(node, ast.FunctionDef) and node.name == name and not _overload(node)]
    lines = [line for node in found for line in text.splitlines()[node.lineno - 1 : node.end_lineno] if piece in line]
    if len(found) != 1 or len(lines) != 1:
        raise DerivationError(
            step, f"runtime/{file}: {function} has {len(lines)} lines with {piece!r}, not the one that the audit names"
        )
    return Place(f"runtime/{file}", function, lines[0].strip())


def _overload(node: ast.FunctionDef) -> bool:
    return any(ast.unparse(decorator) == "overload" for decorator in node.decorator_list)


@lru_cache
def _parsed(file: str) -> tuple[str, ast.Module]:
    found = importlib.util.find_spec("hystrip")
    if found is None or found.origin is None:
        raise FileNotFoundError("the package hystrip is not installed")
    text = (Path(found.origin).parent / file).read_text(encoding="utf-8")
    return text, ast.parse(text)

"""Where a step is derived, where it is computed, and where the runtime carries out what it says: file, line and text.

The latter, and which steps a step enters that no function computes by itself, by the function that derives the step:
``places.toml``. A place is a function of the runtime and a piece of the line that does it. The page quotes the line; one that is
gone, or no longer the only one, is an error that names the step.
"""

import ast
import inspect
import pkgutil
import tomllib
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import cache
from importlib import resources
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


@dataclass(frozen=True)
class Place:
    file: str
    function: str
    text: str


def deriving(function: str) -> Source:
    """Source of a deriving function, given as ``module.name``, where a module in a folder has a dot in its name."""
    lines, first = inspect.getsourcelines(pkgutil.resolve_name(f"{PACKAGE}.{function}"))
    return Source(f"derivation/{function.rpartition('.')[0].replace('.', '/')}.py", first, "".join(lines).rstrip())


def title(module: str) -> str:
    """First line of a module's docstring."""
    return inspect.getdoc(pkgutil.resolve_name(f"{PACKAGE}.{module}:")).splitlines()[0].rstrip(".").replace("``", "")


def functions(file: str, text: str) -> dict[str, Source]:
    """Source of every function of a module, by its name, qualified by the class."""
    lines = text.splitlines()
    return {
        name: Source(file, node.lineno, "\n".join(lines[node.lineno - 1 : node.end_lineno]))
        for name, node in _named(ast.parse(text).body)
    }


def _named(body: Iterable[ast.stmt], within: str = "") -> Iterator[tuple[str, ast.stmt]]:
    for node in body:
        if isinstance(node, ast.ClassDef):
            yield from _named(node.body, f"{node.name}.")
        elif isinstance(node, ast.FunctionDef):
            yield within + node.name, node
        elif isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Tuple):  # several are the results of one call
            yield from ((ast.unparse(name), node) for name in node.targets[0].elts)


def carried_out(step: Derived) -> list[Place]:
    """The runtime's lines for a step."""
    found = []
    for file, function, piece in RUNTIME.get(step.function, ()):
        source = _of_runtime(file).get(function)
        lines = [line.strip() for line in source.text.splitlines() if piece in line] if source else []
        if len(lines) != 1:
            claim = f"runtime/{file}: {function} has {len(lines)} lines with {piece!r}, not the one that the audit names"
            raise DerivationError(step.name, claim)
        found.append(Place(f"runtime/{file}", function, lines[0]))
    return found


@cache
def _of_runtime(file: str) -> dict[str, Source]:
    return functions(f"runtime/{file}", resources.files("hystrip").joinpath(file).read_text(encoding="utf-8"))

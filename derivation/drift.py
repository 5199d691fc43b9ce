"""Finding out whether the generated files on disk are what the derivation would write.

Two gates. Text: the emitted Python is compared byte by byte. Numbers: ``certificates.json`` holds a bound on the error of every
emitted function; the figures measured vary with the processor and with NumPy, so what is compared is that every function
has a certificate, made for this very solver, and (in the tests) that the error measured here stays below the bound.
"""

import difflib
import json
import os
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from .certificates import certified_names
from .derive import derive
from .emit import emit, input_hash
from .folder import AUDIT, CERTIFICATES, MEASURED, dumped, generated_folder, read_certificates, read_measured
from .model import Model
from .models import MODELS
from .outcome import Derivation
from .pages import audit_files
from .progress import Progress, Report

IGNORED = ("__pycache__",)


@dataclass(frozen=True)
class Drift:
    """One difference: ``kind`` is "missing", "stray" or "different"; ``diff`` is what would be written against what is."""

    kind: str
    path: str
    diff: str

    def __str__(self) -> str:
        return f"{self.kind}: {self.path}\n{self.diff}".rstrip()


def check(
    generated: str | os.PathLike[str] | None = None,
    models: Iterable[Model] | None = None,
    progress: Report | None = None,
) -> list[Drift]:
    """Compare the folder of generated files with what the derivation emits now; an empty list means no drift."""
    folder = Path(generated) if generated is not None else generated_folder()
    chosen = tuple(models) if models is not None else MODELS
    derivations = tuple(Progress(progress, len(chosen)).each(map(derive, chosen)))
    texts = emit(derivations)
    texts |= audit_texts(derivations, texts, _readable_certificates(folder), read_measured(folder))
    return compare(folder, texts, {d.model.name: certified_names(d) for d in derivations})


def compare(folder: Path, files: dict[str, str], functions: dict[str, list[str]]) -> list[Drift]:
    """Differences between the files in ``folder`` and the text of those that should be there."""
    found = {path.relative_to(folder).as_posix(): path for path in sorted(folder.rglob("*")) if _counts(path, folder)}
    drift = []
    for name, text in sorted(files.items()):
        if name not in found:
            drift.append(Drift("missing", name, _diff(name, "", text)))
        elif found[name].read_bytes() != text.encode():
            drift.append(Drift("different", name, _diff(name, found[name].read_bytes().decode(errors="replace"), text)))
    drift += certificate_drift(folder, functions) + _measured_drift(folder)
    for name in sorted(set(found) - set(files) - {CERTIFICATES, MEASURED}):
        drift.append(Drift("stray", name, _diff(name, found[name].read_bytes().decode(errors="replace"), "")))
    return drift


def certificate_drift(folder: Path, functions: dict[str, list[str]]) -> list[Drift]:
    path = folder / CERTIFICATES
    if not path.exists():
        return [Drift("missing", CERTIFICATES, "every emitted function needs a certificate: regenerate")]
    try:
        stored = json.loads(path.read_text(encoding="utf-8"))
        present = {model: list(entry["functions"]) for model, entry in stored["models"].items()}
        hash_stored, text_again = stored["hash"], dumped(stored)
    except (ValueError, KeyError, TypeError, AttributeError) as problem:
        return [Drift("different", CERTIFICATES, f"not a table of certificates: {problem!r}")]
    lines = []
    if hash_stored != input_hash():
        lines += [f"-hash {hash_stored}", f"+hash {input_hash()}"]
    for model in sorted(set(present) | set(functions)):
        has, wants = set(present.get(model, ())), set(functions.get(model, ()))
        lines += [f"-{model}.{name}" for name in sorted(has - wants)] + [f"+{model}.{name}" for name in sorted(wants - has)]
    if not lines and path.read_text(encoding="utf-8") != text_again:
        lines = list(_diff(CERTIFICATES, path.read_text(encoding="utf-8"), text_again).splitlines())
    return [Drift("different", CERTIFICATES, "\n".join(lines))] if lines else []


def _measured_drift(folder: Path) -> list[Drift]:
    path = folder / MEASURED
    if not path.exists():
        return [Drift("missing", MEASURED, "pictures and measured figures of the audit: run `hystrip audit`")]
    try:
        return (
            [] if isinstance(json.loads(path.read_text(encoding="utf-8")), dict) else [Drift("different", MEASURED, "no table")]
        )
    except ValueError as problem:
        return [Drift("different", MEASURED, f"not JSON: {problem}")]


def audit_texts(
    derivations: Iterable[Derivation], texts: dict[str, str], certificates: dict[str, Any], measured: dict[str, Any]
) -> dict[str, str]:
    """Text of the audit's pages and tables, by path in the folder of generated files."""
    solvers = {name: text for name, text in texts.items() if name.endswith(".py")}
    pages = audit_files(tuple(derivations), solvers, certificates, measured)
    return {f"{AUDIT}/{name}": text for name, text in pages.items()}


def _readable_certificates(folder: Path) -> dict[str, Any]:
    try:
        return read_certificates(folder / CERTIFICATES)
    except (ValueError, KeyError, TypeError):
        return {}  # and certificate_drift says so


def _counts(path: Path, folder: Path) -> bool:
    return path.is_file() and not set(path.relative_to(folder).parts) & set(IGNORED)


def _diff(name: str, before: str, after: str) -> str:
    lines = difflib.unified_diff(before.splitlines(), after.splitlines(), f"generated/{name}", f"regenerated/{name}", lineterm="")
    return "\n".join(lines)

"""Finding out whether the generated files on disk are what the derivation would write.

Two gates. Text: every file is compared byte by byte. Numbers: ``certificates.json`` holds a bound on the error of every
emitted function; the figures measured vary with the processor and with NumPy, so what is compared is that every function
has a certificate, made for this very solver, and (in the tests) that the error measured here stays below the bound.
"""

import difflib
import os
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from .certificates import SCALE, WORDS, certified_names
from .derive import Report, derivations_of
from .emit import emit, input_hash
from .folder import AUDIT, CERTIFICATES, MEASURED, dumped, folder_of, read_certificates, read_measured
from .model import Model
from .outcome import Derivation
from .pages import audit_files


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
    folder = folder_of(generated, "generated")
    derivations = derivations_of(models, progress)
    texts = emit(derivations)
    texts |= audit_texts(derivations, texts, _readable_certificates(folder), read_measured(folder))
    return compare(folder, texts, derivations)


def compare(folder: Path, texts: Mapping[str, str], derivations: Iterable[Derivation]) -> list[Drift]:
    """Differences between the files in ``folder`` and what should be there.

    These are the ``texts``, a certificate, not measured anew, for each function of the ``derivations``, and measured figures.
    """
    stored = _readable_certificates(folder)
    certificates = {}
    for derivation in derivations:
        name = derivation.model.name
        entry = stored.get(name, {"functions": {}})
        rows = {each: entry["functions"].get(each, "to be measured") for each in certified_names(derivation)}
        certificates[name] = entry | {"functions": rows}
    wanted = {**texts, CERTIFICATES: certificates_text(certificates), MEASURED: dumped(read_measured(folder))}
    files = (path for path in folder.rglob("*") if path.is_file() and path.parent.name != "__pycache__")
    found = {path.relative_to(folder).as_posix(): path.read_bytes() for path in files}
    drift = []
    for name in sorted(wanted.keys() | found.keys()):
        if name not in found:
            drift.append(Drift("missing", name, _diff(name, "", wanted[name])))
        elif name not in wanted or found[name] != wanted[name].encode():
            kind = "different" if name in wanted else "stray"
            drift.append(Drift(kind, name, _diff(name, found[name].decode(errors="replace"), wanted.get(name, ""))))
    return drift


def certificates_text(models: Mapping[str, Any]) -> str:
    """The certificates of models, with what the bounds mean and of which solver they are."""
    unit = f"ulp (2**-52) of the natural scale: {SCALE}"
    return dumped({"hash": input_hash(), "unit": unit, "domain": WORDS, "models": models})


def audit_texts(
    derivations: Iterable[Derivation], texts: dict[str, str], certificates: dict[str, Any], measured: dict[str, Any]
) -> dict[str, str]:
    """Text of the audit's pages and tables, by path in the folder of generated files."""
    solvers = {name: text for name, text in texts.items() if name.endswith(".py")}
    pages = audit_files(tuple(derivations), solvers, certificates, measured)
    return {f"{AUDIT}/{name}": text for name, text in pages.items()}


def _readable_certificates(folder: Path) -> dict[str, Any]:
    try:
        stored = read_certificates(folder)
        rows = [row.keys() for entry in stored.values() for row in entry["functions"].values()]
        return stored if all(keys >= {"bound", "points", "domain"} for keys in rows) else {}
    except (ValueError, KeyError, TypeError, AttributeError):
        return {}  # and the file is different from one


def _diff(name: str, before: str, after: str) -> str:
    lines = difflib.unified_diff(before.splitlines(), after.splitlines(), f"generated/{name}", f"regenerated/{name}", lineterm="")
    return "\n".join(lines)

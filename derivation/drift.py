"""Writing the generated files, and finding out whether those on disk are what the derivation would write.

Two gates. Text: the emitted Python is compared byte by byte. Numbers: ``certificates.json`` holds a bound on the error of every
emitted function; the figures measured vary with the processor and with NumPy, so what is compared is that every function
has a certificate, made for this very solver, and (in the tests) that the error measured here stays below the bound.
"""

from __future__ import annotations

import difflib
import importlib.util
import json
import os
import shutil
import tempfile
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType
from typing import Any

from .certificates import SCALE, WORDS, Certificate, certificates_of, certified_names, domain, modes_of
from .derive import derive, stages_of
from .emit import INTERFACE, emit, input_hash
from .model import Model
from .model_file import require_names
from .models import MODELS
from .outcome import Derivation
from .pages import audit_files

CERTIFICATES = "certificates.json"
AUDIT = "audit"
MEASURED = f"{AUDIT}/measured.json"  # pictures and measured figures of the pages, which `hystrip audit` makes anew
AIM = 16.0  # ulp of the natural scale
IGNORED = ("__pycache__",)
HELPERS = ("stable", "modes")  # what a solver imports
SHARES = 40  # in which the certificates of a model are reported; a stage of its derivation is one
Report = Callable[[int, int], None]


class Progress:
    """Counts finished stages for a caller that wants (done, total)."""

    def __init__(self, report: Report | None, total: int):
        self._report, self._done, self._total = report, 0, total

    def __call__(self, stage: str = "") -> None:
        self._done += 1
        if self._report is not None:
            self._report(self._done, self._total)


def _counted(certificates: Iterable[Certificate], count: int, say: Progress) -> Iterator[Certificate]:
    """The ``count`` certificates of a model, reported in so many shares as they are made."""
    reported = 0
    for number, certificate in enumerate(certificates, start=1):
        yield certificate
        while reported < number * SHARES // count:
            say("certificates")
            reported += 1


class CertificateError(Exception):
    """An emitted function is less accurate than its stored bound."""


@dataclass(frozen=True)
class Drift:
    """One difference: ``kind`` is "missing", "stray" or "different"; ``diff`` is what would be written against what is."""

    kind: str
    path: str
    diff: str

    def __str__(self) -> str:
        return f"{self.kind}: {self.path}\n{self.diff}".rstrip()


def generated_folder() -> Path:
    """Where the solvers of the package live."""
    found = importlib.util.find_spec("hystrip.generated")
    if found is None or found.origin is None:
        raise FileNotFoundError("the package hystrip.generated is not installed")
    return Path(found.origin).parent


def regenerate(
    out_dir: str | os.PathLike[str] | None = None,
    models: Iterable[Model] | None = None,
    progress: Report | None = None,
    accept: dict[str, str] | None = None,
) -> list[Path]:
    """Derive, emit and certify the solvers of ``models`` (those that ship) into ``out_dir``; returns the files written.

    Nothing is written unless everything succeeded. A folder that does not exist yet is written aside and renamed as a whole, in
    one that does each file is. Raises :class:`DerivationError` for an inadmissible model, :class:`CertificateError` for a
    function that is not accurate enough, and :class:`FileExistsError` for a folder that holds something else. A bound in an
    existing
    ``certificates.json`` grows only for a function in ``accept``, which says why: ``{"module.function": "reason"}``.
    ``progress`` is called with (done, in all): stages of the derivation, then shares of the certificates.
    """
    chosen = tuple(models) if models is not None else MODELS
    require_names(chosen)
    target = Path(out_dir) if out_dir is not None else generated_folder()
    require_folder(target)
    say = Progress(progress, sum(len(stages_of(model)) + SHARES for model in chosen) + 2)
    derivations = tuple(derive(model, say) for model in chosen)
    files = emit(derivations)
    say("emission")
    with tempfile.TemporaryDirectory() as aside:
        folder = _staged(Path(aside), files)
        stored = read_certificates(target / CERTIFICATES)
        certificates = {}
        for derivation in derivations:
            solver = _loaded(folder, derivation.model.name)
            measured = _counted(certificates_of(derivation, solver), len(certified_names(derivation)), say)
            rows = bounds_of(derivation.model.name, measured, stored, accept or {})
            certificates[derivation.model.name] = {
                "interface": INTERFACE,
                "modes": list(modes_of(derivation.model)),
                "functions": rows,
            }
    files[CERTIFICATES] = _certificates_text(certificates)
    known = read_measured(target) or read_measured(generated_folder())
    measured = {name: known[name] for name in certificates if name in known}
    files |= audit_texts(derivations, files, certificates, measured)
    files[MEASURED] = dumped(measured)
    written = write_files(target, files) if target.exists() else write_folder(target, files)
    say("writing")
    return written


def require_folder(target: Path) -> None:
    """Raise an error unless solvers can be written there: a new or empty folder, or one that holds solvers."""
    if target.is_dir():
        if any(target.iterdir()) and not (target / CERTIFICATES).is_file():
            raise FileExistsError(f"{target} holds files, but no solver: name a new folder")
    elif target.exists():
        raise FileExistsError(f"{target} is a file: name a folder")


def check(
    generated: str | os.PathLike[str] | None = None,
    models: Iterable[Model] | None = None,
    progress: Report | None = None,
) -> list[Drift]:
    """Compare the folder of generated files with what the derivation emits now; an empty list means no drift."""
    folder = Path(generated) if generated is not None else generated_folder()
    chosen = tuple(models) if models is not None else MODELS
    say = Progress(progress, sum(len(stages_of(model)) for model in chosen))
    derivations = tuple(derive(model, say) for model in chosen)
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


def stored_bounds(folder: Path | None = None) -> dict[str, dict[str, float]]:
    """Bounds in ulp of the natural scale, by model and function."""
    stored = read_certificates((folder or generated_folder()) / CERTIFICATES)
    return {model: {name: row["bound"] for name, row in entry["functions"].items()} for model, entry in stored.items()}


def bounds_of(
    model: str, certificates: Iterable[Certificate], stored: dict[str, Any], accept: dict[str, str]
) -> dict[str, dict[str, Any]]:
    """Hold what was measured to the ``stored`` bounds; a function without a bound gets one."""
    before = stored.get(model, {}).get("functions", {})
    rows = {}
    for certificate in certificates:
        name, worst = certificate.name, certificate.worst
        row = {key: value for key, value in before.get(name, {"bound": _bound(worst)}).items() if key in ("bound", "why")}
        why = accept.get(f"{model}.{name}")
        if worst > row["bound"]:
            if why is None:
                raise CertificateError(
                    f"{model}.{name} is off by {worst:.3g} ulp of its natural scale, beyond its stored bound "
                    f"{row['bound']:g}, at {certificate.where}. Find a better form, or say why it may grow."
                )
            row = {"bound": _bound(worst), "why": why}
        if row["bound"] > AIM and "why" not in row:
            raise CertificateError(f"{model}.{name}: {worst:.3g} ulp, too near to the aim of {AIM:g} without a reason given")
        rows[name] = {**row, "points": certificate.points, "domain": domain(certificate.args)}
    return rows


def _bound(worst: float) -> float:
    """Half as much again as was measured, on the ladder 8, 12, 16, 24, ...: processors and libraries differ by an ulp.

    At least 8, because a few hundred points do not find the worst of all: of 15,000 random points beyond the grid most functions
    stayed below 2, contact_work reached 7.3.
    """
    ladder = (step * 2.0**octave for octave in range(3, 60) for step in (1.0, 1.5))
    return next((bound for bound in ladder if bound >= 1.5 * worst), float("inf"))


def _certificates_text(models: dict[str, Any]) -> str:
    unit = f"ulp (2**-52) of the natural scale: {SCALE}"
    return dumped({"hash": input_hash(), "unit": unit, "domain": WORDS, "models": models})


def dumped(content: Any) -> str:
    return json.dumps(content, indent=1, sort_keys=True) + "\n"


def read_certificates(path: Path) -> dict[str, Any]:
    return json.loads(path.read_text(encoding="utf-8"))["models"] if path.exists() else {}


def _readable_certificates(folder: Path) -> dict[str, Any]:
    try:
        return read_certificates(folder / CERTIFICATES)
    except (ValueError, KeyError, TypeError):
        return {}  # and certificate_drift says so


def read_measured(folder: Path) -> dict[str, Any]:
    """What was measured and drawn for the pages in a folder of generated files, by model; empty if nothing can be read."""
    try:
        stored = json.loads((folder / MEASURED).read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return {}
    return stored if isinstance(stored, dict) else {}


def _staged(folder: Path, files: dict[str, str]) -> Path:
    package = folder / "candidate"
    package.mkdir()
    for name, text in files.items():
        (package / name).parent.mkdir(parents=True, exist_ok=True)
        (package / name).write_bytes(text.encode())
    return package


def _loaded(package: Path, name: str) -> ModuleType:
    """Import ``name`` from a folder that is no installed package, without leaving a trace in ``sys.modules``."""
    import sys

    root = f"_hystrip_candidate_{abs(hash(str(package)))}"
    try:
        for module, path in (
            (root, package / "__init__.py"),
            *((f"{root}.{helpers}", package / f"{helpers}.py") for helpers in HELPERS if (package / f"{helpers}.py").exists()),
            (f"{root}.{name}", package / f"{name}.py"),
        ):
            spec = importlib.util.spec_from_file_location(
                module, path, submodule_search_locations=[str(package)] if module == root else None
            )
            loaded = importlib.util.module_from_spec(spec)
            sys.modules[module] = loaded
            spec.loader.exec_module(loaded)
        return loaded
    finally:
        for module in [m for m in sys.modules if m == root or m.startswith(f"{root}.")]:
            del sys.modules[module]


def write_files(folder: Path, files: dict[str, str]) -> list[Path]:
    """Write each file aside and rename it into place."""
    return [_write(folder / name, text) for name, text in sorted(files.items())]


def write_folder(folder: Path, files: dict[str, str]) -> list[Path]:
    """Write a new folder aside and rename it into place."""
    folder.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=folder.parent, prefix=f".{folder.name}.") as aside:
        whole = Path(aside) / folder.name
        whole.mkdir()
        write_files(whole, files)
        os.replace(whole, folder)
    return [folder / name for name in sorted(files)]


def _write(path: Path, text: str) -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    handle, aside = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name}.")
    try:
        with os.fdopen(handle, "wb") as stream:
            stream.write(text.encode())
        shutil.copymode(path, aside) if path.exists() else os.chmod(aside, 0o644)
        os.replace(aside, path)
    except BaseException:
        Path(aside).unlink(missing_ok=True)
        raise
    return path


def _counts(path: Path, folder: Path) -> bool:
    return path.is_file() and not set(path.relative_to(folder).parts) & set(IGNORED)


def _diff(name: str, before: str, after: str) -> str:
    lines = difflib.unified_diff(before.splitlines(), after.splitlines(), f"generated/{name}", f"regenerated/{name}", lineterm="")
    return "\n".join(lines)

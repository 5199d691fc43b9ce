"""The folder of generated files: where it is, what stands in it, and how it is written."""

import importlib
import json
import os
import sys
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from importlib import resources
from pathlib import Path
from types import ModuleType
from typing import Any

from hystrip.files import path_of

CERTIFICATES = "certificates.json"
AUDIT = "audit"
MEASURED = f"{AUDIT}/measured.json"  # pictures and measured figures of the pages, which `hystrip audit` makes anew
FIGURES = ("pictures", "tables", "versions")  # of a model in it


def generated_folder() -> Path:
    """Where the solvers of the package live."""
    return Path(str(resources.files("hystrip.generated")))


def folder_of(given: str | os.PathLike[str] | None, field: str) -> Path:
    """The folder that was ``given``, or where the solvers of the package live."""
    return path_of(given, field, "a folder") if given is not None else generated_folder()


def require_folder(target: Path) -> None:
    """Raise an error unless solvers can be written there: a new or empty folder, or one that holds solvers."""
    if target.is_dir():
        if any(target.iterdir()) and not (target / CERTIFICATES).is_file():
            raise FileExistsError(f"{target} holds files, but no solver: name a new folder")
    elif target.exists():
        raise FileExistsError(f"{target} is a file: name a folder")


def dumped(content: Any) -> str:
    return json.dumps(content, indent=1, sort_keys=True) + "\n"


def read_certificates(folder: Path) -> dict[str, Any]:
    """Certificates by model in a folder of generated files, if it has any."""
    path = folder / CERTIFICATES
    return json.loads(path.read_text(encoding="utf-8"))["models"] if path.exists() else {}


def stored_bounds(folder: str | os.PathLike[str] | None = None) -> dict[str, dict[str, float]]:
    """Bounds in ulp of the natural scale, by model and function."""
    stored = read_certificates(folder_of(folder, "folder"))
    return {model: {name: float(row["bound"]) for name, row in entry["functions"].items()} for model, entry in stored.items()}


def read_measured(folder: Path) -> dict[str, Any]:
    """What was measured and drawn for the pages in a folder of generated files, by model; empty if nothing can be read."""
    try:
        stored = json.loads((folder / MEASURED).read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return {}
    entries = stored.values() if isinstance(stored, dict) else (None,)
    whole = all(isinstance(entry, dict) and all(isinstance(entry.get(part), dict) for part in FIGURES) for entry in entries)
    return stored if whole else {}


@contextmanager
def importable(files: dict[str, str]) -> Iterator[Callable[[str], ModuleType]]:
    """Import emitted modules by name from a package that lasts as long as the context and leaves no trace."""
    with tempfile.TemporaryDirectory(prefix="hystrip_") as aside:
        package = f"_{Path(aside).name}"
        write_files(Path(aside) / package, files)
        sys.path.insert(0, aside)
        try:
            yield lambda name: importlib.import_module(f"{package}.{name}")
        finally:
            sys.path.remove(aside)
            for module in [name for name in sys.modules if name.partition(".")[0] == package]:
                del sys.modules[module]


def write_files(folder: Path, files: dict[str, str]) -> list[Path]:
    """Write all files aside; then rename a new folder into place as a whole, in one that exists each file."""
    new = not folder.exists()
    beside = folder.parent if new else folder
    beside.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=beside, prefix=f".{folder.name}.") as aside:
        whole = Path(aside) / folder.name
        for name, text in files.items():
            (whole / name).parent.mkdir(parents=True, exist_ok=True)
            (whole / name).write_bytes(text.encode())
        if new:
            os.replace(whole, folder)
        else:
            for name in files:
                (folder / name).parent.mkdir(parents=True, exist_ok=True)
                os.replace(whole / name, folder / name)
    return [folder / name for name in sorted(files)]

"""Writing the audit: pages, JSON, and the pictures and figures that only the running solver can supply."""

import os
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

from ..derive import Report, derivations_of
from ..drift import compare
from ..emit import emit
from ..folder import AUDIT, MEASURED, dumped, folder_of, generated_folder, read_certificates, read_measured, write_files
from ..model import Model
from .render import audit_files

KEPT = ("figure_6",)  # measured tables that take minutes and have a command of their own, tools/figure6.py


class AuditError(Exception):
    """The installed solver is not the one that would be audited."""


def audit(
    out_dir: str | os.PathLike[str] | None = None,
    models: Iterable[Model] | None = None,
    progress: Report | None = None,
    measure: Callable[[str], dict[str, Any] | None] | None = None,
) -> list[Path]:
    """Derive, verify and write the audit into ``out_dir`` (the generated folder's own); returns the files written.

    ``measure``, if given: pictures and measured figures of a model, by its name, or None where there are none.

    Raises :class:`DerivationError` at the first step that does not verify, and :class:`AuditError` unless the installed
    solver and its certificates are those of this derivation.
    """
    installed = generated_folder()
    target = folder_of(out_dir if out_dir is not None else installed / AUDIT, "out_dir")
    derivations = derivations_of(models, progress)
    texts = emit(derivations)
    drift = compare(installed, texts, derivations)
    stale = [record.path for record in drift if record.kind != "stray" and not record.path.startswith(AUDIT)]
    if stale:
        raise AuditError(f"{', '.join(stale)} in {installed} is not what the derivation emits; run `hystrip regenerate` first")
    names = [derivation.model.name for derivation in derivations]
    found = {name: figures for name in names if measure is not None and (figures := measure(name)) is not None}
    for name, stored in read_measured(installed).items():
        if name in found:
            found[name]["tables"] |= {table: rows for table, rows in stored.get("tables", {}).items() if table in KEPT}
    pages = audit_files(derivations, texts, read_certificates(installed), found)
    pages[Path(MEASURED).name] = dumped(found)
    return write_files(target, pages)

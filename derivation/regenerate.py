"""Deriving, emitting and certifying solvers, and writing them."""

import os
from collections.abc import Iterable
from math import isfinite
from pathlib import Path
from typing import Any

from .certificates import SCALE, WORDS, Certificate, certificates_of, certified_names, domain, modes_of
from .derive import derive
from .drift import audit_texts
from .emit import INTERFACE, emit, input_hash
from .folder import (
    CERTIFICATES,
    MEASURED,
    dumped,
    generated_folder,
    importable,
    read_certificates,
    read_measured,
    require_folder,
    write_files,
    write_folder,
)
from .model import Model
from .model_file import require_names
from .models import MODELS
from .progress import SHARES, Progress, Report

AIM = 16.0  # ulp of the natural scale


class CertificateError(Exception):
    """An emitted function is less accurate than its stored bound."""


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
    existing ``certificates.json`` grows only for a function in ``accept``, which says why: ``{"module.function": "reason"}``.
    ``progress`` is called with (done, in all): models derived, then shares of their certificates.
    """
    chosen = tuple(models) if models is not None else MODELS
    require_names(chosen)
    target = Path(out_dir) if out_dir is not None else generated_folder()
    require_folder(target)
    say = Progress(progress, (1 + SHARES) * len(chosen) + 2)
    derivations = tuple(say.each(map(derive, chosen)))
    files = emit(derivations)
    say()
    certificates = {}
    with importable(files) as solver:
        stored = read_certificates(target / CERTIFICATES)
        for derivation in derivations:
            name = derivation.model.name
            measured = say.counted(certificates_of(derivation, solver(name)), len(certified_names(derivation)))
            rows = bounds_of(name, measured, stored, accept or {})
            certificates[name] = {"interface": INTERFACE, "modes": list(modes_of(derivation.model)), "functions": rows}
    files[CERTIFICATES] = _certificates_text(certificates)
    known = read_measured(target) or read_measured(generated_folder())
    measured = {name: known[name] for name in certificates if name in known}
    files |= audit_texts(derivations, files, certificates, measured)
    files[MEASURED] = dumped(measured)
    written = write_files(target, files) if target.exists() else write_folder(target, files)
    say()
    return written


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
        if not isfinite(worst):
            raise CertificateError(f"{model}.{name} overflows, or is no number, at {certificate.where}. Find a better form.")
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

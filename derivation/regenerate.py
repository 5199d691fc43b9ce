"""Deriving, emitting and certifying solvers, and writing them."""

import difflib
import os
from collections.abc import Iterable
from math import isfinite
from pathlib import Path
from typing import Any

from hystrip.errors import InputError

from .certificates import Certificate, certificates_of, certified_names, domain, modes_of
from .derive import Report, derivations_of, reported
from .drift import audit_texts, certificates_text
from .emit import INTERFACE, emit
from .folder import (
    CERTIFICATES,
    MEASURED,
    dumped,
    folder_of,
    generated_folder,
    importable,
    read_certificates,
    read_measured,
    require_folder,
    write_files,
)
from .model import Model
from .outcome import Derivation

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

    Nothing is written unless everything succeeded (:func:`.folder.write_files`). Raises :class:`DerivationError` for an
    inadmissible model, :class:`CertificateError` for a function that is not accurate enough, and :class:`FileExistsError` for a
    folder that holds something else. A bound in an existing ``certificates.json`` grows only for a function in ``accept``, which
    says why: ``{"module.function": "reason"}``. ``progress`` is called with (done, in all): of the models to derive, then of
    the functions of each to measure.
    """
    target = folder_of(out_dir, "out_dir")
    require_folder(target)
    accepted = {} if accept is None else accept
    if not (isinstance(accepted, dict) and all(isinstance(text, str) for text in (*accepted, *accepted.values()))):
        raise InputError("accept", accept, 'a dictionary {"module.function": "reason"}, or None')
    derivations = derivations_of(models, progress)
    require_certified(accepted, derivations)
    files = emit(derivations)
    certificates = {}
    with importable(files) as solver:
        stored = read_certificates(target)
        for derivation in derivations:
            name = derivation.model.name
            measured = reported(certificates_of(derivation, solver(name)), progress, len(certified_names(derivation)))
            rows = bounds_of(name, measured, stored, accepted)
            certificates[name] = {"interface": INTERFACE, "modes": list(modes_of(derivation.model)), "functions": rows}
    files[CERTIFICATES] = certificates_text(certificates)
    known = read_measured(target) or read_measured(generated_folder())
    figures = {name: known[name] for name in certificates if name in known}
    files |= audit_texts(derivations, files, certificates, figures)
    files[MEASURED] = dumped(figures)
    return write_files(target, files)


def require_certified(accept: dict[str, str], derivations: Iterable[Derivation]) -> None:
    """Raise :class:`hystrip.InputError` unless every key of ``accept`` is a function that has a bound."""
    known = [f"{derivation.model.name}.{name}" for derivation in derivations for name in certified_names(derivation)]
    for key in accept:
        if key not in known:
            near = difflib.get_close_matches(key, known) or known[:3]
            raise InputError("accept", key, f'functions that have a bound, as "module.function", such as {", ".join(near)}')


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

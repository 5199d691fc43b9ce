"""The derivation of the shipped models, made once per test session; and patched copies of it."""

from __future__ import annotations

import functools
import importlib
import itertools
import json
import shutil
import sys
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest
from mpmath.libmp import libelefun

import hystrip.derivation
from hystrip.derivation import MODELS, STANDARD_LINEAR_SOLID, Derivation, derive, generated_folder
from hystrip.derivation.drift import audit_texts
from hystrip.derivation.emit import emit
from hystrip.derivation.folder import read_certificates, read_measured

SOURCES = Path(hystrip.derivation.__file__).parent
_copies = itertools.count()


@functools.cache
def derivation() -> Derivation:
    return derive(STANDARD_LINEAR_SOLID)


@functools.cache
def derivations() -> tuple[Derivation, ...]:
    """Of every model that ships."""
    return tuple(derivation() if model is STANDARD_LINEAR_SOLID else derive(model) for model in MODELS)


@functools.cache
def emitted() -> dict[str, str]:
    return emit(derivations())


@functools.cache
def audited() -> dict[str, str]:
    """The audit's pages as they should be, with the certificates and the measured figures that are checked in."""
    folder = generated_folder()
    return audited_with(read_certificates(folder), read_measured(folder))


def audited_with(certificates: dict[str, Any], measured: dict[str, Any]) -> dict[str, str]:
    """The audit's pages with these certificates and measured figures."""
    return _audited_with(json.dumps((certificates, measured)))


@functools.cache
def _audited_with(figures: str) -> dict[str, str]:
    return audit_texts(derivations(), emitted(), *json.loads(figures))


@pytest.fixture(scope="module")
def series_once():
    """Exponentials and sines of many digits, each computed once. Three of four are asked for again, as a function is evaluated
    at a point and, for its scale, next to it in one input: they are told by argument, precision and kind, all integers."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(libelefun, "exponential_series", functools.lru_cache(2**16)(libelefun.exponential_series))
        yield


def tampered(folder: Path, file: str, before: str, after: str) -> ModuleType:
    """Import a copy of the derivation in which ``before``, found exactly once in ``file``, reads ``after``."""
    name = f"tampered_{next(_copies)}"
    shutil.copytree(SOURCES, folder / name, ignore=shutil.ignore_patterns("__pycache__"))
    path = folder / name / file
    text = path.read_text(encoding="utf-8")
    assert text.count(before) == 1, f"{before!r} is in {file} {text.count(before)} times"
    path.write_text(text.replace(before, after), encoding="utf-8")
    sys.path.insert(0, str(folder))
    try:
        return importlib.import_module(name)
    finally:
        sys.path.remove(str(folder))


def altered(file: str, before: str, after: str) -> ModuleType:
    """One module of the derivation in which ``before``, found exactly once in ``file``, reads ``after``; no other is changed."""
    text = (SOURCES / file).read_text(encoding="utf-8")
    assert text.count(before) == 1, f"{before!r} is in {file} {text.count(before)} times"
    name = f"{hystrip.derivation.__name__}.altered_{next(_copies)}"
    module = sys.modules[name] = ModuleType(name)
    module.__package__ = hystrip.derivation.__name__
    exec(compile(text.replace(before, after), str(SOURCES / file), "exec"), vars(module))
    return module

"""A sweep on disk: one file for every finished batch, each either whole or not there."""

from __future__ import annotations

import contextlib
import hashlib
import json
import os
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import HystripError, InputError


class Store:
    """The folder ``<out>/<name>.parts`` of a sweep.

    ``plan.json`` says whose parts these are. A part is written aside, flushed to the disk and renamed, and carries a
    checksum: after a kill or a power cut it is whole, absent, or known to be damaged and solved again.
    """

    def __init__(self, folder: Path, fingerprint: str, about: dict[str, Any]):
        self.folder, self.fingerprint, self._about = folder, fingerprint, about

    @contextlib.contextmanager
    def open(self, restart: bool = False) -> Iterator[None]:
        """Make the folder or check that it belongs to this sweep, and keep other processes out while it is used."""
        self.folder.mkdir(parents=True, exist_ok=True)
        with _locked(self.folder / "lock"):
            plan = self.folder / "plan.json"
            if restart:
                for path in (plan, *self.folder.glob("part-*.json")):
                    path.unlink(missing_ok=True)
            if plan.exists() and not self._ours(plan):
                raise InputError("--out", str(self.folder), "results of this very sweep; these are of another scene or version "
                                 "(--restart deletes them, or give another --out)")  # fmt: skip
            if not plan.exists():
                _write(plan, json.dumps({"fingerprint": self.fingerprint, **self._about}, indent=1))
            for left in self.folder.glob("*.tmp"):
                left.unlink(missing_ok=True)
            yield

    def _ours(self, plan: Path) -> bool:
        try:
            return json.loads(plan.read_text(encoding="utf-8")).get("fingerprint") == self.fingerprint
        except (ValueError, AttributeError):
            return False

    def path(self, number: int) -> Path:
        return self.folder / f"part-{number:06d}.json"

    def write(self, number: int, numbers: np.ndarray, reasons: dict[int, str]) -> None:
        """Store a finished batch."""
        body = json.dumps({"numbers": numbers.tolist(), "failed": {str(row): reason for row, reason in sorted(reasons.items())}})
        _write(self.path(number), f"{hashlib.sha256(body.encode()).hexdigest()}\n{body}\n")

    def read(self, number: int) -> tuple[np.ndarray, dict[int, str]] | None:
        """A stored batch, or None if it is not there or not whole."""
        try:
            check, body = self.path(number).read_text(encoding="utf-8").split("\n", 1)
        except (OSError, ValueError):
            return None
        body = body.rstrip("\n")
        if hashlib.sha256(body.encode()).hexdigest() != check:
            return None
        content = json.loads(body)
        return np.array(content["numbers"], dtype=float), {int(row): reason for row, reason in content["failed"].items()}


def _write(path: Path, text: str) -> None:
    aside = path.with_name(f"{path.name}.{os.getpid()}.tmp")
    try:
        with open(aside, "w", encoding="utf-8", newline="\n") as file:
            file.write(text)
            file.flush()
            os.fsync(file.fileno())
        os.replace(aside, path)
    finally:
        aside.unlink(missing_ok=True)


@contextlib.contextmanager
def _locked(path: Path) -> Iterator[None]:
    with open(path, "a") as file:
        try:
            import fcntl
        except ImportError:  # Windows has no such lock: two runs of one sweep at once are the user's to avoid
            yield
            return
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)  # released by the system even when a run is killed
        except OSError:
            raise HystripError(f"{path.parent}: another run of this sweep is at work there") from None
        yield

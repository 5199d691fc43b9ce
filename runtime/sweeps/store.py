"""A sweep on disk: one file for every finished batch, each either whole or not there."""

import contextlib
import hashlib
import json
import os
import secrets
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import HystripError, InputError
from ..extras import require
from ..files import named, synced
from .batch import Batch


class Store:
    """The folder ``<out>/<name>.parts`` of a sweep.

    ``plan.json`` says whose parts these are, and which run is at work on them. A part is written aside, flushed to the
    disk and renamed. Its checksum covers the fingerprint of its sweep and its place in it: after a kill or a power cut, and
    whatever was copied there, it is this very part, or it is not read.
    """

    def __init__(self, folder: Path, fingerprint: str, about: dict[str, Any]):
        self.folder, self.fingerprint, self._about = folder, fingerprint, about
        self._run = secrets.token_hex(8)

    @contextlib.contextmanager
    def open(self, restart: bool = False) -> Iterator[None]:
        """Make the folder or check that it belongs to this sweep, and keep other processes out while it is used."""
        filelock = require("filelock", "cli", "a sweep")
        self.folder.mkdir(parents=True, exist_ok=True)
        lock = filelock.FileLock(self.folder / "lock", timeout=0)  # released by the system even when a run is killed
        try:
            lock.acquire()
        except filelock.Timeout:
            raise HystripError(f"{self.folder}: another run of this sweep is at work there") from None
        try:
            self._claim(restart)
            yield
        finally:
            lock.release()

    def _claim(self, restart: bool) -> None:
        parts, plan = [*self.folder.glob("part-*.json")], self.folder / "plan.json"
        if restart:
            for path in (*parts, plan):  # the plan last: as long as there are parts it says whose they are
                path.unlink(missing_ok=True)
        else:
            theirs = self._plan().get("fingerprint")
            if theirs != self.fingerprint and (theirs is not None or parts):
                held = "these are of another scene or version" if theirs else "these are parts without a plan"
                raise InputError("out", str(self.folder), f"results of this very sweep; {held} "
                                 "(restart=True (--restart) deletes them; or give another folder)")  # fmt: skip
        for left in self.folder.glob("*.tmp"):
            left.unlink(missing_ok=True)
        _write(plan, json.dumps({"fingerprint": self.fingerprint, "run": self._run, **self._about}, indent=1))

    def _plan(self) -> dict[str, Any]:
        """What ``plan.json`` holds; nothing if it is not there or not readable."""
        try:
            plan = json.loads((self.folder / "plan.json").read_text(encoding="utf-8"))
        except (OSError, ValueError):
            return {}
        return plan if isinstance(plan, dict) else {}

    def require_ours(self) -> None:
        """``HystripError`` unless this run is still the one at work in the folder."""
        if self._plan().get("run") != self._run:
            raise HystripError(f"{self.folder}: the folder was removed, or taken over by another run, while this sweep ran")

    def path(self, first: int) -> Path:
        """File of the batch that begins with the point ``first``."""
        return self.folder / f"part-{first:09d}.json"

    def write(self, batch: Batch) -> None:
        """Store a finished batch."""
        self.require_ours()
        body = json.dumps({
            "sweep": self.fingerprint,
            "first": batch.first,
            "points": batch.points,
            "work": batch.work,
            "columns": {column: values.tolist() for column, values in batch.columns.items()},
            "failed": {str(row): reason for row, reason in sorted(batch.failed.items())},
        })  # fmt: skip
        _write(self.path(batch.first), f"{hashlib.sha256(body.encode()).hexdigest()}\n{body}\n")

    def read(self, first: int, points: int) -> Batch | None:
        """The stored batch of so many points from ``first`` on, or None if it is not there, not whole, or not this one."""
        try:
            check, body = self.path(first).read_text(encoding="utf-8").split("\n", 1)
        except (OSError, ValueError):
            return None
        body = body.rstrip("\n")
        if hashlib.sha256(body.encode()).hexdigest() != check:
            return None
        content = json.loads(body)
        if not isinstance(content, dict) or [content.get(key) for key in ("sweep", "first", "points")] != [
            self.fingerprint, first, points,
        ]:  # fmt: skip
            return None
        columns = {column: np.array(values, dtype=float) for column, values in content["columns"].items()}
        failed = {int(row): reason for row, reason in content["failed"].items()}
        return Batch(first, points, columns, failed, content["work"])


def _write(path: Path, text: str) -> None:
    aside = path.with_name(f"{path.name}.{os.getpid()}.tmp")
    with named(path):
        try:
            aside.write_text(text, encoding="utf-8", newline="\n")
            synced(aside)
            os.replace(aside, path)
        finally:
            with contextlib.suppress(OSError):
                aside.unlink(missing_ok=True)

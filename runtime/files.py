"""Files that are either there and whole, or not there."""

from __future__ import annotations

import os
import shutil
from pathlib import Path
from types import TracebackType

from hystrip.errors import InputError


class Outputs:
    """A set of files in one folder that appear together, or not at all.

    Each is written aside under a hidden name; on leaving the ``with`` block without an error all are renamed into
    place. On an error nothing is left, not even a folder that was made for them.

    Parameters
    ----------
    folder : where the files go; made if need be
    """

    def __init__(self, folder: str | os.PathLike[str]):
        self.folder = Path(folder)
        self._parts: dict[Path, Path] = {}
        self._made: Path | None = None

    def path(self, name: str) -> Path:
        """Where to write the file that will be called `name`. The name keeps its suffix."""
        part = self.folder / f".{os.getpid()}.part.{name}"
        self._parts[self.folder / name] = part
        return part

    def __enter__(self) -> Outputs:
        missing = [each for each in (self.folder, *self.folder.parents) if not each.exists()]
        self.folder.mkdir(parents=True, exist_ok=True)
        self._made = missing[-1] if missing else None
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None) -> None:
        try:
            if kind is None:
                for final, part in self._parts.items():
                    os.replace(part, final)
        finally:
            for part in self._parts.values():
                part.unlink(missing_ok=True)
            if kind is not None and self._made is not None:
                shutil.rmtree(self._made, ignore_errors=True)


def write_text(path: str | os.PathLike[str], text: str) -> None:
    """Write a text file (UTF-8, line feeds) aside and rename it into place."""
    target = Path(path)
    with Outputs(target.parent) as outputs:
        outputs.path(target.name).write_text(text, encoding="utf-8", newline="\n")


def refuse_unwritable(folder: str | os.PathLike[str], field: str) -> None:
    """Raise InputError, naming `field`, if files cannot be put into `folder` or it cannot be made."""
    path = Path(folder)
    nearest = next(each for each in (path, *path.absolute().parents) if each.exists())
    if not nearest.is_dir():
        raise InputError(field, str(folder), f"a folder; {nearest} is a file")
    if not os.access(nearest, os.W_OK | os.X_OK):
        raise InputError(field, str(folder), f"a folder that can be written to; {nearest} cannot")

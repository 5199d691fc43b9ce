"""Files that are either there and whole, or not there."""

from __future__ import annotations

import contextlib
import errno
import os
from pathlib import Path
from types import TracebackType

from .errors import InputError


class Outputs:
    """A set of files in one folder that appear together, or not at all.

    Each is written aside under a hidden name; on leaving the ``with`` block without an error all are renamed into
    place. On an error nothing is left, not even a folder that was made for them (unless somebody else put something
    there).

    Parameters
    ----------
    folder : where the files go; made if need be
    """

    def __init__(self, folder: str | os.PathLike[str]):
        self.folder = Path(folder)
        self._parts: dict[Path, Path] = {}
        self._made: list[Path] = []

    def path(self, name: str) -> Path:
        """Where to write the file that will be called `name`. The name keeps its suffix."""
        part = self.folder / f".{os.getpid()}.part.{name}"
        self._parts[self.folder / name] = part
        return part

    def __enter__(self) -> Outputs:
        self._made = [each for each in (self.folder, *self.folder.parents) if not each.exists()]
        self.folder.mkdir(parents=True, exist_ok=True)
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None) -> None:
        placed = False
        try:
            if kind is None:
                for final in self._parts:  # the one thing that would stop the renaming half-way
                    if final.is_dir():
                        raise IsADirectoryError(errno.EISDIR, "a folder stands where the file would go", str(final))
                for final, part in self._parts.items():
                    os.replace(part, final)
                placed = True
        finally:
            for part in self._parts.values():
                part.unlink(missing_ok=True)
            if not placed:
                with contextlib.suppress(OSError):  # not empty: another run writes there too
                    for folder in self._made:
                        folder.rmdir()


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

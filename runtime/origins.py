"""Which input each file of an output folder was made from: results of one input never take the place of another's."""

import contextlib
import json
import os
from collections.abc import Iterator, Sequence
from pathlib import Path

from .errors import InputError
from .extras import require
from .files import Outputs, read_at_most

#: hidden files in the output folder. Of names -> the input, as a path from the folder on, or the name of a built-in scene; and
#: held by the run that puts its files there, released by the system even when it is killed
_INDEX, _LOCK = ".origins.json", ".origins.lock"


def refuse_other_origin(out: Path, names: Sequence[str], source: str | os.PathLike[str]) -> None:
    """Raise InputError if a file of these names is there that was made from another input of the same stem, or a folder is, or
    a table that hystrip has not written: measured data, say."""
    known, mine = _read(out), _origin(out, source)
    for name in names:
        if (out / name).is_dir():
            raise InputError("out", str(out), f"another folder: {name} in it is a folder, not a file to replace")
        if name.endswith(".csv") and (out / name).is_file() and read_at_most(out / name, 8) != b"# hystrip":
            raise InputError("out", str(out), f"another folder: {name} in it was not written by this version of hystrip")
        for there, other in known.items():
            # names that differ in case alone are one on some file systems
            if there.casefold() == name.casefold() and (there, other) != (name, mine) and (out / there).exists():
                said = f"another folder: {there} in it was made from {other}, this would be from {mine}"
                raise InputError("out", str(out), said + (f", as {name}" if there != name else ""))


@contextlib.contextmanager
def outputs_from(source: str | os.PathLike[str], out: Path, names: Sequence[str]) -> Iterator[Outputs]:
    """Files called ``names`` in the folder ``out`` that are made from ``source``; a note of that appears together with them.

    One run at a time puts them there. It sees what others have put there while it worked: InputError if that has another input.
    """
    filelock = require("filelock", "cli", "noting what files are made from")
    with contextlib.ExitStack() as alone, Outputs(out) as files:
        yield files
        files.flush()  # a full disk is seen while nothing but the files is there
        # of another user in the same folder too; a file system that knows no locks is no reason to lose the work
        with contextlib.suppress(OSError, NotImplementedError):
            alone.enter_context(filelock.FileLock(out / _LOCK, mode=0o666))
        refuse_other_origin(out, names, source)
        here = {name.casefold() for name in names}
        known = {there: other for there, other in _read(out).items() if there.casefold() not in here}
        known |= dict.fromkeys(names, _origin(out, source))
        files.path(_INDEX).write_text(json.dumps(known, indent=1, sort_keys=True) + "\n", encoding="utf-8", newline="\n")


def _origin(out: Path, source: str | os.PathLike[str]) -> str:
    text = os.fspath(source)
    if not os.path.exists(text):
        return text
    return Path(os.path.relpath(os.path.realpath(text), os.path.realpath(out))).as_posix()  # by whatever links it is reached


def _read(out: Path) -> dict[str, str]:
    try:
        known = json.loads((out / _INDEX).read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return {}
    return known if isinstance(known, dict) else {}

"""Files that are either there and whole, or not there."""

from __future__ import annotations

import contextlib
import errno
import os
import platform
import re
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING

from .errors import InputError
from .extras import require

if TYPE_CHECKING:
    from xarray import Dataset

#: seconds after which a file that a run left half-written is nobody's, whatever its name says; no picture takes a day
_FORGOTTEN = 86_400.0
#: seconds after which that holds for a folder of generated files: written and renamed in one
_FORGOTTEN_FOLDER = 3_600.0
_HOST = re.sub(r"\W", "", platform.node()) or "here"


class Outputs:
    """A set of files in one folder that appear together, or not at all.

    Each is written aside under a hidden name; on leaving the ``with`` block without an error all are flushed to the disk
    and renamed into place. On an error nothing is left, not even a folder that was made for them (unless somebody else put
    something there). What a killed run left aside of a file of the same name is removed.

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
        _remove_left(self.folder, name)
        part = self.folder / f".{_HOST}-{os.getpid()}.part.{name}"
        self._parts[self.folder / name] = part
        return part

    def flush(self) -> None:
        """Have what is written so far on the disk."""
        for final, part in self._parts.items():
            with named(final):
                synced(part)

    def __enter__(self) -> Outputs:
        self._made = [each for each in (self.folder, *self.folder.parents) if not each.exists()]
        self.folder.mkdir(parents=True, exist_ok=True)
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None) -> None:
        placed = False
        try:
            if isinstance(error, OSError) and self._parts:  # of what was being written
                _name(error, next(reversed(self._parts)))
            if kind is None:
                for final in self._parts:  # the one thing that would stop the renaming half-way, and what it would destroy
                    if final.is_dir():
                        raise IsADirectoryError(errno.EISDIR, "a folder stands where the file would go", str(final))
                    if final.exists() and not final.is_file():
                        raise OSError(errno.EINVAL, "a pipe or a device stands where the file would go", str(final))
                self.flush()
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


def synced(path: Path) -> None:
    """Have the content of a file on the disk."""
    with open(path, "rb+") as file:
        os.fsync(file.fileno())


@contextlib.contextmanager
def named(path: Path) -> Iterator[None]:
    """Have an error of the system, such as a full disk, name the file it concerns."""
    try:
        yield
    except OSError as error:
        _name(error, path)
        raise


def _name(error: OSError, path: Path) -> None:
    error.filename = str(path)


def _remove_left(folder: Path, name: str) -> None:
    """Remove what killed runs of this machine, or forgotten ones of others, left aside of a file called `name`."""
    for left in folder.glob(f".*.part.{glob_escaped(name)}"):
        run = re.match(r"\.(?:(?P<host>\w+)-)?(?P<pid>\d+)\.part\.", left.name)
        with contextlib.suppress(OSError):
            forgotten = time.time() - left.stat().st_mtime > _FORGOTTEN
            if forgotten or (run and run["host"] == _HOST and not _alive(int(run["pid"]))):
                left.unlink()


def remove_left_folders(folder: Path) -> None:
    """Remove what killed runs, an hour ago or more, left of generated files that were to go into `folder`: folders
    ``.NAME.xxxxxxxx`` in it or beside it, with a folder NAME and nothing else in them."""
    import shutil

    name = folder.absolute().name
    for left in (each for place in (folder, folder.parent) for each in place.glob(f".{glob_escaped(name)}.????????")):
        with contextlib.suppress(OSError):
            forgotten = time.time() - left.lstat().st_mtime > _FORGOTTEN_FOLDER
            if forgotten and not left.is_symlink() and {each.name for each in left.iterdir()} <= {name}:
                shutil.rmtree(left)


def glob_escaped(name: str) -> str:
    """A name for ``Path.glob`` in which no character stands for others."""
    return re.sub(r"([*?\[])", r"[\1]", name)


def _alive(pid: int) -> bool:
    """Whether a process of this machine runs; True where the system cannot say without doing harm."""
    if sys.platform == "win32":  # os.kill(pid, 0) would send it Ctrl-C
        return True
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    except OSError:  # another user's
        return True
    return True


def refuse_unwritable(folder: str | os.PathLike[str], field: str) -> None:
    """Raise InputError, naming `field`, if files cannot be put into `folder` or it cannot be made."""
    import tempfile

    path = path_of(folder, field, "a folder")
    try:
        nearest = next(each for each in (path, *path.absolute().parents) if each.exists() or each.is_symlink())
    except OSError as error:
        raise InputError(field, str(folder), f"a folder that can be written to ({error.strerror or error})") from None
    if not nearest.is_dir():
        raise InputError(field, str(folder), f"a folder; {nearest} is {'a file' if nearest.exists() else 'a link to nothing'}")
    try:
        tempfile.TemporaryFile(dir=nearest).close()  # what permissions say does not hold on every file system, nor for every user
    except OSError as error:
        raise InputError(field, str(folder), f"a folder that can be written to; {nearest} cannot ({error.strerror})") from None


def path_of(given: str | os.PathLike[str], field: str, what: str) -> Path:
    """``given`` as a path. InputError, naming ``field`` and ``what`` the path should be of, unless it can be one."""
    try:
        path = os.fspath(given)
    except TypeError:
        raise InputError(field, given, f"the path of {what}") from None
    if not isinstance(path, str) or "\0" in path or not path:
        raise InputError(field, given, f"the path of {what}")
    return Path(path)


def read_at_most(path: str | os.PathLike[str], most: int) -> bytes:
    """The content of a file, its first ``most`` + 1 bytes at most. OSError for what is no regular file, such as a pipe,
    which might never end or never begin."""
    import stat

    kind = os.stat(path).st_mode
    if stat.S_ISDIR(kind):
        raise IsADirectoryError(errno.EISDIR, "this is a folder", os.fspath(path))
    if not stat.S_ISREG(kind):
        raise OSError(errno.EINVAL, "no regular file, but a pipe or a device", os.fspath(path))
    with open(path, "rb") as file:
        return file.read(most + 1)


def save(data: Dataset, path: str | os.PathLike[str]) -> Path:
    """Write a dataset as netCDF, aside and then renamed: at no time is there half a file. Returns the path.

    Needs the extra ``dataset``.
    """
    require("h5netcdf", "dataset", "writing netCDF")
    target = path_of(path, "path", "a netCDF file to write")
    with Outputs(target.parent) as files:
        write_netcdf(data, files.path(target.name))
    return target


def write_netcdf(data: Dataset, path: Path) -> None:
    """Write a dataset as netCDF. It is made in memory: HDF5 brings the process down where the disk is full."""
    from io import BytesIO

    import h5netcdf
    from xarray.backends import H5NetCDFStore

    made = BytesIO()
    with h5netcdf.File(made, "w") as file:
        data.dump_to_store(H5NetCDFStore(file))
    path.write_bytes(made.getbuffer())

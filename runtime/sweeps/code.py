"""Which code solves: its hash tells sweeps of different versions apart, and workers that have another one."""

import functools
import hashlib
from pathlib import Path

#: folders of the package that read, draw or say something, and solve nothing
_BESIDE = {"commands", "dma", "figures", "plots", "roughness", "derivation", "generated"}


@functools.cache
def code_key() -> str:
    """Hash of the source that this process solves with: the library and the generated solvers. 10 ms, once."""
    return fresh_code_key()


def fresh_code_key() -> str:
    """The same of the files as they are now."""
    import hystrip
    import hystrip.generated

    library, solvers = (Path(each.__file__).parent for each in (hystrip, hystrip.generated))
    return hashlib.sha256(f"{key_of(library)} {key_of(solvers)}".encode()).hexdigest()


def key_of(folder: Path) -> str:
    """Hash of the Python files in a folder and its subfolders, by their names in it; line ends do not count."""
    hashed = hashlib.sha256()
    names = {path.relative_to(folder).as_posix(): path for path in folder.rglob("*.py")}
    for name, path in sorted(names.items()):
        if name.partition("/")[0] not in _BESIDE:
            text = path.read_bytes().replace(b"\r\n", b"\n")
            hashed.update(f"{name}\n{len(text)}\n".encode() + text)
    return hashed.hexdigest()

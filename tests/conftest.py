"""What several test files ask for by name."""

import os
import sys

import pytest

from hystrip.commands import entry

# SymPy keeps a thousand results of each of its functions; the derivation and its changed copies ask for more again and again.
# It reads this when it is imported, which is later.
os.environ.setdefault("SYMPY_CACHE_SIZE", "None")


#: modules with single tests of several seconds that stand late in the alphabet
LONG = ("test_sweep", "test_types")


def pytest_collection_modifyitems(items):
    """Long tests first: at the end of a run one worker would be at them, and the others have nothing left."""
    items.sort(key=lambda item: item.path.stem not in LONG)


@pytest.fixture
def run(monkeypatch, tmp_path, capsys):
    """Run a command line in an empty folder; gives (status, standard output, standard error)."""
    monkeypatch.chdir(tmp_path)

    def call(*arguments):
        monkeypatch.setattr(sys, "argv", ["hystrip", *map(str, arguments)])
        with pytest.raises(SystemExit) as end:
            entry.main()
        return end.value.code, *capsys.readouterr()

    return call

"""What several test files ask for by name."""

import sys

import pytest

from hystrip.commands import entry


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

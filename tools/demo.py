"""The demo: friction of the paper's two-level surface over sliding velocity, as a table, a CSV and a picture.

    python3 tools/demo.py [OPTIONS OF `hystrip solve`]

Needs nothing but Python 3.11 or newer: it makes its own environment at the first run.
"""

import sys

import _environment

if __name__ == "__main__":
    options = sys.argv[1:]
    if not any(option.split("=")[0] == "--out" for option in options):
        options += ["--out", "hystrip-out"]
    exe = _environment.python("demo", ["cli", "plot"])
    sys.exit(_environment.run(exe, "-m", "hystrip", "solve", "paper_fig6", *options))

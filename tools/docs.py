"""The documentation site: pages, executed examples and the reference of the API, as HTML.

    python3 tools/docs.py [--out FOLDER] [OPTIONS OF sphinx-build]

Needs nothing but Python 3.11 or newer: it makes its own environment at the first run. A warning is an error, a broken
link inside the site and an example that fails too. Sources: tools/docs/.
"""

import os
import sys

import _environment

SOURCE = os.path.join(_environment.ROOT, "tools", "docs")


def main(arguments):
    out = os.path.join(_environment.ROOT, ".docs", "html")
    if arguments[:1] == ["--out"]:
        out, arguments = os.path.abspath(arguments[1]), arguments[2:]
    exe = _environment.python("docs", ["docs"])
    cache = os.path.join(_environment.ROOT, ".docs", "doctrees")
    options = ["-b", "html", "-d", cache, "--fail-on-warning", "--keep-going", "--quiet", *arguments]
    status = _environment.run(exe, "-m", "sphinx", *options, SOURCE, out)
    if status == 0:
        print("open " + os.path.relpath(os.path.join(out, "index.html")))
    return status


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

"""The whole test suite. Further arguments go on to pytest; the exit status is pytest's.

    python3 tools/test.py [PYTEST ARGUMENTS]

Needs nothing but Python 3.11 or newer: it makes its own environment at the first run. A run in which no test was
executed fails, whatever pytest says of it.
"""

import os
import sys
import tempfile
import xml.etree.ElementTree as ElementTree

import _environment


def executed(report):
    """Number of tests that really ran according to a JUnit report (0 if there is none)."""
    try:
        suites = ElementTree.parse(report).getroot().iter("testsuite")
        return sum(int(suite.get("tests", 0)) - int(suite.get("skipped", 0)) for suite in suites)
    except (OSError, ElementTree.ParseError):
        return 0


def spread(arguments):
    """Options that use all cores, unless the caller says how many; tests that need the derivation share one."""
    return [] if any(a.startswith("-n") for a in arguments) else ["-n", "auto", "--dist", "loadgroup"]


def main(arguments):
    exe = _environment.python("test", ["test"])
    for library in ("OMP", "OPENBLAS"):
        os.environ.setdefault(library + "_NUM_THREADS", "1")  # there is a worker on every core
    # pytest compiles all of a plugin's package anew, in every worker, for the sake of its assertions: no other than is needed
    os.environ["PYTEST_DISABLE_PLUGIN_AUTOLOAD"] = "1"
    with tempfile.TemporaryDirectory() as folder:
        report = os.path.join(folder, "report.xml")
        options = ["-p", "xdist.plugin", *spread(arguments), "--junitxml=" + report]
        status = _environment.run(exe, "-m", "pytest", *options, *arguments)
        if status == 0 and not executed(report):
            sys.stderr.write("no test ran\n")
            return 5
    return status


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

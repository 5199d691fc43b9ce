"""Set-up of the repository commands: a private virtual environment for each, made and renewed when needed.

Only the standard library, and only old syntax: this file has to run on whatever Python the reader has, if only to say
that it is too old.
"""

import hashlib
import os
import shutil
import subprocess
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
HOME = os.path.join(ROOT, ".venv-tools")
NEEDS = (3, 11)

NO_VENV = """\
This Python ({exe}) cannot make virtual environments: it comes without {module}.
On Debian and Ubuntu that is a package of its own; install it, then run this command again:
    apt install python3-venv
Or run the command with a Python that is complete (from python.org, pyenv, conda or uv).
"""


def say(text):
    """Write a line about the set-up to standard error, so that standard output stays the command's own."""
    sys.stderr.write(text.rstrip("\n") + "\n")
    sys.stderr.flush()


def python(name, extras):
    """Path of the Python of the environment `name`, with hystrip and the `extras` installed; made if need be.

    Exits with a message and a non-zero status if that is impossible.
    """
    if sys.version_info < NEEDS:
        sys.exit(
            "hystrip needs Python %d.%d or newer; this is Python %s (%s)." % (NEEDS + (sys.version.split()[0], sys.executable))
        )
    folder = os.path.join(HOME, name)
    exe = os.path.join(folder, "Scripts", "python.exe") if os.name == "nt" else os.path.join(folder, "bin", "python")
    os.makedirs(HOME, exist_ok=True)
    with _Lock(os.path.join(HOME, name + ".lock")):
        if not _ready(folder, exe, extras):
            _make(folder, exe, name, extras)
    return exe


def run(exe, *arguments):
    """Run the environment's Python in the repository; returns its exit status (128 + n if signal n ended it)."""
    process = subprocess.Popen([exe] + list(arguments), cwd=ROOT, env=_variables())
    while True:
        try:
            status = process.wait()
            return status if status >= 0 else 128 - status
        except KeyboardInterrupt:
            continue  # the child got the same Ctrl-C from the terminal, and decides how to end


def _stamp(extras):
    """What an environment depends on: this text is written into it when it is complete."""
    with open(os.path.join(ROOT, "pyproject.toml"), "rb") as file:
        project = hashlib.sha256(file.read()).hexdigest()
    return "\n".join([project, ROOT, sys.version, os.path.realpath(sys.executable), ",".join(extras)]) + "\n"


def _ready(folder, exe, extras):
    """Whether the environment was finished for this very project file, place and Python, and still starts."""
    try:
        with open(os.path.join(folder, "complete")) as file:
            if file.read() != _stamp(extras):
                return False
        probe = [exe, "-c", "import hystrip, numpy"]
        return subprocess.call(probe, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, cwd=HOME) == 0
    except OSError:
        return False


def _make(folder, exe, name, extras):
    for module in ("venv", "ensurepip"):
        try:
            __import__(module)
        except ImportError:
            sys.exit(NO_VENV.format(exe=sys.executable, module=module))
    say("Setting up the environment for '%s' in %s (once; a minute or two) ..." % (name, os.path.relpath(folder, ROOT)))
    # A half-made or outdated environment is never mended: the stamp is written last, so what lacks it goes.
    shutil.rmtree(folder, ignore_errors=True)
    _step([sys.executable, "-m", "venv", folder], "making the virtual environment")
    target = "%s[%s]" % (ROOT, ",".join(extras)) if extras else ROOT
    _step(
        [exe, "-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--no-input", "--editable", target],
        "installing hystrip and what '%s' needs" % name,
    )
    part = os.path.join(folder, "complete.part")
    with open(part, "w") as file:
        file.write(_stamp(extras))
    os.replace(part, os.path.join(folder, "complete"))


def _variables():
    """The caller's environment variables without those that would mix other Pythons' packages into this one's."""
    return {key: value for key, value in os.environ.items() if key not in ("PYTHONPATH", "PYTHONHOME")}


def _step(command, purpose):
    result = subprocess.run(
        command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, env=_variables(), cwd=HOME
    )
    if result.returncode:
        say(result.stdout.decode(errors="replace"))
        sys.exit(
            "Set-up failed while %s (exit status %d). Is the package index reachable? "
            "Run the command again to retry." % (purpose, result.returncode)
        )


class _Lock:
    """Keeps two runs from making the same environment at once. Released by the system even when a run is killed."""

    def __init__(self, path):
        self.path = path

    def __enter__(self):
        self.file = open(self.path, "a")
        try:
            import fcntl
        except ImportError:  # Windows: no such lock; two first runs at once are then the reader's to avoid
            return self
        fcntl.flock(self.file, fcntl.LOCK_EX)
        return self

    def __exit__(self, *_):
        self.file.close()

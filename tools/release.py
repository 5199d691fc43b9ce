"""Build wheel and sdist, check what is in them, and run the demo from the wheel where the repository is not.

    python3 tools/release.py [--out FOLDER]

Needs nothing but Python 3.11 or newer: it makes its own environment at the first run. Writes to dist/ by default.
"""

import os
import shutil
import subprocess
import sys
import tarfile
import tempfile
import zipfile

import _environment

#: folder of the tree -> where its files stand in the wheel
FOLDERS = {"runtime": "hystrip", "derivation": "hystrip/derivation", "generated": "hystrip/generated"}
SHIPPED = (".py", ".jinja", ".toml", ".json", ".html", ".typed")
#: what the source distribution needs to be built again
SOURCES = ("pyproject.toml", "README.md", "LICENSE")


def tree():
    """Path in the wheel -> path in the repository, of everything that a user needs."""
    files = {}
    for folder, place in FOLDERS.items():
        for where, _, names in os.walk(os.path.join(_environment.ROOT, folder)):
            for name in names:
                path = os.path.relpath(os.path.join(where, name), _environment.ROOT).replace(os.sep, "/")
                if name.endswith(SHIPPED):
                    files[place + path[len(folder) :]] = path
    return files


def check(wheel, sdist):
    """Say what is missing or too much, by name; exits then."""
    with zipfile.ZipFile(wheel) as archive:
        inside = {name for name in archive.namelist() if ".dist-info/" not in name}
    with tarfile.open(sdist) as archive:
        packed = {name.partition("/")[2] for name in archive.getnames()}
    wanted = tree()
    problems = ["not in the wheel: " + name for name in sorted(set(wanted) - inside)]
    problems += ["in the wheel, not in the tree: " + name for name in sorted(inside - set(wanted))]
    problems += ["not in the sdist: " + name for name in sorted({*SOURCES, *wanted.values()} - packed)]
    if problems:
        sys.exit("\n".join(problems))
    for path, names in ((wheel, inside), (sdist, packed)):
        print(f"{os.path.basename(path)}: {len(names)} entries; all of the tree is there")


def demo(wheel, folder):
    """Install the wheel into an environment of its own and solve a built-in scene there."""
    home = os.path.join(folder, "installed")
    subprocess.run([sys.executable, "-m", "venv", home], check=True)
    python = os.path.join(home, "Scripts" if os.name == "nt" else "bin", "python")
    quiet = ["--quiet", "--disable-pip-version-check", "--no-input"]
    subprocess.run([python, "-m", "pip", "install", *quiet, f"{wheel}[cli,plot,units,dataset]"], check=True)
    solve = ["-m", "hystrip", "solve", "paper_fig6", "--netcdf", "--no-table", "--out", "out"]
    subprocess.run([python, *solve], check=True, cwd=folder, env=_environment._variables())
    made = sorted(name for name in os.listdir(os.path.join(folder, "out")) if not name.startswith("."))
    if made != ["paper_fig6.csv", "paper_fig6.nc", "paper_fig6.png"]:
        sys.exit(f"the demo from the wheel wrote {made}")
    print("the demo runs from the wheel")


def main(arguments):
    out = os.path.abspath(arguments[1]) if arguments[:1] == ["--out"] else os.path.join(_environment.ROOT, "dist")
    exe = _environment.python("release", ["release"])
    with tempfile.TemporaryDirectory() as folder:
        # from a copy: a build leaves folders behind that would end up in later wheels
        source = os.path.join(folder, "source")
        ignored = shutil.ignore_patterns(".git", ".venv*", ".docs", "build", "dist", "*.egg-info", "__pycache__", "hystrip-*")
        shutil.copytree(_environment.ROOT, source, ignore=ignored)
        built = os.path.join(folder, "dist")
        subprocess.run([exe, "-m", "build", "--outdir", built, source], check=True, stdout=subprocess.DEVNULL)
        paths = [os.path.join(built, name) for name in sorted(os.listdir(built))]
        wheel = next(path for path in paths if path.endswith(".whl"))
        sdist = next(path for path in paths if path.endswith(".tar.gz"))
        subprocess.run([exe, "-m", "twine", "check", "--strict", wheel, sdist], check=True)
        check(wheel, sdist)
        demo(wheel, folder)
        os.makedirs(out, exist_ok=True)
        for path in (wheel, sdist):
            shutil.copy(path, out)
            print("wrote " + os.path.relpath(os.path.join(out, os.path.basename(path))))


if __name__ == "__main__":
    main(sys.argv[1:])

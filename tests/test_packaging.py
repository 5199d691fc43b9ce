"""The wheel holds all of the tree, and works where the repository is not."""

import json
import os
import re
import shutil
import subprocess
import sys
import tomllib
import zipfile
from pathlib import Path

import pytest

# one wheel for all, and not one in every process
pytestmark = pytest.mark.xdist_group("wheel")

ROOT = Path(__file__).resolve().parent.parent
FOLDERS = {"runtime": "hystrip", "derivation": "hystrip/derivation", "generated": "hystrip/generated"}
SHIPPED = (".py", ".jinja", ".toml", ".lark", ".json", ".html", ".typed")


def tree():
    """Path in the wheel -> file of the tree, for everything that a user needs."""
    files = {}
    for folder, place in FOLDERS.items():
        for path in (ROOT / folder).rglob("*"):
            if path.suffix in SHIPPED or path.name == "py.typed":
                files[f"{place}/{path.relative_to(ROOT / folder).as_posix()}"] = path
    return files


def test_every_subpackage_is_listed():
    listed = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["tool"]["setuptools"]["packages"]
    found = {name.rsplit("/", 1)[0].replace("/", ".") for name in tree() if name.endswith(".py")}
    assert sorted(listed) == sorted(found)


def test_every_subpackage_has_an_init():
    folders = {path.parent for path in tree().values() if path.suffix == ".py"}
    assert not [str(folder.relative_to(ROOT)) for folder in folders if not (folder / "__init__.py").exists()]


def test_versions_agree():
    """Stated in one file; the build reads it there, and what cites the software says the same."""
    import hystrip

    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    assert "version" in project["project"]["dynamic"] and "version" not in project["project"]
    assert project["tool"]["setuptools"]["dynamic"]["version"] == {"attr": "hystrip._version.__version__"}
    assert f"\nversion: {hystrip.__version__}\n" in (ROOT / "CITATION.cff").read_text(encoding="utf-8")
    assert f"\n## {hystrip.__version__}" in (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")


def test_core_needs_numpy_and_scipy_alone():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    assert [re.match(r"[a-z]+", each)[0] for each in project["dependencies"]] == ["numpy", "scipy"]


@pytest.fixture(scope="module")
def wheel(tmp_path_factory):
    """Built from a copy: a build folder left in the tree would end up in later wheels."""
    place = tmp_path_factory.mktemp("wheel")
    source = place / "source"
    source.mkdir()
    for name in ("pyproject.toml", "README.md", "LICENSE"):
        shutil.copy(ROOT / name, source / name)
    for folder in FOLDERS:
        shutil.copytree(ROOT / folder, source / folder, ignore=shutil.ignore_patterns("__pycache__"))
    command = [sys.executable, "-m", "pip", "wheel", "--no-deps", "--no-input", "--disable-pip-version-check"]
    built = subprocess.run([*command, "-w", place, source], capture_output=True, text=True)
    assert built.returncode == 0, built.stdout + built.stderr
    return next(place.glob("*.whl"))


@pytest.fixture(scope="module")
def installed(wheel, tmp_path_factory):
    """Runs Python code against the unpacked wheel, away from the repository. `hide`: modules that are not there."""
    place = tmp_path_factory.mktemp("installed")
    site = place / "site"
    with zipfile.ZipFile(wheel) as archive:
        archive.extractall(site)
    work = place / "work"
    work.mkdir()

    def run(code, hide=(), **environment):
        start = f"import sys; sys.path.insert(0, {str(site)!r})\n"
        start += f"sys.modules.update(dict.fromkeys({list(hide)!r}))\n"
        start += f"import hystrip; assert hystrip.__file__.startswith({str(site)!r}), hystrip.__file__\n"
        result = subprocess.run(
            [sys.executable, "-c", start + code],
            cwd=work,
            capture_output=True,
            text=True,
            env={**os.environ, "PYTHONPATH": "", **environment},
        )
        assert result.returncode == 0, result.stdout + result.stderr
        return result.stdout, work

    return run


def test_wheel_has_the_version(wheel):
    import hystrip

    assert wheel.name.startswith(f"hystrip-{hystrip.__version__}-")


def test_wheel_holds_the_tree(wheel):
    with zipfile.ZipFile(wheel) as archive:
        names = {name for name in archive.namelist() if ".dist-info/" not in name}
        assert names == set(tree())
        for name, path in tree().items():
            assert archive.read(name) == path.read_bytes(), name


def test_wheel_solves_the_demo_scene(installed):
    code = "from hystrip.commands.entry import main; sys.argv = ['hystrip', 'solve', 'paper_fig6', '--out', 'demo']; main()"
    out, work = installed(code)
    text = (work / "demo" / "paper_fig6.csv").read_text(encoding="utf-8")
    lines = [line for line in text.splitlines() if not line.startswith("#")]
    assert len(lines) == 61
    assert (work / "demo" / "paper_fig6.png").read_bytes().startswith(b"\x89PNG")
    assert "mu" in out


OPTIONAL = (
    "sympy",
    "jinja2",
    "matplotlib",
    "xarray",
    "pandas",
    "typer",
    "rich",
    "msgspec",
    "pint",
    "mpmath",
    "distributed",
    "SurfaceTopography",
)


def test_core_solves_without_any_extra(installed):
    code = """
material = hystrip.StandardLinearSolid(K=1e9, T_eps=1e-2, T_sigma=1e-4)
adhesion = hystrip.Dugdale(gamma=2.5e-5, delta_0=1e-8)
levels = [hystrip.Level(l=10e-6, h=1e-6), hystrip.Level(l=500e-9, h=100e-9)]
print(float(hystrip.solve(material, adhesion, levels, pressure=100.0, velocity=5e-3).mu))
"""
    out, _ = installed(code, hide=OPTIONAL)
    assert float(out) > 0


@pytest.mark.parametrize(
    ("hidden", "arguments", "extra"),
    [
        ("typer", ["--version"], "cli"),
        ("msgspec", ["solve", "paper_fig6"], "cli"),
        ("matplotlib", ["solve", "paper_fig6"], "plot"),
        ("distributed", ["sweep", "paper_fig7", "--scheduler", "tcp://127.0.0.1:9"], "dask"),
        ("xarray", ["sweep", "paper_fig7", "--netcdf"], "dataset"),
        ("matplotlib", ["sweep", "paper_fig7", "--plot"], "plot"),
        ("SurfaceTopography", ["levels", "scan.nc", "--pressure", "1e5"], "roughness"),
        ("matplotlib", ["fit", "dma.csv"], "plot"),
        ("sympy", ["check"], "regenerate"),
        ("jinja2", ["regenerate", "--out", "elsewhere"], "regenerate"),
    ],
)
def test_missing_extra_is_named(installed, hidden, arguments, extra):
    code = f"""
import contextlib, io
from hystrip.commands.entry import main
sys.argv = ["hystrip", *{arguments!r}]
said = io.StringIO()
try:
    with contextlib.redirect_stderr(said):
        main()
except SystemExit as end:
    print(end.code, said.getvalue())
"""
    out, work = installed(code, hide=[hidden])
    assert out.startswith("2 hystrip: ") and repr(hidden) in out and f"pip install 'hystrip[{extra}]'" in out
    assert not (work / "elsewhere").exists() and not (work / "hystrip-out").exists()


@pytest.mark.parametrize("hidden", ["sympy", "lark"])
def test_the_derivation_names_its_extra(installed, hidden):
    code = """
try:
    import hystrip.derivation.models
except hystrip.MissingExtra as error:
    print(error)
"""
    out, _ = installed(code, hide=[hidden])
    assert repr(hidden) in out and "pip install 'hystrip[regenerate]'" in out


def test_wheel_makes_a_solver_of_a_model_file_with_the_same_bytes_under_any_hash_seed(installed):
    """A user's model, that of the shipped solver under another name: the derivation finds its templates there, and what it emits
    is what is checked in. That its sources are the tree's is tested above, and the pages, under seeds of other processes, in
    test_drift."""
    code = """
import functools, os
from pathlib import Path
from hystrip.derivation import load_model, regenerate
from hystrip.derivation.certificates import certify
certify.COUNTS = (1,)  # how accurate it is, with more, is measured for the solver that ships
for name in ("measure", "measure_material", "measure_regimes"):
    setattr(certify, name, functools.partial(getattr(certify, name), points=1))
os.mkdir("own")
os.chdir("own")
Path("my_model.py").write_text("from hystrip.derivation import prony_model\\n\\nMODEL = prony_model('my_rubber')\\n")
seen = []
written = regenerate("my_solver", load_model("my_model.py"), progress=lambda done, total: seen.append((done, total)))
measured = seen[-1][1]  # certificates are shown as they are made, too
assert seen == [(1, 1), *((done, measured) for done in range(1, measured + 1))], seen
assert all(each.is_file() for each in written)
print(*(each.relative_to("my_solver").as_posix() for each in written))
"""
    out, work = installed(code, PYTHONHASHSEED="0" if os.environ.get("PYTHONHASHSEED") != "0" else "4242")
    own, shipped = work / "own" / "my_solver", ROOT / "generated"
    emitted = {"__init__.py", "stable.py", "modes.py", "my_rubber.py"}
    assert set(out.split()) >= emitted | {"certificates.json", "audit/index.html", "audit/my_rubber.html"}
    assert sorted(path.name for path in own.parent.iterdir() if path.name != "__pycache__") == ["my_model.py", "my_solver"]
    assert list(json.loads((own / "certificates.json").read_text(encoding="utf-8"))["models"]) == ["my_rubber"]
    # nothing but the name tells it from the solver that ships
    for name in ("stable.py", "modes.py", "generalised.py"):
        mine = (own / name.replace("generalised", "my_rubber")).read_bytes()
        assert mine.replace(b"my_rubber", b"generalised") == (shipped / name).read_bytes(), name

"""The examples of the README and of the documentation run as they stand there; so does every example in a docstring."""

import doctest
import importlib.util
import inspect
import pkgutil
import re
import runpy
import sys
from pathlib import Path

import pytest

import hystrip

ROOT = Path(__file__).resolve().parent.parent
PAGES = [ROOT / "README.md", *sorted((ROOT / "tools" / "docs").rglob("*.md"))]


def examples():
    found = []
    for page in PAGES:
        blocks = re.findall(r"```python\n(.*?)```", page.read_text(encoding="utf-8"), re.DOTALL)
        found += [pytest.param(block, id=f"{page.stem} {number}") for number, block in enumerate(blocks, start=1)]
    return found


@pytest.mark.parametrize("code", examples())
def test_example(code, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    exec(compile(code, "example", "exec"), {})
    assert capsys.readouterr().out.strip()


@pytest.mark.parametrize(
    ("name", "hidden", "extra"), [("plot_4_own_model", "sympy", "regenerate"), ("plot_5_sweep", "distributed", "dask")]
)
def test_an_example_names_the_extra_that_it_lacks(monkeypatch, name, hidden, extra):
    for module in [module for module in sys.modules if module.split(".")[:2] == ["hystrip", "derivation"]]:
        monkeypatch.delitem(sys.modules, module)  # another test may have imported it
    monkeypatch.setitem(sys.modules, hidden, None)
    with pytest.raises(hystrip.errors.MissingExtra, match=rf"{hidden}.*pip install 'hystrip\[{extra}\]'"):
        runpy.run_path(str(ROOT / f"tools/docs/examples/{name}.py"))


def test_readme_is_two_screens_and_its_links_lead_somewhere():
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    assert len(text.splitlines()) <= 70 and "```python" in text
    links = re.findall(r"\]\(([^)#]+)\)", text)
    assert links and not [link for link in links if not (ROOT / link).exists()]


def modules():
    skip = ("hystrip.derivation", "hystrip.generated", "hystrip.__main__")
    return [m.name for m in pkgutil.walk_packages(hystrip.__path__, "hystrip.") if not m.name.startswith(skip)]


def test_docstrings():
    failed = attempted = 0
    for name in modules():
        result = doctest.testmod(importlib.import_module(name))
        failed, attempted = failed + result.failed, attempted + result.attempted
    assert failed == 0 and attempted


MATERIALS = ("KelvinVoigt", "Prony", "StandardLinearSolid")
CALLED = ("Dugdale", "Level", *MATERIALS, "friction_law", "load_scene", "solve", "solve_level", "solve_strip", "sweep")


@pytest.mark.parametrize("name", CALLED)
def test_what_a_user_calls_has_an_example(name):
    assert ">>> " in getattr(hystrip, name).__doc__


@pytest.mark.skipif(not (ROOT / "tools/docs.py").is_file(), reason="checks the pages that the repository's documentation makes")
def test_dead_links_of_the_site_are_found(tmp_path, monkeypatch):
    monkeypatch.syspath_prepend(ROOT / "tools")
    docs = importlib.import_module("docs")
    (tmp_path / "code").mkdir()
    (tmp_path / "index.html").write_text('<p id="a b"><a href="#a%20b">here</a><a href="code/x.html#y">y</a><img src="no.png">')
    (tmp_path / "code/x.html").write_text('<a href="../index.html#dma.y" id="y">back</a><a href="https://example.org/#z">out</a>')
    assert docs.dead_links(tmp_path) == [("code/x.html", "../index.html#dma.y"), ("index.html", "no.png")]


def test_warnings_of_a_package_are_documented_where_their_code_is():
    # the links from the code to the reference are made of the name of the package that a module was first documented under
    for package in (hystrip.dma, hystrip.roughness):
        assert all(getattr(package, name).__module__.startswith(package.__name__) for name in package.__all__), package


@pytest.mark.skipif(not (ROOT / "tools/docs").is_dir(), reason="reads the documentation of the repository")
def test_lists_of_names_hold_nothing_but_names():
    """On the pages of the reference a paragraph below a list of arguments was read as one more of them."""
    spec = importlib.util.spec_from_file_location("field_lists", ROOT / "tools/docs/_extensions/field_lists.py")
    spec.loader.exec_module(lists := importlib.util.module_from_spec(spec))
    things = {f"{m.__name__}.{name}": thing for m in (hystrip, hystrip.dma, hystrip.roughness) for name, thing in vars(m).items()}
    things |= {f"{name}.{n}": t for name, of in things.items() if isinstance(of, type) for n, t in vars(of).items()}
    listed = 0
    for name, thing in things.items():
        lines = (inspect.getdoc(thing) or "").splitlines()
        lists.process(None, "class", name, thing, None, lines)
        section = ""
        for before, line, after in zip(["", *lines], lines, [*lines[1:], ""], strict=False):
            if after and set(after) == {"-"}:
                section = line
            elif not line and not before:
                section = ""
            elif section in ("Parameters", "Attributes", "Raises", "Warns") and line[:1].strip() and set(line) != {"-"}:
                assert re.fullmatch(r"[\w*]+(, [\w*]+)*", line), (name, line)
                listed += 1
    assert listed > 50


def test_every_public_name_is_described():
    for name in hystrip.__all__:
        thing = getattr(hystrip, name)
        assert thing.__doc__ and not thing.__doc__.startswith(f"{name}("), name
        for member, value in vars(thing).items() if isinstance(thing, type) else ():
            if not member.startswith("_") and (callable(value) or isinstance(value, property)):
                assert value.__doc__, f"{name}.{member}"

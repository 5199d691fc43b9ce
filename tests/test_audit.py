"""The audit: what its pages say, that they need nothing but a browser, and that it refuses what does not verify."""

from __future__ import annotations

import json
import re
from html.parser import HTMLParser
from pathlib import Path

import pytest
from derived_once import audited, derivation, tampered

import hystrip.derivation.pages.publish as publish
from hystrip.derivation import AuditError, generated_folder
from hystrip.derivation.drift import read_measured
from hystrip.derivation.emit import input_hash
from hystrip.derivation.pages.latex import pieces
from hystrip.derivation.pages.measured import measured
from hystrip.generated import standard_linear_solid

PAGE = "audit/standard_linear_solid.html"


def content() -> dict:
    return json.loads(audited()["audit/standard_linear_solid.json"])


class _Seen(HTMLParser):
    def __init__(self, text: str):
        super().__init__()
        self.ids: list[str] = []
        self.links: list[str] = []
        self.sources: list[str] = []
        self.tags: set[str] = set()
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        given = dict(attributes)
        self.tags.add(tag)
        self.ids += [given["id"]] if "id" in given else []
        self.links += [given["href"]] if tag == "a" else []
        self.sources += [given[key] for key in ("src", "href") if key in given and tag != "a"]


@pytest.mark.parametrize("name", ["audit/index.html", PAGE])
def test_a_page_needs_nothing_else_and_no_script(name: str) -> None:
    seen = _Seen(audited()[name])
    assert "script" not in seen.tags
    assert all(source.startswith("data:") for source in seen.sources)
    assert len(seen.ids) == len(set(seen.ids))
    for link in seen.links:
        file, _, place = link.partition("#")
        assert not re.match(r"\w+:", file)
        target = audited()[f"audit/{file}"] if file else audited()[name]
        assert not place or f'id="{place}"' in target, link


def test_no_page_is_large() -> None:
    assert all(path.stat().st_size < 1_000_000 for path in (generated_folder() / "audit").iterdir())


def test_every_equation_of_the_paper_has_a_row_that_leads_somewhere() -> None:
    assert [row["number"] for row in content()["equations"]] == list(range(1, 17))
    assert all(row["steps"] for row in content()["equations"])
    corrected = [row["number"] for row in content()["equations"] if row["status"] == "reproduced with a correction"]
    assert corrected == [1, 6, 16]


def test_every_step_and_every_certificate_is_told() -> None:
    told = [step for stage in content()["stages"] for step in stage["steps"]]
    assert sorted(step["name"] for step in told) == sorted(step.name for step in derivation().steps)
    assert all(step["checks"] and step["derived_by"]["line"] > 0 for step in told)
    functions = {kernel.formula.name for kernel in derivation().kernels}
    assert set(content()["certificates"]) == functions == {p["function"] for step in told for p in step["computed_by"]}
    assert content()["identity"]["inputs"] == input_hash() == standard_linear_solid.HASH
    assert input_hash() in audited()[PAGE]


def test_a_line_that_is_named_is_the_line() -> None:
    lines = (generated_folder() / "standard_linear_solid.py").read_text(encoding="utf-8").splitlines()
    for stage in content()["stages"]:
        for step in stage["steps"]:
            for place in step["computed_by"]:
                assert lines[place["line"] - 1].startswith(f"def {place['function']}(")


def test_every_regime_has_its_equations_and_a_picture() -> None:
    pictures = read_measured(generated_folder())["standard_linear_solid"]["pictures"]
    for regime in content()["regimes"]:
        assert len(regime["equations"]) == len(regime["unknowns"]) and regime["admissible"]
        assert pictures[regime["sequence"]]
    assert audited()[PAGE].count("data:image/svg+xml") == sum(map(len, pictures.values()))


def test_figure_7_is_demonstrated() -> None:
    (row,) = [row for row in content()["misprints"] if row["equations"] == [16]]
    mu, printed = ([float(line[n]) for line in row["table"]["rows"]] for n in (4, 5))
    assert mu == pytest.approx([2.92e-4, 5.83e-5, 1.46e-5], rel=3e-3)
    assert printed == sorted(printed)  # the wrong order


def test_the_measured_figures_are_those_of_the_solver() -> None:
    stored, fresh = read_measured(generated_folder())["standard_linear_solid"], measured()
    for regime, pictures in fresh["pictures"].items():
        assert [p["caption"].split(",")[0] for p in pictures] == [p["caption"].split(",")[0] for p in stored["pictures"][regime]]
        assert all(regime in p["caption"] or regime == "ac" and "(cf)" in p["caption"] for p in pictures)
    for row, known in zip(fresh["tables"]["balance"]["rows"], stored["tables"]["balance"]["rows"], strict=True):
        assert [float(v) for v in row[2:5]] == pytest.approx([float(v) for v in known[2:5]], rel=1e-3)
        assert float(row[6]) < 1e-9  # what is left over is the derived X
    assert fresh["tables"]["branches"]["rows"] == stored["tables"]["branches"]["rows"]


def test_an_equation_is_cut_only_where_it_may_be() -> None:
    assert pieces(r"a = b,\quad c = \left(d + e\right) f") == ["a = b,", r"c = \left(d + e\right) f"]
    long = r"\sin{\left(s_{0} \right)} " * 4
    assert pieces(rf"{long} + \left({long} - x\right) - y")[0] == long.strip()
    for stage in content()["stages"]:
        for step in stage["steps"]:
            for piece in pieces(step["latex"]):
                assert piece.count("{") == piece.count("}") and piece.count(r"\left") == piece.count(r"\right")


def test_a_changed_sign_stops_the_audit_by_name(tmp_path: Path) -> None:
    wrong = tampered(tmp_path, "flows.py", "(entry - particular.subs(s, s_0))", "(entry + particular.subs(s, s_0))")
    with pytest.raises(wrong.DerivationError, match="'contact flow'"):
        wrong.audit(tmp_path / "audit")
    assert not (tmp_path / "audit").exists()


def test_the_command_names_the_step_that_fails(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    from typer.testing import CliRunner

    import hystrip.derivation.stable as stable
    from hystrip.commands.app import build

    monkeypatch.setattr(stable, "FORCING", stable.Formula("forcing", stable.FORCING.args, -stable.FORCING.result))
    done = CliRunner().invoke(build(), ["audit", "--out", str(tmp_path / "audit")])
    assert done.exit_code == 1 and "step 'forcing' failed" in done.output
    assert not (tmp_path / "audit").exists()


def test_another_solver_than_the_installed_one_is_not_audited(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(publish, "derive_any", lambda model, say: derivation())
    monkeypatch.setattr(publish, "emit", lambda made: {"stable.py": "another\n"})
    with pytest.raises(AuditError, match="stable.py"):
        publish.audit(tmp_path / "audit")
    assert not (tmp_path / "audit").exists()

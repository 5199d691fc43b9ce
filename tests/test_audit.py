"""The audit: what its pages say, that they need nothing but a browser, and that it refuses what does not verify."""

from __future__ import annotations

import json
import re
from html.parser import HTMLParser
from pathlib import Path

import pytest
from derived_once import audited, derivation, tampered

import hystrip.derivation.pages.publish as publish
import hystrip.derivation.pages.two_levels as comparison
from hystrip.derivation import AuditError, DerivationError, generated_folder
from hystrip.derivation.drift import read_measured
from hystrip.derivation.emit import input_hash
from hystrip.derivation.pages import places
from hystrip.derivation.pages.latex import pieces
from hystrip.derivation.pages.measured import measured
from hystrip.derivation.pages.pictures import ADHESION, CONTACT
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


def _steps() -> dict:
    return {step["name"]: step for stage in content()["stages"] for step in stage["steps"]}


def test_every_equation_of_the_paper_has_a_row_that_leads_somewhere() -> None:
    rows = content()["equations"]
    assert [row["number"] for row in rows] == list(range(1, 17))
    by_status = {status: [row["number"] for row in rows if row["status"] == status] for status in {row["status"] for row in rows}}
    assert by_status == {
        "reproduced": [2, 3, 4, 5, 8, 10, 11, 12, 13, 14, 15],
        "reproduced with a correction": [1, 6, 16],
        "not compared": [7, 9],
    }
    for row in rows:
        first = _steps()[row["steps"][0]]
        assert row["number"] in first["equations"] or row["note"], row
        assert first["statement"] and first["latex"] and first["checks"] and first["derived_by"]["function"]


def test_every_step_leads_to_what_computes_it_or_to_the_steps_it_enters() -> None:
    nowhere = [n for n, step in _steps().items() if not (step["computed_by"] or step["carried_out_by"] or step["enters"])]
    assert nowhere == ["admissibility", *(f"friction balance {sequence}" for sequence in ("acaf", "afc", "af", "ac"))]
    for number in range(11, 15):
        row = content()["equations"][number - 1]
        assert any(place["text"] for name in row["steps"] for place in _steps()[name]["carried_out_by"]), number


def test_a_line_of_the_runtime_that_is_gone_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    (step,) = [step for step in derivation().steps if step.name == "carried friction"]
    file, function, piece = places.RUNTIME[step.function][0]
    assert places.carried_out(step)[0].text.startswith("total")
    monkeypatch.setitem(places.RUNTIME, step.function, ((file, function, piece + " gone"),))
    with pytest.raises(DerivationError, match="'carried friction' failed: runtime/level/carried.py: _contributions"):
        places.carried_out(step)


def test_names_in_the_tables_of_places_are_steps() -> None:
    assert {*places.RUNTIME, *places.ENTERS, *places.MEASURED} <= {step.function for step in derivation().steps}
    assert {name for names in places.ENTERS.values() for name in names} <= set(_steps())


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


def test_zones_of_a_picture_are_shaded_and_their_edges_labelled() -> None:
    stored = read_measured(generated_folder())["standard_linear_solid"]["pictures"]
    for drawn in stored.values():
        for picture in drawn:
            sequence = re.search(r"\((\w+)\)", picture["caption"])[1]
            for zone, colour in (("c", CONTACT), ("a", ADHESION)):
                assert (colour in picture["svg"]) == (zone in sequence), (sequence, zone)
            labels = {
                "acaf": ("-a", "b", "-c", "d"),
                "afc": ("-a", "b = d", "-c"),
                "af": ("-c", "d"),
                "ac": ("-a", "b"),
                "cf": ("-a", "b"),
            }
            assert all(f">{label}</text>" in picture["svg"] for label in labels.get(sequence, ())), sequence


def test_figure_7_is_demonstrated() -> None:
    (row,) = [row for row in content()["misprints"] if row["equations"] == [16]]
    mu, printed = ([float(line[n]) for line in row["table"]["rows"]] for n in (4, 6))
    assert mu == pytest.approx([2.92e-4, 5.83e-5, 1.46e-5], rel=3e-3)
    assert printed == sorted(printed)  # the wrong order
    in_micrometres = [[float(line[n]) for line in row["table"]["rows"]] for n in (5, 7)]
    assert in_micrometres[0] == mu and in_micrometres[1] == pytest.approx([value / 1e6 for value in printed], rel=1e-3)


def test_the_measured_figures_are_those_of_the_solver(monkeypatch: pytest.MonkeyPatch) -> None:
    stored = read_measured(generated_folder())["standard_linear_solid"]
    monkeypatch.setattr("hystrip.derivation.pages.measured.two_levels", dict)  # measured for longer than a test may take
    fresh = measured()
    for regime, pictures in fresh["pictures"].items():
        assert [p["caption"].split(",")[0] for p in pictures] == [p["caption"].split(",")[0] for p in stored["pictures"][regime]]
        assert all(regime in p["caption"] or regime == "ac" and "(cf)" in p["caption"] for p in pictures)
    for row, known in zip(fresh["tables"]["balance"]["rows"], stored["tables"]["balance"]["rows"], strict=True):
        assert [float(v) for v in row[2:5]] == pytest.approx([float(v) for v in known[2:5]], rel=1e-3)
        assert float(row[6]) < 1e-9  # what is left over is the derived X
    assert fresh["tables"]["branches"]["rows"] == stored["tables"]["branches"]["rows"]


def test_the_runtime_carries_out_equations_12_to_14(monkeypatch: pytest.MonkeyPatch) -> None:
    """The stored comparison is close; in complete contact plain sums are exact, so that one is made anew."""
    stored = read_measured(generated_folder())["standard_linear_solid"]["tables"]["two_levels"]["rows"]
    assert all(float(row[4]) < (2e-3 if float(row[0]) < 1e3 else 1e-12) for row in stored)
    monkeypatch.setattr(comparison, "PRESSURES", (5e6,))
    monkeypatch.setattr(comparison, "STRIPS", 20)
    monkeypatch.setattr(comparison, "POINTS", 40)
    fresh = comparison.two_levels()["rows"]
    assert [row[:3] for row in fresh] == [row[:3] for row in stored if row[0] == "5e+06"]
    assert all(float(row[4]) < 1e-12 for row in fresh)


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


@pytest.mark.parametrize("command", [["audit", "--out", "audit"], ["check"]])
def test_the_command_names_the_step_that_fails(command: list[str], monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    from typer.testing import CliRunner

    import hystrip.derivation.stable as stable
    from hystrip.commands.app import build

    monkeypatch.setattr(stable, "FORCING", stable.Formula("forcing", stable.FORCING.args, -stable.FORCING.result))
    monkeypatch.chdir(tmp_path)
    done = CliRunner().invoke(build(), command)
    assert done.exit_code == 1 and "step 'forcing' failed" in done.output
    assert not (tmp_path / "audit").exists()


def test_another_solver_than_the_installed_one_is_not_audited(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(publish, "derive_any", lambda model, say: derivation())
    monkeypatch.setattr(publish, "emit", lambda made: {"stable.py": "another\n"})
    with pytest.raises(AuditError, match="stable.py"):
        publish.audit(tmp_path / "audit")
    assert not (tmp_path / "audit").exists()

"""The figures of the paper: they are drawn, with their data, and say what the paper says where the text does."""

import csv
import dataclasses

import numpy as np
import pytest

import hystrip
from hystrip.figures import FIGURES, draw, fig3, fig7
from hystrip.scene import load_scene


def read(path):
    with open(path, encoding="utf-8", newline="") as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


def test_files_of_fig5_and_fig7(tmp_path):
    written = draw(["fig7", "fig5"], tmp_path)
    there = [path for path in tmp_path.iterdir() if not path.name.startswith(".")]
    assert sorted(path.name for path in there) == sorted(
        f"{f}.{kind}" for f in ("fig5", "fig7") for kind in ("csv", "png", "svg")
    )
    assert set(written) == set(there) and all(path.stat().st_size > 1000 for path in written)
    rows = read(tmp_path / "fig5.csv")
    regimes = {row["strip"]: row["regime"] for row in rows}
    assert regimes["0.0"] == "partial contact, discrete adhesion zones"
    assert regimes["75.0"] == "saturated contact"
    # level 2 adds only where level 1 is in contact; both are drawn with their sign
    assert max(float(row["tangential stress of level 2 [Pa]"]) for row in rows if row["strip"] == "0.0") > 0


def test_fig3_tells_what_load_control_reaches(monkeypatch):
    """At 1 mm/s the crest lets go at -675 Pa; the flat rims hold on to -707 Pa, which load control reaches by a jump."""
    scene = dataclasses.replace(load_scene("paper_fig3"), velocity=np.array(1e-3))
    monkeypatch.setattr("hystrip.scene.load_scene", lambda name: scene)
    monkeypatch.setattr(fig3, "_RTOL", 1e-2)
    table = fig3.data()
    part, p = np.array(table["part"]), table["pressure [Pa]"]
    reached = p[(part == "unloading, reachable") & np.isfinite(p)]
    assert reached.min() == pytest.approx(-707.3, abs=0.5)
    held = p[(part == "unloading, not reachable") & np.isfinite(p)]
    assert held.min() >= reached.min() - 0.5 and held.max() < -500
    # coming from no contact nothing holds: hardly any tension, and the same saturated end
    loading = p[(part == "loading") & np.isfinite(p)]
    assert -20 < loading.min() < 0 and loading.max() > reached.max()


def test_fig7_peaks_where_eq_16_corrected_says():
    table = fig7.data()
    V = table["velocity [m/s]"]
    for level, (wavelength, mu) in enumerate([(1e-5, 2.92e-4), (5e-7, 5.83e-5), (5e-9, 1.46e-5)], start=1):
        part = table[f"mu of level {level}"]
        top = int(np.argmax(part))
        assert part[top] == pytest.approx(mu, rel=5e-3)
        assert V[top] == pytest.approx(wavelength / (2 * np.pi * 1e-4), rel=0.13)


def test_an_unknown_figure_is_refused_before_any_work(tmp_path):
    with pytest.raises(hystrip.InputError, match="only: got 'fig8'"):
        draw(["fig7", "fig8"], tmp_path / "out")
    assert not (tmp_path / "out").exists() and len(FIGURES) == 5

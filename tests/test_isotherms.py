"""Which rows of a file are one isotherm."""

import numpy as np
import pytest

import hystrip
from hystrip.dma import master_curve, read_isotherms
from hystrip.dma.isotherms import repeats_differ

SHIFT = hystrip.WLF(8.86, 101.6, 293.15)
TIMES = np.geomspace(1e-9, 100, 23)
MODULI = 2e7 * np.exp(-(((np.log10(TIMES) + 5) / 4) ** 2))
SWEEP = np.geomspace(0.1, 100, 13)


def row(celsius, f):
    x = 2j * np.pi * f * float(SHIFT.factor(celsius + 273.15)) * TIMES
    E = 2e6 + np.sum(MODULI * x / (1 + x))
    return f"{celsius:.3f},{f:.6g},{E.real:.6g},{E.imag:.6g}"


def read(tmp_path, rows, head="T [degC],f [Hz],E' [Pa],E'' [Pa]"):
    path = tmp_path / "raw.csv"
    path.write_text("\n".join([head, *rows]) + "\n", encoding="utf-8")
    return read_isotherms(path)


def celsius(found):
    return [round(each.temperature - 273.15, 2) for each in found]


def test_steps_below_one_kelvin_are_no_single_temperature(tmp_path):
    """A ramp of 0.5 K, three frequencies at each step; in order, and in that of the frequencies."""
    steps = np.arange(-30, 60.1, 0.5)
    found = read(tmp_path, [row(T, f) for T in steps for f in (1, 10, 100)])
    assert celsius(found) == steps.tolist() and {each.omega.size for each in found} == {3}
    assert celsius(read(tmp_path, [row(T, f) for f in (100, 10, 1) for T in steps])) == steps.tolist()


@pytest.mark.parametrize("shuffled", [False, True])
def test_isotherms_one_kelvin_apart_are_told_apart(tmp_path, shuffled):
    rows = [row(T, f) for T in (19, 20, 21, 22) for f in SWEEP]
    if shuffled:
        np.random.default_rng(0).shuffle(rows)
    assert celsius(read(tmp_path, rows)) == [19, 20, 21, 22]


def test_temperature_that_drifts_along_each_sweep_gives_isotherms(tmp_path):
    centres = list(range(-9, 30, 3))
    rows = [row(T + 1.2 * drift, f) for T in centres for drift, f in zip(np.linspace(-1, 1, 13), SWEEP, strict=True)]
    found = read(tmp_path, rows)
    assert celsius(found) == centres and {each.omega.size for each in found} == {13}
    assert "temperature drifts by up to 2.4 K within an isotherm" in found[0].columns[-1]
    # continuous heating along sweeps up and down
    steady = [row(T, f) for T, f in zip(np.arange(0, 30, 0.2), np.tile([1, 10, 100, 100, 10, 1], 25), strict=True)]
    assert len(read(tmp_path, steady)) == 50


def test_scatter_of_a_furnace_and_repeated_sweeps_are_one_temperature(tmp_path):
    rng = np.random.default_rng(0)
    found = read(tmp_path, [row(T + 0.1 * rng.standard_normal(), f) for T in (10, 20, 30) for _ in range(2) for f in SWEEP])
    assert [each.omega.size for each in found] == [26, 26, 26] and not any("drifts" in line for line in found[0].columns)


@pytest.mark.parametrize(
    ("rows", "said"),
    [
        ([row(T, 1.0) for T in np.arange(-30, 60.1, 0.5)], r"-30.0 degC \(243.15 K\) to 60.0 degC .* told apart"),
        ([row(T, f) for T, f in zip(np.arange(0, 9, 0.1), np.tile([1, 1, 10], 30), strict=True)], "told apart"),
        ([row(T, 1.0) for T in np.arange(-30, 61, 5)], r"one frequency at -30.0 degC \(243.15 K\)"),
        ([row(20, f) for f in SWEEP], r"one temperature, 20.0 degC \(293.15 K\)"),
    ],
)
def test_temperatures_that_are_no_isotherms_are_refused(tmp_path, rows, said):
    with pytest.raises(hystrip.InputError, match=said):
        read(tmp_path, rows)


def test_sets_are_isotherms_though_one_temperature_is_repeated(tmp_path):
    sets = {"a": 0, "b": 10, "c": 20, "d": 30, "again": 20}
    rows = [f"{name},{row(T, f)}" for name, T in sets.items() for f in SWEEP]
    found = read(tmp_path, rows, "Set,T [degC],f [Hz],E' [Pa],E'' [Pa]")
    assert celsius(found) == [0, 10, 20, 30, 20]
    curve = master_curve(found)
    assert curve.a_T[2:4] == pytest.approx([1, 1], abs=1e-3) and curve.shift.C_1 == pytest.approx(8.86, rel=0.01)
    wide = [f"{name},{row(T, f)}" for name in "ab" for T, f in zip(np.linspace(0, 40, 13), SWEEP, strict=True)]
    with pytest.raises(hystrip.InputError, match=r"Set .a.: got .0.0 degC .* to 40.0 degC"):
        read(tmp_path, wide, "Set,T [degC],f [Hz],E' [Pa],E'' [Pa]")


def test_reference_of_the_command_is_the_one_asked_for(run, tmp_path):
    read(tmp_path, [row(T, f) for T in (0, 10, 20, 30) for f in SWEEP])
    status, out, err = run("master", tmp_path / "raw.csv", "--reference", "25 degC", "--no-plot", "--out", tmp_path / "out")
    assert (status, err) == (0, "") and "master     at 25.0 degC" in out
    status, out, err = run("master", tmp_path / "raw.csv", "--reference", "200 degC", "--no-plot", "--out", tmp_path / "out2")
    assert status == 2 and "--reference" in err and "0.0 degC (273.15 K) to 30.0 degC (303.15 K)" in err


def test_frequencies_close_together_are_several(tmp_path):
    found = read(tmp_path, [row(T, f) for T in (20, 26) for f in np.geomspace(1, 100, 1500)])
    assert [each.omega.size for each in found] == [1500, 1500] and max(map(repeats_differ, found)) < 0.01

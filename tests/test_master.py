"""Master curves: the shift that isotherms were made with comes back; and the example from isotherms and scan to friction."""

import dataclasses

import numpy as np
import pytest

import hystrip
from hystrip.dma import DynamicModulus, fit_prony, master_curve, read_dma, read_isotherms, superposition
from hystrip.dma.read import read_shift
from hystrip.example import rubber
from hystrip.plots.master import master_curve as draw
from hystrip.scene import load_scene

TIMES = np.geomspace(1e-9, 100, 34)
MODULI = 2e7 * np.exp(-(((np.log10(TIMES) + 4) / 2.2) ** 2) / 2)
FREQUENCY = np.geomspace(0.1, 100, 13)


WILLIAMS = hystrip.WLF(8.86, 101.6, 293.15)


def isotherms(shift, celsius, noise=0.0, frequency=FREQUENCY, seed=0):
    rng = np.random.default_rng(seed)
    found = []
    for T in np.array(celsius) + 273.15:
        x = 2j * np.pi * float(shift.factor(T)) * np.multiply.outer(frequency, TIMES)
        E = (1e6 + (x / (1 + x)) @ MODULI) * float(shift.modulus_factor(T))
        scatter = 1 + noise * rng.standard_normal((2, len(frequency)))
        found.append(DynamicModulus(2 * np.pi * frequency, E.real * scatter[0], E.imag * scatter[1], temperature=T))
    return found


def decades_off(found, shift=WILLIAMS):
    """log10 of the shift factors less their true values, (n,)."""
    return np.log10(found.a_T * shift.factor(found.T_ref) / shift.factor(found.temperatures))


@pytest.mark.parametrize(
    ("shift", "vertical"),
    [
        (hystrip.WLF(8.86, 101.6, 293.15), False),
        (hystrip.WLF(8.86, 101.6, 293.15, vertical=1.0), True),
        (hystrip.Arrhenius(1.4e5, 293.15), False),
    ],
)
def test_shift_of_made_isotherms_comes_back(shift, vertical):
    celsius = np.arange(-10, 61, 5)
    found = master_curve(isotherms(shift, celsius, 0.01)[::-1], vertical=vertical)
    assert found.T_ref == pytest.approx(293.15) and type(found.shift) is type(shift)
    T = celsius + 273.15
    assert np.abs(np.log10(found.a_T / shift.factor(T))).max() < 0.05
    assert np.abs(np.log10(found.shift.factor(T) / shift.factor(T))).max() < 0.05
    assert found.b_T == pytest.approx(shift.modulus_factor(T), rel=0.03) and found.rms < 0.012
    labels = [panel.get_ylabel() for panel in draw(found).axes]
    assert labels[:2] == ["modulus $E$ (Pa)", "modulus $E/b_T$ (Pa)" if vertical else "modulus $E$ (Pa)"]
    # standard errors say how uncertain the factors are
    off = np.log(found.a_T / shift.factor(T)) / np.maximum(found.a_T_error, 1e-3)
    assert np.sqrt(np.mean(off**2)) < 4
    # and the curve is the modulus at the reference temperature
    series = fit_prony(found.data, terms=12)
    x = 1j * np.multiply.outer(found.data.omega, TIMES)
    exact = 1e6 + (x / (1 + x)) @ MODULI
    inner = slice(10, -10)
    assert np.abs(series.modulus(found.data.omega) / exact - 1)[inner].max() < 0.12


def test_reference_and_law_are_chosen():
    found = master_curve(isotherms(WILLIAMS, [10, 20, 30, 40]), T_ref=304.0, law="Arrhenius")
    assert found.T_ref == found.data.temperature == 304.0 and isinstance(found.shift, hystrip.Arrhenius)
    assert "Arrhenius: E_a" in found.report()


def test_master_curve_moves_to_any_measured_temperature():
    given = isotherms(hystrip.WLF(8.86, 101.6, 293.15, vertical=1.0), [0, 10, 20, 30, 40])
    at = {T_ref: master_curve(given, T_ref=T_ref, vertical=True) for T_ref in (293.15, 297.0, 303.15)}
    for T_ref, found in at.items():
        assert found.T_ref == T_ref and np.abs(decades_off(found)).max() < 0.005
        assert found.shift.factor(273.15) == pytest.approx(WILLIAMS.factor(273.15) / WILLIAMS.factor(T_ref), rel=0.02)
        assert found.b_T == pytest.approx(found.temperatures / T_ref, rel=0.01)
    # between isotherms none is certain, and the two next to the reference are the least uncertain
    errors = at[297.0].a_T_error
    assert errors.min() > 0 and set(np.argsort(errors)[:2]) == {2, 3}
    for outside in (25.0, 473.15):
        with pytest.raises(hystrip.InputError, match=r"T_ref.* 0.0 degC \(273.15 K\) to 40.0 degC \(313.15 K\)"):
            master_curve(given, T_ref=outside)


@pytest.mark.parametrize(
    ("celsius", "frequency", "pair"),
    [
        ([-30, 20, 60], FREQUENCY, "-30.0 degC .* and 20.0 degC .* more than a decade is missing"),
        ([-7, 20], FREQUENCY, "-7.0 degC .* and 20.0 degC .* about 0.[12] decades are missing"),
        ([-5, 20, 30], FREQUENCY, "-5.0 degC .* and 20.0 degC .* they share 0.1"),
        (range(-55, -29, 5), FREQUENCY, "-55.0 degC .* and -50.0 degC .* and . more.; allowed"),
        (range(-30, 61, 6), np.array([1.0, 10.0]), "-30.0 degC .* and -24.0 degC .* decades are missing"),
    ],
)
def test_neighbours_that_do_not_overlap_after_shifting_are_refused(celsius, frequency, pair):
    with pytest.raises(hystrip.InputError, match=pair):
        master_curve(isotherms(WILLIAMS, celsius, frequency=frequency))


def test_a_gap_across_which_nothing_determines_a_shift_is_told_as_one():
    with pytest.raises(hystrip.InputError, match="degC .* and .*; allowed: neighbours that overlap"):
        master_curve(isotherms(WILLIAMS, [-50, -44, 36, 42], 0.01, seed=2))


def test_an_isotherm_off_the_law_is_remarked_on():
    given = isotherms(WILLIAMS, range(-30, 61, 6), 0.01)
    assert not master_curve(given).remarks
    given[7] = dataclasses.replace(given[7], omega=2 * np.pi * given[7].omega)  # Hz taken for rad/s, or the reverse
    (said,) = master_curve(given).remarks
    assert said.startswith("at 12.0 degC a_T is 10^-0.80 times that of the law, others within 10^0.0")


def test_modulus_of_another_sample_is_refused():
    given = isotherms(WILLIAMS, range(-30, 61, 6))
    glass = given[0]
    given[0] = DynamicModulus(glass.omega, 3 * glass.storage, 3 * glass.loss, temperature=glass.temperature)
    with pytest.raises(hystrip.InputError, match="-30.0 degC .* and -24.0 degC .* no modulus in common"):
        master_curve(given)


def test_moduli_that_do_not_change_with_frequency_are_refused():
    flat = [DynamicModulus([1.0, 10.0, 100.0], np.full(3, 1e6), np.full(3, 1e5), temperature=T) for T in (290, 300)]
    with pytest.raises(hystrip.InputError, match="change with frequency determines the shift"):
        master_curve(flat)
    with pytest.raises(hystrip.InputError, match="or their frequencies too few"):
        master_curve(isotherms(WILLIAMS, (10, 20), frequency=np.array([0.1, 100.0])))


@pytest.mark.parametrize("celsius", [(10, 20), (10, 18, 26), (10, 20, 30)])
def test_errors_of_shifts_by_three_frequencies_are_those_of_a_curve_that_does_not_meet_all_points(celsius):
    found = [master_curve(isotherms(WILLIAMS, celsius, 0.005, np.array([0.1, 3.0, 100.0]), seed)) for seed in range(8)]
    off = np.ravel([decades_off(each)[each.temperatures != each.T_ref] for each in found])
    errors = np.ravel([np.log10(np.e) * each.a_T_error[each.temperatures != each.T_ref] for each in found])
    assert np.abs(off).max() < 0.1 and np.sqrt(np.mean((off / errors) ** 2)) < 2 and errors.min() > 1e-3


@pytest.mark.parametrize(
    ("celsius", "frequency"),
    [(range(-44, 60, 8), [0.3, 3, 10]), ([-48, *np.linspace(-25, 60, 40)], [0.1, 0.3, 1, 3, 10])],
)
def test_isotherms_that_do_not_overlap_are_refused_soon(monkeypatch, celsius, frequency):
    """A gap leaves loose how far apart its sides are: with many knots fits went on along it for seconds."""
    calls, splines = [], superposition._splines
    monkeypatch.setattr(superposition, "_splines", lambda *given: calls.append(1) or splines(*given))
    given = isotherms(WILLIAMS, celsius, 0.01, np.array(frequency))
    with pytest.raises(hystrip.InputError, match="neighbours that overlap after shifting"):
        master_curve(given)
    assert len(calls) < 1000


def test_two_frequencies_determine_shifts_of_near_temperatures():
    found = master_curve(isotherms(WILLIAMS, range(0, 61, 4), frequency=np.array([1.0, 10.0])))
    assert np.abs(decades_off(found)).max() < 0.005 and np.ptp(np.log10(found.a_T)) > 4.5


def test_law_of_a_ramp_in_small_steps():
    found = master_curve(isotherms(WILLIAMS, np.arange(0, 24, 0.4), frequency=np.array([1.0, 10.0, 100.0])))
    assert np.abs(decades_off(found)).max() < 0.005 and found.shift.C_1 == pytest.approx(8.86, rel=0.02)


def test_standard_errors_are_the_scatter_of_the_shifts():
    """Of isotherms with 2 % noise: usual ones, those with two frequencies, and a pair that shares a third of a decade."""
    sets = [(range(-20, 61, 8), FREQUENCY, False), (range(-20, 61, 8), FREQUENCY, True)]
    sets += [(range(0, 61, 4), np.array([1.0, 10.0]), False), ([-3.5, 20], FREQUENCY, False)]
    for celsius, frequency, vertical in sets:
        off = []
        for seed in range(12):
            found = master_curve(isotherms(WILLIAMS, celsius, 0.02, frequency, seed), T_ref=293.15, vertical=vertical)
            kept = found.a_T_error > 0
            off += list(decades_off(found)[kept] * np.log(10) / found.a_T_error[kept])
        assert 0.7 < np.sqrt(np.mean(np.square(off))) < 1.5, (list(celsius), len(frequency), vertical)


@pytest.mark.parametrize("vertical", [False, True])
def test_points_that_come_to_lie_on_one_another_determine_shifts(vertical):
    """Two frequencies a decade, shifted by half a decade: between few places a curve of many knots follows any shift."""
    given = []
    for i, T in enumerate((273.15, 283.15, 293.15, 303.15, 313.15)):
        omega = 2 * np.pi * np.array([0.1, 0.3, 1, 3, 10, 30, 100])
        z = (1e-3j * omega * 10 ** (-i / 2)) ** 0.5
        E = 1e6 + 5e8 * z / (1 + z)
        given.append(DynamicModulus(omega, E.real, E.imag, temperature=T))
    found = master_curve(given, T_ref=293.15, vertical=vertical)
    assert np.log10(found.a_T) == pytest.approx([1, 0.5, 0, -0.5, -1], abs=1e-3) and abs(found.shift.vertical) < 0.01


BUMPY = {"TIMES": np.geomspace(1e-9, 100, 20)}
BUMPY["MODULI"] = 2e7 * np.exp(-(((np.log10(BUMPY["TIMES"]) + 4) / 2.2) ** 2) / 2 + 1.2 * np.cos(5.0 * np.arange(20) ** 2))
#: 1/K, expansion of a rubber
EXPANSION = 6.5e-4


def density_ratio(T):
    """b_T of an ideal rubber, density times temperature, against 293.15 K."""
    return T / 293.15 / (1 + EXPANSION * (T - 293.15))


@pytest.mark.parametrize(
    ("spectrum", "noise", "whole"),
    [({}, 0.01, 0.0), ({}, 0.005, 0.01), (BUMPY, 0.01, 0.0), (BUMPY, 0.002, 0.0)],
    ids=["smooth", "clamped anew", "bumpy", "bumpy, quiet"],
)
def test_vertical_exponent_is_known_to_its_standard_error(monkeypatch, spectrum, noise, whole):
    """Two times of three within one, 19 of 20 within two: with noise of points, with another factor for each isotherm, as samples
    that are clamped anew have it, and for spectra whose bumps once passed for exponents of 0.6 +- 0.2 and the like."""
    for name, values in spectrum.items():
        monkeypatch.setitem(isotherms.__globals__, name, values)
    off = []
    for seed in range(45):
        v = (0.0, -1.0, 1 - EXPANSION * 293.15)[seed % 3]
        rng = np.random.default_rng(seed + 100)
        given = []
        for each in isotherms(WILLIAMS, range(-20, 61, 10), noise, FREQUENCY, seed):
            b = density_ratio(each.temperature) if v > 0 else (each.temperature / 293.15) ** v
            given.append(each.shifted(1.0, np.exp(whole * rng.standard_normal()) / b))
        found = master_curve(given, vertical=True)
        off.append((found.shift.vertical - v) / found.vertical_error)
    off = np.abs(off)
    assert 0.5 < np.mean(off < 1) < 0.85 and np.mean(off < 2) > 0.87 and off.max() < 4.5, np.sort(off)


def test_constants_of_wlf_that_only_their_ratio_is_known_of_are_remarked_on():
    """Shift factors straight over temperature: C_1 = 5000 and C_2 = 1e5 K, the bound, came out without a word."""
    celsius = np.arange(0, 61, 10)
    given = []
    for T, at_20 in zip(celsius, isotherms(WILLIAMS, [20] * 7, 0.003), strict=True):
        each = at_20.shifted(10 ** ((T - 20) / 20))  # measured at that frequency, it is hotter by so much
        given.append(dataclasses.replace(each, temperature=T + 273.15))
    found = master_curve(given, law="WLF")
    assert found.shift.C_1 / found.shift.C_2 == pytest.approx(1 / 20, rel=0.02) and found.shift.C_2 > 1e4
    (said,) = found.remarks
    assert said.startswith("log10 a_T is straight over temperature: C_1 and C_2 of WLF are known by their ratio alone, 0.0")
    assert not master_curve(isotherms(WILLIAMS, celsius, 0.003), law="WLF").remarks


def test_vertical_exponent_is_printed_with_its_standard_error_and_what_it_may_be():
    given = isotherms(WILLIAMS, range(-20, 61, 10), 0.01)

    def noted(v):
        found = master_curve([each.shifted(1.0, (293.15 / each.temperature) ** v) for each in given], vertical=True)
        stated = f"vertical exponent {found.shift.vertical:.3g} +- {found.vertical_error:.2g}; "
        assert stated in found.report() and 0.02 < found.vertical_error < 0.12
        assert found.b_T_error == pytest.approx(np.abs(np.log(found.temperatures / 293.15)) * found.vertical_error)
        return " ".join(each for each in found.remarks if "exponent" in each)

    assert noted(0.0).endswith("cannot be told from 0, no vertical shift")
    assert noted(0.9) == ""
    assert noted(-1.0).endswith("is neither 0 nor that of rubber elasticity, 0.75 to 1: filler, glass, or a sample that changed")
    assert "stands at a bound" in noted(3.5)
    plain = master_curve(given)
    assert plain.vertical_error == 0 and not plain.b_T_error.any() and "vertical exponent 0; " in plain.report()
    near = master_curve(isotherms(WILLIAMS, (18, 20, 22, 24, 26), 0.02, FREQUENCY[::2]), vertical=True)
    assert any("from 0, no vertical shift, nor from that of rubber elasticity" in each for each in near.remarks)


def test_shift_across_a_whole_number_of_decades_is_certain_as_its_neighbours():
    """The number of knots of the smooth curve once changed with the shifts, which made one of them certain to 3e-8."""
    given = isotherms(hystrip.WLF(8.86, 101.6, 293.15, vertical=1.0), range(-30, 61, 6))
    for T_ref in np.arange(290.0, 297.0, 1.0):
        errors = master_curve(given, T_ref=T_ref, vertical=True).a_T_error
        assert 0.3 < errors[0] / errors[1] < 3


def test_neighbours_that_share_little_are_remarked_on():
    found = master_curve(isotherms(WILLIAMS, [-3, 20, 30]), T_ref=293.15)
    assert found.remarks == ("-3.0 degC and 20.0 degC share 0.4 decades: the shift between them rests on little",)
    assert f"note       {found.remarks[0]}" in found.report()
    assert not master_curve(isotherms(WILLIAMS, [0, 20, 30])).remarks


def test_repeat_at_one_temperature_has_a_shift_of_its_own():
    given = isotherms(WILLIAMS, [0, 10, 20, 30])
    later = given[2].shifted(1.1)
    found = master_curve([*given, later])
    assert found.temperatures[2] == found.temperatures[3] == found.T_ref == 293.15
    assert found.a_T[2] == 1 and found.a_T[3] == pytest.approx(1 / 1.1, rel=0.003)
    # two temperatures determine no curvature, however often they were measured
    assert isinstance(master_curve([given[2], later, given[3]]).shift, hystrip.Arrhenius)


def test_repeats_that_differ_are_remarked_on():
    given = isotherms(WILLIAMS, [0, 10, 20, 30])
    x = given[2]
    both = {name: np.tile(getattr(x, name), 2) for name in ("omega", "storage", "loss")}
    both["storage"][13:] *= 1.3
    given[2] = DynamicModulus(**both, temperature=x.temperature)
    assert master_curve(given).remarks[0].startswith("at 20.0 degC moduli measured twice differ by up to 30 %")


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (lambda given: given[:1], "two or more"),
        (lambda given: 3, "two or more"),
        (lambda given: given * 501, "at most 1000"),
        (lambda given: [given[0], given[0]], "temperatures that differ"),
        (lambda given: [given[0], DynamicModulus([1.0, 2.0], [1e6, 1e6], [1e5, 1e5], "G", 300)], "kind: got 'G'"),
        (lambda given: [given[0], DynamicModulus([1.0, 2.0], [1e6, 1e6], [1e5, 1e5])], "temperature: got None"),
        (
            lambda given: [given[0], DynamicModulus([1.0, 2.0], [1e6, 1e6], [0, 1e5], temperature=300)],
            r"> 0.*: that at 26.9 degC and 0.1592 Hz",
        ),
        (lambda given: [given[0], DynamicModulus([1e9, 2e9], [1e6, 1e6], [1e5, 1e5], temperature=300)], "that overlap"),
    ],
)
def test_what_is_no_set_of_isotherms_is_refused(change, said):
    given = isotherms(hystrip.WLF(8.86, 101.6, 293.15), [10, 20])
    with pytest.raises(hystrip.InputError, match=said):
        master_curve(change(given))
    for options in ({"law": "wlf"}, {"T_ref": -1}):
        with pytest.raises(hystrip.InputError):
            master_curve(given, **options)


def test_files_without_temperatures_are_refused(tmp_path):
    (tmp_path / "a.csv").write_text("f [Hz],E' [kPa],E'' [kPa]\n1,2,3\n2,3,4\n", encoding="utf-8")
    with pytest.raises(hystrip.InputError, match="no column of temperatures"):
        read_isotherms(tmp_path / "a.csv")
    (tmp_path / "b.csv").write_text("T [K],f [Hz],E' [kPa],E'' [kPa]\n300,1,2,3\n300.2,2,3,4\n", encoding="utf-8")
    with pytest.raises(hystrip.InputError, match=r"one temperature, 27.0 degC \(300.10 K\)"):
        read_isotherms(tmp_path / "b.csv")
    (tmp_path / "c.csv").write_text("# shift: WLF C_1=8\nf [Hz],E' [kPa],E'' [kPa]\n1,2,3\n2,3,4\n", encoding="utf-8")
    with pytest.raises(hystrip.InputError, match="shift: got .# shift: WLF C_1=8"):
        read_shift(tmp_path / "c.csv")


@pytest.mark.parametrize("remark", ["# {}", '"# {}"', '"# {}";;', "\ufeff# {};;", "  # {}", "#{}"])
def test_a_shift_is_found_in_what_spreadsheets_make_of_its_remark(tmp_path, remark):
    stated = remark.format("shift: WLF C_1=8.86 C_2=101.6 T_ref=293.15 vertical=1.0")
    text = f'{stated}\r\n"f [Hz]";"E\' [kPa]";"E\'\' [kPa]"\r\n0,1;2,5;3\r\n2;3;4\r\n'
    (tmp_path / "a.csv").write_bytes(text.encode())
    assert read_shift(tmp_path / "a.csv") == hystrip.WLF(8.86, 101.6, 293.15, 1.0)


def test_example_from_isotherms_and_scan_to_friction(run, tmp_path):
    """The README's way, as a new user goes it: each command writes what the next one reads."""
    pytest.importorskip("SurfaceTopography")
    status, out, err = run("init", "--example", "rubber", tmp_path)
    assert (status, err) == (0, "") and "hystrip fit rubber.csv" in out
    assert sorted(rubber()) == sorted(path.name for path in tmp_path.iterdir() if path.is_file())
    load_scene(tmp_path / "scene.toml")
    assert run("init", "--example", "rubber", tmp_path)[0] == 2 and run("init", "--example", "steel")[0] == 2
    status, out, err = run("master", "raw.csv", "--vertical")
    assert (status, err) == (0, "") and "16, -30.0 degC to 60.0 degC" in out and "WLF" in out
    stated = (tmp_path / "hystrip-out/raw.shifts.csv").read_text(encoding="utf-8")
    assert "standard error of the vertical exponent: 0.0" in stated and "relative standard error of b_T" in stated
    status, out, err = run("fit", "hystrip-out/raw.master.csv", "--nu", 0.49, "--accuracy", 0.05, "--scene", "scene.toml")
    assert (status, err) == (0, "")
    status, out, err = run("levels", "scan.txt", "--count", 3, "--scene", "hystrip-out/raw.master.fitted.toml")
    assert (status, err) == (0, "")
    path = tmp_path / "hystrip-out/scan.levels.toml"
    text = path.read_text(encoding="utf-8")
    path.write_text(
        text.replace("num = 60", "num = 2").replace("# temperature = 313.15", "temperature = 313.15"), encoding="utf-8"
    )
    scene = load_scene(path)
    assert len(scene.levels) == 3 and float(scene.pressure) == 3e5 and scene.title == "Tread compound on a rough road"
    assert scene.material.shift.C_1 == pytest.approx(8.86, rel=0.1)
    status, out, err = run("solve", "hystrip-out/scan.levels.toml")
    assert (status, err) == (0, "")
    names = sorted(each.name for each in (tmp_path / "hystrip-out").iterdir() if each.name[0] != ".")
    assert "scan.spectrum.png" in names and len(names) == len(set(names)) == 10, names


def test_master_curve_of_the_example_is_its_own_formula():
    from hystrip.example import _SHIFT, _modulus

    files = rubber()
    assert rubber() == files
    curve = files["rubber.csv"].splitlines()
    assert curve[0].startswith("# shift: WLF C_1=8.86")
    f, storage, loss = np.loadtxt(curve[3:], delimiter=",").T
    E = _modulus(f, _SHIFT.T_ref)
    assert np.abs(1e6 * storage / E.real - 1).max() < 0.05 and np.abs(1e6 * loss / E.imag - 1).max() < 0.05


def test_shift_travels_with_the_curve(tmp_path):
    (tmp_path / "rubber.csv").write_text(rubber()["rubber.csv"], encoding="utf-8")
    assert read_shift(tmp_path / "rubber.csv") == hystrip.WLF(8.86, 101.6, 293.15, 1.0)
    assert read_dma(tmp_path / "rubber.csv").omega.size == 97


@pytest.mark.parametrize("law", ["best", "WLF", "Arrhenius"])
def test_times_that_grow_with_temperature_follow_no_law(law):
    """A column of temperatures upside down: WLF came out without any shift."""
    upside_down = isotherms(hystrip.Arrhenius(6e4, 293.15), [0, 20, 40])
    T = [each.temperature for each in upside_down]
    upside_down = [dataclasses.replace(each, temperature=at) for each, at in zip(upside_down, T[::-1], strict=True)]
    with pytest.raises(hystrip.InputError, match=r"isotherms: got 'log10 a_T = \[-.*allowed: times that become shorter"):
        master_curve(upside_down, law=law)

"""Master curves: the shift that isotherms were made with comes back; and the example from isotherms and scan to friction."""

import numpy as np
import pytest

import hystrip
from hystrip.dma import DynamicModulus, fit_prony, master_curve, read_dma, read_isotherms
from hystrip.dma.read import read_shift
from hystrip.example import rubber
from hystrip.scene import load_scene

TIMES = np.geomspace(1e-9, 100, 34)
MODULI = 2e7 * np.exp(-(((np.log10(TIMES) + 4) / 2.2) ** 2) / 2)
FREQUENCY = np.geomspace(0.1, 100, 13)


def isotherms(shift, celsius, noise=0.0):
    rng = np.random.default_rng(0)
    found = []
    for T in np.array(celsius) + 273.15:
        x = 2j * np.pi * float(shift.factor(T)) * np.multiply.outer(FREQUENCY, TIMES)
        E = (1e6 + (x / (1 + x)) @ MODULI) * float(shift.modulus_factor(T))
        scatter = 1 + noise * rng.standard_normal((2, 13))
        found.append(DynamicModulus(2 * np.pi * FREQUENCY, E.real * scatter[0], E.imag * scatter[1], temperature=T))
    return found


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
    # standard errors say how uncertain the factors are
    off = np.log(found.a_T / shift.factor(T)) / np.maximum(found.a_T_error, 1e-3)
    assert np.sqrt(np.mean(off**2)) < 4
    # and the curve is the modulus at the reference temperature
    series = fit_prony(found.data)
    x = 1j * np.multiply.outer(found.data.omega, TIMES)
    exact = 1e6 + (x / (1 + x)) @ MODULI
    inner = slice(10, -10)
    assert np.abs(series.modulus(found.data.omega) / exact - 1)[inner].max() < 0.12


def test_reference_and_law_are_chosen():
    shift = hystrip.WLF(8.86, 101.6, 293.15)
    found = master_curve(isotherms(shift, [10, 20, 30, 40]), T_ref=304.0, law="Arrhenius")
    assert found.T_ref == pytest.approx(303.15) and isinstance(found.shift, hystrip.Arrhenius)
    assert "Arrhenius: E_a" in found.report()


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (lambda given: given[:1], "two or more"),
        (lambda given: 3, "two or more"),
        (lambda given: [*given, given[0]], "different temperatures"),
        (lambda given: [given[0], DynamicModulus([1.0, 2.0], [1e6, 1e6], [1e5, 1e5])], "temperature: got None"),
        (lambda given: [given[0], DynamicModulus([1.0, 2.0], [1e6, 1e6], [0, 1e5], temperature=300)], "loss moduli > 0"),
        (lambda given: [given[0], DynamicModulus([1e9, 2e9], [1e6, 1e6], [1e5, 1e5], temperature=300)], "frequency overlap"),
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
    (tmp_path / "a.csv").write_text("f [Hz],E' [Pa],E'' [Pa]\n1,2,3\n2,3,4\n", encoding="utf-8")
    with pytest.raises(hystrip.InputError, match="no column of temperatures"):
        read_isotherms(tmp_path / "a.csv")
    (tmp_path / "b.csv").write_text("T [K],f [Hz],E' [Pa],E'' [Pa]\n300,1,2,3\n300.2,2,3,4\n", encoding="utf-8")
    with pytest.raises(hystrip.InputError, match="one temperature, 300.1 K"):
        read_isotherms(tmp_path / "b.csv")
    (tmp_path / "c.csv").write_text("# shift: WLF C_1=8\nf [Hz],E' [Pa],E'' [Pa]\n1,2,3\n2,3,4\n", encoding="utf-8")
    with pytest.raises(hystrip.InputError, match="shift: got .# shift: WLF C_1=8"):
        read_shift(tmp_path / "c.csv")


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

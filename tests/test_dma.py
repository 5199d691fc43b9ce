"""DMA data: what is read, and that a known spectrum comes back."""

import numpy as np
import pytest

import hystrip
from hystrip.dma import DynamicModulus, fit_prony, read_dma
from hystrip.scene import load_scene

OMEGA = np.geomspace(1e-2, 1e4, 61)
TIMES = np.geomspace(1e-4, 1e2, 7)
MODULI = np.array([3e8, 1e8, 2e7, 5e6, 2e6, 1e6, 4e5])


def known(relaxed, moduli, times, omega=OMEGA):
    """Storage and loss modulus of a Prony series, from their textbook forms."""
    x = np.multiply.outer(omega, times)
    return DynamicModulus(omega, relaxed + x**2 / (1 + x**2) @ moduli, x / (1 + x**2) @ moduli)


def written(path, data, head="f, E_stor, E_loss\nHz, MPa, MPa", scale=1e6):
    table = np.column_stack((data.omega / (2 * np.pi), data.storage / scale, data.loss / scale))
    path.write_text(head + "\n" + "\n".join(",".join(map(repr, row)) for row in table.tolist()) + "\n", encoding="utf-8")
    return path


def test_spectrum_on_the_grid_is_recovered():
    series = fit_prony(known(7e5, MODULI, TIMES))
    assert series.relaxed == pytest.approx(7e5, rel=1e-12)
    assert np.allclose(series.times, TIMES, rtol=1e-12) and np.allclose(series.moduli, MODULI, rtol=1e-11)
    assert max(series.rms_storage, series.rms_loss, series.worst) < 1e-12
    assert series.glassy == pytest.approx(7e5 + MODULI.sum(), rel=1e-12)


def test_times_that_are_not_there_are_dropped():
    series = fit_prony(known(7e5, MODULI[1::2], TIMES[1::2]))
    assert series.offered == 7 and np.allclose(series.times, TIMES[1::2]) and np.allclose(series.moduli, MODULI[1::2], rtol=1e-10)


@pytest.mark.parametrize("terms", [1, 2, 3, 4])
def test_times_are_placed_where_they_were(terms):
    rng = np.random.default_rng(terms)
    times = np.sort(10 ** (-4 + 6 * (np.arange(terms) + rng.uniform(0.2, 0.8, terms)) / terms))
    moduli = 10 ** rng.uniform(5, 9, terms)
    series = fit_prony(known(1e6, moduli, times), terms=terms)
    assert np.allclose(series.times, times, rtol=1e-7) and np.allclose(series.moduli, moduli, rtol=1e-7)


def test_noise_moves_the_modulus_by_less_than_itself():
    rng, exact = np.random.default_rng(7), known(7e5, MODULI, TIMES)
    noisy = DynamicModulus(
        OMEGA, exact.storage * (1 + 0.03 * rng.standard_normal(61)), exact.loss * (1 + 0.03 * rng.standard_normal(61))
    )
    series = fit_prony(noisy)
    assert 0.01 < series.rms_storage < 0.03 and 0.01 < series.rms_loss < 0.03
    off = series.modulus(OMEGA) / (exact.storage + 1j * exact.loss) - 1
    assert np.sqrt(np.mean(np.abs(off) ** 2)) < 0.02


def test_no_other_series_on_the_same_times_fits_better():
    """The optimum of the stated objective: moving any modulus, up or down, makes the sum of squares larger."""
    rng, exact = np.random.default_rng(3), known(7e5, MODULI, 3 * TIMES)
    data = DynamicModulus(
        OMEGA, exact.storage * (1 + 0.1 * rng.standard_normal(61)), exact.loss * (1 + 0.1 * rng.standard_normal(61))
    )
    series = fit_prony(data)

    def misfit(relaxed, moduli):
        x = np.multiply.outer(OMEGA, series.times)
        storage, loss = relaxed + x**2 / (1 + x**2) @ moduli, x / (1 + x**2) @ moduli
        return np.sum((storage / data.storage - 1) ** 2) + np.sum((loss / data.loss - 1) ** 2)

    best = misfit(series.relaxed, np.array(series.moduli))
    assert best == pytest.approx(61 * (series.rms_storage**2 + series.rms_loss**2), rel=1e-9)
    for change in (0.99, 1.01):
        assert misfit(series.relaxed * change, np.array(series.moduli)) > best
        for j in range(len(series.times)):
            moved = np.array(series.moduli)
            moved[j] *= change
            assert misfit(series.relaxed, moved) > best


def test_one_time_is_the_standard_linear_solid():
    K, T_eps, T_sigma, length = 1e9, 1e-2, 1e-4, 2e-3
    solid = hystrip.StandardLinearSolid(K, T_eps, T_sigma)
    omega = np.geomspace(1, 1e6, 40)
    stiffness = K * (1 + 1j * omega * T_eps) / (1 + 1j * omega * T_sigma)
    series = fit_prony(DynamicModulus(omega, stiffness.real * length, stiffness.imag * length), terms=1)
    found = series.standard_linear_solid(length)
    assert (found.K, found.T_eps, found.T_sigma) == pytest.approx((solid.K, solid.T_eps, solid.T_sigma), rel=1e-9)
    foundation = series.foundation(length)
    assert foundation.K + foundation.moduli[0] == pytest.approx(float(solid.K_glassy), rel=1e-9)


def test_layout_units_and_order(tmp_path):
    data = known(7e5, MODULI, TIMES)
    first = read_dma(written(tmp_path / "a.csv", data))
    assert np.allclose(first.omega, data.omega, rtol=1e-14) and np.allclose(first.storage, data.storage, rtol=1e-14)
    again = tmp_path / "b.csv"
    again.write_text("\ufeffG_loss,note,omega,G_stor\nkPa,,rad/s,GPa\n3,x,2,1e-6\n\n,y,5,1\n4,z,1,2e-6\n", encoding="utf-8")
    found = read_dma(again)
    assert (
        found.kind == "G"
        and found.omega.tolist() == [1, 2]
        and found.storage.tolist() == [2e3, 1e3]
        and found.loss.tolist() == [4e3, 3e3]
    )


def test_one_temperature_of_raw_data(tmp_path):
    path = tmp_path / "raw.csv"
    path.write_text(
        "f,E_stor,E_loss,T,Set\nHz,MPa,MPa,C,-\n1,1,.1,20,0\n2,2,.2,20,0\n1,3,.3,30,1\n2,4,.4,30,1\n", encoding="utf-8"
    )
    assert read_dma(path, "1").storage.tolist() == [3e6, 4e6]
    with pytest.raises(hystrip.InputError, match="Set: got .*master curve"):
        read_dma(path)


def test_band():
    data = known(7e5, MODULI, TIMES, 2 * np.pi * np.geomspace(1e-2, 1e4, 7))
    assert fit_prony(data.between(1, 100), per_decade=0.5).band == pytest.approx((1, 100), rel=1e-12)
    with pytest.raises(hystrip.InputError, match="measured: 0.01 to 1e\\+04 Hz"):
        data.between(2, 3)


HEAD = "f,E_stor,E_loss\nHz,MPa,MPa\n"
BAD_FILES = [
    ("", "0 rows"),
    ("f,E_stor,E_loss\n", "a row of units"),
    ("t,E_relax\ns,MPa\n1,2\n", "'f' \\(Hz\\) or 'omega'"),
    ("f,E_stor\nHz,MPa\n1,2\n", "'E_stor' and 'E_loss'"),
    ("f,E_stor,E_loss,E_stor\nHz,MPa,MPa,MPa\n1,2,3,4\n2,3,4,5\n", "row 1: got .*; allowed: one column named 'E_stor'"),
    (HEAD.replace("Hz", "kHz") + "1,2,3\n", "row 2, f: got 'kHz'; allowed: Hz"),
    (HEAD.replace("MPa,MPa", "MPa,psi") + "1,2,3\n", "row 2, E_loss: got 'psi'; allowed: one of Pa"),
    (HEAD + "1,2,3\n", "1 rows of numbers"),
    (HEAD + "1,2,3\n2,two,3\n", "row 4, E_stor: got 'two'"),
    (HEAD + '"1,5",2,3\n2,2,3\n', "row 3, f: got '1,5'; allowed: a number with a decimal point"),
    (HEAD + "1,2,3\n2,inf,3\n", "row 4: .*finite"),
    (HEAD + "0,2,3\n2,3,3\n", "f: got 0.0; allowed: numbers > 0"),
    (HEAD + "1,-2,3\n2,3,3\n", "E_stor: got -2.0; allowed: numbers > 0"),
    (HEAD + "1,2,-3\n2,3,3\n", "E_loss: got -3.0; allowed: numbers >= 0"),
]


@pytest.mark.parametrize(("text", "said"), BAD_FILES)
def test_bad_files_are_named(tmp_path, text, said):
    (tmp_path / "bad.csv").write_text(text, encoding="utf-8")
    with pytest.raises(hystrip.InputError, match=said) as refused:
        read_dma(tmp_path / "bad.csv")
    assert "bad.csv" in str(refused.value)


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"terms": 2, "per_decade": 1}, "one of the three"),
        ({"terms": 0}, "terms: got 0"),
        ({"terms": 2.0}, "terms: got 2.0"),
        ({"per_decade": 0}, "per_decade: got 0"),
        ({"per_decade": 1e9}, "fewer unknowns"),
        ({"times": [1.0, -1.0]}, "times: got -1.0"),
    ],
)
def test_bad_arguments(options, said):
    with pytest.raises(hystrip.InputError, match=said):
        fit_prony(known(7e5, MODULI, TIMES), **options)


def test_what_is_no_relaxing_solid_is_refused():
    with pytest.raises(hystrip.InputError, match="no relaxed modulus"):
        fit_prony(known(0.0, np.array([1e6]), np.array([1.0])))
    with pytest.raises(hystrip.InputError, match="loss modulus is not zero"):
        fit_prony(DynamicModulus([1.0, 10.0], [1e6, 1e6], [0.0, 0.0]))
    with pytest.raises(hystrip.InputError, match="exactly one"):
        fit_prony(known(7e5, MODULI, TIMES)).standard_linear_solid(1e-3)
    with pytest.raises(hystrip.InputError, match="length: got 0"):
        fit_prony(known(7e5, MODULI, TIMES)).foundation(0)


def test_several_times_are_a_prony_material():
    series = fit_prony(known(1e6, MODULI[2:4], TIMES[2:4]), times=TIMES[2:4])
    material = series.material(2e-3)
    assert isinstance(material, hystrip.Prony) and material.K == pytest.approx(5e8)
    assert material.times == pytest.approx(TIMES[2:4]) and material.moduli == pytest.approx(MODULI[2:4] / 2e-3)
    one = fit_prony(known(1e6, MODULI[:1], TIMES[:1]), terms=1).material(2e-3)
    assert isinstance(one, hystrip.StandardLinearSolid)


def test_command_writes_a_prony_scene_that_solves(run, tmp_path):
    written(tmp_path / "rubber.csv", known(1e6, MODULI[2:4], TIMES[2:4]))
    status, _, err = run("fit", "rubber.csv", "--terms", 2, "--length", 0.002)
    assert (status, err) == (0, "")
    scene = tmp_path / "hystrip-out/rubber.fitted.toml"
    case = load_scene(scene)
    assert case.edge == "constitutive" and case.material.times == pytest.approx(TIMES[2:4])
    scene.write_text(scene.read_text(encoding="utf-8").replace("pressure = 100\n", "pressure = 1e8\n"), encoding="utf-8")
    result = load_scene(scene).solve()
    # saturated on all levels: 1/2 sum k A^2 Im K* over the waves of Eq. 4, with the loss modulus that was measured
    tau = 0
    for level in case.levels:
        rate = level.k * result.velocity
        tau = tau + 0.5 * level.k * 1.5 * (level.h / 4) ** 2 * series_loss(rate, MODULI[2:4], TIMES[2:4]) / 2e-3
    assert np.allclose(result.tau, tau, rtol=1e-6)


def series_loss(rate, moduli, times):
    x = np.multiply.outer(rate, times)
    return x / (1 + x**2) @ moduli


def test_command_writes_a_scene_that_loads(run, tmp_path):
    written(tmp_path / "rubber.csv", known(1e6, np.array([9.9e7]), np.array([1e-4])))
    status, out, err = run("fit", "rubber.csv", "--terms", 1, "--length", "2 mm")
    assert (status, err) == (0, "") and "residuals" in out
    names = ["rubber.fit.csv", "rubber.fit.png", "rubber.fitted.toml"]
    assert sorted(path.name for path in (tmp_path / "hystrip-out").iterdir()) == names
    material = load_scene(tmp_path / "hystrip-out/rubber.fitted.toml").material
    assert (material.K, material.T_eps, material.T_sigma) == pytest.approx((5e8, 1e-2, 1e-4), rel=1e-9)
    text = (tmp_path / "hystrip-out/rubber.fitted.toml").read_text(encoding="utf-8")
    assert "# Fitted to rubber.csv" in text and "[adhesion]          # leave this table out" in text


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["absent.csv"], "absent.csv"),
        (["good.csv", "--terms", "9"], "terms: got 9"),
        (["good.csv", "--length", "2 mmm"], "--length: got '2 mmm'"),
        (["good.csv", "--length", "-1"], "length: got -1.0"),
        (["good.csv", "--low", "1e9"], "frequencies: got"),
        (["good.csv", "--set", "1"], "no column 'Set'"),
        (["good.csv", "--length", "1", "--scene", "absent.toml"], "absent.toml: no such file"),
    ],
)
def test_wrong_calls_leave_nothing(run, tmp_path, arguments, said):
    written(tmp_path / "good.csv", known(7e5, MODULI, TIMES))
    status, out, err = run("fit", *arguments)
    assert status == 2 and out == "" and said in err and "Traceback" not in err and err.count("\n") == 1
    assert [path.name for path in tmp_path.iterdir()] == ["good.csv"]

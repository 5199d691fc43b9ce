"""DMA data: what is read, and that a known spectrum comes back."""

import warnings

import numpy as np
import pint
import pytest

import hystrip
from hystrip.dma import DynamicModulus, fit_prony, placement, read_dma
from hystrip.dma.fit import ACCURACY, FitWarning
from hystrip.dma.projection import by_log_times, solved
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
    series = fit_prony(known(7e5, MODULI, TIMES), per_decade=1)
    assert series.relaxed == pytest.approx(7e5, rel=1e-12)
    assert np.allclose(series.times, TIMES, rtol=1e-12) and np.allclose(series.moduli, MODULI, rtol=1e-11)
    assert max(series.rms_storage, series.rms_loss, series.worst) < 1e-12
    assert series.glassy == pytest.approx(7e5 + MODULI.sum(), rel=1e-12)


def test_times_that_are_not_there_are_dropped():
    series = fit_prony(known(7e5, MODULI[1::2], TIMES[1::2]), per_decade=1)
    assert series.offered == 7 and np.allclose(series.times, TIMES[1::2]) and np.allclose(series.moduli, MODULI[1::2], rtol=1e-10)


@pytest.mark.filterwarnings("ignore:dma.loss over dma.storage")  # no rubber is that viscous
@pytest.mark.parametrize("terms", [1, 2, 3, 4])
def test_times_are_placed_where_they_were(terms):
    rng = np.random.default_rng(terms)
    times = np.sort(10 ** (-4 + 6 * (np.arange(terms) + rng.uniform(0.2, 0.8, terms)) / terms))
    moduli = 10 ** rng.uniform(5, 9, terms)
    series = fit_prony(known(1e6, moduli, times), terms=terms)
    assert np.allclose(series.times, times, rtol=1e-7) and np.allclose(series.moduli, moduli, rtol=1e-7)


@pytest.mark.parametrize(("noise", "points"), [(0.0, 150), (0.02, 200), (0.02, 20_000)])
def test_no_other_times_fit_better(noise, points):
    """Of all that was measured, not only of the few numbers in which times are looked for."""
    omega = np.geomspace(1e-2, 1e4, points)
    z, rng = (1j * omega) ** 0.4, np.random.default_rng(5)
    exact = 1e6 * (1 + 100 * z) / (1 + z)
    measured = exact + noise * (exact.real * rng.standard_normal(points) + 1j * exact.imag * rng.standard_normal(points))
    data = DynamicModulus.from_complex(omega, measured)
    series = fit_prony(data, terms=6)

    def misfit(times):
        return np.sum(solved(data, np.asarray(times))[1] ** 2)

    least = misfit(series.times)
    for i in range(6):
        for by in (-1e-3, 1e-3):
            moved = np.array(series.times)
            moved[i] *= 1 + by
            assert least < misfit(moved)


def test_work_does_not_grow_with_what_was_measured(monkeypatch):
    """20,000 frequencies took minutes: times are looked for with columns at as many as determine all others."""
    rows = []

    def counted(*arguments):
        rows.append(len(by_log_times(*arguments)))
        return by_log_times(*arguments)

    monkeypatch.setattr(placement, "by_log_times", counted)
    with pytest.warns(FitWarning):
        series = fit_prony(known(7e5, MODULI, TIMES, np.geomspace(1e-2, 1e4, 20_000)), terms=2)
    assert series.points == 20_000 and max(rows) < 400


@pytest.mark.parametrize("decades", [0.3, 1, 4, 12, 24])
def test_sums_over_many_frequencies_are_had_from_few(decades):
    rng = np.random.default_rng(3)
    omega = np.sort(np.append(10.0 ** rng.uniform(0, decades, 5000), [1.0, 10.0**decades]))
    times = 10.0 ** rng.uniform(-decades - 1, 1, 20)
    weights = rng.standard_normal((2 * omega.size, 3))
    few, taken = placement._sampled(omega, weights)
    assert few.size < 50 + 27 * decades
    for columns in (placement.columns, lambda omega, times: by_log_times(omega, times, np.ones(times.size))):
        exact, least = weights.T @ columns(omega, times), 1e-15 * np.abs(weights).sum()
        assert np.abs(taken.T @ columns(few, times) - exact).max() < 10 * least


def test_noise_moves_the_modulus_by_less_than_itself():
    rng, exact = np.random.default_rng(7), known(7e5, MODULI, TIMES)
    noisy = DynamicModulus(
        OMEGA, exact.storage * (1 + 0.03 * rng.standard_normal(61)), exact.loss * (1 + 0.03 * rng.standard_normal(61))
    )
    series = fit_prony(noisy, per_decade=1)
    assert 0.01 < series.rms_storage < 0.03 and 0.01 < series.rms_loss < 0.03
    off = series.modulus(OMEGA) / (exact.storage + 1j * exact.loss) - 1
    assert np.sqrt(np.mean(np.abs(off) ** 2)) < 0.02


def test_no_other_series_on_the_same_times_fits_better():
    """The optimum of the stated objective: moving any modulus, up or down, makes the sum of squares larger."""
    rng, exact = np.random.default_rng(3), known(7e5, MODULI, 3 * TIMES)
    data = DynamicModulus(
        OMEGA, exact.storage * (1 + 0.1 * rng.standard_normal(61)), exact.loss * (1 + 0.1 * rng.standard_normal(61))
    )
    with pytest.warns(hystrip.dma.FitWarning):
        series = fit_prony(data, per_decade=1)

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


EXPORTS = {
    "semicolons, decimal comma, one row of names": "Frequency [Hz];E' [MPa];E'' [MPa]\n0,5;1,5;0,25\n5;3;0,75\n",
    "tabs, spaces and tan delta": "Frequency (Hz)\tStorage modulus (MPa)\tTan delta\n0.5\t1.5\t0.16666666666666666\n5\t3\t0.25\n",
    "omega in rad/s, thousands": "omega in rad/s\tE_loss / kPa\tE_stor / kPa\n"
    "3.141592653589793\t250\t1,500\n31.41592653589793\t750\t3,000.0\n",
    "remarks above, exotic units": "Instrument: X\nDate, today\n\nE″ [N/mm^2],Temp. [°C],E′ [bar],f / mHz\n"
    "0.25,20,15,500\n0.75,20.3,30,5000\n",
    "units in a row, another column": "f;E';E\";note\nHz;Pa;Pa;\n0,5;1500000;250000;a;\n5;3e6;7,5e5;b\n;3e6;7,5e5;b\n",
    "units after underscores, one that is none": "f_Hz,E_stor_MPa,E''_kPa,T_C,T_ref\n0.5,1.5,250,20,a\n5,3,750,20,b\n",
    "absolute value and tan delta": "f [Hz],|E*| [MPa],tan δ\n"
    f"0.5,{1.5 * np.hypot(1, 1 / 6)},{1 / 6}\n5,{3 * np.hypot(1, 0.25)},0.25\n",
}


@pytest.mark.parametrize("name", EXPORTS)
@pytest.mark.parametrize("encoding", ["utf-8", "utf-16"])
def test_what_instruments_export(tmp_path, name, encoding):
    (tmp_path / "export.txt").write_text(EXPORTS[name], encoding=encoding)
    data = read_dma(tmp_path / "export.txt")
    assert data.frequency == pytest.approx([0.5, 5], rel=1e-12)
    assert data.storage == pytest.approx([1.5e6, 3e6], rel=1e-12) and data.loss == pytest.approx([2.5e5, 7.5e5], rel=1e-12)
    assert ("absolute value" if "absolute" in name else "storage modulus") in "".join(data.columns)


def test_ambiguous_numbers_can_be_decided(tmp_path):
    (tmp_path / "a.csv").write_text("f [Hz];E' [kPa];E'' [kPa]\n1;1,000;2,000\n2;3,000;4,000\n", encoding="utf-8")
    assert read_dma(tmp_path / "a.csv", decimal=",").storage.tolist() == [1e3, 3e3]
    assert read_dma(tmp_path / "a.csv", decimal=".").storage.tolist() == [1e6, 3e6]


def fractional_zener(omega):
    x = (1j * omega * 1e-4) ** 0.4
    return 1e6 + 1e9 * x / (1 + x)


def test_as_few_times_as_reach_the_accuracy():
    for accuracy in (0.05, 0.01):
        series = fit_prony(fractional_zener, band=(1e-2, 1e6), accuracy=accuracy)
        assert series.rms <= accuracy
        with np.errstate(all="raise"):
            fewer = fit_prony(fractional_zener, band=(1e-2, 1e6), terms=len(series.times) - 1)
        assert fewer.rms > accuracy


def test_times_beyond_the_band_count_among_those_that_reach_the_accuracy():
    """Of a spring-pot next to a dashpot no number of times evenly over the band gets there."""
    series = fit_prony(lambda omega: 1e6 * (1j * omega) ** 0.9, band=(1e-2, 1e3))
    assert series.rms <= ACCURACY and len(series.times) < 12


def test_table_function_and_data_give_the_same_series():
    omega = 2 * np.pi * np.geomspace(1e-2, 1e2, 49)
    E = fractional_zener(omega)
    one = fit_prony(fractional_zener, band=(1e-2, 1e2), accuracy=0.05)
    for data in ((omega, E), DynamicModulus(omega, E.real, E.imag)):
        assert fit_prony(data, accuracy=0.05).moduli == pytest.approx(one.moduli, rel=1e-6)
    for bad in (None, 3, (1, 2, 3), "E", (omega, ["a"] * 49)):
        with pytest.raises(hystrip.InputError):
            fit_prony(bad)
    with pytest.raises(hystrip.InputError, match="band: got None"):
        fit_prony(fractional_zener)
    with pytest.raises(hystrip.InputError, match=r"modulus: .*shape \(3,\)'; allowed: one for each omega"):
        fit_prony(lambda omega: np.ones(3), band=(1e-2, 1e2))


def test_a_band_may_be_an_array():
    fitted = [fit_prony(fractional_zener, band=band, terms=8) for band in ((1e-2, 1e2), np.array([1e-2, 1e2]))]
    assert fitted[0] == fitted[1]


def test_poor_fit_warns_with_its_band():
    with pytest.warns(hystrip.dma.FitWarning, match="poor fit: .* rms between 0.01 and 1e\\+06 Hz"):
        series = fit_prony(fractional_zener, band=(1e-2, 1e6), terms=3)
    assert series.quality.endswith("with 3 relaxation times")
    with pytest.warns(hystrip.dma.FitWarning, match="with 1 relaxation time$"):
        fit_prony(fractional_zener, band=(1e-2, 1e6), terms=1)
    # the error is said where it is: slow branches fit well here, or fast ones; nowhere beyond the band
    assert series.fit.error_between(1e-2, 1e6) == max(series.fit.rms) > 0.1
    assert series.fit.error_between(1e7, 1e9) is None and series.fit.low == pytest.approx(1e-2)
    assert np.sqrt(np.mean(np.square(series.fit.rms))) == pytest.approx(series.rms, rel=0.1)


def test_noise_that_no_series_fits_is_not_chased():
    rng, omega = np.random.default_rng(1), 2 * np.pi * np.geomspace(1e-2, 1e6, 80)
    E = fractional_zener(omega)
    noisy = DynamicModulus(omega, E.real * (1 + 0.05 * rng.standard_normal(80)), E.imag * (1 + 0.05 * rng.standard_normal(80)))
    series = fit_prony(noisy, accuracy=1e-4)
    assert len(series.times) < 16 and 0.03 < series.rms < 0.06


def test_standard_errors_are_those_of_repeated_measurements():
    exact = known(1e6, np.array([3e7, 4e6]), np.array([1e-3, 10.0]))
    rng, found = np.random.default_rng(5), []
    for _ in range(60):
        noise = 1 + 0.02 * rng.standard_normal((2, OMEGA.size))
        series = fit_prony(DynamicModulus(OMEGA, exact.storage * noise[0], exact.loss * noise[1]), terms=2)
        found.append((series.relaxed, *series.moduli, *series.times))
    scatter = np.std(np.log(found), axis=0)
    said = np.array((series.relaxed_error, *series.moduli_errors, *series.times_errors))
    assert (np.abs(np.log(said / scatter)) < 0.35).all()


def test_a_branch_beyond_the_times_that_are_looked_for_is_undetermined():
    slow, fast = 1 / OMEGA[0], 0.01 / OMEGA[-1]
    series = fit_prony(known(1e6, np.array([1e6, 1e9]), np.array([slow, fast])), terms=2)
    assert not np.isclose(series.times[0], fast, rtol=1) and series.times[1] == pytest.approx(slow, rel=0.01)
    assert np.isinf((series.times_errors[0], series.moduli_errors[0])).all()
    assert series.times_errors[1] < 0.1 and series.report().count("undetermined") == 2


def test_one_temperature_of_raw_data(tmp_path):
    path = tmp_path / "raw.csv"
    path.write_text(
        "f,E_stor,E_loss,T,Set\nHz,MPa,MPa,C,-\n1,1,.1,20,0\n2,2,.2,20,0\n1,3,.3,30,1\n2,4,.4,30,1\n", encoding="utf-8"
    )
    assert read_dma(path, "1").storage.tolist() == [3e6, 4e6]
    with pytest.raises(hystrip.InputError, match="Set: got .*master curve"):
        read_dma(path)


def test_frequencies_measured_twice_determine_no_more_times():
    data = known(7e5, MODULI, TIMES, np.repeat([1.0, 10, 100], 4))
    with pytest.raises(hystrip.InputError, match="3 relaxation times for 3 frequencies"):
        fit_prony(data, terms=3)
    with pytest.warns(FitWarning):
        series = fit_prony(data, accuracy=1e-6)
    assert len(series.times) <= 2 and np.isfinite(series.moduli_errors).all() and "fitted     12 points" in series.report()


def test_band():
    data = known(7e5, MODULI, TIMES, 2 * np.pi * np.geomspace(1e-2, 1e4, 7))
    with pytest.warns(hystrip.dma.FitWarning):  # three frequencies of a spectrum that spans six decades
        assert fit_prony(data.between(1, 100), terms=2).band == pytest.approx((1, 100), rel=1e-12)
    with pytest.raises(hystrip.InputError, match="measured: 0.01 to 1e\\+04 Hz"):
        data.between(2, 3)
    twice = DynamicModulus(*(np.repeat(each, 2) for each in (data.omega, data.storage, data.loss)))
    with pytest.raises(hystrip.InputError, match=r"frequencies: got \(0.5, 2\); .* two measured frequencies"):  # not of omega
        twice.between(0.5, 2)


HEAD = "f,E_stor,E_loss\nHz,MPa,MPa\n"
BAD_FILES = [
    ("", "no text"),
    ("   \n\n", "no text"),
    ("f,E_stor,E_loss\n", "column 'f', unit: got None; allowed: Hz, or rad/s"),
    (HEAD, "no row of numbers"),
    ("hello\nworld\n", "got 'hello'; allowed: a row of names, in one of them frequency or omega"),
    ("t,E_relax\ns,MPa\n1,2\n", "in one of them frequency or omega"),
    ("f,E_stor\nHz,MPa\n1,2\n", "line 1: .*in this row of names also one more of storage, loss"),
    ("f|E_stor|E_loss\nHz|MPa|MPa\n1|2|3\n", "separated by comma, semicolon or tab"),
    ("f,E_stor,E_loss,E_stor\nHz,MPa,MPa,MPa\n1,2,3,4\n2,3,4,5\n", "line 1: got .*; allowed: one column of storage"),
    ("f,E_stor,G_loss\nHz,MPa,MPa\n1,2,3\n2,3,4\n", "both of E or both of G"),
    ("f [s],E' [MPa],E'' [MPa]\n1,2,3\n2,3,4\n", "'f \\[s\\]', unit: got 's'; allowed: Hz, or rad/s"),
    ("f [rpm],E' [MPa],E'' [MPa]\n1,2,3\n2,3,4\n", "unit: got 'rpm'"),
    ("omega [Hz],E' [MPa],E'' [MPa]\n1,2,3\n2,3,4\n", "rad/s, since it is an angular frequency"),
    ("f [Hz],E' [m],E'' [MPa]\n1,2,3\n2,3,4\n", "a unit of stress such as MPa; 'm' is a unit of something else"),
    ("f [Hz],E' [mpa],E'' [MPa]\n1,2,3\n2,3,4\n", "the unit 'mpa' is not known \\(case counts\\)"),
    ("f [Hz],E',E''\n1,2,3\n2,3,4\n", '"E\'", unit: got None'),
    ("f [Hz],E' [MPa],tan delta [MPa]\n1,2,3\n2,3,4\n", "'tan delta \\[MPa\\]', unit: got 'MPa'; allowed: none, or %"),
    ("f [Hz],E'' [MPa],tan delta\n1,2,0\n2,3,4\n", "numbers > 0 where the storage modulus follows"),
    (HEAD + "1,2,3\n", "1 row of numbers"),
    (HEAD + "1,2,3\n1e300,2,3\n", "line 4, column 'f': got 1e\\+300; allowed: numbers > 0, in SI from 1e-40 to 1e\\+40"),
    (HEAD + "1,2,3\n2,2,1e39\n", "line 4, column 'E_loss': got 1e\\+39; allowed: numbers >= 0, in SI from 0 to 1e\\+40"),
    (HEAD + "1,2,3\n2,two,3\n", "line 4, column 'E_stor': got 'two'; allowed: a number with a decimal point"),
    (HEAD + "1,2,3\n2,1_000,3\n", "line 4, column 'E_stor': got '1_000'"),
    (HEAD + "1,2,3\n2,inf,3\n", "line 4: .*finite"),
    (HEAD + "0,2,3\n2,3,3\n", "line 3, column 'f': got 0.0; allowed: numbers > 0"),
    (HEAD + "1,-2,3\n2,3,3\n", "column 'E_stor': got -2.0; allowed: numbers > 0"),
    (HEAD + "1,2,-3\n2,3,3\n", "column 'E_loss': got -3.0; allowed: numbers >= 0"),
    ("f [Hz];E' [Pa];E'' [Pa]\n1;1,000;2,000\n2;3,000;4,000\n", "read in one way; say decimal"),
    ("f [Hz];E' [Pa];E'' [Pa]\n1;1,5;2.5\n2;3,5;4.5\n", "line 2, .*got '2.5'; allowed: a number with a decimal comma"),
    ("T [furlong],f [Hz],E' [Pa],E'' [Pa]\n1,1,1,1\n2,2,2,2\n", "'T \\[furlong\\]', unit: got 'furlong'; allowed: K"),
    ("T [°C],f [Hz],E' [Pa],E'' [Pa]\n-300,1,1,1\n2,2,2,2\n", "above absolute zero"),
    ("T [°C],f [Hz],E' [kPa],E'' [kPa]\n" + "".join(f"{T},{f},{f},1\n" for T in (20, 40) for f in (1, 2)), "`hystrip master`"),
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
        ({"terms": 2, "per_decade": 1}, "one of them"),
        ({"terms": 0}, "terms: got 0"),
        ({"terms": 2.0}, "terms: got 2.0"),
        ({"per_decade": 0}, "per_decade: got 0"),
        ({"terms": 41}, "an integer from 1 to 40"),
        ({"per_decade": 1e9}, "at most 40"),
        ({"per_decade": 25, "band": (1, 10)}, "fewer unknowns"),
        ({"accuracy": 0.9}, "accuracy: got 0.9"),
        ({"band": 3}, "band: got 3"),
        ({"times": [1.0, -1.0]}, "times: got -1.0"),
        ({"times": []}, "at least one relaxation time"),
        ({"times": 1e30}, "one gets a modulus, such as those from 0.0001 to 100 s"),
    ],
)
def test_bad_arguments(options, said):
    with pytest.raises(hystrip.InputError, match=said):
        fit_prony(known(7e5, MODULI, TIMES), **options)


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize(
    ("call", "said"),
    [
        (lambda data: DynamicModulus.from_function(np.sqrt, 1, 10, per_decade="12"), "per_decade: got '12'"),
        (lambda data: DynamicModulus.from_function(np.sqrt, 1, 10, per_decade=np.nan), "per_decade: got nan"),
        (lambda data: DynamicModulus.from_function(np.sqrt, 1, 10, per_decade=0), "per_decade: got 0"),
        (lambda data: DynamicModulus.from_function(np.sqrt, 1, 10, per_decade=1e6), "per_decade: .*up to 1000"),
        (lambda data: DynamicModulus.from_function(None, 1, 10), "modulus: got None; allowed: a function"),
        (lambda data: DynamicModulus.from_complex([1, 2], pint.Quantity([1, 2], "MPa")), "modulus: .*without a unit"),
        (lambda data: fit_prony((OMEGA, pint.Quantity(data.storage + 1j * data.loss, "MPa"))), "modulus: .*without a unit"),
        (lambda data: DynamicModulus.from_complex([1, 2], [True, 2 + 1j]), "modulus: got .True"),
        (lambda data: DynamicModulus.from_complex([1, 2], ["1", "2"]), "modulus: got .'1'"),
        (lambda data: data.between("1", 2), "low: got '1'"),
        (lambda data: data.between(-1, 2), "low: got -1; allowed: a finite number >= 0 .Hz."),
        (lambda data: data.between(1, -2), "high: got -2; allowed: a finite number >= 0 .Hz."),
        (lambda data: data.shifted(2.0, 0), "vertical: got 0"),
        (lambda data: data.shifted("2"), "factor: got '2'"),
        (lambda data: fit_prony(data).modulus("1"), "omega: got '1'"),
    ],
)
def test_calls_of_the_wrong_kind_are_named(call, said):
    with pytest.raises(hystrip.InputError, match=said):
        call(known(7e5, MODULI, TIMES))


@pytest.mark.filterwarnings("ignore:dma.loss over dma.storage")  # no rubber is that viscous
def test_what_is_no_relaxing_solid_is_refused():
    with pytest.raises(hystrip.InputError, match="^data: got 'no relaxed modulus"):
        fit_prony(known(0.0, np.array([1e6]), np.array([1.0])))
    with pytest.raises(hystrip.InputError, match="^data: .*loss modulus is not zero"):
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
    assert one.n == 1 and one.fit.low == pytest.approx(OMEGA[0] / (2 * np.pi))


def test_command_writes_a_prony_scene_that_solves(run, tmp_path):
    written(tmp_path / "rubber.csv", known(1e6, MODULI[2:4], TIMES[2:4]))
    status, _, err = run("fit", "rubber.csv", "--terms", 2, "--length", 0.002, "--pressure", "100 MPa")
    assert (status, err) == (0, "")
    scene = tmp_path / "hystrip-out/rubber.fitted.toml"
    case = load_scene(scene)
    assert case.edge == "constitutive" and case.material.times == pytest.approx(TIMES[2:4], rel=1e-5)
    assert (case.title, float(case.pressure)) == ("Rubber of rubber.csv", 1e8)
    result = load_scene(scene).solve()
    # saturated on all levels: 1/2 sum k A^2 Im K* over the waves of Eq. 4, with the loss modulus that was measured
    tau = 0
    for level in case.levels:
        rate = level.k * result.velocity
        tau = tau + 0.5 * level.k * 1.5 * (level.h / 4) ** 2 * series_loss(rate, MODULI[2:4], TIMES[2:4]) / 2e-3
    assert np.allclose(result.tau, tau, rtol=1e-5)


def series_loss(rate, moduli, times):
    x = np.multiply.outer(rate, times)
    return x / (1 + x**2) @ moduli


def test_command_writes_a_scene_that_loads(run, tmp_path):
    written(tmp_path / "rubber.csv", known(1e6, np.array([9.9e7]), np.array([1e-4])))
    status, out, err = run("fit", "rubber.csv", "--terms", 1, "--length", "2 mm", "--pressure", 1e5, "--title", 'A "layer"')
    assert (status, err) == (0, "") and "residuals" in out
    names = ["rubber.fit.csv", "rubber.fit.png", "rubber.fitted.toml"]
    assert sorted(path.name for path in (tmp_path / "hystrip-out").glob("[!.]*")) == names
    case = load_scene(tmp_path / "hystrip-out/rubber.fitted.toml")
    assert (
        case.title == 'A "layer"'
        and case.edge == "continuous"
        and case.material.fit.low == pytest.approx(1e-2 / (2 * np.pi), rel=1e-2)
    )
    solid = case.material.single
    assert (solid.K, solid.T_eps, solid.T_sigma) == pytest.approx((5e8, 1e-2, 1e-4), rel=1e-5)
    text = (tmp_path / "hystrip-out/rubber.fitted.toml").read_text(encoding="utf-8")
    assert "# Fitted to rubber.csv" in text and "[adhesion]          # leave this table out" in text


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["absent.csv"], "absent.csv"),
        (["fluid.csv"], "hystrip: fluid.csv: got 'no relaxed modulus"),
        (["good.csv", "--terms", "41"], "terms: got 41"),
        (["good.csv", "--length", "1 mm"], "--pressure: got None"),
        (["good.csv", "--nu", "0.5", "--length", "1 mm"], "--nu, --length"),
        (["good.csv", "--nu", "0.7", "--pressure", "1e5"], "nu: got 0.7"),
        (["good.csv", "--nu", "0.5", "--pressure", "1 bar m"], "--pressure: got '1 bar m'"),
        (["good.csv", "--length", "2 mmm"], "--length: got '2 mmm'"),
        (["good.csv", "--length", "-1", "--pressure", "1e5"], "length: got -1.0"),
        (["good.csv", "--low", "1e9"], "--low, --high: got"),
        (["good.csv", "--set", "1"], "no column 'Set'"),
        (["good.csv", "--length", "1", "--scene", "absent.toml"], "absent.toml: no such file"),
    ],
)
def test_wrong_calls_leave_nothing(run, tmp_path, arguments, said):
    written(tmp_path / "good.csv", known(7e5, MODULI, TIMES))
    written(tmp_path / "fluid.csv", known(0.0, np.array([1e6]), np.array([20.0])))
    status, out, err = run("fit", *arguments)
    assert status == 2 and out == "" and said in err and "Traceback" not in err and err.count("\n") == 1
    assert sorted(path.name for path in tmp_path.iterdir()) == ["fluid.csv", "good.csv"]


def test_command_writes_a_half_space(run, tmp_path):
    written(tmp_path / "rubber.csv", known(1e6, MODULI[2:4], TIMES[2:4]))
    status, out, err = run("fit", "rubber.csv", "--nu", "0.49", "--pressure", "0.3 MPa")
    assert (status, err) == (0, "") and "read       'E_stor': storage modulus E, in MPa" in out
    assert "note       adhesion, levels, velocity and rtol are those of `hystrip init`: edit them, or name a --scene" in out
    case = load_scene(tmp_path / "hystrip-out/rubber.fitted.toml")
    assert isinstance(case.material, hystrip.HalfSpace) and case.material.nu == 0.49
    assert case.material.moduli == pytest.approx(MODULI[2:4], rel=1e-5) and case.material.fit.rms
    # another material into a scene of several tables of it leaves nothing of the old one
    (tmp_path / "G.csv").write_text(
        "omega [rad/s];G' [MPa];tan delta\n1;1,1;0,05\n10;1,2;0,2\n100;2;0,3\n1000;3;0,05\n", encoding="utf-8"
    )
    status, out, err = run("fit", "G.csv", "--nu", "0.5", "--terms", 1, "--scene", "hystrip-out/rubber.fitted.toml")
    assert status == 0 and "hystrip init" not in out
    text = (tmp_path / "hystrip-out/G.fitted.toml").read_text(encoding="utf-8")
    assert (
        text.count("[material.fit]") == 1
        and "E = 2 (1 + nu) G" in text
        and load_scene(tmp_path / "hystrip-out/G.fitted.toml").material.n == 1
    )


@pytest.mark.parametrize(
    ("given", "said"),
    [
        (
            {"temperature": 20.0},
            "dma.temperature, taken for K: 1 of 1 values is at 20 K, where a rubber is within 100 to 473.15 K",
        ),
        ({"storage": [2.0, 1e3], "loss": [1.0, 1.0]}, "dma.storage, taken for Pa: 1 of 2 values is at 2 Pa, where a rubber is"),
        ({"storage": [2e12, 3e12]}, "dma.storage, taken for Pa: 2 of 2 values are at 2e.12 to 3e.12 Pa"),
        ({"loss": [1e6, 5e7]}, "dma.loss over dma.storage: 1 of 2 values is at 25 of tan delta, .*: per cent, or another unit"),
    ],
)
def test_moduli_and_temperatures_of_no_rubber_are_warned_of_as_those_of_a_file(given, said):
    usual = {"omega": [1.0, 10.0], "storage": [1e6, 2e6], "loss": [1e5, 1e5], "temperature": 293.15}
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        DynamicModulus(**usual)
    with pytest.warns(hystrip.dma.DataWarning, match=said) as told:
        data = DynamicModulus(**usual | given)
    assert len(told) == 1 and told[0].filename == __file__
    with warnings.catch_warnings():  # said once
        warnings.simplefilter("error")
        data.shifted(2.0).between(0.1)

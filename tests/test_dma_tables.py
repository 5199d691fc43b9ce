"""Tables of moduli as instruments export them: each is read as the same four numbers, or refused by name."""

import time
import warnings

import numpy as np
import pytest

import hystrip
from hystrip.dma import DynamicModulus, read_dma, read_isotherms
from hystrip.dma.read import read_readings


def written(tmp_path, text):
    (tmp_path / "table.csv").write_text(text, encoding="utf-8")
    return tmp_path / "table.csv"


def rows(*cells):
    return "".join(";".join(map(str, row)) + "\n" for row in cells)


# storage 1.5 and 3 MPa, loss 0.25 and 0.75 MPa at 0.5 and 5 Hz
HZ, RAD = (0.5, 5), (np.pi, 10 * np.pi)
MPA = ((1.5, 0.25), (3, 0.75))
SIZE = (np.hypot(1.5, 0.25), np.hypot(3, 0.75))
DELTA = (np.arctan2(0.25, 1.5), np.arctan2(0.75, 3))


def table(names, frequency=HZ, moduli=MPA, scale=1.0):
    return names + "\n" + rows(*((f, *(scale * each for each in E)) for f, E in zip(frequency, moduli, strict=True)))


EXPORTS = {
    "units below in square brackets": table("Frequency;Storage Modulus;Loss Modulus\n[Hz];[MPa];[MPa]"),
    "per second below in brackets": table("Angular frequency;E';E''\n[1/s];[MPa];[MPa]", RAD),
    "acute accents": table("f [Hz];E´ [MPa];E´´ [MPa]"),
    "slashes without blanks": table("f/Hz;E'/MPa;E''/MPa"),
    "slash and brackets": table("f/(Hz);E'/(N/mm²);E''/(N/mm²)"),
    "curly and angle brackets": table("f {Hz};E' <MPa>;E'' <MPa>"),
    "a ratio is no modulus": table("f/Hz;E'/MPa;E''/MPa;E''/E'"),
    "dyn/cm2": table("f [Hz];E' [dyn/cm2];E'' [dyn/cm²]", scale=1e7),
    "N/mm2": table("f [Hz];E' [N/mm2];E'' [N mm-2]"),
    "N/m2": table("f [Hz];E' [N/m2];E'' [N·m⁻²]", scale=1e6),
    "rad s⁻¹": table("f [rad s⁻¹];E' [MPa];E'' [MPa]", RAD),
    "rad.s-1": table("Angular freq [rad.s-1];E' [MPa];E'' [MPa]", RAD),
    "rad·s-1": table("Ang. Freq. [rad·s-1];E' [MPa];E'' [MPa]", RAD),
    "rad/min": table("f [rad/min];E' [MPa];E'' [MPa]", (60 * np.pi, 600 * np.pi)),
    "s⁻¹": table("f [s⁻¹];E' [MPa];E'' [MPa]"),
    "modulus behind the symbol": table("f [Hz];E' modulus [MPa];E''-Modul [MPa]"),
    "Young's": table("f [Hz];Young's storage modulus [MPa];Young’s loss modulus [MPa]"),
    "symbol in brackets": table("f [Hz];Storage (E') [MPa];Loss (E'') [MPa]"),
    "unit in name and below, the same": table("f [Hz];E' [MPa];E''\nHz;N/mm2;MPa"),
    "phase angle in degrees": table("f [Hz];|E*| [MPa];Phase angle [°]", moduli=zip(SIZE, np.degrees(DELTA), strict=True)),
    "delta in rad": table("f [Hz];E* [MPa];delta [rad]", moduli=zip(SIZE, DELTA, strict=True)),
    "storage and delta": table("f [Hz];E' [MPa];δ\n;;deg", moduli=zip((1.5, 3), np.degrees(DELTA), strict=True)),
    "storage and absolute": table("f [Hz];E' [MPa];|E*| [MPa]", moduli=zip((1.5, 3), SIZE, strict=True)),
    "loss and absolute": table("f [Hz];E'' [MPa];|E*| [MPa]", moduli=zip((0.25, 0.75), SIZE, strict=True)),
    "thousands parted by blanks": "f [Hz];E' [Pa];E'' [Pa]\n0.5;1 500 000;250 000.0\n5;3 000 000;750 000.0\n",
    "by no-break blanks": "f [Hz];E' [Pa];E'' [Pa]\n0,5;1\u00a0500\u00a0000;250\u202f000\n5;3\u00a0000\u00a0000;750\u202f000,0\n",
    "by apostrophes": "f [Hz];E' [Pa];E'' [Pa]\n0.5;1'500'000;250’000\n5;3'000'000;750’000\n",
    "by points, comma elsewhere": "f [Hz];E' [kPa];E'' [kPa]\n0,5;1.500;250\n5;3.000;750\n",
    "by points, twice": "f [mHz];E' [Pa];E'' [Pa]\n500;1.500.000;250.000\n5.000;3.000.000;750.000\n",
    "by commas, point elsewhere": "f [Hz];E' [kPa];E'' [kPa]\n0.5;1,500;250\n5;3,000;750\n",
    "three digits between commas": "f [Hz],E' [MPa],E'' [kPa]\n0.5,1.500,250\n5,3,750\n".replace("0.5", "0.500"),
    "names behind the sign of a remark": table("# f [Hz];E' [MPa];E'' [MPa]"),
    "units behind it too": table("# f;E';E''\n# Hz;MPa;MPa"),
    "blanks, units behind it too": "% f E' E''\n%Hz MPa MPa\n5.0e-01 1.5e+00 2.5e-01\n5.0e+00 3.0e+00 7.5e-01\n",
    "names in a remark and again": "# f;E';E''\n" + table("f [Hz];E' [MPa];E'' [MPa]"),
    "names again above each part": "[step]\nsweep 1\n"
    + table("f;E';E''\nHz;MPa;MPa", HZ[:1], MPA[:1])
    + "[step]\nName;sweep 2\n"
    + table("f;E';E''\nHz;MPa;MPa", HZ[1:], MPA[1:]),
    "quotation mark in a remark": '"Sample: foo\nx\n' + table("f [Hz];E' [MPa];E'' [MPa]"),
    "quotation mark below": table("f [Hz];E' [MPa];E'' [MPa];note").replace("0.25\n", '0.25;"3 inch\n'),
    "name of two lines": table('f [Hz];"E\'\n[MPa]";"E\'\'\n[MPa]"'),
    "blanks, as many as align": "Frequency [Hz]   E' [MPa]  tan delta\n 0.5       1.5      0.16666666666666666\n 5  3  0.25\n",
    "a blank each": "Sample of frequency, storage\nSample: frequency storage loss\n"
    "f [Hz] storage modulus (MPa) loss modulus (MPa) Note\n0,5 1,5 0,25 x\n5 3 0,75 x\n",
    "blanks, units below": "angular frequency  E_stor  E''   note\nrad/s  MPa  N/mm^2  -\n"
    + "".join(f"{w!r} {E[0]} {E[1]} ok\n" for w, E in zip(RAD, MPA, strict=True)),
    "blanks beside a slash": "f / Hz E' / MPa E'' in MPa\n0.5\t1.5 0.25\n5 3 0.75\n",
    "blanks behind the sign of a remark": "# f [Hz] E' [MPa] E'' [MPa]\n5.0e-01 1.5e+00 2.5e-01\n5.0e+00 3.0e+00 7.5e-01\n",
    "blanks, names again above each": "step 1\nf E' E''\nHz MPa MPa\n0.5 1.5 .25\nstep 2 of 2\nf E' E''\nHz MPa MPa\n5 3 .75\n",
    "blanks and blanks in thousands": "f [Hz]   E' [Pa]   E'' [Pa]\n0.5   1 500 000   250 000\n5     3 000 000   750000\n",
    "blank cells to the right": table("f [Hz];E' [MPa];E'' [MPa];;").replace("0.25\n", "0.25;;;;\n"),
}


@pytest.mark.parametrize("name", EXPORTS)
def test_exports_are_read_as_the_same_numbers(tmp_path, name):
    data = read_dma(written(tmp_path, EXPORTS[name]))
    assert data.kind == "E" and data.frequency == pytest.approx(HZ, rel=1e-12)
    assert data.storage == pytest.approx([1.5e6, 3e6], rel=1e-12) and data.loss == pytest.approx([2.5e5, 7.5e5], rel=1e-12)


def test_what_stands_first_behind_the_sign_of_a_remark_is_a_column_too(tmp_path):
    export = "#INSTRUMENT:;DMA\n##Temp./°C;Freq./Hz;E'/MPa;E''/MPa\n20,0;0,5;1,5;0,25\n20,1;5;3;0,75\n"
    readings = read_readings(written(tmp_path, export))
    assert readings.temperature == pytest.approx([293.15, 293.25])


@pytest.mark.parametrize("unit", ["° C", "º C", "deg C", "°C"])
def test_a_degree_may_have_a_blank(tmp_path, unit):
    export = f"Temp. ({unit});f (Hz);E' (MPa);E'' (MPa)\n20,0;0,5;1,5;0,25\n20,1;5;3;0,75\n"
    assert read_dma(written(tmp_path, export)).temperature == pytest.approx(293.2)


def test_steps_of_temperature_may_have_tables_of_their_own(tmp_path):
    names = "Angular frequency;Storage modulus;Loss modulus;Temperature\nrad/s;MPa;MPa;°C\n"
    text = "".join(f"[step]\nFrequency sweep - {T}\n{names}1;3;1;{T}\n10;4;1;{T}\n\n" for T in (10, 20))
    readings = read_readings(written(tmp_path, text))
    assert readings.temperature == pytest.approx([283.15] * 2 + [293.15] * 2) and readings.omega.tolist() == [1, 10] * 2
    assert "2 tables with the same names, one below the other" in readings.columns


def test_all_digits_in_threes_between_commas_are_decimal_points(tmp_path):
    data = read_dma(written(tmp_path, "f [Hz],E' [MPa],E'' [MPa]\n1.000,2.100,1.200\n2.000,2.200,1.300\n"))
    assert data.storage == pytest.approx([2.1e6, 2.2e6]) and data.loss == pytest.approx([1.2e6, 1.3e6])


HEAD = "f [Hz];E' [MPa];E'' [MPa]\n"
REFUSED = {
    "decimal commas between commas": (
        "f [Hz],E' [MPa],E'' [MPa]\n1,2,1,0,3\n2,3,2,0,4\n",
        r"line 2: got \['1', '2', '1', '0', '3'\]; allowed: 3 cells, as many as there are names; with a decimal comma",
    ),
    "a cell without a name": ("f [Hz];E' [MPa];E'' [MPa];;\n1;2;1\n2;3;2;;x\n", "line 3: .*allowed: 3 cells"),
    "absolute below storage": (
        "f [Hz];E' [MPa];|E*| [MPa]\n1;2;3\n2;3;2.9\n",
        r"line 3, column '\|E\*\| \[MPa\]': got 2.9; allowed: numbers not below those of \"E' \[MPa\]\"",
    ),
    "absolute is loss": ("f [Hz];E'' [MPa];|E*| [MPa]\n1;2;3\n2;3;3\n", "got 3.0; allowed: numbers above those of"),
    "phase without unit": ("f [Hz];|E*| [MPa];delta\n1;2;3\n2;3;3\n", r"'delta', unit: got None; allowed: deg \(°\) or rad"),
    "phase of a liquid": ("f [Hz];|E*| [MPa];delta [deg]\n1;2;3\n2;3;90\n", "got 90.0; allowed: angles >= 0, below 90 degrees"),
    "units that disagree": ("f;E' [MPa];E''\nHz;kPa;MPa\n1;2;1\n2;3;2\n", "unit below it: got 'kPa'; allowed: 'MPa' as in"),
    "frequencies that disagree": ("f [Hz];E';E''\nrad/s;MPa;MPa\n1;2;1\n2;3;2\n", "got 'rad/s'; allowed: 'Hz' as in the name"),
    "degrees that disagree": ("f;E';E'';T [K]\nHz;MPa;MPa;°C\n1;2;1;20\n2;3;2;20\n", "got '°C'; allowed: 'K' as in the name"),
    "compliances": ("f [Hz];J' [1/MPa];J'' [1/MPa]\n1;2;1\n2;1;.5\n", "moduli where \"J' .*\" is a compliance: E' = J'/"),
    "a row behind the sign of a remark": (
        "# " + HEAD + "#1;2;3\n" + rows((1, 2, 1), (2, 3, 2)),
        "line 2, .*got '#1'; .*a number",
    ),
    "such a row between blanks": ("# f E' E''\n#Hz Pa Pa\n1 2 1\n#1 2 3\n2 3 2\n", "line 4, .*got '#1'; .*a number"),
    "one frequency": (HEAD + "5;2;0.3\n5;2.1;0.31\n", "frequency: got '2 rows of numbers, at 5 Hz alone'; .*two different"),
    "points or thousands": ("f [Hz];E' [kPa];E'' [kPa]\n1;2.100;210\n2;2.200;220\n", "got '2.100'; .*read in one way"),
    "both in threes": ("f [Hz];E' [kPa];E'' [kPa]\n1;2.100;1,210\n2;2.200;220\n", "read in one way"),
    "a cell missing between blanks": (
        "f [Hz]  E' [MPa]  E'' [MPa]  T [K]\n1  2  1  300\n2  3  300\n",
        "line 3: .*allowed: 4 cells, as many as there are names; parted by semicolon or tab where some are empty or hold blanks",
    ),
    "thousands parted like the cells": ("f [Hz] E' [Pa] E'' [Pa]\n1 2000 100\n2 3 000 200\n", "line 3: .*allowed: 3 cells"),
    "a number more than names": (
        "f [Hz] E' [Pa] tan delta\n1 2 000 0.1\n2 3 000 0.2\n",
        r"line 1: got .*'tan delta'\]; allowed: as many names as numbers below, two blanks or more between",
    ),
    "names that blanks part in several ways": (
        "f storage modulus loss modulus\nHz MPa MPa\n1 2 1\n2 3 2\n",
        "line 1: .*as many names",
    ),
    "a column missing below names that blanks part surely": (
        "E' [MPa]  t (s)  tan delta  Force [N]  f (Hz)\n3.7 49.3 0.6 0.1\n4.4 74.8 0.3 10\n",
        "line 1: .*as many names as numbers below",
    ),
    "a number more than names behind the sign of a remark": (
        "# f [Hz]  E' [MPa]  E'' [MPa]\n1 2 1 500\n2 3 2 500\n",
        "line 1: got .*'f .Hz.'.*as many names as numbers below",
    ),
    "blanks and commas": ("f E' E''\nHz Pa Pa\n1.500, 2.500, 3.500\n2.500, 3.500, 4.500\n", "line 3: .*parted by blanks alone"),
    "one column short, between blanks": ("f [Hz]  E' [MPa]  Elost [MPa]\n1  2  1\n2  3  2\n", "line 1: got .*also one more of"),
    "no frequency": ("remark\nTime;G' [MPa];G'' [MPa]\n1;2;1\n", "line 2: got .*in this row of names also frequency or omega$"),
    "logarithms": ("log f [Hz];log E' [Pa];log E''\n1;6;5\n", "line 1: .*also frequency .*themselves where 'log f .Hz.' has log"),
    "a logarithm": (
        "log10 frequency;E' [Pa];E'' [Pa]\n1;6;5\n",
        "also frequency or omega; the numbers .* 'log10 frequency' has log",
    ),
    "no loss": ("f, Hz;E' [MPa];Elost [MPa]\n1;2;1\n", "line 1: got .*also one more of storage, loss .*tan delta or delta$"),
    "no moduli": ("f, Hz;Ep [MPa];Edp [MPa]\n1;2;1\n", "line 1: got .*also two of storage, loss"),
    "kinds that contradict": ("f [Hz];E' [MPa];G'' [MPa]\n1;2;1\n2;3;2\n", "both of E or both of G"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_what_can_be_read_wrongly_is_refused(tmp_path, name):
    text, said = REFUSED[name]
    with pytest.raises(hystrip.InputError, match=said) as refused:
        read_dma(written(tmp_path, text))
    assert "table.csv" in str(refused.value)


def test_blanks_in_a_name_take_no_time(tmp_path):
    (tmp_path / "wide.csv").write_text(f"f [Hz],G' [Pa],G'' [Pa],a{' ' * 5000}x\n1,1e6,1e5,1\n10,2e6,2e5,1\n100,3e6,2e5,1\n")
    assert read_dma(tmp_path / "wide.csv").storage.tolist() == [1e6, 2e6, 3e6]


def test_what_parts_the_cells_is_said(tmp_path):
    said = read_dma(written(tmp_path, EXPORTS["a blank each"])).columns
    assert "'f [Hz]': frequency, in Hz" in said and "cells parted by blanks, decimal comma" in said


def test_lines_of_many_words_take_no_time(tmp_path):
    path = written(tmp_path, ("( " * 60_000 + "\n") * 20)
    start = time.process_time()
    with pytest.raises(hystrip.InputError, match="a row of names"):
        read_dma(path)
    assert time.process_time() - start < 3


def test_one_frequency_in_python_is_refused():
    with pytest.raises(hystrip.InputError, match="dma.omega: got 5.0; allowed: at least two different frequencies"):
        DynamicModulus([5.0, 5.0], [1e6, 1e6], [1e5, 1e5])


def test_decimal_sign_can_be_said_for_points_too(tmp_path):
    path = written(tmp_path, "f [Hz];E' [kPa];E'' [kPa]\n1;2.100;210\n2;2.200;220\n")
    with pytest.warns(hystrip.dma.DataWarning, match="tan delta"):
        assert read_dma(path, decimal=".").storage == pytest.approx([2100, 2200])
    assert read_dma(path, decimal=",").storage == pytest.approx([2.1e6, 2.2e6])


def test_moduli_without_a_letter(tmp_path):
    path = written(tmp_path, table("f [1/s];Storage Modulus [MPa];Loss Modulus [MPa]"))
    found = read_dma(path)
    said = "\n".join(found.columns)
    assert found.kind == "E" and "taken for Young's, E" in said and "shear=True (--shear)" in said
    assert "in 1/s, taken for Hz, cycles per second" in said
    shear = read_dma(path, shear=True)
    assert shear.kind == "G" and shear.storage.tolist() == found.storage.tolist() and "of shear, G" in "\n".join(shear.columns)
    named = read_dma(written(tmp_path, table("f [Hz];G' [MPa];G'' [MPa]")), shear=True)
    assert named.kind == "G" and "taken for" not in "\n".join(named.columns)
    with pytest.raises(hystrip.InputError, match="shear: got True; allowed: False: .*are moduli E"):
        read_dma(written(tmp_path, HEAD + "1;2;1\n2;3;2\n"), shear=True)


def at_temperatures(tmp_path, celsius, per=3):
    """A table of ``per`` frequencies at each temperature."""
    cells = ((T, 10**i, 2 + i, 1 + 0.001 * n) for n, T in enumerate(celsius) for i in range(per))
    return written(tmp_path, "T [degC];f [Hz];E' [MPa];E'' [MPa]\n" + rows(*cells))


def test_a_slow_ramp_is_no_single_temperature(tmp_path):
    steps = np.arange(-30, 60.1, 0.5)
    path = at_temperatures(tmp_path, steps)
    with pytest.raises(hystrip.InputError, match="temperature: got '543 rows at -30.0 to 60.0 degC'; .*`hystrip master`"):
        read_dma(path)
    found = read_isotherms(path)
    assert [each.temperature - 273.15 for each in found] == pytest.approx(steps) and {each.omega.size for each in found} == {3}


@pytest.mark.parametrize("celsius", [(19, 20), (20, 20.7, 21.4, 22.1), (20, 21.5)])
def test_steps_are_not_pooled(tmp_path, celsius):
    path = at_temperatures(tmp_path, celsius)
    assert [each.temperature - 273.15 for each in read_isotherms(path)] == pytest.approx(celsius)
    with pytest.raises(hystrip.InputError, match="temperature: got"):
        read_dma(path)


def test_bands_that_do_not_overlap_are_not_pooled_either(tmp_path):
    cells = [(T, f, 2 + f, 1) for T, band in ((60, (0.1, 0.5)), (20, (1, 5)), (-20, (10, 50))) for f in band]
    with pytest.raises(hystrip.InputError, match="6 rows at -20.0 to 60.0 degC"):
        read_dma(written(tmp_path, "T [degC];f [Hz];E' [MPa];E'' [MPa]\n" + rows(*cells)))


def test_drift_within_two_kelvin_is_one_temperature_and_said(tmp_path):
    found = read_dma(at_temperatures(tmp_path, (19.2, 19.8, 20.4, 21.2), per=2))
    assert found.temperature == pytest.approx(293.3) and found.columns[-1] == "temperature of the rows used: 19.2 to 21.2 degC"


def test_drift_is_told_from_steps_by_its_gaps(tmp_path):
    """Furnace steps of 1.4 K with a drift of 0.6 K each: no gap of 1 K between neighbours."""
    celsius = [T + drift for T in (20.0, 21.4, 22.8) for drift in (0, 0.3, 0.6)]
    found = read_isotherms(at_temperatures(tmp_path, celsius))
    assert [each.temperature - 273.15 for each in found] == pytest.approx([20.3, 21.7, 23.1])


def test_a_set_has_one_temperature(tmp_path):
    text = "Set;T [degC];f [Hz];E' [MPa];E'' [MPa]\n" + rows(
        (1, 20, 1, 2, 1), (1, 35, 2, 3, 1), (2, 20, 1, 2, 1), (2, 20, 2, 3, 1)
    )
    assert read_dma(written(tmp_path, text), "2").storage.tolist() == [2e6, 3e6]
    with pytest.raises(hystrip.InputError, match="2 rows at 20.0 to 35.0 degC"):
        read_dma(tmp_path / "table.csv", "1")


def test_utf_16_has_its_mark(tmp_path):
    text = "f [Hz]\tE' [kPa]\tE'' [kPa]\n1\t2\t3\n2\t3\t4\n"
    (tmp_path / "a.txt").write_bytes(text.encode("utf-16"))
    assert read_dma(tmp_path / "a.txt").omega.size == 2
    (tmp_path / "a.txt").write_bytes(text.encode("utf-16-le"))
    with pytest.raises(hystrip.InputError, match="UTF-16 with its byte order mark"):
        read_dma(tmp_path / "a.txt")


@pytest.mark.parametrize("none", ["", "-", "---", "–", "n/a", "NA", "null", "NaN"])
def test_a_row_with_a_cell_that_says_there_is_no_number_is_left_out(tmp_path, none):
    found = read_dma(written(tmp_path, f"f [Hz];E' [MPa];E'' [MPa]\n0.5;1.5;0.25\n2;2;{none}\n5;3;0.75\n"))
    assert found.storage.tolist() == [1.5e6, 3e6] and "1 row left out: a number is missing" in found.columns
    first = f"f [Hz];E' [MPa];E'' [MPa]\n{none};{none};{none}\n0.5;1.5;0.25\n5;3;0.75\n"  # it was taken for a row of units
    assert read_dma(written(tmp_path, first)).storage.tolist() == [1.5e6, 3e6]


def test_numbers_that_are_none_in_the_first_row_are_no_units(tmp_path):
    (tmp_path / "a.csv").write_text("f [Hz];E' [Pa];E'' [Pa]\n1.0D+00;2.0D+00;3.0D+00\n2.0D+00;3.0D+00;4.0D+00\n")
    with pytest.raises(hystrip.InputError, match=r"line 2, column 'f \[Hz\]': got '1.0D\+00'; allowed: a number"):
        read_dma(tmp_path / "a.csv")


@pytest.mark.parametrize(
    ("names", "cells", "said"),
    [
        (
            "T [°C];f [Hz];E' [MPa];E'' [MPa]",
            (20, 293.15),
            r"column 'T \[°C\]', taken for °C: 1 of 2 rows is at 566.3 K.*200 degC",
        ),
        ("T [K];f [Hz];E' [MPa];E'' [MPa]", (293.15, 20), r"column 'T \[K\]', taken for K: 1 of 2 rows is at 20 K"),
        (
            "T [K];f [Hz];E' [mPa];E'' [mPa]",
            (293, 293),
            'column "E\' \\[mPa\\]", taken for mPa: 2 of 2 rows are at 0.0015 to 0.003',
        ),
        ("T [K];f [Hz];E' [TPa];E'' [TPa]", (293, 293), "taken for TPa: 2 of 2 rows are at 1.5e\\+12 to 3e\\+12 Pa"),
        (
            "T [K];f [Hz];E' [MPa];E'' [GPa]",
            (293, 293),
            "taken for GPa: 2 of 2 rows are at 166.7 to 250 of tan delta, where .* 0 to 10: per",
        ),
    ],
)
def test_what_no_rubber_has_is_remarked_on(tmp_path, names, cells, said):
    text = names + "\n" + rows(*((T, f, *E) for T, f, E in zip(cells, HZ, MPA, strict=True)))
    with pytest.warns(hystrip.dma.DataWarning, match=said):
        read_readings(written(tmp_path, text))


#: moduli, and what follows from them exactly: tan delta, delta in degrees, the absolute value
ALL = [
    (f, E, loss, loss / E, np.degrees(np.arctan(loss / E)), np.hypot(E, loss)) for f, E, loss in ((0.5, 1.5, 0.25), (5, 3, 0.75))
]
NAMES = "f [Hz];E' [MPa];E'' [MPa];tan delta;delta [°];E* [MPa]"


@pytest.mark.parametrize(
    ("names", "cells"),
    [
        (NAMES, ALL),
        (NAMES, [(0.5, 1.5, 0.2, 0.17, 9.5, 1.52), (5, 3, 0.8, 0.25, 14, 3.1)]),  # the loss to one digit
        (NAMES, [(0.5, 1.5, 0.25, 0.2, 9, 2), (5, 3, 0.75, "2E-1", 14, "0.3e1")]),  # the others to one
        (NAMES, [(0.5, 1.5, 0.25, 0.172, 9.7, 1.55), (5, 3, 0.75, 0.243, 13.7, 3.0)]),  # 3 % of scatter
        (NAMES.replace("tan delta", "tan delta [%]"), [(0.5, 1.5, 0.25, 16.7, 9.46, 1.52), (5, 3, 0.75, "", "n/a", "-")]),
        (
            NAMES.replace("delta [°];E*", "delta;E*").replace("* [MPa]", "*"),
            [(0.5, 1.5, 0.25, 0.167, 3, 3), (5, 3, 0.75, "x", 3, 3)],
        ),
        (
            "f;E';E'';tan delta;delta;E*\nHz;MPa;MPa;%;rad;kPa",
            [(0.5, 1.5, 0.25, 16.7, 0.165, 1521), (5, 3, 0.75, 25, 0.245, 3092)],
        ),
        ("f [Hz];ω [1/s];E' [MPa];E'' [MPa]", [(0.5, "3.142", 1.5, 0.25), (5, "", 3, 0.75)]),
        ("f [Hz];ω [Hz];E' [MPa];E'' [MPa]", [(0.5, 0.5, 1.5, 0.25), (5, 5, 3, 0.75)]),
        ("f [Hz];E' [MPa];E'' [MPa];tan delta [V]", [(0.5, 1.5, 0.25, 3), (5, 3, 0.75, 3)]),
    ],
)
def test_columns_that_agree_but_for_digits_and_scatter_are_not_remarked_on(tmp_path, names, cells):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        data = read_dma(written(tmp_path, f"{names}\n{rows(*cells)}"))
    assert data.storage == pytest.approx([1.5e6, 3e6], rel=1e-12)


@pytest.mark.parametrize(
    ("names", "cells", "said"),
    [
        (
            "f [Hz];E' [MPa];E'' [MPa];tan delta",
            [(0.5, 1.5, 0.25, 0.167), (5, "3.000", "0.750", "0.350")],
            r"""column 'tan delta': 1 of 2 rows contradict "E' \[MPa\]" and "E'' \[MPa\]", by up to 40 % of the tan delta that """
            r"follows; the first, line 3, by \+40 %\.",
        ),
        ("f [Hz];E' [MPa];E'' [kPa];tan delta", [(0.5, 1.5, 250, 16.7), (5, 3, 750, 25.0)], "2 of 2 .* line 2, by .9900 %"),
        (
            "f [Hz];E' [MPa];E'' [MPa];tan delta",
            [(0.5, 1.5, 0.25, 0.15), (5, "3.00", "0.750", "0.20")],
            "1 of 2 .* line 3, by -20 %",
        ),
        ("f;E';E'';tan delta\nHz;MPa;MPa;%", [(0.5, 1.5, 0.25, 0.167), (5, 3, 0.75, 0.25)], "2 of 2 .* line 3, by -99 %"),
        (
            "f [Hz];E' [MPa];tan delta;delta [rad]",
            [(0.5, 1.5, 0.2, 0.2), (5, 3, 0.25, 0.345)],
            "'delta .rad.'.* line 3, by .44 %",
        ),
        (
            "f [Hz];ω [rad/s];E' [MPa];E'' [MPa]",
            [(0.5, "0.50", 1.5, 0.25), (5, "5.0", 3, 0.75)],
            "'ω .* 'f .Hz.'.* line 2, by -84 %",
        ),
        ("f [Hz];E' [MPa];E'' [MPa];delta [°]", [(0.5, 1.5, 0.25, "-9.5"), (5, 3, 0.75, 104)], "2 of 2 .* line 2, by -200 %"),
        (
            "f [Hz];E' [MPa];E'' [MPa];E* [kPa]",
            [(0.5, 1.5, 0.25, 1700), (5, 3, 0.75, 3092)],
            r"'E\* .* of the \|E\*\| .* 2, by .12 %",
        ),
    ],
)
def test_columns_that_contradict_each_other_are_remarked_on(tmp_path, names, cells, said):
    with pytest.warns(hystrip.dma.DataWarning, match=said):
        read_dma(written(tmp_path, f"{names}\n{rows(*cells)}"))


@pytest.mark.parametrize(
    ("names", "cells", "said"),
    [
        (
            "f [Hz];E' [Pa];E'' [Pa]",
            [(1, 1e6, 1e5), (10, 2e6, 1e-21)],
            r"line 3, column .E''.*: got 1e-21; .* 0, or 1e-20 to 1e\+40",
        ),
        ("f [Hz];E' [MPa];tan delta", [(1, 1, 1e-30), (10, 2, 0.1)], "line 2, column 'tan delta': got 1e-30; .* a loss modulus"),
        (
            "f [Hz];E' [Pa];E'' [Pa]",
            [(1, 1e6, 1e5), (10, 1e-30, 1e-1)],
            r"line 3, column .E' .*: got 1e-30; .* 1e-20 to 1e\+40 Pa",
        ),
        ("f [Hz];E' [GPa];tan delta", [(1, 1, 0.1), (10, 1e30, 1e20)], "line 3, column 'tan delta': got 1e.20; .* loss modulus"),
    ],
)
def test_moduli_beyond_all_are_refused_with_their_place(tmp_path, names, cells, said):
    with pytest.raises(hystrip.InputError, match=said):
        read_dma(written(tmp_path, f"{names}\n{rows(*cells)}"))


FOOTED = "f [Hz];E' [MPa];E'' [MPa]\n0.1;1.02;0.11\n1;1.31;0.28\n10;2.2;0.9\n"


@pytest.mark.parametrize(
    ("table", "footer", "line", "beginning"),
    [
        (FOOTED, "End of data\n", 5, "End of data"),
        (FOOTED, "\nComments: sample slipped; repeated\n", 6, "Comments: sample slipped repeated"),
        (FOOTED, "Operator;A. Smith;12.5;lab;3\n", 5, "Operator A. Smith 12.5 lab 3"),
        (FOOTED, "\nTg;-45,2 °C\n", 6, "Tg -45,2 °C"),  # which said that all others have a decimal comma
        (FOOTED, "Mean;1.5;0.4\n", 5, "Mean 1.5 0.4"),
        (FOOTED, "# " + "end " * 30, 5, "# " + ("end " * 30)[:38]),
        (FOOTED.replace(";", "  ").replace(" [", "["), "End of data\n", 5, "End of data"),
        (FOOTED.replace(";", "  ").replace(" [", "["), "Measured by A. Smith in 2024\n", 5, "Measured by A. Smith in 2024"),
    ],
)
def test_text_below_a_table_is_refused_as_such(tmp_path, table, footer, line, beginning):
    said = f"line {line}: got {beginning!r}; allowed: rows of numbers down to the end: delete the text below .*, line 4, or keep"
    with pytest.raises(hystrip.InputError, match=said):
        read_dma(written(tmp_path, table + footer))


def test_text_within_a_table_or_in_one_cell_is_no_footer(tmp_path):
    with_text = "\n".join(f"{first};{row}" for first, row in zip(("at", "ok", "ok", "ok"), FOOTED.splitlines(), strict=True))
    for text in (FOOTED.replace("1;1.31", "pause;1.31"), FOOTED + "100;overflow;0.9\n", with_text + "\nok;100;overflow;0.9\n"):
        with pytest.raises(
            hystrip.InputError, match="line [35], column .*: got '(pause|overflow)'; allowed: a number with a decimal"
        ):
            read_dma(written(tmp_path, text))


@pytest.mark.parametrize(
    ("names", "said"),
    [
        ("f [Hz];E' 10°C [MPa];E'' 10°C [MPa];E' 20°C [MPa]", "such as \"E' 10°C .MPa.\" and \"E'' 10°C"),
        ("f [Hz];E'(283 K);E'(293 K);E'(303 K)", 'such as "E\'.283 K." and "E\'.293 K'),
        ("f [Hz];10;20;30.5", "such as '10' and '20'"),
        ("T [°C];E' 1 Hz [MPa];E'' 1 Hz [MPa];E' 10 Hz [MPa]", 'and frequencies so, not in columns such as "E\' 1 Hz .MPa." and'),
        ("f [Hz];E' [MPa];E'' [MPa];E' [MPa]", "line 1: got .*; allowed: one column of storage; several temperatures"),
    ],
)
def test_columns_for_each_temperature_are_refused_as_such(tmp_path, names, said):
    with pytest.raises(hystrip.InputError, match=said) as refused:
        read_isotherms(written(tmp_path, f"{names}\n1;2;3;4\n10;3;4;5\n"))
    assert "several temperatures stand one below the other, each row with its temperature in a column of its own" in str(
        refused.value
    )


def test_columns_of_e_and_of_g_are_not_taken_for_two_temperatures(tmp_path):
    with pytest.raises(hystrip.InputError, match="one column of storage; of E or of G$"):
        read_dma(written(tmp_path, "f [Hz];E' [MPa];E'' [MPa];G' [MPa];G'' [MPa]\n1;3;0.3;1;0.1\n10;6;0.6;2;0.2\n"))


@pytest.mark.parametrize("rule", ["-" * 30, "=====  =====", "_________", "******", "----- ----- -----"])
def test_lines_that_rule_off_are_passed_over(tmp_path, rule):
    names, *below = ["f[Hz]  E'[MPa]  E''[MPa]", "0.1  1.02  0.11", "10  2.2  0.9"]
    for lines in ([names, rule, *below], [rule, names, *below], [names, *below, rule]):
        data = read_dma(written(tmp_path, "\n".join(lines)))
        assert data.storage == pytest.approx([1.02e6, 2.2e6]) and not any("left out" in each for each in data.columns)


def test_a_unit_may_follow_a_blank(tmp_path):
    data = read_dma(written(tmp_path, "Freq Hz,Temp °C,Storage modulus MPa,Phase angle deg\n0.1,20,1,10\n10,20,2,20\n"))
    assert data.frequency == pytest.approx([0.1, 10]) and data.temperature == pytest.approx(293.15)
    assert data.loss == pytest.approx(data.storage * np.tan(np.radians([10, 20])))
    data = read_dma(written(tmp_path, "Angular frequency rad/s;E' MPa;tan delta\n0.1;1;0.1\n10;2;0.2\n"))
    assert data.omega == pytest.approx([0.1, 10]) and data.storage == pytest.approx([1e6, 2e6])


@pytest.mark.parametrize("other", ["Temp C", "Set °C", "f Hz", "E' Pa", "tan delta K", "Delta K"])
def test_a_unit_behind_a_blank_makes_no_second_column_of_a_kind_and_none_of_another(tmp_path, other):
    """Names that came to nothing before units were read there."""
    last = "delta [rad]" if other == "Delta K" else "tan delta"
    names = f"Frequency [Hz];Temperature [K];{other};Storage modulus [MPa];{last}"
    data = read_dma(written(tmp_path, f"{names}\n0.1;293.15;20.1;1;0.001\n10;293.15;20.2;2;0.002\n"))
    assert data.frequency == pytest.approx([0.1, 10]) and data.temperature == pytest.approx(293.15)
    assert data.loss == pytest.approx([1e3, 4e3], rel=1e-5) and any(f"ignored: {other!r}" in each for each in data.columns)


STRAINS = "f [Hz];Strain [%];E' [MPa];E'' [MPa];T [°C];note\n" + "".join(
    f"{f};{strain};{E};0.3;{T};\n" for T in (20, 40) for f in (1, 10, 100) for strain, E in ((0.1, 3), (1, 2.4), (10, 1.5))
)


@pytest.mark.parametrize("read", [read_dma, read_isotherms])
def test_sweeps_of_strain_are_not_pooled_without_a_word(tmp_path, read):
    text = STRAINS if read is read_isotherms else "\n".join(row for row in STRAINS.splitlines() if ";40;" not in row)
    said = r"3 rows at 1 Hz and one temperature .* differ by up to 97 %; ignored columns that differ there: 'Strain \[%\]'\. "
    with pytest.warns(hystrip.dma.DataWarning, match=said):
        read(written(tmp_path, text))


@pytest.mark.parametrize("moduli", ["3;0.3", "3.1;0.3", "3;0.45"])
def test_repeats_that_scatter_are_not_remarked_on(tmp_path, moduli):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        read_dma(written(tmp_path, f"f [Hz];E' [MPa];E'' [MPa]\n1;3;0.3\n1.00001;{moduli}\n1.01;5;0.3\n"))


def test_of_a_spreadsheet_it_is_said_what_to_save(tmp_path):
    (tmp_path / "rubber.xlsx").write_bytes(b"PK\x03\x04\x14\x00\x06\x00" + bytes(200))
    with pytest.raises(
        hystrip.InputError, match=r"rubber.xlsx.* allowed: a text file \(.*; of a spreadsheet, one sheet saved as CSV"
    ):
        read_dma(tmp_path / "rubber.xlsx")

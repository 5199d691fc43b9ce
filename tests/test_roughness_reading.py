"""Reading measured roughness: units, gaps and decimal commas, the command, and what cannot be read is named."""

import re
import warnings
from pathlib import Path

import numpy as np
import pytest
from surfaces import eq4

import hystrip
from hystrip.roughness import Scan, levels_of, read_surface
from hystrip.scene import load_scene

LEVELS = [(1e-5, 1e-6), (5e-7, 1e-7)]


def found(result):
    return [(level.l, level.h) for level in result.levels]


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    topography = pytest.importorskip("SurfaceTopography")
    folder = tmp_path_factory.mktemp("scans")
    heights = eq4(LEVELS, 20.0e-6, 400) * 1e6
    topography.Topography(heights, (20.0, 20.0), unit="um", periodic=True).to_netcdf(str(folder / "scan.nc"))
    np.savetxt(folder / "plain.txt", heights)
    (folder / "text.csv").write_text("no,surface\n", encoding="utf-8")
    return folder


def test_a_file_with_units_is_read(files):
    scan = read_surface(files / "scan.nc")
    assert scan.periodic and scan.sizes == pytest.approx((2e-5, 2e-5), rel=1e-7)
    # this format keeps lengths in single precision
    assert np.allclose(found(levels_of(scan)), LEVELS, rtol=1e-7)


@pytest.mark.parametrize("magic", ["aISO-1.0", "aBCR-1.0"])
def test_surface_data_files_of_either_name_keep_their_scales(tmp_path, magic):
    """The format had another first line before ISO 25178-71, which the reader does not know."""
    pytest.importorskip("SurfaceTopography")
    heights = np.arange(90.0).reshape(9, 10) % 7
    header = {"NumPoints": 10, "NumProfiles": 9, "Xscale": 1e-6, "Yscale": 2e-6, "Zscale": 1e-9, "Compression": 0, "DataType": 7}
    lines = [magic, *(f"{name} = {value}" for name, value in header.items()), "*", *(" ".join(map(str, row)) for row in heights)]
    (tmp_path / "scan.sdf").write_text("\n".join([*lines, "*", ""]))
    scan = read_surface(tmp_path / "scan.sdf")
    assert scan.sizes == pytest.approx((1e-5, 1.8e-5)) and scan.heights == pytest.approx(1e-9 * heights.T)


def test_a_file_without_sizes_and_unit_takes_them(files):
    scan = read_surface(files / "plain.txt", sizes=(20.0, 20.0), unit="um")
    assert scan.sizes == pytest.approx((2e-5, 2e-5)) and np.allclose(scan.heights.std(), eq4(LEVELS, 2e-5, 400).std())


HEADS = {
    "nothing": "# Channel: Height\n",
    "lengths": "# Width: 0.02 mm\n# Height: 0.02 mm\n",
    "heights": "# Width: 20\n# Height: 20\n# Value units: µm\n",
    "both": "# Width: 20 µm\n# Height: 0.02 mm\n# Value units: um\n",
    "heights in words": "Height [nm]\n",
    "all in words": "# z in nm\n# Width: 0.02 mm\n# Height: 0.02 mm\n",
}
SIZES = {"sizes": (20.0, 20.0)}


def text_scan(path, head, factor=1e6, write=str):
    """Two levels on 20 x 20 um, as text below a head; heights in um unless the factor is another one."""
    rows = (" ".join(write(f"{each:.9g}") for each in row) for row in eq4(LEVELS, 2e-5, 160) * factor)
    path.write_text(HEADS[head] + "\n".join(rows) + "\n", encoding="utf-8")
    return path


@pytest.mark.parametrize(
    ("head", "options", "said"),
    [
        ("nothing", SIZES | {"unit": "um"}, "lengths in µm as given, heights in µm as given"),
        ("lengths", {"unit": "um"}, "lengths in mm as the file says, heights in µm as given"),
        ("heights", {"unit": "um"}, "lengths in µm as given, heights in µm as the file says"),
        ("both", {}, "lengths in µm as the file says x mm as the file says, heights in µm as the file says"),
    ],
)
def test_a_unit_stands_for_what_the_file_does_not_state(files, tmp_path, head, options, said):
    scan = read_surface(text_scan(tmp_path / "scan.txt", head), **options)
    assert scan.units == said and said in scan.report()
    assert scan.sizes == pytest.approx((2e-5, 2e-5)) and scan.heights.std() / eq4(LEVELS, 2e-5, 160).std() == pytest.approx(1)


@pytest.mark.parametrize(("head", "options"), [("heights in words", SIZES | {"unit": "um"}), ("all in words", {})])
def test_a_unit_of_heights_may_stand_in_words_above_them(files, tmp_path, head, options):
    """It was passed over: the unit given for lengths held for them, too, and they were a thousand times too large."""
    scan = read_surface(text_scan(tmp_path / "scan.txt", head, 1e9), **options)
    assert scan.units.endswith("heights in nm as the file says") and scan.sizes == pytest.approx((2e-5, 2e-5))
    assert scan.heights.std() / eq4(LEVELS, 2e-5, 160).std() == pytest.approx(1)


SPIP = "# File Format = ASCII\n# x-pixels = 30\n# y-pixels = 40\n# x-length = 30\n# y-length = 40\n"


@pytest.mark.parametrize(
    ("more", "unit", "size", "height", "said"),
    [
        ("# x-unit = um\n# y-unit = um\n", "nm", 1e-6, 1e-9, "lengths in µm as the file says, heights in nm as given"),
        (
            "# x-unit = um\n# y-unit = um\n# z-unit = nm\n",
            None,
            1e-6,
            1e-9,
            "lengths in µm as the file says, heights in nm as the file says",
        ),
        ("# Bit2nm = 2\n", None, 1e-9, 2e-9, "lengths in nm as the file says, heights in nm as the file says"),
        ("", "nm", 1e-9, 1e-9, "lengths in nm as the file says, heights in nm as given"),
    ],
)
def test_lengths_of_spip_are_in_nanometres_where_nothing_is_said(files, tmp_path, more, unit, size, height, said):
    """They were said to be, and without a unit of the heights taken to be, where the file has another one."""
    rows = (" ".join(f"{(3 * i + j) % 7}" for j in range(30)) for i in range(40))
    (tmp_path / "scan.asc").write_text(SPIP + more + "\n".join(rows) + "\n", encoding="utf-8")
    scan = read_surface(tmp_path / "scan.asc", unit=unit)
    assert scan.units == said and scan.sizes == pytest.approx((30 * size, 40 * size))
    assert np.ptp(scan.heights) == pytest.approx(6 * height)


def test_a_unit_of_lengths_leaves_stated_heights_alone(files, tmp_path):
    scan = read_surface(text_scan(tmp_path / "scan.txt", "heights"), unit="mm")
    assert scan.sizes == pytest.approx((0.02, 0.02)) and np.ptp(scan.heights) == pytest.approx(np.ptp(eq4(LEVELS, 2e-5, 160)))


@pytest.mark.parametrize(
    ("head", "options", "said"),
    [
        ("nothing", {}, "sizes: got None; .. (--size, --unit)"),
        ("nothing", SIZES, "unit: got None; .. of the lengths and heights"),
        ("lengths", {}, "unit: got None; .. of the heights"),
        ("heights", {}, "unit: got None; .. of the lengths"),
        ("heights", {"unit": "inch"}, "unit: got 'inch'; allowed: one of .. mm"),
        ("both", {"unit": "nm"}, "unit: got 'nm'; .. says: lengths in µm x mm, heights in µm"),
        ("both", SIZES, "sizes: got .. says: 20 x 20 um"),
        (
            "lengths",
            {"unit": "mm"},
            "on a scan of 2e-05 m'; .. lengths in mm as the file says, heights in mm as given .. # Value units: nm",
        ),
    ],
)
def test_units_that_lack_or_contradict(files, tmp_path, head, options, said):
    path = text_scan(tmp_path / "scan.txt", head)
    with pytest.raises(hystrip.InputError, match=re.escape(said).replace(re.escape(" .. "), ".*")):
        read_surface(path, **options)


def test_a_unit_that_the_file_states_too_may_be_given(files):
    assert read_surface(files / "scan.nc", unit="um").sizes == read_surface(files / "scan.nc").sizes


@pytest.mark.parametrize(
    ("head", "sizes", "height"),
    [
        ("Lateral units: mm\n", 1e-2, 9e-6),
        ("Value units: nm\n", 1e-5, 9e-9),
        ("Lateral units: mm\n# Value units: nm\n", 1e-2, 9e-9),
    ],
)
def test_units_of_coordinates_may_be_stated_one_by_one(files, tmp_path, head, sizes, height):
    rows = "".join(f"{i} {j} {i * j / 9:.9g}\n" for i in range(10) for j in range(10))
    path = tmp_path / "scan.xyz"
    path.write_text(f"# Channel: Height\n# {head}{rows}", encoding="utf-8")
    scan = read_surface(path, unit=None if head.count("units") == 2 else "um")
    assert f"heights in {'nm as the file says' if 'nm' in head else 'µm as given'}" in scan.units
    assert scan.sizes == pytest.approx((sizes, sizes)) and np.ptp(scan.heights) / height == pytest.approx(1)


DEKTAK = "Scan Parameters\nType,Standard\n\nScan Data\n\nLateral um,Total Profile{},\n"


@pytest.mark.parametrize(
    ("head", "separator", "encoding"),
    [
        ("x [mm],z [um]\n", ",", "utf-8"),
        ("Messung 1\nDatum 2.3.2024\nx [mm];z [µm]\n", ";", "cp1252"),
        ("x/mm\tz/um\n", "\t", "utf-16"),
        ("# x [mm] z [um]\n\n", " ", "utf-8-sig"),
        ("x;z\nmm;µm\n", ";", "utf-8"),
        ("No,x [mm],z [um]\n", ",", "utf-8"),
        ("X;Y;valid\n[mm];[um];[1/0]\n", ";", "utf-8"),
    ],
)
def test_units_of_points_may_stand_in_their_heading(files, tmp_path, head, separator, encoding):
    """They were passed over: with the unit of the lengths for both heights were a thousand times too large, without a word."""
    more = {"N": lambda i, row: [str(i + 1), *row], "X": lambda i, row: [*row, "1"]}.get(head[0], lambda i, row: row)
    rows = (separator.join(more(i, [f"{0.02 * i:.6f}", f"{i % 7:.6f}"])) for i in range(200))
    (tmp_path / "line.csv").write_text(head + "\n".join(rows) + "\n", encoding=encoding)
    scan = read_surface(tmp_path / "line.csv")
    assert scan.units == "lengths in mm as the file says, heights in µm as the file says"
    assert scan.sizes == pytest.approx((4e-3,)) and np.ptp(scan.heights) == pytest.approx(6e-6)
    with pytest.raises(hystrip.InputError, match="unit: got 'mm'; .* says: lengths in mm, heights in µm"):
        read_surface(tmp_path / "line.csv", unit="mm")


@pytest.mark.parametrize(
    ("unit", "options", "height"),
    [("(nm)", {}, 6e-9), ("", {"unit": "nm"}, 6e-9), ("", {"unit": "um", "height_factor": 1e-3}, 6e-9), ("", {}, None)],
)
def test_heights_of_a_profilometer_take_the_unit_that_is_given(files, tmp_path, unit, options, height):
    """Its reader takes heights without a unit to be in that of the lengths, whatever was given and said."""
    (tmp_path / "line.csv").write_text(DEKTAK.format(unit) + "".join(f"{20 * i},{i % 7},\n" for i in range(200)))
    if height is None:
        with pytest.raises(hystrip.InputError, match="unit: got None; .* of the heights"):
            read_surface(tmp_path / "line.csv")
        return
    scan = read_surface(tmp_path / "line.csv", **options)
    assert scan.sizes == pytest.approx((4e-3,)) and np.ptp(scan.heights) == pytest.approx(height)
    assert scan.units.startswith("lengths in µm as the file says, heights in ")


@pytest.mark.parametrize(
    ("sizes", "said"),
    [
        ((20.0,), "got \\(20.0,\\); allowed: 2 of them"),
        ((20.0, 20.0, 20.0), ".* allowed: 2 of them"),
        ((-5.0, 20.0), "got -5.0; allowed: .* > 0"),
    ],
)
def test_sizes_are_those_of_the_directions(files, sizes, said):
    with pytest.raises(hystrip.InputError, match=f"plain.txt, sizes: {said}"):
        read_surface(files / "plain.txt", sizes=sizes, unit="um")


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("text", ["", "1 2 3\n1 2\n"])
def test_what_is_no_scan_is_refused_without_a_warning(tmp_path, text):
    (tmp_path / "none.txt").write_text(text)
    with pytest.raises(hystrip.InputError):
        read_surface(tmp_path / "none.txt", sizes=(20.0, 20.0), unit="um")


def test_decimal_commas_are_read(files, tmp_path):
    path = text_scan(tmp_path / "scan.txt", "lengths", write=lambda number: number.replace(".", ","))
    assert np.allclose(read_surface(path, unit="um").heights.std(), eq4(LEVELS, 2e-5, 160).std(), rtol=1e-6, atol=0)


@pytest.mark.parametrize(("sign", "end"), [(",", "\n"), (";", "\r\n"), (" ; ", ";\n")])
def test_a_matrix_may_have_commas_or_semicolons(files, tmp_path, sign, end):
    heights = np.add.outer(np.arange(12) ** 2, np.cos(np.arange(9))) / 7
    heights[0, :2] = heights[5, 5] = np.nan
    rows = [sign.join("" if np.isnan(each) else f"{each:.9e}" for each in row) for row in heights]
    (tmp_path / "heights.csv").write_bytes(f"# heights{end}{end.join(rows)}{end}".encode())
    with pytest.warns(hystrip.roughness.ScanWarning, match="2.8 % of the points"):
        found = read_surface(tmp_path / "heights.csv", sizes=(90.0, 120.0), unit="um").heights
    there = np.isfinite(heights.T)
    assert found.shape == (9, 12) and np.allclose(found[there], 1e-6 * heights.T[there], rtol=1e-8)


@pytest.mark.parametrize("sign", [",", ";"])
def test_signs_in_remarks_part_no_numbers(files, tmp_path, sign):
    path = text_scan(tmp_path / "scan.txt", "lengths")
    plain = read_surface(path, unit="um")
    rows = [row.replace(" ", sign) for row in path.read_text(encoding="utf-8").splitlines()[2:]]
    path.write_text(
        "\n".join(["# Made: today; by nobody, 1.5 h", *HEADS["lengths"].splitlines(), *rows]) + "\n", encoding="utf-8"
    )
    scan = read_surface(path, unit="um")
    assert scan.sizes == plain.sizes and np.array_equal(scan.heights, plain.heights)


def test_commas_that_may_be_decimal_signs_part_no_numbers(tmp_path):
    """``12,5,13,2`` is two heights or four."""
    rows = [
        ",".join(f"{each:.1f}".replace(".", ",") for each in row)
        for row in 10 + np.add.outer(np.arange(12) / 4, np.arange(9) / 3)
    ]
    (tmp_path / "heights.csv").write_text("# version 1.0\n" + "\n".join(rows) + "\n")
    with pytest.raises(hystrip.InputError, match="whole numbers parted by commas.*may be decimal signs"):
        read_surface(tmp_path / "heights.csv", sizes=(90.0, 120.0), unit="um")


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("".join(f"{i} {j} 1.5\n" for i in range(9) for j in range(9) if i != j), "a matrix of 3 x 72.*not measured as nan"),
        ("", "no point"),
    ],
)
def test_points_that_fill_no_grid_are_said(files, tmp_path, text, said):
    (tmp_path / "points.xyz").write_text(text)
    with pytest.raises(hystrip.InputError, match=f"points.xyz: got '{said}"):
        read_surface(tmp_path / "points.xyz", unit="um")


@pytest.mark.parametrize("beside", ["rows", "columns", "both"])
def test_positions_beside_a_matrix_are_no_heights(tmp_path, beside):
    pytest.importorskip("SurfaceTopography")
    table = np.random.default_rng(0).standard_normal((16, 16))
    if beside != "columns":
        table = np.column_stack((np.round(np.arange(16) / 3, 2), table))
    if beside != "rows":
        table = np.vstack((np.arange(table.shape[1]) - 1, table))
    np.savetxt(tmp_path / "table.txt", table, fmt="%.6g")
    with pytest.raises(
        hystrip.InputError, match=r"table.txt: got 'a first row or column of (0.33, 0.67, 1|0, 0.33, 0.67|0, 1, 2), ...'; allowed"
    ):
        read_surface(tmp_path / "table.txt", sizes=(50.0, 50.0), unit="um")


def test_one_length_of_two_is_told(files, tmp_path):
    (tmp_path / "half.txt").write_text("# Width: 20 um\n" + (files / "plain.txt").read_text(), encoding="utf-8")
    with pytest.raises(hystrip.InputError, match=r"half.txt, sizes: got \[20.0\]; allowed: 2 lengths.*# Width and # Height"):
        read_surface(tmp_path / "half.txt", unit="um")


@pytest.mark.parametrize("text", ["x,z\n" + "1,2\n" * 9, "1,2,3\n" * 9 + "1,2\n", "1,,3\n" * 9 + "1,2\n", "1;b;3\n" * 9])
def test_other_tables_are_no_matrix(files, tmp_path, text):
    (tmp_path / "table.csv").write_text(text)
    with pytest.raises(hystrip.InputError):
        read_surface(tmp_path / "table.csv", sizes=(20.0, 20.0), unit="um")


@pytest.mark.parametrize(("name", "points"), [("wide.txt", (60, 40)), ("wide.npy", (40, 60))])
def test_lengths_in_the_other_order_are_remarked_on(files, tmp_path, name, points):
    """The first direction is along the rows of text, but across those of an array."""
    heights = np.random.default_rng(0).normal(size=(40, 60)) * 1e-3
    np.savetxt(tmp_path / "wide.txt", heights)
    np.save(tmp_path / "wide.npy", heights)
    right = tuple(count / 2 for count in points)
    with warnings.catch_warnings():
        warnings.simplefilter("error", hystrip.roughness.ScanWarning)
        assert read_surface(tmp_path / name, unit="um", sizes=right).heights.shape == points
        read_surface(tmp_path / name, unit="um", sizes=(30.0, 31.0))  # uneven either way
    said = rf"sizes: {right[1]:g} x {right[0]:g} for {points[0]} x {points[1]} points puts these .* the other way round evenly"
    with pytest.warns(hystrip.roughness.ScanWarning, match=said):
        read_surface(tmp_path / name, unit="um", sizes=right[::-1])


def test_what_has_the_size_of_terrain_is_none(files, tmp_path):
    """Any file of 2 n^2 bytes was read as n x n heights: an array of three dimensions, a table of moduli."""
    sizes = {"sizes": (1e5, 1e5), "unit": "km"}
    (tmp_path / "moduli.csv").write_text("f [Hz];E' [MPa];E'' [MPa]\n".ljust(2 * 30**2, " "))
    (tmp_path / "noise.bin").write_bytes(np.random.default_rng(0).bytes(2 * 40**2))
    (tmp_path / "N00E000.HGT").write_bytes(np.random.default_rng(1).bytes(2 * 40**2))
    for name in ("moduli.csv", "noise.bin"):
        with pytest.raises(hystrip.InputError, match="no format that SurfaceTopography knows"):
            read_surface(tmp_path / name, **sizes)
    assert read_surface(tmp_path / "N00E000.HGT", **sizes).heights.shape == (40, 40)
    text = "\n".join(",".join(f"{each:.3f}" for each in row) for row in eq4(LEVELS, 2e-5, 50) * 1e6)
    (tmp_path / "matrix.csv").write_text(text.ljust(2 * 90**2, "\n"))
    assert len(text) < 2 * 90**2
    assert read_surface(tmp_path / "matrix.csv", sizes=(20, 20), unit="um").heights.shape == (50, 50)


def test_a_byte_order_mark_hides_no_number(files, tmp_path):
    path = text_scan(tmp_path / "marked.txt", "nothing")
    plain = read_surface(path, **SIZES, unit="um")
    for old, new in ((HEADS["nothing"].encode(), b""), (b".", b",")):  # the second time decimal commas too
        path.write_bytes(b"\xef\xbb\xbf" + path.read_bytes().replace(b"\xef\xbb\xbf", b"").replace(old, new))
        scan = read_surface(path, **SIZES, unit="um")
        assert np.array_equal(scan.heights, plain.heights)
    line = "# Lateral units: um\n# Value units: nm\n" + "".join(f"{i} {i % 3}\n" for i in range(9))
    (tmp_path / "line.xyz").write_text(line, encoding="utf-8-sig")
    assert read_surface(tmp_path / "line.xyz").units == "lengths in µm as the file says, heights in nm as the file says"


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"height_factor": 0}, "height_factor: got 0; allowed: a finite number other than 0"),
        ({"height_factor": "2"}, "height_factor: got '2'; allowed: a finite number"),
        ({"sizes": 20}, "sizes: got 20; allowed: one number for each direction of the scan"),
    ],
)
def test_arguments_of_the_wrong_kind_are_named(files, options, said):
    with pytest.raises(hystrip.InputError, match=f"plain.txt, {said}"):
        read_surface(files / "plain.txt", **{"sizes": (20.0, 20.0), "unit": "um", **options})
    with pytest.raises(hystrip.InputError, match="scan: got 3; allowed: a hystrip.roughness.Scan"):
        levels_of(3)


def test_points_of_a_line_follow_each_other(files, tmp_path):
    turned = {"unsorted": [0, 2, 1, *range(3, 20)], "repeated": [0, 1, 1, *range(3, 20)], "reversed": np.arange(20)[::-1]}
    for name, x in turned.items():
        path = tmp_path / f"{name}.xyz"
        np.savetxt(path, np.column_stack((x, np.sin(np.arange(20)))))
        with pytest.raises(hystrip.InputError, match=rf"{name}.xyz, positions: got '-?1e-06 m after .*that grow from row to row"):
            read_surface(path, unit="um")


def test_gaps_and_uneven_steps_are_filled(files, tmp_path):
    topography = pytest.importorskip("SurfaceTopography")
    heights = eq4([(1e-6, 1e-7)], 4e-6, 64)
    gaps = heights.copy()
    gaps[5, 7] = np.nan
    np.savetxt(tmp_path / "gaps.txt", gaps)
    scan = read_surface(tmp_path / "gaps.txt", sizes=(4e-6, 4e-6), unit="m")
    assert scan.heights.T[5, 7] == pytest.approx(heights[5, 7], abs=5e-9) and scan.filled == 1 / 64**2
    assert "0.024 % of the points were undefined" in scan.report()
    x = np.linspace(0, 1, 200) ** 1.1
    topography.NonuniformLineScan(x, 0.1 * np.sin(20 * x), unit="mm").to_netcdf(str(tmp_path / "line.nc"))
    even = read_surface(tmp_path / "line.nc")
    assert even.heights.shape == (200,) and even.sizes[0] == pytest.approx(1e-3, rel=0.01)


def test_gaps_of_a_line_are_filled_and_said(tmp_path):
    pytest.importorskip("SurfaceTopography")
    x = np.arange(100)
    lacking = (x < 40) | (x >= 60)
    np.savetxt(tmp_path / "line.txt", np.column_stack((x, np.sin(x)))[lacking])
    with pytest.warns(hystrip.roughness.ScanWarning, match="21 % of the points were undefined"):
        assert read_surface(tmp_path / "line.txt", unit="um").filled == pytest.approx(21 / 99)


def test_large_gaps_are_warned_of_and_nothing_but_gaps_refused(files, run, tmp_path):
    heights = eq4(LEVELS, 2e-5, 64) * 1e6
    heights[8:24, 8:24] = np.nan
    np.savetxt(tmp_path / "hole.txt", heights)
    status, out, err = run("levels", "hole.txt", "--pressure", "1", *2 * ["--size", "20"], "--unit", "um", "--no-plot")
    assert status == 0 and "6.2 % of the points were undefined" in out and "warning: " in err and "6.2 % of the points" in err
    np.savetxt(tmp_path / "none.txt", np.full((16, 16), np.nan))
    with pytest.raises(hystrip.InputError, match="no defined point"):
        read_surface(tmp_path / "none.txt", sizes=(20.0, 20.0), unit="um")


def test_a_number_that_marks_what_was_not_measured_is_refused():
    heights = eq4(LEVELS, 2e-5, 64)
    heights[::9, ::9] = -9.99e-6
    with pytest.raises(hystrip.InputError, match="-9.99e-06 m at 64 points, .* standard deviations off"):
        Scan(heights, (2e-3, 2e-3))


def test_command_writes_a_scene_that_loads(run, files, tmp_path):
    status, out, err = run("levels", files / "scan.nc", "--pressure", "0.1 MPa")
    assert (status, err) == (0, "") and "left out" in out and "lengths in µm as the file says" in out
    assert "note       material, adhesion, velocity and rtol are those of `hystrip init`" in out
    assert sorted(path.name for path in (tmp_path / "hystrip-out").glob("[!.]*")) == ["scan.levels.toml", "scan.spectrum.png"]
    scene = load_scene(tmp_path / "hystrip-out/scan.levels.toml")
    assert np.allclose([(level.l, level.h) for level in scene.levels], LEVELS, rtol=1e-5)
    assert (scene.title, float(scene.pressure)) == ("Surface of scan.nc", 1e5)


def test_command_takes_heights_in_another_unit_than_lengths(run, files, tmp_path):
    np.save(tmp_path / "nm.npy", eq4(LEVELS, 2e-5, 160) * 1e9)
    options = [*2 * ["--size", "20"], "--unit", "um", "--pressure", "1", "--no-plot"]
    status, _, err = run("levels", "nm.npy", *options)
    assert status == 2 and "heights in another unit: --height-factor 1e-3 for nm with --unit um" in err
    status, out, err = run("levels", "nm.npy", *options, "--height-factor", "1e-3")
    assert (status, err) == (0, "") and "heights in µm as given, times 0.001" in out
    scene = load_scene(tmp_path / "hystrip-out/nm.levels.toml")
    assert [level.h for level in scene.levels] == pytest.approx([1e-6, 1e-7], rel=0.15)


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["absent.nc"], "a file with a measured surface"),
        (["text.csv"], "--pressure: got None"),
        (["text.csv", "--scene", "paper_fig3"], "text.csv: got 'no format that SurfaceTopography knows'"),
        (["plain.txt"], "(--size, --unit)"),
        (["plain.txt", "--size", "20", "--size", "20"], "plain.txt, unit: got None"),
        (["scan.nc", "--unit", "nm"], "unit: got 'nm'"),
        (["scan.nc", "--channel", "Phase"], "channel: got 'Phase'; allowed: one of 'Default'"),
        (["scan.nc", "--count", "0"], "count: got 0"),
        (["scan.nc", "--longest", "20"], "longest: got 20.0; allowed: a wavelength from 1e-07 to 2e-05 m"),
        (["scan.nc", "--count", "2", "--ratio", "3"], "--count, --ratio: got {'count': 2, 'ratio': 3.0}; allowed: one of them"),
        (["scan.nc", "--longest", "1 um", "--shortest", "2 um"], "--longest, --shortest: got (1e-06, 2e-06); allowed: a longest"),
        (["scan.nc", "--shortest", "ten"], "--shortest: got 'ten'"),
        (["scan.nc", "--scene", "absent.toml"], "no such file"),
    ],
)
def test_wrong_calls_leave_nothing(run, files, tmp_path, arguments, said):
    name, *rest = arguments
    status, out, err = run("levels", files / name, *rest, *([] if "--scene" in rest or name == "text.csv" else ["--pressure", 1]))
    assert status == 2 and out == "" and said in err and err.count("\n") == 1
    assert not list(tmp_path.iterdir())


def test_steps_of_the_example_are_named_and_their_files_documented(files, run, tmp_path):
    pytest.importorskip("matplotlib")
    said = run("init", "--example", "rubber", ".")[1]
    page = (Path(__file__).parent.parent / "tools/docs/files.md").read_text(encoding="utf-8")
    for step in ("master raw.csv --vertical", "levels scan.txt --count 3"):
        assert f"hystrip {step}" in said and run(*step.split(), *["--scene", "scene.toml"] * step.startswith("levels"))[0] == 0
    written = [path.name.split(".", 1)[1] for path in (tmp_path / "hystrip-out").glob("[!.]*")]
    assert len(written) == 5 and all(f"`name.{part}`" in page for part in written)


MATRIX = [[f"{np.sin(0.7 * i) + np.cos(0.3 * i * j):.3f}" for j in range(16)] for i in range(16)]
LINE = [[f"{i / 1000}", f"{np.sin(0.7 * i):.3f}"] for i in range(24)]
GIVEN = {"unit": "um", "sizes": (16, 16)}


@pytest.mark.parametrize("mark", ["***", "-", "#N/A", "1.2.3"])
@pytest.mark.parametrize("row", [0, 9, 15])
@pytest.mark.parametrize("separator", [" ", "\t", ";", ","])
def test_a_row_with_a_mark_of_no_number_is_named(tmp_path, mark, row, separator):
    """Readers drop it: the other rows stood closer, over the same length."""
    pytest.importorskip("SurfaceTopography")
    rows = [separator.join(each[:5] + [mark if at == row else each[5]] + each[6:]) for at, each in enumerate(MATRIX)]
    (tmp_path / "scan.txt").write_text("\n".join(rows) + "\n")
    with pytest.raises(hystrip.InputError, match=f"scan.txt, line {row + 1}: got .*; allowed: numbers alone, nan for"):
        read_surface(tmp_path / "scan.txt", **GIVEN)


@pytest.mark.parametrize("mark", ["***", "", "BAD"])
@pytest.mark.parametrize("separator", ["\t", ","])
def test_a_point_of_a_line_with_a_mark_of_no_number_is_named(tmp_path, mark, separator):
    """Readers drop it, and all above."""
    pytest.importorskip("SurfaceTopography")
    rows = [separator.join([x, mark if at == 12 else z]) for at, (x, z) in enumerate(LINE)]
    (tmp_path / "line.csv").write_text(f"x [mm]{separator}z [um]\n" + "\n".join(rows) + "\n")
    with pytest.raises(hystrip.InputError, match="line.csv, line 14: got '0.012"):
        read_surface(tmp_path / "line.csv")


@pytest.mark.parametrize("between", ["part 2", "# part 2"])
def test_points_below_a_remark_are_not_taken_for_all(tmp_path, between):
    pytest.importorskip("SurfaceTopography")
    rows = [",".join(each) for each in LINE]
    (tmp_path / "line.csv").write_text("\n".join(["x [mm],z [um]", *rows[:12], between, *rows[12:], ""]))
    with pytest.raises(hystrip.InputError, match=f"line.csv, line 14: got '{between}'"):
        read_surface(tmp_path / "line.csv")


@pytest.mark.parametrize(
    ("above", "mark", "below"),
    [
        ("", "nan", ""),
        ("", "BAD", ""),
        ("Columns: " + " ".join(map(str, range(16))) + "\n", "1.5", "end 1 2 3\n"),
        ("16 16 V\n", "0", ""),
    ],
)
def test_remarks_and_undefined_points_of_a_matrix_are_read_as_ever(tmp_path, above, mark, below):
    pytest.importorskip("SurfaceTopography")
    rows = [" ".join(each[:5] + [mark if at == 9 else each[5]] + each[6:]) for at, each in enumerate(MATRIX)]
    (tmp_path / "scan.txt").write_text(above + "\n".join([*rows[:8], "second half", "", *rows[8:]]) + "\n" + below)
    assert read_surface(tmp_path / "scan.txt", **GIVEN).heights.shape == (16, 16)


def test_numbers_above_the_names_of_a_line_are_no_points(tmp_path):
    pytest.importorskip("SurfaceTopography")
    rows = [f"{at},{z}" for at, (_, z) in enumerate(LINE)]
    (tmp_path / "line.csv").write_text("\n".join(["0.5,1", "speed,2", "x,z", *rows, ""]))
    assert read_surface(tmp_path / "line.csv", unit="um").heights.shape == (24,)


def test_what_is_wrong_with_the_heights_of_a_file_names_it(tmp_path):
    pytest.importorskip("SurfaceTopography")
    (tmp_path / "scan.txt").write_text("\n".join(" ".join(row) for row in MATRIX))
    with pytest.raises(hystrip.InputError, match="scan.txt, heights: got 'heights that differ by"):
        read_surface(tmp_path / "scan.txt", unit="um", sizes=(1, 1))


def test_positions_that_go_back_are_said_in_metres(tmp_path):
    """Of the file, whatever the unit of the heights."""
    pytest.importorskip("SurfaceTopography")
    rows = [f"{0.001 * (at if at < 9 else at - 1):.4f},{z}" for at, (_, z) in enumerate(LINE)]
    (tmp_path / "line.csv").write_text("\n".join(["x [mm],z [um]", *rows]))
    with pytest.raises(
        hystrip.InputError, match="positions: got '8e-06 m after 8e-06 m'; allowed: positions along the line that grow"
    ):
        read_surface(tmp_path / "line.csv")

"""Measured roughness: known levels come back from their surface, and what cannot be read is named."""

import numpy as np
import pytest

import hystrip
from hystrip.roughness import Scan, levels_of, read_surface
from hystrip.scene import load_scene

LEVELS = [(1e-5, 1e-6), (5e-7, 1e-7)]


def surface(levels, size, n):
    """Eq. 4, summed over the levels, on a grid of n by n points."""
    x = np.arange(n) * (size / n)
    out = np.zeros((n, n))
    for wavelength, height in levels:
        wave = np.cos(2 * np.pi / wavelength * x) + 1
        out += height - height / 4 * np.multiply.outer(wave, wave)
    return out


def isotropic(n=512, size=1e-4, band=(1e-5, 1e-6), rms=1e-7, seed=0):
    """A random surface, periodic, with roughness between two wavelengths alone; heights and exact rms gradient."""
    q = np.hypot.outer(*2 * [2 * np.pi * np.fft.fftfreq(n, size / n)])
    shape = np.where((q > 2 * np.pi / band[0]) & (q < 2 * np.pi / band[1]), np.maximum(q, 1.0) ** -1.8, 0.0)
    modes = shape * np.fft.fft2(np.random.default_rng(seed).standard_normal((n, n)))
    heights = np.fft.ifft2(modes).real
    gradient = np.sqrt(np.sum(q**2 * np.abs(modes) ** 2) / np.sum(np.abs(modes) ** 2))
    return heights * rms / heights.std(), gradient * rms


def found(result):
    return [(level.l, level.h) for level in result.levels]


def test_known_levels_are_recovered():
    result = levels_of(Scan(surface(LEVELS, 2e-5, 400), (2e-5, 2e-5), periodic=True))
    assert np.allclose(found(result), LEVELS, rtol=1e-9)
    assert result.rms_left_out < 1e-6 * result.rms_height[1] and len(result.report().splitlines()) == 4


@pytest.mark.parametrize(
    ("options", "count"),
    [({"edges": [3e-5, 3e-6, 3e-7, 8e-8]}, 3), ({"ratio": 9, "longest": 1e-5, "shortest": 1.2e-7}, 2)],
)
def test_known_levels_are_recovered_from_stated_bands(options, count):
    levels = [*LEVELS, (1e-7, 2e-8)][:count]
    scan = Scan(surface(levels, 1e-5, 800), (1e-5, 1e-5), periodic=True)
    assert np.allclose(found(levels_of(scan, **options)), levels, rtol=1e-9)


def test_a_tilted_piece_that_is_no_period_gives_nearly_the_same():
    n, size = 1024, 1.07e-4
    levels = [(1e-5, 1e-6), (8e-7, 1e-7)]
    tilt = 0.01 * np.arange(n)[:, None] * size / n
    assert np.allclose(found(levels_of(Scan(surface(levels, size, n) + tilt, (size, size)))), levels, rtol=5e-3)


def test_height_and_gradient_of_a_random_surface_are_kept():
    """The surface of Eq. 4 with the level's l and h has the rms height and the rms gradient of what was measured."""
    heights, gradient = isotropic()
    result = levels_of(Scan(heights, (1e-4, 1e-4), periodic=True), count=1, longest=1.2e-5, shortest=9e-7)
    (level,) = result.levels
    copy = surface([(1.0, level.h / level.l)], 1.0, 64) * level.l
    slopes = np.gradient(np.pad(copy, 1, mode="wrap"), level.l / 64)
    assert copy.std() == pytest.approx(heights.std(), rel=1e-9) == result.rms_height[0]
    inner = np.hypot(*slopes)[1:-1, 1:-1]
    assert np.sqrt(np.mean(inner**2)) == pytest.approx(gradient, rel=3e-3)
    assert result.rms_gradient[0] == pytest.approx(gradient, rel=1e-9)


def test_bands_add_up():
    heights, _ = isotropic()
    scan = Scan(heights, (1e-4, 1e-4), periodic=True)
    for count in (1, 2, 3):
        result = levels_of(scan, count=count, longest=1.2e-5, shortest=9e-7)
        assert len(result.levels) == count and np.sum(result.rms_height**2) == pytest.approx(heights.var(), rel=1e-12)
        assert (np.diff([level.l for level in result.levels]) < 0).all()
        for (long, short), level in zip(result.bands, result.levels, strict=True):
            assert short <= level.l / np.sqrt(6 / 5) <= long
    centre = levels_of(scan, count=1, longest=1.6e-5, shortest=1e-6, wavelength="centre")
    assert centre.levels[0].l == pytest.approx(4e-6)


def test_lines_of_an_isotropic_surface_stand_for_it():
    heights, _ = isotropic()
    limits = {"count": 1, "shortest": 9e-7}
    (whole,) = levels_of(Scan(heights, (1e-4, 1e-4), periodic=True), longest=1.2e-5, **limits).levels
    # a line sees oblique waves stretched: all of it up to its length
    lines = [levels_of(Scan(line, 1e-4, periodic=True), longest=1e-4, **limits).levels[0] for line in heights]
    assert np.sqrt(np.mean([line.h**2 for line in lines])) == pytest.approx(whole.h, rel=0.01)
    slope2 = np.mean([line.h**2 / line.l**2 for line in lines])
    assert slope2 == pytest.approx((whole.h / whole.l) ** 2, rel=0.03)


FLAT = Scan(np.zeros((16, 16)), (1.0, 1.0))
ROUGH = Scan(surface([(1e-6, 1e-7)], 4e-6, 64), (4e-6, 4e-6), periodic=True)


@pytest.mark.parametrize(
    ("scan", "options", "said"),
    [
        (ROUGH, {"count": 2, "ratio": 3}, "one of the three"),
        (ROUGH, {"count": 0}, "count: got 0"),
        (ROUGH, {"count": True}, "count: got True"),
        (ROUGH, {"ratio": 1}, "ratio: got 1"),
        (ROUGH, {"ratio": 1.0001}, "at most 20 bands"),
        (ROUGH, {"longest": 1e-9}, "longest: got 1e-09; allowed: .* from 1.25e-07 to 4e-06 m"),
        (ROUGH, {"longest": 1e-6, "shortest": 2e-6}, "a longest wavelength above"),
        (ROUGH, {"edges": [1e-6]}, "two different wavelengths"),
        (ROUGH, {"edges": [1e-6, 1e-7], "longest": 1e-6}, "where the edges are given"),
        (ROUGH, {"edges": [1e-9, 1e-10]}, "no roughness between 1e-09 and 1e-10 m"),
        (ROUGH, {"wavelength": "mean"}, "wavelength: got 'mean'"),
        (FLAT, {}, "no roughness"),
    ],
)
def test_wrong_arguments(scan, options, said):
    with pytest.raises(hystrip.InputError, match=said):
        levels_of(scan, **options)


@pytest.mark.parametrize(
    ("heights", "sizes", "field"),
    [
        (np.zeros(4), 1.0, "scan.heights"),
        (np.zeros((16, 16)), 1.0, "scan.sizes"),
        (np.zeros(16), -1.0, "scan.sizes"),
        ([[np.nan] * 16] * 16, (1, 1), "scan.heights"),
    ],
)
def test_wrong_scans(heights, sizes, field):
    with pytest.raises(hystrip.InputError) as refused:
        Scan(heights, sizes)
    assert refused.value.field == field


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    topography = pytest.importorskip("SurfaceTopography")
    folder = tmp_path_factory.mktemp("scans")
    heights = surface(LEVELS, 20.0e-6, 400) * 1e6
    topography.Topography(heights, (20.0, 20.0), unit="um", periodic=True).to_netcdf(str(folder / "scan.nc"))
    np.savetxt(folder / "plain.txt", heights)
    (folder / "text.csv").write_text("no,surface\n", encoding="utf-8")
    return folder


def test_a_file_with_units_is_read(files):
    scan = read_surface(files / "scan.nc")
    assert scan.periodic and scan.sizes == pytest.approx((2e-5, 2e-5), rel=1e-7)
    # this format keeps lengths in single precision
    assert np.allclose(found(levels_of(scan)), LEVELS, rtol=1e-7)


def test_a_file_without_sizes_and_unit_takes_them(files):
    scan = read_surface(files / "plain.txt", sizes=(20.0, 20.0), unit="um")
    assert scan.sizes == pytest.approx((2e-5, 2e-5)) and np.allclose(scan.heights.std(), surface(LEVELS, 2e-5, 400).std())


def test_gaps_and_uneven_steps_are_filled():
    topography = pytest.importorskip("SurfaceTopography")
    from hystrip.roughness.read import _even

    heights = np.ma.masked_array(surface([(1e-6, 1e-7)], 4e-6, 64))
    heights[5, 7] = np.ma.masked
    filled, _, _ = _even(topography.Topography(heights, (4e-6, 4e-6), unit="m"), "x")
    assert filled[5, 7] == pytest.approx(surface([(1e-6, 1e-7)], 4e-6, 64)[5, 7], abs=5e-9)
    x = np.linspace(0, 1, 200) ** 1.1
    line = topography.NonuniformLineScan(x, np.sin(20 * x), unit="mm")
    even, sizes, _ = _even(line, "x")
    assert even.shape == (200,) and sizes[0] == pytest.approx(1e-3, rel=0.01)


def test_command_writes_a_scene_that_loads(run, files, tmp_path):
    status, out, err = run("levels", files / "scan.nc", "--pressure", "0.1 MPa")
    assert (status, err) == (0, "") and "left out" in out
    assert sorted(path.name for path in (tmp_path / "hystrip-out").glob("[!.]*")) == ["scan.levels.toml", "scan.spectrum.png"]
    scene = load_scene(tmp_path / "hystrip-out/scan.levels.toml")
    assert np.allclose([(level.l, level.h) for level in scene.levels], LEVELS, rtol=1e-5)
    assert (scene.title, float(scene.pressure)) == ("Surface of scan.nc", 1e5)


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["absent.nc"], "a file with a measured surface"),
        (["text.csv"], "--pressure: got None"),
        (["text.csv", "--scene", "paper_fig3"], "text.csv: got 'no format that SurfaceTopography knows'"),
        (["plain.txt"], "(--size, --unit)"),
        (["plain.txt", "--size", "20", "--size", "20"], "plain.txt, unit: got None"),
        (["scan.nc", "--unit", "um"], "fixed by file"),
        (["scan.nc", "--channel", "Phase"], "channel: got 'Phase'; allowed: one of 'Default'"),
        (["scan.nc", "--count", "0"], "count: got 0"),
        (["scan.nc", "--longest", "20"], "longest: got 20.0; allowed: a wavelength from 1e-07 to 2e-05 m"),
        (["scan.nc", "--shortest", "ten"], "--shortest: got 'ten'"),
        (["scan.nc", "--scene", "absent.toml"], "no such file"),
    ],
)
def test_wrong_calls_leave_nothing(run, files, tmp_path, arguments, said):
    name, *rest = arguments
    status, out, err = run("levels", files / name, *rest, *([] if "--scene" in rest or name == "text.csv" else ["--pressure", 1]))
    assert status == 2 and out == "" and said in err and err.count("\n") == 1
    assert not list(tmp_path.iterdir())

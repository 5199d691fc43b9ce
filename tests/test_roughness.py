"""Measured roughness: known levels come back from their surface."""

import warnings

import numpy as np
import pytest
from surfaces import eq4

import hystrip
from hystrip.roughness import Scan, ScanWarning, levels_of

LEVELS = [(1e-5, 1e-6), (5e-7, 1e-7)]


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
    result = levels_of(Scan(eq4(LEVELS, 2e-5, 400), (2e-5, 2e-5), periodic=True))
    assert np.allclose(found(result), LEVELS, rtol=1e-9)
    assert result.rms_left_out < 1e-6 * result.rms_height[1] and len(result.report().splitlines()) == 4


@pytest.mark.parametrize(
    ("options", "count"),
    [({"edges": [3e-5, 3e-6, 3e-7, 8e-8]}, 3), ({"ratio": 9, "longest": 1e-5, "shortest": 1.2e-7}, 2)],
)
def test_known_levels_are_recovered_from_stated_bands(options, count):
    levels = [*LEVELS, (1e-7, 2e-8)][:count]
    scan = Scan(eq4(levels, 1e-5, 800), (1e-5, 1e-5), periodic=True)
    assert np.allclose(found(levels_of(scan, **options)), levels, rtol=1e-9)


def test_bounds_do_not_part_the_waves_of_a_level():
    """The oblique wave of the first level has wave number sqrt(2) k: a bound between k and that does not cut it off."""
    scan = Scan(eq4(LEVELS, 1e-5, 400), (1e-5, 1e-5), periodic=True)
    for bound in (9.9e-6, 8e-6, 7.1e-6):
        result = levels_of(scan, edges=[2e-5, bound, 1.1e-7])
        assert np.allclose(found(result), LEVELS, rtol=1e-9) and "note" not in result.report()


def test_the_shorter_of_two_spacings_is_no_bound():
    """256 x 192 points: the oblique wave of a level of 4.8 points is shorter than four of the coarser direction."""
    x, y = (np.cos(2 * np.pi * 40 * np.arange(n) / n) + 1 for n in (256, 192))
    scan = Scan(1e-7 - 1e-7 / 4 * np.multiply.outer(x, y), (4e-6, 4e-6), periodic=True)
    assert np.allclose(found(levels_of(scan, count=1)), [(1e-7, 1e-7)], rtol=1e-9)


@pytest.mark.parametrize(("modes", "noted"), [(11.3, True), (8.0, False)])
def test_a_wave_that_the_taper_spreads_over_a_bound_is_noted(modes, noted):
    # the bound is at a wavelength of 0.0884 of the scan: mode 11.3
    size, n = 1e-4, 256
    result = levels_of(Scan(eq4([(size / modes, 1e-6)], size, n), (size, size)), count=2)
    assert ("note: more than half of level 1, 2" in result.report()) == noted
    level = result.levels[0]
    assert (level.h / 1e-6 == pytest.approx(1, rel=1e-3)) != noted
    if not noted:
        assert 1 - level.l * modes / size == pytest.approx(0.3 / modes**2, rel=0.15)


def test_a_tilted_piece_that_is_no_period_gives_nearly_the_same():
    n, size = 1024, 1.07e-4
    levels = [(1e-5, 1e-6), (8e-7, 1e-7)]
    tilt = 0.01 * np.arange(n)[:, None] * size / n
    assert np.allclose(found(levels_of(Scan(eq4(levels, size, n) + tilt, (size, size)))), levels, rtol=5e-3)


def test_height_and_gradient_of_a_random_surface_are_kept():
    """The surface of Eq. 4 with the level's l and h has the rms height and the rms gradient of what was measured."""
    heights, gradient = isotropic()
    result = levels_of(Scan(heights, (1e-4, 1e-4), periodic=True), count=1, longest=1.5e-5, shortest=9e-7)
    (level,) = result.levels
    copy = eq4([(1.0, level.h / level.l)], 1.0, 64) * level.l
    slopes = np.gradient(np.pad(copy, 1, mode="wrap"), level.l / 64)
    assert copy.std() / heights.std() == pytest.approx(1, rel=1e-9) == result.rms_height[0] / heights.std()
    inner = np.hypot(*slopes)[1:-1, 1:-1]
    assert np.sqrt(np.mean(inner**2)) == pytest.approx(gradient, rel=3e-3)
    assert result.rms_gradient[0] == pytest.approx(gradient, rel=1e-9)


def test_bands_add_up():
    heights, _ = isotropic()
    scan = Scan(heights, (1e-4, 1e-4), periodic=True)
    for count in (1, 2, 3):
        result = levels_of(scan, count=count, longest=1.5e-5, shortest=9e-7)
        assert len(result.levels) == count and np.sum(result.rms_height**2) / heights.var() == pytest.approx(1)
        assert (np.diff([level.l for level in result.levels]) < 0).all()
        for (long, short), level in zip(result.bands, result.levels, strict=True):
            assert short / np.sqrt(2) <= level.l / np.sqrt(6 / 5) <= long
    centre = levels_of(scan, count=1, longest=1.6e-5, shortest=1e-6, wavelength="centre")
    assert centre.levels[0].l == pytest.approx(4e-6)


def test_the_largest_level_comes_first_whatever_its_band():
    """Oblique waves make a level shorter than that of the next band: in the order of bands they were refused when solved."""
    x, y = np.meshgrid(*2 * [2 * np.pi * np.arange(64) / 64])
    heights = 1e-6 * np.cos(7 * x) * np.cos(7 * y) + 1e-6 * np.cos(9 * x)
    found = levels_of(Scan(heights, (1e-3, 1e-3), periodic=True), edges=[1e-3, 1.25e-4, 5e-5])
    assert [level.l for level in found.levels] == pytest.approx(np.sqrt(6 / 5) * np.array([1 / 9, 1 / np.sqrt(98)]) * 1e-3)
    assert found.bands[:, 0].tolist() == [1.25e-4, 1e-3] and found.rms_height == pytest.approx([np.sqrt(0.5) * 1e-6, 0.5e-6])


def test_lines_of_an_isotropic_surface_stand_for_it():
    heights, _ = isotropic()
    limits = {"count": 1, "shortest": 9e-7}
    (whole,) = levels_of(Scan(heights, (1e-4, 1e-4), periodic=True), longest=1.5e-5, **limits).levels
    # a line sees oblique waves stretched: all of it up to its length
    lines = [levels_of(Scan(line, 1e-4, periodic=True), longest=1e-4, **limits).levels[0] for line in heights]
    assert np.sqrt(np.mean([line.h**2 for line in lines])) == pytest.approx(whole.h, rel=0.01)
    slope2 = np.mean([line.h**2 / line.l**2 for line in lines])
    assert slope2 == pytest.approx((whole.h / whole.l) ** 2, rel=0.03)


def test_levels_are_drawn_on_the_scale_of_the_spectrum():
    """Parts of the spectrum, and the stretches of the levels, add up to the same variance."""
    pytest.importorskip("matplotlib")
    heights, _ = isotropic()
    scan = Scan(heights, (1e-4, 1e-4), periodic=True)
    result = levels_of(scan, count=2, longest=1.5e-5, shortest=9e-7)
    (panel,) = hystrip.plots.roughness_levels(result, scan).axes
    parts, edges, _ = panel.patches[0].get_data()
    assert np.allclose(np.diff(np.log10(edges)), 1 / 8) and np.nansum(parts**2) / heights.var() == pytest.approx(1)
    stretches = [line.get_data() for line in panel.lines if len(line.get_data()[0]) == 2 and line.get_linestyle() == "-"]
    variance = [8 * np.log10(band[0] / band[1]) * height[0] ** 2 for band, height in stretches]
    assert np.allclose(variance, result.rms_height**2, rtol=1e-9, atol=0) and len(variance) == 2


FLAT = Scan(np.zeros((16, 16)), (1.0, 1.0))
TILTED = Scan(0.33 + 0.1 * np.linspace(0, 1, 16)[:, None] + np.zeros((16, 16)), (1.0, 1.0))
ROUGH = Scan(eq4([(1e-6, 1e-7)], 4e-6, 64), (4e-6, 4e-6), periodic=True)


@pytest.mark.parametrize(
    ("scan", "options", "said"),
    [
        (ROUGH, {"count": 2, "ratio": 3}, "one of them"),
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
        (TILTED, {}, "no roughness"),
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
        (np.linspace(0, 1.1, 16), 1.0, "scan.heights"),
        (np.where(np.arange(160) % 40 == 3, -1e-3, 1e-6 * np.sin(np.arange(160))), 1.0, "scan.heights"),
    ],
)
def test_wrong_scans(heights, sizes, field):
    with pytest.raises(hystrip.InputError) as refused:
        Scan(heights, sizes)
    assert refused.value.field == field


@pytest.mark.parametrize("filled", [-0.1, 1.1, True, "a"])
def test_the_share_that_was_filled_is_one(filled):
    with pytest.raises(hystrip.InputError, match="^scan.filled: got "):
        Scan(np.zeros(16), 1.0, filled=filled)


@pytest.mark.parametrize("share", [0.003, 0.05, 0.4])
@pytest.mark.parametrize(("mark", "offset"), [(0.0, 0.0), (0.0, 8e-7), (2e-7, 0.0)])
def test_heights_missing_as_one_value_are_remarked_on(share, mark, offset):
    heights, _ = isotropic(n=256, size=5e-5)
    missing = np.random.default_rng(1).random(heights.shape) < share
    with pytest.warns(ScanWarning, match=rf"scan.heights: .* % of the points are at exactly {mark:.6g} m"):
        Scan(np.where(missing, mark, heights + offset), (1e-4, 1e-4))
    if missing[60].sum() > 1:
        with pytest.warns(ScanWarning, match="at exactly"):
            Scan(np.where(missing[60], mark, heights[60] + offset), 1e-4)


@pytest.mark.parametrize("digits", [1, 2, 15])
def test_heights_that_are_there_are_not_remarked_on(digits):
    """Measured with few digits, or with flat parts that begin without a step."""
    heights, _ = isotropic(n=128)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        Scan(np.round(heights / heights.std(), digits) * 1e-7, (1e-4, 1e-4))
        Scan(np.maximum(heights, -1e-7), (1e-4, 1e-4))
        Scan(eq4(LEVELS, 2e-5, 400), (2e-5, 2e-5))

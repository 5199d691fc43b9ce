"""Pictures show what the numbers say: legends inside the canvas, units from the data, maps and loops as the means have it."""

import dataclasses
import functools

import numpy as np
import pytest
from matplotlib.colors import to_hex

import hystrip
from hystrip.arguments import point_index
from hystrip.at_point import cell_of, stresses_along
from hystrip.plots.legend import legend_above
from hystrip.plots.style import COLUMN, stacked
from hystrip.plots.units import unit_for

MATERIAL = hystrip.StandardLinearSolid(K=1e9, T_eps=1e-2, T_sigma=1e-4)
ADHESION = hystrip.Dugdale(gamma=2.5e-5, delta_0=1e-8)
LEVELS = [hystrip.Level(l=10e-6, h=1e-6), hystrip.Level(l=500e-9, h=100e-9)]
SMALL = LEVELS[1]


def saturated(count):
    levels = [hystrip.Level(l=1e-5 / 3**i, h=1e-6 / 3**i) for i in range(count)]
    return hystrip.solve(MATERIAL, hystrip.Dugdale(gamma=0), levels, pressure=1e8, velocity=[1e-4, 1e-3])


def inside(figure):
    figure.draw_without_rendering()
    boxes = [legend.get_window_extent() for legend in [*figure.legends, *(a.get_legend() for a in figure.axes if a.get_legend())]]
    boxes += [axis.get_tightbbox() for axis in figure.axes]
    canvas = figure.bbox
    return all(b.x0 >= -0.5 and b.y0 >= -0.5 and b.x1 <= canvas.x1 + 0.5 and b.y1 <= canvas.y1 + 0.5 for b in boxes)


@pytest.mark.parametrize("count", [2, 6, 8])
def test_legends_stand_inside_the_canvas(count):
    assert inside(saturated(count).plot())


@pytest.mark.parametrize("count", [14, 15, 50])
def test_no_two_levels_are_drawn_alike(count):
    figure = saturated(count).plot("mu")
    panel, *scale = figure.axes
    lines = [line for line in panel.lines if "level" in line.get_label()]
    styles = {(to_hex(line.get_color()), str(line._unscaled_dash_pattern)) for line in lines}
    assert len(lines) == len(styles) == count
    named = [text.get_text() for text in figure.legends[0].get_texts()]
    if count < 15:
        assert len(named) == count + 1 and not scale
    else:
        assert named == ["total"]
        (said,) = [[each.get_text() for each in axis.get_xticklabels()] for axis in scale]
        assert said[0] == "1\n10 µm" and said[-1].startswith(f"{count}\n")
    assert inside(figure)


@pytest.mark.parametrize("kind", ["mu", "tau", None])
def test_points_that_did_not_converge_are_marked(kind):
    result = saturated(2)
    assert "not converged" not in [line.get_label() for axis in result.plot(kind).axes for line in axis.lines]
    doubtful = dataclasses.replace(result, converged=np.array([True, False]))
    for axis in doubtful.plot(kind).axes:
        total, (marks,) = axis.lines[0], [line for line in axis.lines if line.get_label() == "not converged"]
        assert total.get_label() == "total"
        assert marks.get_xdata() == [1e-3] and marks.get_ydata() == total.get_ydata()[1:]


@pytest.mark.filterwarnings("error")
def test_a_legend_may_be_longer_than_the_figure():
    (panel,) = stacked(1, COLUMN, 0.5 * COLUMN)
    for i in range(15):
        panel.plot([0, 1], [0, i], label=f"level {i} of a surface that has very many of them")
    legend_above(panel.figure, *panel.get_legend_handles_labels())
    assert inside(panel.figure)


def test_long_labels_are_wrapped():
    (panel,) = stacked(1, COLUMN, COLUMN)
    handles = [panel.plot([0, 1], [0, i])[0] for i in range(3)]
    legend_above(panel.figure, handles, ["a very long label that says all there is to say about a line, and then more"] * 3)
    assert inside(panel.figure)


def test_units_follow_the_data():
    assert [unit_for("m", v)[1] for v in (2.0, 2e-3, 2e-6, 9.98e-7, 1e-9)] == ["m", "mm", "µm", "nm", "nm"]
    assert unit_for("Pa", [np.nan, -3e6, 10.0]) == (1e6, "MPa") and unit_for("Pa", [0.0]) == (1.0, "Pa")
    figure = hystrip.solve(MATERIAL, ADHESION, [SMALL], pressure=[3e3, 5e3], velocity=1e-3).plot()
    assert figure.axes[-1].get_xlabel() == "nominal pressure $p$ (kPa)"
    assert [axis.get_ylabel() for axis in figure.axes] == [
        "friction stress $\\tau$ (Pa)", "contact fraction", "penetration $D$ (µm)", "friction coefficient $\\mu$"
    ]  # fmt: skip


@pytest.fixture(scope="module")
def over_pressure():
    return hystrip.solve(MATERIAL, ADHESION, [SMALL], pressure=np.linspace(-1000, 3000, 17), velocity=1e-3, rtol=1e-2)


def test_no_line_through_the_pole_nor_across_pull_off(over_pressure):
    (panel,) = over_pressure.plot("mu").axes
    x, y = panel.lines[0].get_data()
    crossing = [(a, b) for a, b in zip(x[:-1], x[1:], strict=True) if a < 0 < b]
    assert not crossing and np.isnan(y[np.isnan(x)]).all()
    # zero pressure stands alone, and what is far from it fits
    assert np.isnan(y[x == 0]).all()
    far = np.abs(over_pressure.pressure) > 500
    low, high = panel.get_ylim()
    assert (over_pressure.mu[far] >= low).all() and (over_pressure.mu[far] <= high).all()
    tau = over_pressure.plot("tau").axes[0].lines[0].get_xdata()
    off = over_pressure.pressure[over_pressure.pulled_off].max() / 1e3
    assert np.isnan(tau[np.flatnonzero(tau == off) + 1]).all()


def test_friction_without_a_pole_is_seen_down_to_no_pressure():
    result = hystrip.solve(MATERIAL, hystrip.Dugdale(gamma=0), [SMALL], pressure=[-1, 100, 300, 1e4], velocity=1e-3, rtol=1e-2)
    (panel,) = result.plot("mu").axes
    assert result.mu[2] > 1.1 * result.mu[3] and panel.get_ylim()[1] > result.mu.max()


def test_points_of_a_level_that_stand_alone_are_not_joined():
    sides = hystrip.solve(MATERIAL, hystrip.Dugdale(gamma=0), LEVELS, pressure=[-1e5, 1e5], velocity=1e-3, rtol=1e-2)
    for panel in sides.plot().axes:
        assert all(line.get_linestyle() == "None" for line in panel.lines if line.get_marker() == ".")


def test_no_line_over_velocity_through_the_pole_nor_across_pull_off():
    V = np.geomspace(1e-4, 1e-1, 13)
    held = hystrip.solve(MATERIAL, ADHESION, LEVELS[:1], penetration=5.5e-7, velocity=V, rtol=1e-2)
    pulled = hystrip.solve(MATERIAL, ADHESION, [SMALL], pressure=-1000, velocity=V, rtol=1e-2)
    for result, changes in ((held, np.sign(held.pressure)), (pulled, pulled.pulled_off)):
        x, y = result.plot("mu").axes[0].lines[0].get_data()
        (at,) = np.flatnonzero(changes[1:] != changes[:-1])
        assert np.array_equal(np.insert(V, at + 1, np.nan), x, equal_nan=True) and np.isnan(y[at + 1])
    low, high = held.plot("mu").axes[0].get_ylim()
    assert high - low < np.ptp(held.mu)


def test_a_panel_at_zero_pressure_says_why_it_is_empty():
    result = hystrip.solve(MATERIAL, ADHESION, [SMALL], pressure=[[0.0], [1e8]], velocity=[1e-4, 1e-3], rtol=1e-2)
    at_zero, other = result.plot("mu").axes
    assert [text.get_text() for text in at_zero.texts] == [r"$\mu$ is not defined at zero pressure"] and not other.texts
    assert "2 points lie at zero pressure, where mu is not defined" in result.summary()


def test_panels_of_a_surface_that_is_pulled_off_say_so():
    result = hystrip.solve(MATERIAL, ADHESION, LEVELS[:1], pressure=-5e3, velocity=np.geomspace(1e-3, 1e-2, 3), rtol=1e-2)
    assert result.pulled_off.all()
    mu, contact = result.plot().axes
    assert all([text.get_text() for text in panel.texts] == ["pulled off: no contact"] for panel in (mu, contact))
    assert contact.get_ylim() == (-0.05, 1.05)


def test_decades_of_velocity_that_begin_at_rest_are_drawn_over_decades():
    over = functools.partial(hystrip.solve, MATERIAL, hystrip.Dugdale(gamma=0), LEVELS[:1], pressure=1e3, rtol=1e-2)
    panel = over(velocity=np.r_[0, np.geomspace(1e-5, 1e-1, 9)]).plot("mu").axes[0]
    assert panel.get_xscale() == "symlog" and panel.get_xlim() == (0, 1e-1)
    even = hystrip.solve(
        MATERIAL, hystrip.Dugdale(gamma=0), LEVELS[:1], pressure=1e3, velocity=np.linspace(0, 1e-1, 21), rtol=1e-2
    )
    assert even.plot("mu").axes[0].get_xscale() == "linear"


def test_a_height_that_does_not_change_has_the_unit_of_its_magnitude():
    result = hystrip.solve(MATERIAL, ADHESION, [hystrip.Level(l=1e-5, h=0)], pressure=100.0, velocity=1e-3)
    assert result.plot("strip").axes[1].get_ylabel() == "height (nm)"


def test_velocity_is_found_along_any_axis():
    p, V = np.array([1e3, 2e3, 3e3]), np.array([1e-3, 1e-2])
    one, other = (
        hystrip.solve(MATERIAL, ADHESION, [SMALL], pressure=load, velocity=velocity, rtol=1e-2).plot().axes
        for load, velocity in ((p[:, None], V), (p, V[:, None]))
    )
    assert [axis.get_title() for axis in other] == ["pressure 1 kPa", "pressure 2 kPa", "pressure 3 kPa"]
    for a, b in zip(one, other, strict=True):
        assert a.get_title() == b.get_title() and np.allclose(a.lines[0].get_data(), b.lines[0].get_data(), rtol=1e-2)
    (panel, _) = hystrip.solve(MATERIAL, ADHESION, [SMALL], pressure=p[:2], velocity=V, rtol=1e-2).plot().axes
    assert panel.get_title() == "pressure 1 to 2 kPa"
    with pytest.raises(hystrip.InputError, match="two different points"):
        hystrip.solve(MATERIAL, ADHESION, [SMALL], pressure=[1e3, 1e3], velocity=[1e-3, 1e-3], rtol=1e-2).plot()


@pytest.mark.parametrize("ends", [(1e-3, 1.2e-3), (1e-3, 2e-3), (3e-3, 5e-2), (1e-3, 1e-2), (1.1e-3, 9e-2), (1e-6, 1.0)])
def test_labels_of_velocities_do_not_overlap(ends):
    figure = hystrip.solve(MATERIAL, hystrip.Dugdale(gamma=0), [SMALL], pressure=1e8, velocity=ends).plot()
    figure.draw_without_rendering()
    axis = figure.axes[-1].xaxis
    labels = [each for minor in (False, True) for each in axis.get_ticklabels(minor=minor) if each.get_text()]
    boxes = [each.get_window_extent() for each in labels if ends[0] * 0.999 <= each.get_position()[0] <= ends[1] * 1.001]
    boxes.sort(key=lambda box: box.x0)
    assert len(boxes) > 1 and all(a.x1 < b.x0 for a, b in zip(boxes[:-1], boxes[1:], strict=True))


@pytest.mark.parametrize("name", ["pressure", "penetration"])
@pytest.mark.parametrize(
    "load", [np.geomspace(1e4, 1e7, 4), [1e4, 3e4, 1e5], np.linspace(1e4, 1e7, 9), [0, 1e4, 1e7], [1e4, 2e4]]
)
def test_a_load_over_decades_has_a_logarithmic_axis(name, load):
    scale = "log" if len(load) in (3, 4) and load[0] > 0 else "linear"
    of = {name: np.asarray(load) / (1e12 if name == "penetration" else 1)}
    figure = hystrip.solve(MATERIAL, hystrip.Dugdale(gamma=0), [SMALL], velocity=1e-3, rtol=1e-2, **of).plot("tau")
    assert figure.axes[-1].get_xscale() == scale and inside(figure)
    if scale == "log":
        assert figure.axes[-1].get_xlim() == pytest.approx((of[name][0], of[name][-1]))
        assert figure.axes[-1].get_xlabel().endswith("(Pa)" if name == "pressure" else "(m)")


def test_values_over_decades_of_load_are_drawn_over_decades():
    without, decades = hystrip.Dugdale(gamma=0), np.geomspace(1, 1e8, 7)
    # what a level adds may be nothing, or next to nothing
    faint = [SMALL, hystrip.Level(l=1e-7, h=1e-13), hystrip.Level(l=1e-8, h=0)]
    for adhesion, levels, pressure, kind, scales in (
        # stress and contact are at their greatest from some pressure on
        (without, LEVELS, decades, None, ["linear", "linear", "log", "log"]),
        (without, faint, decades[4:], "mu", ["log"]),
        (ADHESION, [SMALL], np.linspace(-500, 3000, 8), "mu", ["linear"]),
    ):
        figure = hystrip.solve(MATERIAL, adhesion, levels, pressure=pressure, velocity=1e-3, rtol=1e-2).plot(kind)
        assert [axis.get_yscale() for axis in figure.axes] == scales
        for axis in figure.axes:
            (low, high), total = axis.get_ylim(), axis.lines[0].get_ydata()
            at_the_totals = 5e-4 * total.min() < low < total.min() and total.max() < high < 5 * total.max()
            assert axis.get_yscale() == "linear" or at_the_totals


@pytest.mark.parametrize("loads", [6, 7])
def test_loads_that_are_not_drawn_are_counted(loads):
    pressure = np.linspace(1e8, 2e8, loads)[:, None]
    figure = hystrip.solve(MATERIAL, hystrip.Dugdale(gamma=0), [SMALL], pressure=pressure, velocity=[1e-4, 1e-3]).plot()
    said = [text.get_text() for legend in figure.legends for text in legend.get_texts()]
    assert len(figure.axes) == 6 and said == ([] if loads == 6 else ["total", f"6 of {loads} loads are drawn"]) and inside(figure)


@pytest.mark.parametrize("at, same", [((-1,), 16), (-1, 16), ((np.int64(15),), 15), (15, 15), ((-2,), 15)])
def test_points_are_counted_from_the_end_in_a_tuple_too(over_pressure, at, same):
    assert point_index(at, over_pressure.mu.shape) == same
    assert point_index((-1, -3), (2, 4)) == 5 and point_index((), ()) == 0 == point_index(-1, ())


@pytest.mark.parametrize(
    "at", [17, -18, (17,), (-18,), (0, 0), (), 1.0, (1.0,), "a", slice(0, 1), (slice(0, 1),), [1], True, (False,)]
)
def test_what_is_no_point_is_refused(over_pressure, at):
    with pytest.raises(hystrip.InputError, match="^at: got .*an index into the 17 points, of shape"):
        point_index(at, over_pressure.mu.shape)


def test_the_law_of_a_flat_level_is_drawn_about_its_pull_off():
    figure = hystrip.friction_law(MATERIAL, ADHESION, hystrip.Level(l=1e-6, h=0), V=1e-3, rtol=1e-3).plot()
    low, high = figure.axes[-1].get_xlim()
    assert (low + high) / 2 == pytest.approx(-2.5) and high - low == pytest.approx(5e-4)


def test_every_kind_is_drawn(over_pressure):
    at = int(np.argmax(over_pressure.pressure))
    for kind in (None, "mu", "tau", "contact", "map", "strip"):
        figure = over_pressure.plot(kind, at=at) if kind in ("map", "strip") else over_pressure.plot(kind)
        assert inside(figure), kind
    with pytest.raises(hystrip.InputError, match="kind: got 'dream'"):
        over_pressure.plot("dream")
    with pytest.raises(hystrip.InputError, match="pulled off"):
        over_pressure.plot("map", at=0)
    with pytest.raises(hystrip.InputError, match="1 to 1"):
        over_pressure.plot("map", at=at, level=2)
    with pytest.raises(hystrip.InputError, match="an index into the 17 points"):
        over_pressure.plot("map", at=17)


def test_a_map_has_the_means_of_its_level():
    level = hystrip.solve_level(MATERIAL, ADHESION, LEVELS[0], V=5e-3, pressure=100.0, rtol=1e-6)
    found = level.contact_map()
    # over one period each way: the border stands in the map twice
    mean = lambda values: float(np.mean(values[:-1, :-1]))  # noqa: E731
    assert mean(found.contact) == pytest.approx(float(level.contact_fraction), abs=5e-3)
    assert mean(found.adhesion) == pytest.approx(float(level.adhesion_fraction), abs=5e-3)
    assert mean(found.pressure) == pytest.approx(100.0, abs=15.0)  # of 6000 at most
    # 44.49 and 2.188 %, to the digits that so many points tell
    assert repr(found).endswith(": 44 % in contact, 2.2 % in adhesion")
    assert (found.gap[found.contact] <= 0).all() and not (found.contact & found.adhesion).any()
    assert np.allclose(found.pressure[found.adhesion], -ADHESION.p_0)
    assert inside(found.plot()) and inside(level.plot("strip", y=2e-6))


@pytest.mark.parametrize(("p", "h", "said"), [(1e8, 1e-6, "within 6.35 kPa"), (0, 0, "everywhere"), (3e3, 1e-6, None)])
def test_a_map_of_one_colour_says_how_even_the_pressure_is(p, h, said):
    result = hystrip.solve(MATERIAL, hystrip.Dugdale(gamma=0), [hystrip.Level(l=1e-5, h=h)], pressure=p, velocity=1e-3, rtol=1e-2)
    figure = result.plot("map")
    texts = [text.get_text() for text in figure.axes[0].texts]
    assert texts == ([] if said is None else [f"the same pressure\n{said}"]) and inside(figure)


def scene_of(folder):
    """A surface in complete contact, in closed form."""
    (folder / "s.toml").write_text(
        'pressure = 1e9\nvelocity = 1e-3\nedge = "constitutive"\n[material]\nK = 1e9\nT_eps = 1e-2\nT_sigma = 1e-4\n'
        '[material.shift]\nmodel = "Arrhenius"\nE_a = 1e5\nT_ref = 293.15\n[[levels]]\nl = 1e-5\nh = 1e-6\n'
    )
    return folder / "s.toml"


def test_a_sweep_is_drawn_over_what_has_most_values(tmp_path):
    T, V = np.linspace(273.15, 313.15, 9), np.geomspace(1e-6, 1, 8)
    done = hystrip.sweep(scene_of(tmp_path), over={"temperature": T, "velocity": V}, out=tmp_path)
    figure = done.plot()
    mu, contact = figure.axes
    assert contact.get_xlabel() == "temperature (°C)" and contact.get_xscale() == "linear" and inside(figure)
    lines = [line for line in mu.lines if line.get_label().startswith("velocity")]
    assert len(lines) == 6 and lines[0].get_label() == "velocity 1e-06 m/s"
    assert "6 of 8 combinations are drawn" in [text.get_text() for text in figure.legends[0].get_texts()]
    table = np.reshape(done.columns["mu"], (9, 8))
    assert lines[0].get_xdata() == pytest.approx(T - 273.15) and np.array_equal(lines[0].get_ydata(), table[:, 0])
    assert np.array_equal(lines[-1].get_ydata(), table[:, -1])


def test_points_of_a_list_failed_pulled_off_or_not_converged_are_drawn_as_such(tmp_path):
    K = np.array([1e9, 2e9, 3e9, 5e9, 1e12])
    done = hystrip.sweep(scene_of(tmp_path), over={"material.K": K, "levels[0].h": K / 1e15}, combine="list", out=tmp_path)
    columns = {name: np.array(values) for name, values in done.columns.items()}
    columns["mu"][0] = columns["pressure [Pa]"][0] = np.nan
    columns["pulled off"][1], columns["converged"][3] = 1, 0
    panel, below = dataclasses.replace(done, columns=columns).plot().axes
    line, marks = panel.lines[:2]
    assert below.get_xlabel() == "material.K (Pa/m)" and below.get_xscale() == "log" and not panel.figure.legends
    assert np.isfinite(line.get_ydata()).tolist() == [False, False, True, True, True]
    assert marks.get_xdata() == pytest.approx([5e9]) and marks.get_ydata() == line.get_ydata()[3]


def test_a_sweep_draws_no_line_through_the_pole_of_mu_and_says_why_there_is_none(tmp_path):
    source = scene_of(tmp_path)
    over = {
        "pressure": [-200, -100, 100, 200],
        "velocity": 1e-2,
        "levels[0].h": 1e-7,
        "adhesion.gamma": 2.5e-5,
        "adhesion.delta_0": 1e-8,
    }
    done = hystrip.sweep(source, over=over, out=tmp_path / "a")
    line = done.plot().axes[0].lines[0]
    assert not done.columns["pulled off"].any() and np.isnan(line.get_ydata()).tolist() == [False, False, True, False, False]
    said = [
        text.get_text()
        for text in hystrip.sweep(source, over=over | {"pressure": [0, 0]}, out=tmp_path / "b").plot().axes[0].texts
    ]
    assert said == [r"$\mu$ is not defined at zero pressure"]
    none = hystrip.sweep(source, over={"material.T_sigma": [2.0, 3.0], "pressure": [1.0, 2.0]}, out=tmp_path / "c").plot()
    assert [text.get_text() for panel in none.axes for text in panel.texts] == 2 * ["no point could be solved"]


def test_stresses_along_a_strip_are_those_of_the_levels():
    result = hystrip.solve(MATERIAL, ADHESION, LEVELS, pressure=100.0, velocity=5e-3, rtol=1e-3)
    cell = cell_of(result, 0, 1)
    x, (own, below) = stresses_along(result, cell, 2e-6)
    strip = cell.strip(np.array(2e-6))
    assert np.mean(own[:-1]) == pytest.approx(float(strip.tau_mean), rel=0.02)
    law = hystrip.friction_law(MATERIAL, ADHESION, LEVELS[1], V=5e-3, rtol=1e-3)
    touching = strip.gap(x) <= 0
    assert np.allclose(below[touching], law(strip.pressure(x[touching])), rtol=2e-3, atol=1.0) and not below[~touching].any()


@pytest.mark.parametrize("pressure", [-200.0, -100.0, 1.0, 100.0])
def test_a_lower_level_is_looked_at_under_the_mean_pressure_in_contact(pressure):
    result = hystrip.solve(MATERIAL, ADHESION, LEVELS, pressure=pressure, velocity=5e-3, rtol=1e-3)
    lower = cell_of(result, 0, 2)
    assert lower.level == LEVELS[1]
    of = hystrip.solve_level(MATERIAL, ADHESION, LEVELS[1], V=5e-3, D=lower.D, rtol=1e-3)
    mean = (pressure + ADHESION.p_0 * result.adhesion_by_level[0]) / result.contact_by_level[0]
    assert of.p_mean == pytest.approx(mean, rel=2e-3) and lower.mean_pressure == pytest.approx(mean, rel=2e-3)


def test_a_map_says_at_which_pressure_it_is():
    result = hystrip.solve(MATERIAL, ADHESION, LEVELS, pressure=100.0, velocity=5e-3, rtol=1e-3)
    p = float((100.0 + ADHESION.p_0 * result.adhesion_by_level[0]) / result.contact_by_level[0])
    for level, mean, above in ((1, 100.0, ""), (2, p, ", that in the contact of level 1")):
        found = result.contact_map(level=level)
        assert found.cell.mean_pressure == pytest.approx(mean, rel=1e-3)
        said = f"level {level} at a mean pressure of {found.cell.mean_pressure:.4g} Pa{above}"
        assert f", {said}: " in repr(found)
        assert found.plot().axes[0].get_title().replace("\n", " ") == said and inside(found.plot())
    level = hystrip.solve_level(MATERIAL, ADHESION, LEVELS[0], V=5e-3, pressure=[50.0, 100.0], rtol=1e-3)
    assert ", a mean pressure of 50 Pa: " in repr(level.contact_map(at=0))


def test_a_lower_level_that_the_mean_pressure_pulls_off_is_refused():
    result = hystrip.solve(MATERIAL, ADHESION, LEVELS, pressure=-400.0, velocity=2e-3, rtol=1e-3)
    with pytest.raises(hystrip.InputError, match="not pulled off by the mean pressure in the contact of the one above, -1000 Pa"):
        result.contact_map(level=2)


def test_a_loop_has_pull_off_and_closes():
    loop = hystrip.loading_loop(MATERIAL, ADHESION, SMALL, V=1e-3, rtol=1e-2)
    law = hystrip.friction_law(MATERIAL, ADHESION, SMALL, V=1e-3, rtol=1e-2, below=0.0)
    assert loop.pull_off == pytest.approx(law.pull_off, rel=0.01)
    assert loop.work > 0 and loop.unloading.p_mean[0] == loop.loading.p_mean[0] == 0
    assert loop.unloading.p_mean[-1] == pytest.approx(loop.loading.p_mean[-1], rel=1e-6)
    bare = hystrip.loading_loop(MATERIAL, hystrip.Dugdale(gamma=0), SMALL, V=1e-3, rtol=1e-2)
    assert bare.pull_off == 0 and bare.work == pytest.approx(0, abs=1e-6 * 1e9 * SMALL.h**2)
    assert "pull-off" in repr(loop) and inside(loop.plot()) and inside(bare.plot())


def test_work_and_pull_off_of_a_loop_are_those_of_many_penetrations():
    """Adhesion that pulls by a thousandth of what full contact is pressed by, and a loop that goes far beyond that."""
    adhesion, level = hystrip.Dugdale(p_0=100.0, delta_0=5e-8), hystrip.Level(l=1e-5, h=1e-6)
    far, short = (hystrip.loading_loop(MATERIAL, adhesion, level, V=1e-3, D_max=D_max, rtol=1e-2) for D_max in (4e-6, -4e-8))
    # of 20,001 penetrations from -1 to 2.5 um at rtol 1e-3
    assert far.work == pytest.approx(1.14925e-6, rel=2e-3)
    assert far.unloading.p_mean.min() == pytest.approx(far.pull_off, rel=1e-3) and short.unloading.D[-1] == -4e-8
    for loop in (far, short):
        assert loop.pull_off_penetration == pytest.approx(-9.15e-9, abs=2e-10)


@pytest.mark.parametrize(
    ("changed", "field"),
    [
        ({"material": None}, "material"),
        ({"adhesion": None}, "adhesion"),
        ({"level": LEVELS}, "level"),
        ({"material": hystrip.StandardLinearSolid(K=[1e9, 2e9], T_eps=1e-2, T_sigma=1e-4)}, "material.K"),
        ({"D_max": -1.0}, "D_max"),
        ({"D_max": [1e-7]}, "D_max"),
        ({"V": [1e-3]}, "V"),
        ({"rtol": 2.0}, "rtol"),
        ({"edge": "open"}, "edge"),
    ],
)
def test_what_has_no_loop(changed, field):
    given = {"material": MATERIAL, "adhesion": ADHESION, "level": SMALL, "V": 1e-3} | changed
    with pytest.raises(hystrip.InputError) as refused:
        hystrip.loading_loop(**given)
    assert refused.value.field == field


def test_nothing_touches_without_adhesion_below_zero():
    with pytest.raises(hystrip.InputError, match="more than 0 m, below which nothing touches"):
        hystrip.loading_loop(MATERIAL, hystrip.Dugdale(gamma=0), SMALL, V=1e-3, D_max=0.0)


def test_what_is_no_place_or_level_to_look_at():
    result = hystrip.solve(MATERIAL, ADHESION, [SMALL], pressure=3e3, velocity=1e-3, rtol=1e-2)
    solved = hystrip.solve_level(MATERIAL, ADHESION, SMALL, V=1e-3, D=1e-7, rtol=1e-2)
    for level in (1.0, True, "1", None, 0, 2):
        for look in (result.contact_map, functools.partial(result.plot, "loop"), functools.partial(result.plot, "map")):
            with pytest.raises(hystrip.InputError, match="^level"):
                look(level=level)
    for y in ("a", None, [1e-6], np.inf):
        for look in (result.plot, solved.plot):
            with pytest.raises(hystrip.InputError, match="^y"):
                look("strip", y=y)


def test_a_level_says_its_strips_and_profile():
    level = LEVELS[0]
    y = np.linspace(0, 5e-6, 7)
    A, D = level.strip(y, 6e-7)
    assert np.allclose(A, 0.25 * level.h * (1 + np.cos(level.k * y)), atol=1e-20)
    assert np.allclose(D, 6e-7 - 0.5 * level.h * (1 - np.cos(level.k * y)), atol=1e-20)
    x = np.linspace(-5e-6, 5e-6, 9)
    f = level.h - 0.25 * level.h * (np.cos(level.k * x) + 1) * (np.cos(level.k * y[3]) + 1)
    assert np.allclose(level.profile(x, y[3]), f, atol=1e-20)
    # the strip's own profile is a cut through the level's
    assert np.allclose(D[3] - A[3] * (1 - np.cos(level.k * x)), 6e-7 - level.profile(x, y[3]), atol=1e-20)


@pytest.mark.parametrize(("figure", "path", "field"), [(3, "a.png", "figure"), (None, 3, "path"), (None, "a.dream", "path")])
def test_what_cannot_be_saved_is_named(over_pressure, tmp_path, monkeypatch, figure, path, field):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(hystrip.InputError, match=f"^{field}: got "):
        hystrip.plots.save(over_pressure.plot("mu") if figure is None else figure, path)
    with pytest.raises(hystrip.InputError, match="^path: got 3"):
        over_pressure.save(3)
    assert not list(tmp_path.iterdir())

"""The scenes of the benchmark and who competes on each."""

from __future__ import annotations

import numpy as np
from peers import closed_form, equal_strips, half_space, march, scripted

import hystrip

from .scene import Contestant, Scene, solve

HERE = "hystrip"
EQUAL = "equal strips, batched"
SCRIPT = "scripted, strip by strip"
MARCH = "solve_ivp march"
TAMAAS = "Tamaas 2.9"
NUMPY = "NumPy"

COMPLETE = "non-adhesive, complete contact"
POINT, SWEEP, ADHESIVE, FIG_6 = "non-adhesive, one point", "non-adhesive, a sweep", "adhesive, multivalued", "Fig. 6, two levels"
THREE, EIGHT, FULL = "three levels", "eight levels", "eight levels, saturated"
VELOCITIES, PRESSURES, LEVELS = "cost over velocities", "cost over pressures", "cost over levels"

MATERIAL = hystrip.StandardLinearSolid(K=1e9, T_eps=1e-2, T_sigma=1e-4)
SOFT = hystrip.StandardLinearSolid(K=1e9, T_eps=1e-2, T_sigma=1e-3)
NONE = hystrip.Dugdale(gamma=0)
WEAK, STRONG = (hystrip.Dugdale(gamma=gamma, delta_0=1e-8) for gamma in (2.5e-5, 5e-5))
LARGE, SMALL, SMALLEST = hystrip.Level(10e-6, 1e-6), hystrip.Level(500e-9, 100e-9), hystrip.Level(50e-9, 50e-9)
SIMILAR = tuple(hystrip.Level(1e-5 / 5**i, 1e-6 / 5**i) for i in range(8))
SHALLOW = tuple(hystrip.Level(1e-5 / 5**i, 1e-8 / 5**i) for i in range(8))


def scenes(quick: bool) -> list[Scene]:
    """All scenes; ``quick``: fewer points, settings and digits."""
    one = np.ones
    tight = (1e-3, 1e-6) if quick else (1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10)
    strips = (10, 100) if quick else (10, 30, 100, 300, 1000, 3000)
    curve = np.linspace(0, 0.1, 201)[1:]
    speeds = np.geomspace(1e-5, 1e-2, 100 if quick else 1000)
    pressures = np.linspace(-650, 1500, 4 if quick else 20)
    few = 1 if quick else 4
    some = {1e-3: 100, 1e-4: 100, 1e-5: 100, 1e-6: None, 1e-8: 100, 1e-10: 100}
    fig_6 = [_here(1e-6, 2)] if quick else [_here(*setting) for setting in some.items()]
    # the friction of complete contact is known: does Tamaas, treated like this, get there?
    known = [_tamaas(16, steps) for steps in (64, 256, 1024)] if half_space.available() else []
    return [
        Scene(COMPLETE, SOFT, (NONE,), (LARGE,), one(1) * 1e5, one(1) * 3e-4, 1e-12, (_here(1e-6), *known)),
        Scene(
            POINT,
            SOFT,
            (NONE,),
            (LARGE,),
            one(1) * 100,
            one(1) * 3e-4,
            1e-12,
            (
                *map(_here, tight),
                *(_equal(n) for n in strips),
                *(_script(n) for n in strips[1:4:2]),
                *(_march(n) for n in strips[:3]),
                *(_tamaas(*grid) for grid in _grids(quick)),
            ),
        ),
        Scene(
            SWEEP,
            SOFT,
            (NONE,),
            (LARGE,),
            one(speeds.size) * 100,
            speeds,
            1e-9,
            (
                _here(1e-3),
                _here(1e-6),
                _equal(100, 10),
                _script(100, few),
                *(_tamaas(*grid, 2) for grid in _grids(quick)[:6][-2:]),
            ),
        ),
        Scene(
            ADHESIVE,
            MATERIAL,
            (WEAK,),
            (SMALL,),
            pressures,
            one(pressures.size) * 7e-4,
            1e-12,
            (
                *map(_here, tight),
                *(_equal(n, 10) for n in strips),
                _script(100, 10),
                _march(10, 2),
                *(() if quick else (_march(100, 2),)),
            ),
        ),
        Scene(
            FIG_6,
            MATERIAL,
            (WEAK, STRONG),
            (LARGE, SMALL),
            one(curve.size) * 100,
            curve,
            1e-7 if quick else 1e-11,
            (*fig_6, *(_equal(n, few) for n in strips), _script(100, few), *(() if quick else (_script(300, 2),))),
            2 if quick else 5,
        ),
        Scene(
            THREE,
            MATERIAL,
            (WEAK,),
            (LARGE, SMALL, SMALLEST),
            one(2) * 100,
            np.array([1e-3, 1e-2]),
            1e-4 if quick else 1e-6,
            (
                *(_here(r) for r in ((1e-3,) if quick else (1e-3, 1e-4))),
                *(_equal(n) for n in strips[:3]),
                _script(30 if quick else 100),
            ),
        ),
        Scene(
            EIGHT,
            SOFT,
            (NONE,),
            SIMILAR,
            one(1) * 100,
            one(1) * 3e-4,
            1e-4 if quick else 1e-6,
            (*(_here(r) for r in ((1e-3,) if quick else (1e-3, 1e-4))), *(_equal(n) for n in strips[:2])),
        ),
        Scene(
            FULL,
            MATERIAL,
            (WEAK,),
            SHALLOW,
            one(100_000) * 1e8,
            np.geomspace(1e-6, 10, 100_000),
            None,
            (
                Contestant(HERE, "all of the result", _one_pressure),
                Contestant(NUMPY, "Eq. 16", closed_form.friction),
                Contestant(NUMPY, "Eq. 16, thresholds checked", closed_form.checked_friction),
            ),
        ),
        *_growth(quick),
    ]


def _growth(quick):
    """The same surface with more and more of something: how the cost grows."""
    counts = (8, 32) if quick else (8, 16, 32, 64, 128)
    one = lambda n, value: np.full(n, value)  # noqa: E731
    for n in counts:
        p = np.linspace(-500, 1500, n)
        yield Scene(f"{PRESSURES}: {n}", MATERIAL, (WEAK,), (SMALL,), p, one(n, 7e-4), None, (_here(1e-6),))
    for n in counts:
        V = np.geomspace(3e-4, 3e-3, n)
        yield Scene(f"{VELOCITIES}: {n}", MATERIAL, (WEAK,), (SMALL,), one(n, 100.0), V, None, (_here(1e-6),))
    for n in (1, 2) if quick else (1, 2, 4, 8):
        yield Scene(f"{LEVELS}: {n}", SOFT, (NONE,), SIMILAR[:n], one(1, 100.0), one(1, 3e-4), None, (_here(1e-3),))


def _here(rtol, points=None):
    return Contestant(HERE, f"rtol={rtol:g}", solve(rtol), points)


def _one_pressure(scene, adhesion, p, V):
    return solve(1e-6)(scene, adhesion, p[0], V)


def _each(method, setting, one, points):
    """A contestant that solves point after point: ``one(scene, adhesion, p, V)`` gives friction, strips and failures."""

    def work(scene, adhesion, p, V):
        taus, strips, failures = zip(*(one(scene, adhesion, *map(float, point)) for point in zip(p, V, strict=True)), strict=True)
        return np.array(taus), sum(strips), sum(failures)

    return Contestant(method, setting, work, points)


def _equal(strips, points=None):
    one = lambda s, a, p, V: (equal_strips.friction(s.material, a, s.levels, p, V, strips), 0, 0)  # noqa: E731
    return _each(EQUAL, f"N={strips}", one, points)


def _script(strips, points=None):
    one = lambda s, a, p, V: scripted.friction(s.material, a, s.levels, p, V, strips, strips)  # noqa: E731
    return _each(SCRIPT, f"N={strips}", one, points)


def _march(strips, points=None, rtol=1e-6):
    """It is told the penetration; finding it is not in its time."""
    known = {}

    def one(s, a, p, V):
        if (a, p, V) not in known:
            known[a, p, V] = float(hystrip.solve(s.material, a, s.levels, pressure=p, velocity=V, rtol=1e-9).penetration)
        tau, unsettled = march.friction(s.material, a, s.levels[0], known[a, p, V], V, strips, rtol)
        return tau, strips, unsettled

    return _each(MARCH, f"N={strips}, D given", one, points)


def _grids(quick):
    """Points across the surface and time steps per wavelength; without Tamaas none."""
    every = (
        ((16, 64), (32, 256))
        if quick
        else ((16, 16), (32, 32), (16, 64), (32, 256), (32, 1024), (64, 1024), (64, 4096), (128, 4096))
    )
    return every if half_space.available() else ()


def _tamaas(grid, steps, points=None):
    one = lambda s, a, p, V: (half_space.friction(s.material, s.levels[0], p, V, grid, steps), 0, 0)  # noqa: E731
    return _each(TAMAAS, f"{grid} x {grid}, {steps} steps", one, points)

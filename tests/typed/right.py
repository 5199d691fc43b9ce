"""A user's script that uses every public name; type checkers find nothing in it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import numpy.typing as npt
from matplotlib.figure import Figure
from xarray import Dataset

import hystrip
from hystrip import dma, plots, roughness
from hystrip.typing import Branch, Edge, Material, Numbers

solid = hystrip.StandardLinearSolid(K=1e9, T_eps=1e-2, T_sigma=np.array([1e-4, 2e-4]))
kelvin = hystrip.KelvinVoigt(K=1e9, T_eps=1e-2)
series = hystrip.Prony(K=1e9, moduli=[1e9, 2e9], times=(1e-3, 1e-2))
rubber = hystrip.HalfSpace(E=2e6, nu=0.49, moduli=np.array([1e6]), times=[1e-3])
none, sticky = hystrip.Dugdale(gamma=0), hystrip.Dugdale(gamma=2.5e-5, delta_0=1e-8)
others = [hystrip.Dugdale(p_0=2.5e3, delta_0=1e-8), hystrip.Dugdale(gamma=1e-5, p_0=1e3)]
levels = [hystrip.Level(l=10e-6, h=1e-6), hystrip.Level(l=500e-9, h=100e-9)]
warm = hystrip.StandardLinearSolid(K=1e9, T_eps=1e-2, T_sigma=1e-4, shift=hystrip.WLF(C_1=17.4, C_2=51.6, T_ref=293.15))
cold = hystrip.Arrhenius
materials: list[Material] = [solid, kelvin, series, rubber, warm]


def peak(material: Material, pressure: Numbers, edge: Edge = "continuous", branch: Branch = "unloading") -> float:
    """Largest friction coefficient."""
    result = hystrip.solve(
        material, sticky, levels, pressure=pressure, velocity=np.geomspace(1e-5, 1e-1, 5), edge=edge, branch=branch
    )
    return float(np.nanmax(result.mu))


def results(folder: Path) -> hystrip.Result:
    """Solve, look, keep."""
    result: hystrip.Result = hystrip.solve(
        kelvin, none, levels[0], penetration=[1e-7, 2e-7], velocity=1e-3, rtol=1e-4, strips=None
    )
    mu: npt.NDArray[np.float64] = result.mu
    bad: npt.NDArray[np.bool_] = ~result.converged | result.pulled_off
    figures: list[Figure] = [result.plot(), result.plot("map", at=0, level=1), result.plot("strip", y=1e-6), result.plot("loop")]
    dataset: Dataset = result.to_dataset()
    plots.save(figures[0], folder / "mu.png")
    print(mu[~bad], dataset, result.to_dataframe().shape, result.summary(), result)
    return hystrip.load(result.save(folder / "result.nc"), hystrip.Result)


def parts() -> None:
    """Strips, levels, laws, loops, maps."""
    strips: hystrip.StripSolution = hystrip.solve_strip(kelvin, sticky, l=1e-5, A=[5e-7, 4e-7], D=6e-7, V=5e-3)
    level: hystrip.LevelSolution = hystrip.solve_level(kelvin, sticky, levels[0], V=[1e-3, 2e-3], pressure=100.0)
    law: hystrip.FrictionLaw = hystrip.friction_law(kelvin, sticky, levels[0], V=5e-3, below=1e4)
    loop: hystrip.Loop = hystrip.loading_loop(kelvin, sticky, levels[1], V=1e-3)
    found: hystrip.ContactMap = level.contact_map(at=0)
    drawn: list[Figure] = [strips.plot(), level.plot("strip", at=1), law.plot(), loop.plot(), found.plot()]
    tau: npt.NDArray[np.float64] = law([0.0, 100.0]) + strips.tau_mean + level.tau_mean
    print(tau, drawn, level.to_dataset(), loop.pull_off, found.pressure, levels[0].strip(y=1e-6, D=6e-7))


def scenes(folder: Path) -> Dataset:
    """Scene files and sweeps."""
    scene: hystrip.Scene = hystrip.load_scene("paper_fig7")
    sweep: hystrip.Sweep = hystrip.sweep("paper_fig7", over={"adhesion.gamma": [0, 1e-5]}, out=folder, combine="grid", workers=2)
    print(scene.solve().mu, scene.velocity, sweep.failed, sweep.plot().axes)
    return sweep.to_dataset()


def measured(data: Path, scan: Path) -> list[hystrip.Level]:
    """A material and levels from measurements."""
    fitted = dma.fit_prony(dma.read_dma(data), terms=2)
    surface = roughness.levels_of(roughness.read_surface(scan), count=2)
    print(fitted.report(), hystrip.typing, hystrip.load_solver(data.parent).models)
    return list(surface.levels)


def careful(folder: Path) -> int:
    """Errors have one base class."""
    try:
        results(folder)
    except hystrip.InputError as error:
        print(error.field, error.value, error.allowed)
    except (hystrip.SolverError, hystrip.MissingExtra, hystrip.HystripError) as error:
        print(error)
    return 0

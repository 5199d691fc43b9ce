"""Tamaas, its generalised Maxwell solver with the half-space replaced by independent springs: one level without
adhesion at a given pressure."""

import math

import numpy as np


def available():
    """Whether Tamaas is installed."""
    try:
        import tamaas  # noqa: F401
    except ImportError:
        return False
    return True


def friction(material, level, pressure, V, points, steps, tolerance=1e-10):
    """Friction stress, Pa: a surface of ``points`` squared, drawn along in ``steps`` steps a wavelength.

    The mean over a wavelength after as many as take five retardation times. Errors are of first order in the step, and
    fall with ``points`` where contact is partial. In units of K, h and l; the shear modulus has to be one, or the
    relaxation comes out wrong.
    """
    import tamaas

    tamaas.set_log_level(tamaas.LogLevel.error)
    model = tamaas.ModelFactory.createModel(tamaas.model_type.basic_2d, [1.0, 1.0], [points, points])
    model.nu = 0.0
    model.E = 2.0
    x = np.arange(points) / points
    across = 0.25 * (np.cos(2 * np.pi * x) + 1)
    solver = tamaas.MaxwellViscoelastic(
        model,
        np.multiply.outer(np.cos(2 * np.pi * x) + 1, across),
        tolerance,
        level.l / V / steps,
        [material.T_eps / material.T_sigma - 1],
        [material.T_sigma],
    )
    # the operator exists from here on; independent springs: every wave number alike
    model.operators["westergaard_neumann"]["influence"][...] = 1.0
    surface = np.reshape(solver.surface, (points, points))
    taus = np.zeros(steps)
    periods = 1 + math.ceil(5 * material.T_eps * V / level.l)
    for step in range(periods * steps):
        phase = 2 * np.pi * (x - step / steps)
        surface[...] = np.multiply.outer(np.cos(phase) + 1, across)
        solver.solve(pressure / (material.K * level.h))
        slope = np.multiply.outer(-2 * np.pi * np.sin(phase), across)
        taus[step % steps] = -np.mean(np.reshape(model.traction, (points, points)) * slope)
    return taus.mean() * material.K * level.h**2 / level.l


def elastic_contact(level, pressure, points, tolerance=1e-10):
    """Contact fraction of one level on the elastic half-space of E = 2, nu = 0, at a nominal pressure."""
    import tamaas

    tamaas.set_log_level(tamaas.LogLevel.error)
    model = _unit_half_space(level, points)
    heights = np.multiply.outer(_crests(level, points, 0.0), _crests(level, points, 0.0)) * 0.25 * level.h
    solver = tamaas.PolonskyKeerRey(model, heights, tolerance)
    solver.solve(pressure)
    return float(np.mean(np.reshape(model.traction, (points, points)) > 0))


def viscoelastic(level, branch, tau, pressure, V, points, steps, tolerance=1e-8):
    """Friction stress and contact fraction of one level on the half-space of relaxed shear modulus 1 and nu = 0, with a Maxwell
    branch of shear modulus ``branch`` and time ``tau``: means over a wavelength, after as many as take six times."""
    import tamaas

    tamaas.set_log_level(tamaas.LogLevel.error)
    model = _unit_half_space(level, points)
    across = 0.25 * level.h * _crests(level, points, 0.0)
    heights = np.multiply.outer(_crests(level, points, 0.0), across)
    solver = tamaas.MaxwellViscoelastic(model, heights, tolerance, level.l / V / steps, [branch], [tau])
    surface = np.reshape(solver.surface, (points, points))
    k, x = 2 * np.pi / level.l, level.l * np.arange(points) / points
    taus, contacts = np.zeros(steps), np.zeros(steps)
    # the slow time is that of retardation
    periods = 1 + math.ceil(6 * tau * (1 + branch) * V / level.l)
    for step in range(periods * steps):
        moved = level.l * step / steps
        surface[...] = np.multiply.outer(_crests(level, points, moved), across)
        solver.solve(pressure)
        traction = np.reshape(model.traction, (points, points))
        taus[step % steps] = -np.mean(traction * np.multiply.outer(-k * np.sin(k * (x - moved)), across))
        contacts[step % steps] = np.mean(traction > 0)
    return float(taus.mean()), float(contacts.mean())


def _unit_half_space(level, points):
    import tamaas

    model = tamaas.ModelFactory.createModel(tamaas.model_type.basic_2d, [level.l, level.l], [points, points])
    model.nu, model.E = 0.0, 2.0
    return model


def _crests(level, points, moved):
    """``cos k (x - moved) + 1``."""
    x = level.l * np.arange(points) / points
    return np.cos(2 * np.pi / level.l * (x - moved)) + 1

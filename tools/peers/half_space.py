"""Tamaas, its generalised Maxwell solver with the half-space replaced by independent springs: one level without adhesion at a given pressure."""

import numpy as np


def available():
    """Whether Tamaas is installed."""
    try:
        import tamaas  # noqa: F401
    except ImportError:
        return False
    return True


def friction(material, level, pressure, V, points, periods=3, tolerance=1e-10):
    """Friction stress, Pa: a surface of ``points`` squared rolled step by step over ``periods`` wavelengths.

    In units of K, h and l; the shear modulus has to be one, or the relaxation comes out wrong.
    """
    import tamaas

    tamaas.set_log_level(tamaas.LogLevel.error)
    model = tamaas.ModelFactory.createModel(tamaas.model_type.basic_2d, [1.0, 1.0], [points, points])
    model.nu = 0.0
    model.E = 2.0
    x = np.arange(points) / points
    wave = 0.25 * np.multiply.outer(np.cos(2 * np.pi * x) + 1, np.cos(2 * np.pi * x) + 1)
    slope = np.multiply.outer(-0.5 * np.pi * np.sin(2 * np.pi * x), np.cos(2 * np.pi * x) + 1)
    period = level.l / V
    solver = tamaas.MaxwellViscoelastic(
        model, wave.copy(), tolerance, period / points, [material.T_eps / material.T_sigma - 1], [material.T_sigma]
    )
    # the operator exists from here on; independent springs: every wave number alike
    model.operators["westergaard_neumann"]["influence"][...] = 1.0
    surface = np.reshape(solver.surface, (points, points))
    taus = np.zeros(points)
    for step in range(periods * points):
        surface[...] = np.roll(wave, step, axis=0)
        solver.solve(pressure / (material.K * level.h))
        taus[step % points] = -np.mean(np.reshape(model.traction, (points, points)) * np.roll(slope, step, axis=0))
    return taus.mean() * material.K * level.h**2 / level.l

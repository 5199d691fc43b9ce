"""The foundation under one level that rubs, in complete contact, as a viscoelastic half-space does. SI."""

import sympy as sp

from .check import Derived, derived, zero
from .surface import HEIGHT, mean_over_cell
from .symbols import V, k, l, x, y

E, nu, q, z, P = sp.symbols("E nu q z P", positive=True)
NAMES = {"E": E, r"\nu": nu, "q": q}
"""How the displays call them."""
loss, storage = sp.symbols("E_loss E_storage", positive=True)


def half_space() -> tuple[Derived, Derived]:
    """Stiffness of a half-space under one wave, and of the foundation that stands for it under the waves of Eq. 4."""
    wave = stiffness_under_a_wave()
    return wave, foundation_of_a_level(wave.value)


def stiffness_under_a_wave() -> Derived:
    r"""A pressure wave of wavenumber q, in whatever direction, presses an isotropic half-space in proportion to itself. With a
    constant Poisson ratio the same holds for a complex modulus.

    .. math:: \frac{p}{w} = \frac{E\,q}{2\,(1 - \nu^2)}
    """
    # Airy's function of plane strain in z > 0, with p = P cos qx on z = 0; it and its stresses vanish in the depth
    airy = P / q**2 * (1 + q * z) * sp.exp(-q * z) * sp.cos(q * x)
    s_x, s_z, s_xz = sp.diff(airy, z, 2), sp.diff(airy, x, 2), -sp.diff(airy, x, z)
    strain_z = (1 + nu) / E * ((1 - nu) * s_z - nu * s_x)
    strain_x = (1 + nu) / E * ((1 - nu) * s_x - nu * s_z)
    down = sp.integrate(sp.expand(strain_z), z)  # vanishes in the depth, as every term has exp(-q z)
    along = sp.integrate(sp.expand(strain_x), x)
    w = sp.simplify(down.subs(z, 0))
    stiffness = sp.simplify(P * sp.cos(q * x) / w)
    laplace = lambda f: sp.diff(f, x, 2) + sp.diff(f, z, 2)  # noqa: E731
    checks = [
        zero("the stress function is biharmonic", sp.simplify(laplace(laplace(airy)))),
        zero("on top the pressure is P cos qx and there is no shear", [s_z.subs(z, 0) + P * sp.cos(q * x), s_xz.subs(z, 0)]),
        zero("the displacements have this shear", sp.simplify(sp.diff(down, x) + sp.diff(along, z) - 2 * (1 + nu) / E * s_xz)),
        zero("p = E q/(2 (1 - nu^2)) w", stiffness - E * q / (2 * (1 - nu**2))),
    ]
    return derived(stiffness_under_a_wave, stiffness, checks, "half-space under a wave")


def foundation_of_a_level(stiffness: sp.Expr) -> Derived:
    r"""A half-space under the three waves of Eq. 4 (cos kx, cos ky, and cos kx cos ky, whose wavenumber is sqrt(2) k) in complete
    contact rubs like a foundation of this stiffness. All rates alike: it holds for every relaxation time. In partial contact it
    is an approximation: points of the foundation do not feel their neighbours.

    .. math:: K(i\omega) = c\,\frac{\pi}{l}\,\frac{E(i\omega)}{1 - \nu^2},\quad c = \frac{1/2 + \sqrt{2}/4}{3/4}
    """
    waves = _waves()
    shape = sum(wave for wave, _ in waves)
    slope = sp.diff(shape, x)
    # w = D - f and w_t = V f_x: p = storage w + (loss/omega) w_t with omega = k V, for every wave with its own stiffness
    pressure = sum(
        stiffness.subs({E: storage, q: size}) * -wave + stiffness.subs({E: loss, q: size}) / (k * V) * V * sp.diff(wave, x)
        for wave, size in waves
    )
    alone = [mean_over_cell(stiffness.subs({E: loss, q: size}) / k * sp.diff(wave, x) ** 2) for wave, size in waves]
    rubbing = sp.simplify(mean_over_cell(pressure * slope))
    K_loss = sp.Symbol("K_loss", positive=True)
    local = mean_over_cell((-shape + K_loss / k * slope) * slope)
    K = sp.solve(local - rubbing, K_loss)[0].subs(k, 2 * sp.pi / l)
    c = (sp.Rational(1, 2) + sp.sqrt(2) / 4) / sp.Rational(3, 4)
    checks = [
        zero("the waves are those of Eq. 4, less its mean", sp.expand(HEIGHT - shape - mean_over_cell(HEIGHT))),
        zero("each wave has its wavenumber", [sp.diff(f, x, 2) + sp.diff(f, y, 2) + size**2 * f for f, size in waves]),
        zero("friction needs the loss modulus alone", sp.diff(rubbing, storage)),
        zero("waves of different wavenumber do not rub on one another", rubbing - sum(alone)),
        zero("K = c (pi/l) E/(1 - nu^2) with c = (1/2 + sqrt(2)/4)/(3/4)", K - c * sp.pi / l * loss / (1 - nu**2)),
    ]
    return derived(foundation_of_a_level, c, checks, "foundation that stands for a half-space")


def _waves() -> list[tuple[sp.Expr, sp.Expr]]:
    """The waves of Eq. 4, each with its wavenumber."""
    terms = sp.Add.make_args(sp.expand(HEIGHT))
    sizes = {(True, False): k, (False, True): k, (True, True): sp.sqrt(2) * k}
    return [(term, sizes[term.has(x), term.has(y)]) for term in terms if term.has(x) or term.has(y)]

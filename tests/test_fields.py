"""Pressure, displacement and gap along solved strips: what holds in each zone, at each edge, and over a whole period.

Natural scales: lengths in ``1/k``, ``K = A = 1``; everything is compared with the largest pressure or displacement around.
"""

import pickle
from itertools import product

import numpy as np
import pytest

import hystrip

K, A, LENGTH = 1.0, 1.0, 2 * np.pi
BRANCHES = ("unloading", "loading")
NODES, WEIGHTS = np.polynomial.legendre.leggauss(60)
T_EPS = 1.0

# edge, regime, D, V, T_sigma, p_0, delta_0
STRIPS = [
    ("continuous", "c", 4.0, 1.3, 0.2, 0.4, 0.3),
    ("continuous", "c", 9.0, 4.0, 0.0, 0.4, 0.3),
    ("continuous", "ac", 1.2, 0.5, 0.2, 0.5, 2.0),
    ("continuous", "ac", 1.2, 0.5, 0.0, 0.5, 2.0),
    ("continuous", "acaf", 0.4, 0.5, 0.2, 0.3, 0.1),
    ("continuous", "acaf", 0.4, 0.5, 0.0, 0.3, 0.1),
    ("continuous", "acaf", 0.8, 5.0, 0.05, 0.1, 0.2),
    ("continuous", "cf", 0.4, 0.5, 0.2, 0.0, 0.0),
    ("continuous", "cf", 1.4, 3.0, 0.0, 0.0, 0.0),
    ("continuous", "af", -0.2, 0.5, 0.2, 0.3, 0.25),
    ("continuous", "a", -4.5, 0.5, 0.2, 4.0, 3.2),
    ("continuous", "f", -3.0, 0.5, 0.2, 0.3, 0.1),
    ("constitutive", "c", 4.0, 1.3, 0.2, 0.4, 0.3),
    ("constitutive", "ac", 1.2, 0.5, 0.2, 0.5, 2.0),
    ("constitutive", "acaf", 0.4, 0.5, 0.2, 0.3, 0.1),
    ("constitutive", "acaf", 0.4, 0.5, 0.0, 0.3, 0.1),
    ("constitutive", "afc", 0.4, 0.5, 0.5, 0.6, 0.1),
    ("constitutive", "afc", 0.4, 0.2, 1.0, 0.6, 0.1),
    ("constitutive", "cf", 0.4, 0.5, 0.2, 0.0, 0.0),
    ("constitutive", "af", -0.2, 0.5, 0.2, 0.3, 0.25),
]
IDS = [f"{edge}-{regime}-{T_sigma:g}" for edge, regime, _, _, T_sigma, *_ in STRIPS]


class Case:
    """A solved strip, its zones in x from behind to ahead as (kind, from, to), and its fields inside them."""

    def __init__(self, given):
        self.edge, self.regime, self.D, self.V, self.T_sigma, self.p_0, self.delta_0 = given
        self.solution = self.solve("unloading")
        self.J = self.T_sigma / T_EPS

    def solve(self, branch):
        material = hystrip.StandardLinearSolid(K, T_EPS, self.T_sigma)
        adhesion = hystrip.Dugdale(p_0=self.p_0, delta_0=self.delta_0)
        return hystrip.solve_strip(material, adhesion, l=LENGTH, A=A, D=self.D, V=self.V, edge=self.edge, branch=branch)

    @property
    def onset(self):
        """Where the free part ends: adhesion begins there, or contact if the point snaps in at once."""
        return float(self.solution.b if self.regime == "afc" else self.solution.d)

    @property
    def zones(self):
        s = self.solution
        behind, ahead = -float(s.a), float(s.b)
        if self.regime in ("c", "a", "f"):
            return [(self.regime, -np.pi, np.pi)]
        if self.regime == "cf":
            return [("c", behind, ahead), ("f", ahead, behind + LENGTH)]
        if self.regime == "ac":
            return [("c", behind, ahead), ("a", ahead, behind + LENGTH)]
        end, onset = -float(s.c), self.onset
        if self.regime == "af":
            return [("a", end, onset), ("f", onset, end + LENGTH)]
        zones = [("a", end, behind), ("c", behind, ahead)]
        if self.regime == "acaf":
            zones.append(("a", ahead, onset))
        return [*zones, ("f", onset, end + LENGTH)]

    def w(self, x):
        return self.solution.displacement(x)

    def p(self, x):
        return self.solution.pressure(x)

    def over_period(self, integrand):
        """Integral over a period by Gauss-Legendre in parts of each zone, graded towards its leading end where layers are."""
        total = 0.0
        for _, start, end in self.zones:
            cuts = end - (end - start) * np.concatenate(([0.0], 2.0 ** np.arange(-12, 1)))
            for high, low in zip(cuts[:-1], cuts[1:], strict=True):
                x = 0.5 * (low + high) + 0.5 * (high - low) * NODES
                total += 0.5 * (high - low) * np.sum(WEIGHTS * integrand(x))
        return total

    def sides(self, x, step=1e-10):
        """Pressure and displacement just behind and just ahead of x."""
        return [(float(self.p(at)), float(self.w(at))) for at in (x - step, x + step)]

    def p_x(self, x, h=1e-4):
        return (8 * (self.p(x + h) - self.p(x - h)) - (self.p(x + 2 * h) - self.p(x - 2 * h))) / (12 * h)

    def w_x(self, x, h=1e-4):
        return (8 * (self.w(x + h) - self.w(x - h)) - (self.w(x + 2 * h) - self.w(x - 2 * h))) / (12 * h)

    def loss(self):
        """Energy that the dashpot takes in one period, per area.

        The solid as a spring ``1/J_0`` in series with a Kelvin-Voigt part of strain ``z = w - J_0 p/K``, stiffness
        ``K_1`` and viscosity ``K_1 T_eps``: the loss is that of the viscosity, ``V K_1 T_eps z_x**2``.
        """
        if self.J == 1:
            return 0.0
        K_1 = K / (1 - self.J)

        def rate(x):
            # V T_eps z_x from Eq. 5 itself: z - V T_eps z_x = p/K_1
            p, z = self.p(x), self.w(x) - self.J * self.p(x) / K
            return K_1 / (self.V * T_EPS) * (z - p / K_1) ** 2

        return self.over_period(rate)


@pytest.fixture(params=STRIPS, ids=IDS)
def case(request):
    found = Case(request.param)
    assert found.solution.regime == found.regime
    return found


def inside(start, end, n=41, margin=1e-3):
    return np.linspace(start + margin, end - margin, n)


def test_each_zone_is_what_it_is_called(case):
    assert sum(end - start for _, start, end in case.zones) == pytest.approx(LENGTH, rel=1e-14)
    for kind, start, end in case.zones:
        x = inside(start, end)
        gap, p = case.solution.gap(x), case.p(x)
        if kind == "c":
            assert (gap == 0).all() and (p >= -case.p_0 - 1e-12).all()
        if kind == "a":
            assert (p == -case.p_0).all() and (gap > 0).all() and (gap <= case.delta_0 + 1e-12).all()
        if kind == "f":
            assert (p == 0).all() and (gap > (case.delta_0 if case.p_0 else 0)).all()


def test_displacement_is_profile_plus_gap_and_everything_has_the_period(case):
    x = np.linspace(-4, 4, 57)
    profile = case.D - A * (1 - np.cos(x))
    assert np.allclose(case.w(x) - case.solution.gap(x), profile, rtol=0, atol=1e-14)
    for field in (case.p, case.w):
        assert np.allclose(field(x), field(x + LENGTH), rtol=0, atol=1e-11)


def test_the_foundation_obeys_its_equation(case):
    """``w - V T_eps w_x = (p - V T_sigma p_x)/K`` by finite differences inside every zone."""
    for _, start, end in case.zones:
        x = inside(start, end)
        terms = case.w(x), case.V * T_EPS * case.w_x(x), case.p(x) / K, case.V * case.T_sigma * case.p_x(x) / K
        residual = terms[0] - terms[1] - terms[2] + terms[3]
        assert np.abs(residual).max() <= 1e-8 * (A + max(np.abs(term).max() for term in terms))


def test_edges(case):
    """What is continuous, and what the closure says where the pressure steps."""
    s, near = case.solution, 1e-7
    jump = case.J * case.p_0 / K if case.edge == "constitutive" else 0.0
    if "c" in case.regime and case.regime != "c":
        (p_out, w_out), (p_in, w_in) = case.sides(-float(s.a))
        assert abs(p_in + case.p_0) < near and p_out == -case.p_0 and abs(w_in - w_out) < near
        if case.regime != "afc":
            (p_in, w_in), (p_out, w_out) = case.sides(float(s.b))
            assert abs(w_in - w_out) < near and p_out == -case.p_0
            assert abs(p_in + case.p_0) < near or case.T_sigma == 0
    if "a" in case.regime and "f" in case.regime:
        (p_free, w_free), (p_held, w_held) = case.sides(-float(s.c))
        assert p_free == 0 and p_held == -case.p_0 and abs(w_free - w_held - jump) < near
        assert abs(case.solution.gap(-float(s.c) + 1e-10) - case.delta_0) < near
        (p_in, w_in), (p_free, w_free) = case.sides(case.onset)
        assert p_free == 0 and abs(case.solution.gap(case.onset + 1e-10) - case.delta_0) < near
        if case.regime == "afc":
            assert jump >= case.delta_0 and abs(p_in + K * case.delta_0 / case.J) < near  # the whole range at once
        else:
            assert p_in == -case.p_0 and abs(w_free - w_in - jump) < near


def test_means_are_integrals_of_the_fields(case):
    s, top = case.solution, np.abs(case.p(np.linspace(-np.pi, np.pi, 99))).max() + case.p_0
    assert abs(case.over_period(case.p) / LENGTH - s.p_mean) < 1e-11 * (1 + top)
    # the profile's slope in the direction of travel is -du/dx = A sin x (k = 1)
    drag = case.over_period(lambda x: case.p(x) * A * np.sin(x)) / LENGTH
    assert abs(drag - s.tau_mean) < 1e-11 * (1 + top)
    for kind, fraction in (("c", s.contact_fraction), ("a", s.adhesion_fraction)):
        assert sum(end - start for k, start, end in case.zones if k == kind) / LENGTH == pytest.approx(float(fraction), abs=1e-13)


def test_energy(case):
    """Friction work is what the dashpot takes and what the steps of the pressure take (or, by convention, are spared)."""
    s, work = case.solution, float(case.solution.tau_mean) * LENGTH
    expected = case.loss()
    if "a" in case.regime and "f" in case.regime:
        if case.edge == "continuous":
            expected -= K / (1 - case.J) * case.J / K * case.p_0 * float(case.w(s.d) - case.w(-s.c))
        else:
            glassy = K / case.J if case.J else np.inf
            expected += snap(glassy, case.p_0, case.delta_0, touching="c" in case.regime)
    assert work == pytest.approx(expected, rel=1e-10, abs=1e-11)
    assert work >= 0


def snap(stiffness, p_0, delta_0, touching):
    """Loss of one snap in and one snap out of an elastic foundation of this stiffness, per area."""
    if stiffness == np.inf:
        return 0.0
    if touching and p_0 >= stiffness * delta_0:
        return p_0 * delta_0 + p_0**2 / (2 * stiffness) - stiffness * delta_0**2 / 2
    return p_0**2 / stiffness


@pytest.mark.parametrize(("x_shape", "strips"), list(product([(), (5,), (5, 1)], [(), (5,), (1, 5)])))
def test_positions_broadcast_against_strips(x_shape, strips):
    case = Case(STRIPS[4])
    material, adhesion = hystrip.StandardLinearSolid(K, T_EPS, 0.2), hystrip.Dugdale(p_0=0.3, delta_0=0.1)
    s = hystrip.solve_strip(material, adhesion, l=LENGTH, A=A, D=np.full(strips, 0.4), V=0.5)
    x = np.full(x_shape, 0.2)
    for name in ("pressure", "gap", "displacement"):
        found = getattr(s, name)(x)
        assert found.shape == np.broadcast_shapes(x_shape, strips)
        assert (found == getattr(case.solution, name)(0.2)).all()


def test_flat_strips_have_fields():
    material, adhesion = hystrip.StandardLinearSolid(2.0, 1.0, 0.1), hystrip.Dugdale(p_0=0.6, delta_0=0.1)
    s = hystrip.solve_strip(material, adhesion, l=1.0, A=0.0, D=[0.5, -0.35, -1.0], V=1.0)
    x = np.array([[0.0], [0.3]])
    assert s.regime.tolist() == ["c", "a", "f"]
    assert np.allclose(s.pressure(x), [1.0, -0.6, 0.0])
    assert np.allclose(s.displacement(x), [0.5, -0.3, 0.0])
    assert np.allclose(s.gap(x), [0.0, 0.05, 1.0])


@pytest.mark.parametrize(
    "material",
    [
        hystrip.StandardLinearSolid([1e9, 2e9], 1e-2, 1e-4),
        hystrip.Prony(1e9, [1e9, 1e10], [1e-2, 1e-4]),
        hystrip.HalfSpace(2e6, 0.5, [8e6, 1e6], [1e-3, 1e-1]),
    ],
    ids=lambda m: type(m).__name__,
)
def test_strips_can_be_pickled(material):
    adhesion = hystrip.Dugdale(gamma=2.5e-5, delta_0=1e-8)
    s = hystrip.solve_strip(material, adhesion, l=[1e-5, 2e-5], A=5e-7, D=6e-7, V=5e-3, edge="constitutive")
    x = np.linspace(0, 1e-5, 5)[:, None]
    assert (pickle.loads(pickle.dumps(s)).pressure(x) == s.pressure(x)).all()

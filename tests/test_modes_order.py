"""The claims that the choice of the extremal orbit rests on (``runtime/modes/order.py``), on random states, and the
orbits it leads to."""

import numpy as np
import pytest

from hystrip.generated import generalised
from hystrip.inputs.model import modes_of
from hystrip.orbit.modes.contraction import upper_bound
from hystrip.orbit.modes.coordinates import Order
from hystrip.orbit.modes.engine import solve_modes
from hystrip.orbit.modes.march import march
from hystrip.orbit.modes.problem import ModeStrips
from hystrip.orbit.modes.propagation import exact_gains, least_gains, propagation
from hystrip.orbit.regimes import SEQUENCES

TIMES = (2, 3)
N = 1500


def strips(rng, n, size=N, fast=False):
    """Strips that are often engaged and often not, a third of them snapping into contact; ``fast``: the first time is so short
    that an onset is followed by contact almost at once."""
    log = lambda low, high, *shape: 10 ** rng.uniform(np.log10(low), np.log10(high), shape)  # noqa: E731
    kernel = generalised
    tau_i = np.sort(log(0.01, 30, n, size), axis=0)
    if fast:
        tau_i[0] = log(1e-5, 1e-3, size)
    _, modes = modes_of(kernel, {"K": np.ones(size), "K_i": log(0.05, 30, n, size), "tau_i": tau_i})
    P0, Delta = log(0.05, 5, size), log(0.03, 2, size)
    return kernel, ModeStrips(kernel.at_speed(modes, np.ones(size)), P0, Delta, rng.uniform(-1 - Delta, 3))


def states(rng, order, s):
    """A state and one that is nowhere below it: engaged before free, then every dashpot displacement."""
    n, size = s.modes, s.size
    lower = rng.uniform(-2, 3, (n, size))
    # half of the pairs differ in one component only, and by little
    apart = 10 ** rng.uniform(-6, 0.5, (n, size)) * (rng.random((n, size)) < 0.5)
    engaged = rng.random(size) < 0.6
    return engaged, lower, engaged & (rng.random(size) < 0.6), lower + apart


@pytest.mark.parametrize("n", TIMES)
def test_a_period_preserves_the_order(n):
    rng = np.random.default_rng(n)
    kernel, s = strips(rng, n)
    order = Order.of(kernel, s)
    h, e, h_up, e_up = states(rng, order, s)
    start = rng.uniform(0, 2 * np.pi, N)
    one, two = (march(kernel, s, engaged, order.to_z(state), start) for engaged, state in ((h, e), (h_up, e_up)))
    assert not one.lost.any() and not two.lost.any()
    after, after_up = e + order.to_e(one.dz), e_up + order.to_e(two.dz)
    assert np.all(after <= after_up + 1e-12 * (1 + np.abs(after)))
    assert np.all(one.engaged | ~two.engaged)
    # the test has seen all there is: snap-ins, releases of one but not the other, ordered pairs that stay apart
    snaps = s.step >= s.delta_0
    assert snaps.sum() > N / 10 and (one.engaged & ~two.engaged).sum() > N / 400 and np.any(after < after_up - 1e-3)


def test_order_fails_where_a_free_state_lies_below_an_engaged_one():
    """The order's first part is needed: pairs with e ascending but the free one below are not preserved."""
    rng = np.random.default_rng(5)
    kernel, s = strips(rng, 2)
    order = Order.of(kernel, s)
    e = rng.uniform(-2, 3, (2, N))
    start = np.full(N, np.pi)
    free, engaged = (march(kernel, s, np.full(N, h), order.to_z(state), start) for h, state in ((False, e), (True, e + 1e-3)))
    assert np.any(order.to_e(free.dz) > 1e-3 + order.to_e(engaged.dz) + 1e-3)


@pytest.mark.parametrize(("n", "fast"), [*((n, False) for n in TIMES), (3, True)])
def test_bounds_of_the_derivative(n, fast):
    """Between two ordered states the map grows at least as the lower bound of its derivative says, and contracts
    no less than the upper one says, and the exact one is its slope.

    States lie where all orbits do, between -p_0 and max(D, 0)."""
    rng = np.random.default_rng(10 + n)
    kernel, s = strips(rng, n, N, fast)
    order = Order.of(kernel, s)
    h = rng.random(N) < 0.5
    room = np.maximum(s.D, 0.0) + s.p_0
    # dashpots of one history do not lie far apart
    e = -s.p_0 + room * np.clip(rng.random(N) + rng.normal(0, 0.1, (n, N)), 0, 1)
    step = np.minimum(10 ** rng.uniform(-5, -1, (n, N)), np.maximum(s.D, 0.0) - e)
    start = np.full(N, np.pi)
    lower, upper = (march(kernel, s, h, order.to_z(state), start) for state in (e, e + step))
    once = (
        (lower.onsets == 1)
        & (upper.onsets == 1)
        & (lower.releases == 1)
        & (upper.releases == 1)
        & (lower.engaged == upper.engaged)
    )
    gains = least_gains(s, order, lower, upper, once)
    bound = propagation(s, order, lower, gains)
    grown = order.to_e(upper.dz - lower.dz)
    # a phase is rounded, and a fast mode moves by that over its time
    rounded = np.finfo(float).eps * np.pi / s.m.alpha.min(axis=0) if fast else 0.0
    assert np.all(grown >= np.einsum("Nij,jN->iN", bound, step) - rounded - 1e-11 * (1 + np.abs(e).max(axis=0)))
    assert once.sum() > N / 10
    # the upper bound is that of the map from another phase of the same turn: their spectral radii are to be compared
    most, holds = upper_bound(s, order, lower, upper)
    between = march(kernel, s, h, order.to_z(e + rng.random(N) * step), start)
    growth = lambda change: np.linalg.eigvals(np.where(holds[:, None, None], change, 0.0)).real.max(axis=1)  # noqa: E731
    for period in (lower, between, upper):
        same = holds & (period.contacts == lower.contacts)
        exact = growth(propagation(s, order, period, exact_gains(s, order, period)))
        assert same.sum() > N / 30 and np.all(exact[same] <= growth(most)[same] + 1e-9)
    if fast:
        # onsets that lie further apart than contact is behind them: their gain is known all the same
        wide = once & (upper.onset - lower.onset > 3 * (lower.entry - lower.onset)) & (lower.entry > lower.onset)
        assert (gains[0].gain[wide] > 0).sum() > 10
        return

    near = np.flatnonzero(once & (step.max(axis=0) < 1e-3) & (step.max(axis=0) > 1e-6))
    part = s.take(near)
    tiny = 1e-7 * step[:, near] / step[:, near].max(axis=0)
    base = march(kernel, part, h[near], order.take(near).to_z(e[:, near]), start[near])
    moved = march(kernel, part, h[near], order.take(near).to_z(e[:, near] + tiny), start[near])
    exact = np.einsum("Nij,jN->iN", propagation(part, order.take(near), base, exact_gains(part, order.take(near), base)), tiny)
    steep = np.minimum(-base.slope[0], base.slope[1]) > 0.05  # away from grazing
    same = (base.contacts == moved.contacts) & steep
    measured = order.take(near).to_e(moved.dz - base.dz)
    assert same.sum() > 20
    assert np.allclose(measured[:, same], exact[:, same], rtol=1e-3, atol=1e-12)


@pytest.mark.parametrize("n", TIMES)
def test_plain_iteration_ends_at_the_returned_orbits(n):
    """From far below and far above, period after period: the map alone, without bounds, candidates or boundary equations."""
    rng = np.random.default_rng(20 + n)
    kernel, s = strips(rng, n, 400)
    order = Order.of(kernel, s)
    start = np.full(s.size, np.pi)
    settled_in_all = 0
    for unloading in (True, False):
        solved = solve_modes(kernel, s, unloading)
        assert solved.certified.all()
        engaged = np.full(s.size, unloading)
        z = order.to_z(np.full((n, s.size), -30.0 if unloading else 30.0))
        contact, adhesion, settled = np.zeros(s.size), np.zeros(s.size), np.zeros(s.size, bool)
        left = np.arange(s.size)
        for _ in range(160):
            period = march(kernel, s.take(left), engaged[left], z[:, left], start[left])
            # iteration contracts: what moved this little is there, and need not be followed any further
            still = (np.abs(period.dz).max(axis=0) < 1e-10) & (period.engaged == engaged[left])
            engaged[left], z[:, left] = period.engaged, z[:, left] + period.dz
            length = np.diff(period.ends, axis=0) / (2 * np.pi)
            for fraction, letter in ((contact, 0), (adhesion, 1)):
                fraction[left[still]] = np.where(period.letters == letter, length, 0.0).sum(axis=0)[still]
            settled[left[still]] = True
            left = left[~still]
            if not left.size:
                break
        off = np.maximum(np.abs(contact - solved.contact_fraction), np.abs(adhesion - solved.adhesion_fraction))
        assert np.flatnonzero(settled & (off > 1e-6)).tolist() == []
        assert {"acaf", "ac", "f", "afc"} <= set(SEQUENCES[solved.code[settled]])
        settled_in_all += settled.sum()
    assert settled_in_all > 0.8 * 2 * s.size

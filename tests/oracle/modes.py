"""High-precision reference solution of one strip on a foundation with n relaxation times, closure ``constitutive``.

It follows one material point from event to event. The state are the displacements ``e_i`` of the dashpots: with
relative moduli ``m_i = K_i/K``, times ``theta_i = k V tau_i`` and ``J = 1/(1 + sum m_i)``

    w = J p + z,   z = J sum m_i e_i,   theta_i e_i' = w - e_i

in units of A and K A, a prime being d/ds with ``s = -k x``. Nothing is taken from the library: no boundary equations,
no generated code; the modes of a gap come from a symmetric eigenvalue problem at the working precision.

Which orbit is extremal. With ``y = z - u`` the traction is a relay in y: engagement begins where y falls to Delta and
ends where it rises to ``Delta + J P0``; engaged, ``w = u + max(y - J P0, 0)``, free, ``w = z``. Both are nondecreasing
in every ``e_i`` and the relay in its input, so the period map preserves the order "engaged before free, then every e_i
ascending". Hence from a state below every orbit the iterates rise to the most engaged orbit, from one above every orbit
they fall to the least engaged one. They are accelerated without passing it: if M is a lower bound of the map's
derivative, then ``x + (I - M)^-1 (P(x) - x)`` is still below (above) the orbit.
"""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from mpmath import fp, mp

from .march import Solution, edges_of
from .orbits import LOADING, UNLOADING, Unresolved

DIGITS = 50
#: the eigenvalues of the gap's modes spread over many decades
_GUARD = 40
#: how close the ordered iteration has to come before Newton's method may end it
_CLOSE = mp.mpf("1e-5")
_SWEEPS = 4000
#: to which a start for Newton's method is found in double precision
_CLOSE_ENOUGH = 1e-8
#: modes up to which a spectral radius is found to all digits
_FEW = 3


class Foundation:
    """Relative moduli and times, and the modes of the gap: times ``lambdas``, ``z = sum weight_j v_j``, ``v = S e``,
    ``e = back v``. ``context``: what computes with them, mpmath's floating-point numbers of many digits (or of 16)."""

    context = mp

    def __init__(self, theta, m):
        self.theta, self.m = [mp.mpf(t) for t in theta], [mp.mpf(v) for v in m]
        if not self.theta or min(self.theta) <= 0 or min(self.m) <= 0 or len(self.theta) != len(self.m):
            raise ValueError("need as many moduli as times, all > 0")
        n = self.n = len(self.theta)
        self.J = 1 / (1 + mp.fsum(self.m))
        # W A W^-1 is symmetric for W = diag sqrt(m theta)
        q = [mp.sqrt(m / t) for m, t in zip(self.m, self.theta, strict=True)]
        symmetric = mp.matrix(n, n)
        for i in range(n):
            for j in range(n):
                symmetric[i, j] = (1 / self.theta[i] if i == j else 0) - self.J * q[i] * q[j]
        rates, Q = mp.eigsy(symmetric)
        scale = [mp.sqrt(m * t) for m, t in zip(self.m, self.theta, strict=True)]
        self.lambdas = [1 / rate for rate in rates]
        self.weight = [self.J * mp.fsum(self.m[i] / scale[i] * Q[i, j] for i in range(n)) for j in range(n)]
        self.S = mp.matrix(n, n)
        self.back = mp.matrix(n, n)
        for j in range(n):
            for i in range(n):
                self.S[j, i] = Q[i, j] * scale[i]
                self.back[i, j] = Q[i, j] / scale[i]
        # under a constant pressure p each v_j tends to j_j p
        self.j = [mp.fsum(self.S[k, i] / self.theta[i] for i in range(n)) * self.J * self.lambdas[k] for k in range(n)]

    def rounded(self):
        """The same to double precision."""
        near = object.__new__(Foundation)
        near.context, near.n, near.J = fp, self.n, float(self.J)
        for name in ("theta", "m", "lambdas", "weight", "j"):
            setattr(near, name, [float(v) for v in getattr(self, name)])
        near.S, near.back = fp.matrix(self.S), fp.matrix(self.back)
        return near


class ModesStrip:
    """Dimensionless strip: a ``Foundation``, ``P0 = p_0/(K A)``, ``Delta = delta_0/A``, ``delta = D/A``."""

    def __init__(self, foundation, P0, Delta, delta):
        self.foundation, self.context = foundation, foundation.context
        self.P0, self.Delta, self.delta = (self.context.mpf(value) for value in (P0, Delta, delta))
        self.mean = self.delta - 1
        self.J = foundation.J
        self.step = self.J * self.P0
        if self.P0 == 0:
            self.Delta = self.context.zero

    def u(self, s):
        return self.mean + self.context.cos(s)

    def rounded(self):
        """The same to double precision."""
        return ModesStrip(self.foundation.rounded(), self.P0, self.Delta, self.delta)


# -- first crossings ---------------------------------------------------------------------------------------------------


class Event:
    """``G(s) = constant + a cos s + b sin s + sum c_i exp(-(s - start)/T_i)``, and its first zero if it starts >= 0."""

    def __init__(self, context, start, constant, a, b, terms):
        self.context, self.start, self.constant, self.a, self.b, self.terms = context, start, constant, a, b, terms
        self.amplitude = context.sqrt(a * a + b * b)

    def __call__(self, s):
        return self._parts(s)[0]

    def slope(self, s):
        return self._parts(s)[2]

    def _parts(self, s):
        """Value, a lower bound of the slope at all later phases but for curvature ``amplitude``, the slope, its
        curvature bound."""
        exp = self.context.exp
        cosine, sine = self.context.cos_sin(s)
        value = self.constant + self.a * cosine + self.b * sine
        base = -self.a * sine + self.b * cosine
        slope, bound = base, self.amplitude
        for c, T in self.terms:
            term = c * exp(-(s - self.start) / T)
            value += term
            slope -= term / T
            if c > 0:
                base -= term / T  # convex: its tangent lies below it
            else:
                bound -= term / T**2  # rising ever slower
        return value, base, slope, bound

    def first_zero(self, end):
        """First phase after ``start`` and before ``end`` at which G falls through zero, or None.

        From a point where G > 0 it steps as far as lower bounds of G stay positive: it approaches the first zero and
        cannot pass it.
        """
        s, mp = self.start, self.context
        tolerance = 1e-14 if mp is fp else mp.mpf(10) ** (14 - mp.dps)
        for _ in range(20000):
            if s >= end:
                return None
            value, base, slope, bound = self._parts(s)
            if value < 0:
                if s > self.start or slope < 0:
                    return s  # by rounding, at the start or next to the zero
                value = mp.zero  # a zone begins on the zero of the event that ended the one before
            step = max(_reach(mp, value, base, self.amplitude), _reach(mp, value, slope, bound))
            if step < tolerance:
                return s + step if s + step < end else None
            s += step
        raise ArithmeticError("first crossing did not converge")


def _reach(mp, value, slope, curvature):
    """Positive zero of ``value + slope t - curvature t^2/2``."""
    root = mp.sqrt(slope * slope + 2 * curvature * value)
    if slope > 0:
        return (slope + root) / curvature
    return 2 * value / (root - slope) if root > slope else mp.zero


# -- one period --------------------------------------------------------------------------------------------------------


@dataclass
class Zone:
    """Letter, start, end, and the dashpot displacements at the start."""

    letter: str
    start: Any
    end: Any
    e: Any


def zone_of(strip, engaged, e, s):
    """Zone of a point with this memory at phase s, and whether it is engaged there."""
    f, mp = strip.foundation, strip.context
    y = f.J * mp.fsum(m * each for m, each in zip(f.m, e, strict=True)) - strip.u(s)
    if strip.P0 == 0:
        return ("c" if y < 0 else "f"), True
    engaged = y <= strip.Delta + strip.step if engaged else y <= strip.Delta
    if not engaged:
        return "f", False
    return ("c" if y < strip.step else "a"), True


def advance(strip, letter, start, e, end):
    """Dashpot displacements at ``end`` within one zone, and the event functions of the zone: (event, next zone)."""
    f, mp = strip.foundation, strip.context
    if letter == "c":
        rest = lambda i, s: strip.mean + (mp.cos(s) + f.theta[i] * mp.sin(s)) / (1 + f.theta[i] ** 2)  # noqa: E731
        off = [e[i] - rest(i, start) for i in range(f.n)]
        if end is None:
            in_phase = 1 + mp.fsum(m * t * t / (1 + t * t) for m, t in zip(f.m, f.theta, strict=True))
            out = mp.fsum(m * t / (1 + t * t) for m, t in zip(f.m, f.theta, strict=True))
            terms = [(-m * c, t) for m, c, t in zip(f.m, off, f.theta, strict=True)]
            # p = mean + in_phase cos - out sin - sum m off exp
            excess = Event(mp, start, strip.mean + strip.P0, in_phase, -out, terms)
            return [(excess, "f" if strip.P0 == 0 else "a")]
        return mp.matrix([rest(i, end) + off[i] * mp.exp(-(end - start) / f.theta[i]) for i in range(f.n)])
    p = -strip.P0 if letter == "a" else mp.zero
    v = f.S * e
    off = [v[j] - f.j[j] * p for j in range(f.n)]
    if end is None:
        # gap = w - u, w = p + sum weight off exp (J + sum weight j = 1)
        terms = [(weight * c, t) for weight, c, t in zip(f.weight, off, f.lambdas, strict=True)]
        level = lambda L, sign: Event(  # noqa: E731
            mp, start, sign * (p - strip.mean - L), -sign, mp.zero, [(sign * c, t) for c, t in terms]
        )
        if letter == "f":
            following = "c" if strip.P0 == 0 or strip.step >= strip.Delta else "a"
            return [(level(strip.Delta, 1), following)]
        return [(level(mp.zero, 1), "c"), (level(strip.Delta, -1), "f")]
    grown = [f.j[j] * p + off[j] * mp.exp(-(end - start) / f.lambdas[j]) for j in range(f.n)]
    return f.back * mp.matrix(grown)


def propagated(strip, letter, length, before):
    """What a zone of this length makes of the derivatives ``before`` (n, columns) of the displacements at its start."""
    f, mp = strip.foundation, strip.context
    times = f.theta if letter == "c" else f.lambdas
    kept = [mp.exp(-length / t) for t in times]
    rows = before.tolist() if letter == "c" else _product(mp, f.S.tolist(), before.tolist())
    rows = [[k * v for v in row] for k, row in zip(kept, rows, strict=True)]
    return mp.matrix(rows if letter == "c" else _product(mp, f.back.tolist(), rows))


def _product(mp, left, right):
    """Product of two matrices, lists of rows."""
    if mp is fp:
        return (np.array(left) @ np.array(right)).tolist()
    columns = list(zip(*right, strict=True))
    return [[mp.fdot(zip(row, column, strict=True)) for column in columns] for row in left]


def period(strip, engaged, e, start, gains=True):
    """Follow a point for one turn: zones met, engaged at the end, displacements at the end, derivative of the map, and whether
    it was never released. Without the ``gains`` at release and onset the derivative is bounded from below."""
    f, mp = strip.foundation, strip.context
    n = f.n
    end = start + 2 * mp.pi
    letter, engaged = zone_of(strip, engaged, e, start)
    zones, s = [], start
    change = mp.eye(n)
    never_released = engaged
    for _ in range(60):
        first, following = None, None
        for event, target in advance(strip, letter, s, e, None):
            if strip.P0 == 0 and target == "f" and letter == "a":
                continue
            found = event.first_zero(first if first is not None else end)
            if found is not None:
                first, following, cause = found, target, event
        stop = end if first is None else first
        zones.append(Zone(letter, s, stop, e))
        e = advance(strip, letter, s, e, stop)
        change = propagated(strip, letter, stop - s, change)
        if first is None:
            break
        if strip.P0 > 0 and ("f" in (letter, following)):
            # w steps: the later (earlier) the event, the longer the dashpots feel the lower (higher) w
            jump = strip.step if following == "a" or letter == "a" else min(strip.step, strip.Delta)
            gain = jump / abs(cause.slope(first))
            if gains:
                row = _product(mp, [[f.J * m for m in f.m]], change.tolist())
                change = change + mp.matrix(_product(mp, [[gain / t] for t in f.theta], row))
            never_released = False
        engaged = strip.P0 == 0 or following != "f"
        letter, s = following, stop
    else:
        raise ArithmeticError("too many zones in one period")
    return zones, engaged, e, change, never_released and engaged


# -- the extremal orbit ------------------------------------------------------------------------------------------------


def _solve(mp, M, r):
    """``(I - M)^-1 r``."""
    return mp.lu_solve(mp.eye(M.rows) - M, r)


def _size(strip):
    return 1 + abs(strip.delta) + strip.P0 + strip.Delta


def always_engaged(strip, start, e=None):
    """The one orbit of the strip that is never released: displacements at ``start`` and zones, as ``period`` gives them.

    Raised by P0 it is a strip without traction. Its map is convex and contracts, so Newton's method rises to its fixed point,
    from wherever it starts.
    """
    n, mp = strip.foundation.n, strip.context
    bare = ModesStrip(strip.foundation, 0, 0, strip.delta + strip.P0)
    e = mp.matrix([bare.delta - 1] * n) if e is None else e + mp.matrix([strip.P0] * n)
    limit = _CLOSE_ENOUGH if mp is fp else mp.mpf(10) ** (20 - mp.dps)
    for _ in range(500):
        zones, _, after, least, _ = period(bare, True, e, start, gains=False)
        step = _solve(mp, least, after - e)
        e = e + step
        if mp.norm(step, mp.inf) < limit * _size(strip):
            zones = period(bare, True, e, start, gains=False)[0]
            lowered = [Zone(z.letter.replace("f", "a"), z.start, z.end, z.e - mp.matrix([strip.P0] * n)) for z in zones]
            return e - mp.matrix([strip.P0] * n), lowered, least
    raise Unresolved("always engaged orbit did not converge")


def stays_engaged(strip, zones):
    """Whether the gap of an always engaged orbit never exceeds Delta."""
    for zone in zones:
        if zone.letter == "a":
            released = advance(strip, "a", zone.start, zone.e, None)[1][0]
            if released(zone.start) < 0 or released.first_zero(zone.end) is not None:
                return False
    return True


def extremal(strip, branch):
    """Zones of the extremal orbit from phase pi on, displacements there, and the derivative of its period map.

    The orbit is found to double precision, and followed to the end from there; where that fails, from the start.
    """
    start, rough = +mp.pi, strip.rounded()
    if strip.P0 == 0 and strip.delta <= 0:
        return _free(strip, start)
    try:
        guess = mp.matrix(always_engaged(rough, float(start))[0])
    except (Unresolved, ArithmeticError):
        guess = None
    lowest, zones, least = always_engaged(strip, start, guess)
    if strip.P0 == 0:
        zones = [Zone(z.letter.replace("a", "f"), z.start, z.end, z.e) for z in zones]
        return zones, lowest, least
    admissible = stays_engaged(strip, zones)
    if branch == UNLOADING and admissible:
        return zones, lowest, least
    if branch == LOADING and strip.delta <= -strip.Delta:
        return _free(strip, start)
    try:
        found = _first(rough, branch, fp.matrix(lowest), float(start))
        if isinstance(found, tuple):
            orbit = _newton(strip, found[0], mp.matrix(found[1]), start, found[2])
            found = _confirmed(strip, orbit, mp.matrix(found[1]))
    except (Unresolved, ArithmeticError):
        found = None
    if found is None:
        found = _first(strip, branch, lowest, start)
        if isinstance(found, tuple):
            found = _newton(strip, found[0], found[1], start, found[2])
    if found == "free":
        return _free(strip, start)
    if found == "engaged":
        if not admissible:
            raise Unresolved("engaged all along, but the engaged orbit is not admissible")
        return zones, lowest, least
    return found


def _confirmed(strip, orbit, near):
    """An orbit where it is ``near`` enough, else None."""
    close = orbit is not None and mp.norm(orbit[1] - near, mp.inf) < _CLOSE * _size(strip)
    return orbit if close else None


def _first(strip, branch, lowest, start):
    """The first orbit by ordered iteration from ``lowest`` upwards (unloading) or from above: "free", "engaged", or whether it is
    engaged at ``start``, its displacements there, and the letters of its zones."""
    n, mp = strip.foundation.n, strip.context
    # below (unloading) or above (loading) every orbit
    engaged = branch == UNLOADING
    e = lowest if engaged else mp.matrix([max(strip.delta, 0)] * n)
    if not engaged:
        least = _longest(strip, lowest, start)
    scale, last = _size(strip), None
    still = 1e-14 if mp is fp else mp.mpf(10) ** (25 - mp.dps)
    for _ in range(_SWEEPS):
        zones, after_engaged, after, bound, never_released = period(strip, engaged, e, start, gains=False)
        letters = [zone.letter for zone in zones]
        if branch == LOADING:
            if never_released:
                return "engaged"
            bound = least  # contact of the most engaged orbit: none has more
        elif strip.delta <= -strip.Delta and all(letter == "f" for letter in letters):
            return "free"
        if after_engaged == engaged:
            newton = _newton(strip, engaged, e, start, letters)
            if newton is not None and mp.norm(newton[1] - e, mp.inf) < float(_CLOSE) * scale:
                return engaged, newton[1], letters
            last = e
            e = e + _solve(mp, bound, after - e)
        else:
            engaged, e = after_engaged, after
        if last is not None and mp.norm(last - e, mp.inf) < still * scale:
            raise Unresolved("iteration stands still away from an orbit: a graze")
    raise Unresolved("ordered iteration too slow: a fold is near")


def _longest(strip, lowest, start):
    """Derivative of the period map along the orbit that is never released, from its state ``lowest`` at ``start``."""
    bare = ModesStrip(strip.foundation, 0, 0, strip.delta + strip.P0)
    return period(bare, True, lowest + strip.context.matrix([strip.P0] * strip.foundation.n), start, gains=False)[3]


def _newton(strip, engaged, e, start, letters):
    """Newton's method on the period map; None unless it converges within the same zones."""
    mp = strip.context
    limit = (_CLOSE_ENOUGH if mp is fp else mp.mpf(10) ** (18 - mp.dps)) * _size(strip)
    for _ in range(12):
        try:
            zones, after_engaged, after, exact, _ = period(strip, engaged, e, start)
            step = _solve(mp, exact, after - e)
        except ZeroDivisionError:
            return None
        if after_engaged != engaged or [zone.letter for zone in zones] != letters:
            return None
        e = e + step
        if mp.norm(step, mp.inf) < limit:
            return (zones, e, exact) if radius(exact) < 1 else None
        if mp.norm(step, mp.inf) > float(_CLOSE) * 100 * _size(strip):
            return None
    return None


def radius(matrix):
    """Spectral radius."""
    if matrix.rows == 1:
        return abs(matrix[0, 0])
    if matrix.ctx is fp or matrix.rows > _FEW:
        return max(abs(np.linalg.eigvals(np.array(matrix.tolist(), float))))
    return max(abs(value) for value in matrix.ctx.eig(matrix, left=False, right=False))


def _free(strip, start):
    zero = mp.zeros(strip.foundation.n, 1)
    end = start + 2 * mp.pi
    return [Zone("f", start, end, zero)], zero, propagated(strip, "f", end - start, mp.eye(strip.foundation.n))


# -- public ------------------------------------------------------------------------------------------------------------


def solve(theta, m, P0, Delta, delta, branch=UNLOADING, digits=DIGITS):
    """Extremal orbit of a dimensionless strip under ``constitutive``, with relative moduli ``m`` at times ``theta`` (sequences).

    As ``march.solve``, with the spectral radius of the period map for the slope. Raises ``Unresolved`` next to a fold or a graze.
    """
    with mp.workdps(digits + _GUARD):
        strip = ModesStrip(Foundation(theta, m), P0, Delta, delta)
        zones, _, exact = extremal(strip, branch)
        return _solution(strip, zones, exact)


def solve_si(K, moduli, times, V, l, A, D, p_0, delta_0, branch=UNLOADING, digits=DIGITS):
    """As ``solve`` for SI values: K and moduli in Pa/m, times in s. p_mean and tau_mean in Pa."""
    with mp.workdps(digits + _GUARD):
        K, V, l, A, D, p_0, delta_0 = map(mp.mpf, (K, V, l, A, D, p_0, delta_0))
        k = 2 * mp.pi / l
        theta, m = [k * V * mp.mpf(t) for t in times], [mp.mpf(each) / K for each in moduli]
        found = solve(theta, m, p_0 / (K * A), delta_0 / A, D / A, branch, digits)
        return replace(found, p_mean=found.p_mean * K * A, tau_mean=found.tau_mean * K * A * A * k)


def _solution(strip, zones, exact):
    turn = 2 * mp.pi
    lengths = {letter: mp.zero for letter in "caf"}
    pressure = friction = mp.zero
    for zone in zones:
        lengths[zone.letter] += zone.end - zone.start
        if zone.letter == "c":
            force, work = _contact(strip, zone)
            pressure, friction = pressure + force, friction + work
        elif zone.letter == "a":
            pressure -= strip.P0 * (zone.end - zone.start)
            friction -= strip.P0 * (mp.cos(zone.end) - mp.cos(zone.start))
    cyclic = _joined(zones)
    sequence = "".join(letter for letter, _, _ in cyclic)
    return Solution(
        min(sequence[i:] + sequence[:i] for i in range(len(sequence))),
        edges_of(cyclic),
        pressure / turn,
        friction / turn,
        lengths["c"] / turn,
        lengths["a"] / turn,
        radius(exact),
    )


def _contact(strip, zone):
    """Integrals of ``p`` and ``p u'`` over a contact zone, term by term of ``p = constant + a cos s + b sin s + sum c exp``."""
    ((event, _),) = advance(strip, "c", zone.start, zone.e, None)
    s_0, s_1 = zone.start, zone.end
    (c_0, n_0), (c_1, n_1) = mp.cos_sin(s_0), mp.cos_sin(s_1)
    constant, length = event.constant - strip.P0, s_1 - s_0
    force = constant * length + event.a * (n_1 - n_0) - event.b * (c_1 - c_0)
    work = constant * (c_1 - c_0) + event.a * (c_1**2 - c_0**2) / 2 - event.b * (length - n_1 * c_1 + n_0 * c_0) / 2
    for c, T in event.terms:
        left = mp.exp(-length / T)
        force += c * T * (1 - left)
        work += c * T / (1 + T * T) * (left * (n_1 + T * c_1) - (n_0 + T * c_0))
    return force, work


def _joined(zones):
    """Zones as (letter, start, end) in cyclic order, the one cut by the section joined."""
    cyclic = [(zone.letter, zone.start, zone.end) for zone in zones]
    if len(cyclic) > 1 and cyclic[0][0] == cyclic[-1][0]:
        letter, start, _ = cyclic.pop()
        cyclic[0] = (letter, start - 2 * mp.pi, cyclic[0][2])
    return cyclic

"""One material point under one strip: the rigid profile, the flows of the three zones, and first crossings.

Everything is dimensionless. The phase ``s = -k x`` grows in material time, displacements are in units of the
amplitude ``A``, pressures in units of ``K A``. A prime is ``d/ds``. The foundation obeys
``w + beta w' = p + alpha p'``; with ``z = w - J p`` and ``J = alpha/beta`` this is ``beta z' = p - w``.

The load harmonic ``H = u + beta u'`` decides every event. Each event function ``F`` (the gap less a constant, or the
contact pressure less a constant) obeys ``F + T F' = const -+ H`` within its zone, so at a zero of ``F`` the sign of its
slope is that of the right-hand side: falling and rising zeros lie in arcs known in closed form, at most one in each.
"""

from mpmath import mp

CONTINUOUS, CONSTITUTIVE = "continuous", "constitutive"


class Strip:
    """Dimensionless strip. ``alpha = k V T_sigma``, ``beta = k V T_eps``, ``P0 = p_0/(K A)``, ``Delta = delta_0/A``,
    ``delta = D/A``; all are converted exactly to ``mpf`` at the working precision, which must not change afterwards."""

    def __init__(self, alpha, beta, P0, Delta, delta, closure, J=None):
        if closure not in (CONTINUOUS, CONSTITUTIVE):
            raise ValueError(f"unknown closure {closure!r}")
        self.alpha, self.beta = mp.mpf(alpha), mp.mpf(beta)
        self.P0, self.Delta, self.delta = mp.mpf(P0), mp.mpf(Delta), mp.mpf(delta)
        if not (self.beta > 0 and 0 <= self.alpha <= self.beta and self.P0 >= 0 and self.Delta >= 0):
            raise ValueError("need 0 <= alpha <= beta, beta > 0, P0 >= 0, Delta >= 0")
        if self.P0 == 0:
            self.Delta = mp.zero  # without traction the range of adhesion plays no part
        elif self.Delta == 0:
            raise ValueError("P0 > 0 needs Delta > 0")
        self.closure = closure
        self.J = self.alpha / self.beta if J is None else mp.mpf(J)
        # Pressure step that the instantaneous response of w shares: all of it, or none.
        self.step = self.J * self.P0 if closure == CONSTITUTIVE else mp.zero
        self.snaps = self.P0 > 0 and closure == CONSTITUTIVE and self.step >= self.Delta
        # H = mean + amplitude cos(s + lag);  saturated contact p = mean + in_phase cos s - out_of_phase sin s.
        self.mean, self.amplitude, self.lag = self.delta - 1, mp.hypot(1, self.beta), mp.atan(self.beta)
        square = 1 + self.alpha**2
        self.in_phase, self.out_of_phase = (1 + self.alpha * self.beta) / square, (self.beta - self.alpha) / square
        self.ratio = self.amplitude / mp.sqrt(square)  # amplitude of the saturated pressure

    def u(self, s):
        """Profile of the rigid surface."""
        return self.mean + mp.cos(s)

    def load(self, s):
        """The load harmonic ``H = u + beta u'``."""
        return self.mean + self.amplitude * mp.cos(s + self.lag)

    def load_integral(self, s):
        """An antiderivative of ``H``."""
        return self.mean * s + self.amplitude * mp.sin(s + self.lag)

    def arc_above(self, level, turn=0):
        """Arc of phases where ``H > level``, in the given period; None if there is none."""
        half = self._half_width(level)
        centre = 2 * mp.pi * turn - self.lag
        return (centre - half, centre + half) if half > 0 else None

    def arc_below(self, level):
        """Arc of phases where ``H < level``: the one that follows ``arc_above(level)``."""
        half = mp.pi - self._half_width(level)
        centre = mp.pi - self.lag
        return (centre - half, centre + half) if half > 0 else None

    def _half_width(self, level):
        cosine = (level - self.mean) / self.amplitude
        return mp.acos(max(-1, min(1, cosine)))


def decay(length, time):
    """``exp(-length/time)``, with its limit 0 at ``time = 0`` (the caller sees to ``length > 0`` there)."""
    return mp.exp(-length / time) if time > 0 else mp.zero


class GapFlow:
    """Motion under the uniform pressure ``-traction`` from ``w(start) = w0``: ``w = -traction + c exp(-(s-start)/beta)``."""

    def __init__(self, strip, start, w0, traction):
        self.strip, self.start, self.traction = strip, start, traction
        self.excess = w0 + traction

    def w(self, s):
        return -self.traction + self.excess * decay(s - self.start, self.strip.beta)

    def gap_above(self, level):
        """Event function ``s -> (gap - level, its slope)``."""
        strip = self.strip

        def event(s):
            cosine, sine = mp.cos_sin(s)
            drop = self.excess * decay(s - self.start, strip.beta)
            value = drop - self.traction - strip.mean - cosine - level
            return value, sine - drop / strip.beta

        return event


class ContactFlow:
    """Contact ``w = u`` from ``p(start) = p0``: the saturated field plus ``c exp(-(s-start)/alpha)``."""

    def __init__(self, strip, start, p0):
        self.strip, self.start = strip, start
        # With alpha = 0 the pressure is local and p0 is forgotten at once.
        self.excess = p0 - self.saturated(start) if strip.alpha > 0 else mp.zero

    def saturated(self, s):
        cosine, sine = mp.cos_sin(s)
        return self.strip.mean + self.strip.in_phase * cosine - self.strip.out_of_phase * sine

    def p(self, s):
        return self.saturated(s) + (self.excess * decay(s - self.start, self.strip.alpha) if self.excess else 0)

    def pressure_above(self, level):
        """Event function ``s -> (p - level, its slope)``; needs ``alpha > 0``."""
        strip = self.strip

        def event(s):
            value = self.p(s) - level
            return value, (strip.load(s) - level - value) / strip.alpha

        return event


def crossing(event, start, arc, rising):
    """First phase from ``start`` at which ``event`` crosses zero in the given direction, or None.

    ``arc`` holds all zeros of that direction (and at most one), so the sign at its end decides. A zero reached only at
    the very end of the arc is a graze and does not count. A start already beyond zero counts as a crossing at once.
    """
    if arc is None or start >= arc[1]:
        return None
    low, high = max(start, arc[0]), arc[1]
    sign = 1 if rising else -1
    if sign * event(high)[0] <= 0:
        return None
    if sign * event(low)[0] >= 0:
        return low
    return bracketed_root(event, low, high, sign)


def bracketed_root(event, low, high, sign):
    """Zero of ``event`` (which gives value and slope), known to have sign ``-sign`` at low and ``sign`` at high.

    Newton steps that leave the bracket or shrink too slowly give way to bisection. ``None`` as a value counts as the
    sign of the low end, ``None`` as a slope calls for bisection.
    """
    tolerance = mp.mpf(10) ** (12 - mp.dps)
    point, last = (low + high) / 2, high - low
    for _ in range(400):
        value, slope = event(point)
        if value == 0:
            return point
        if value is not None and sign * value > 0:
            high = point
        else:
            low = point
        following = point - value / slope if value is not None and slope else None
        if following is None or not low <= following <= high or abs(following - point) > last / 2:
            following = (low + high) / 2
        last = abs(following - point)
        if last < tolerance:
            return following
        point = following
    raise ArithmeticError("root finder did not converge")

"""One period of a material point on a foundation with n times: zone after zone, each ended by its first event.

The state handed from zone to zone is ``z`` (n, N), continuous also where the pressure steps, and whether the point is engaged.
"""

from dataclasses import dataclass

import numpy as np

from ...numerics.rounding import EPS
from ..groups import TWO_PI
from .crossing import LOST, LOWER, NONE, Field, first_crossing
from .problem import ModeStrips, rates

CONTACT, ADHESION, FREE = 0, 1, 2
#: row of the edge (d, b, a, c) between a zone and the next
_EDGES = np.array(((2, 2, 2), (1, 3, 3), (0, 0, 0)))
#: zones in a period: more than seven are met where a gap opens by no more than rounding, dozens next to saturated contact
_MAX_ZONES = 60
#: phase within which rounding decides whether a zone that begins where its limit is leads away from it
_BRIEF = 1e-5


@dataclass(slots=True)
class Period:
    """A period of N points. ``dz``: change of the state (accurate also where it is small), (n, N).

    ``edges``: phase of the first onset, entry, exit and release, NaN where none, (4, N); ``counts``: how many of each are met.
    ``lost``: not followed to the end.
    """

    engaged_before: np.ndarray
    engaged: np.ndarray
    dz: np.ndarray
    edges: np.ndarray
    counts: np.ndarray
    lost: np.ndarray

    onsets, contacts, releases = (property(lambda self, k=k: self.counts[k]) for k in (0, 1, 3))

    @property
    def never_free(self) -> np.ndarray:
        """Engaged from the start to the end, without a release."""
        return self.engaged_before & self.engaged & (self.releases == 0) & ~self.lost

    @property
    def never_engaged(self) -> np.ndarray:
        """Free from the start to the end."""
        return ~self.engaged_before & ~self.engaged & (self.onsets == 0) & ~self.lost


def zone_at(kernel, s: ModeStrips, engaged, z, phase):
    """Zone of points with state ``z`` at ``phase``, and which of them are engaged there."""
    y, step = z.sum(axis=0) - kernel.profile(phase, s.D), s.step
    engaged = np.ones(y.shape, bool) if s.bare else np.where(engaged, y <= s.delta_0 + step, y <= s.delta_0)
    return np.where(engaged, np.where(y < step, CONTACT, ADHESION), FREE), engaged


def march(kernel, s: ModeStrips, engaged, z, start, length=TWO_PI) -> Period:
    """Follow every point from the phase ``start`` (N,) for one turn, or for the ``length`` given."""
    n, N = z.shape
    letter, engaged_before = zone_at(kernel, s, engaged, z, start)
    out = Period(engaged_before, engaged_before.copy(), np.zeros((n, N)), np.full((4, N), np.nan), np.zeros((4, N), int),
                 np.zeros(N, bool))  # fmt: skip
    index, here, limit, begin, pressure = np.arange(N), s, start + length, start, None
    for _ in range(_MAX_ZONES):
        if not index.size:
            break
        zone_z = z[:, index] + out.dz[:, index]
        end, change, following, pressure, lost = one_zone(kernel, here, letter, begin, limit, zone_z, pressure)
        out.dz[:, index] += change
        out.lost[index] = lost
        _note(out, index, letter, end, following)
        rest = np.flatnonzero((following >= 0) & ~lost)
        index, letter, limit, begin = index[rest], following[rest], limit[rest], end[rest]
        here, pressure = here.among(rest), pressure[rest]
    out.lost[index] = True
    return out


def one_zone(kernel, s: ModeStrips, letter, start, limit, z, pressure):
    """Follow points through the zone they are in, entered with the ``pressure`` (None or NaN where it follows from the state).

    Returns its end, the change of the state, the letter of the next (-1: at the ``limit``), the pressure with which that begins
    (NaN after an onset), and which points were not followed to the end."""
    n, m = z.shape
    contact = letter == CONTACT
    p = np.where(letter == ADHESION, -s.p_0, 0.0)
    f = Field(start.copy(), np.empty(m), np.empty(m), np.zeros(m), np.empty((n, m)), np.empty((n, m)))
    touching, apart = np.flatnonzero(contact), np.flatnonzero(~contact)
    pressed, open_ = s.among(touching), s.among(apart)  # taking costs: once each
    if touching.size:
        level = (kernel.profile(start[touching], pressed.D) - z[:, touching].sum(axis=0)) / pressed.m.J_0
        p_in = level if pressure is None else np.where(np.isnan(pressure[touching]), level, pressure[touching])
        entry = kernel.overstress(z[:, touching], p_in, pressed.m)
        f.constant[touching] = pressed.p_0 + (pressed.D - 1)
        f.a[touching], f.b[touching] = kernel.storage(pressed.m), -kernel.loss(pressed.m)
        f.c[:, touching] = entry - kernel.saturated_overstress(start[touching], pressed.m)
        f.r[:, touching] = rates(pressed.m.alpha)
    if apart.size:
        f.constant[apart] = p[apart] - (open_.D - 1) - np.where(letter[apart] == FREE, open_.delta_0, 0.0)
        f.a[apart] = -1.0
        f.c[:, apart] = z[:, apart] - open_.m.J * p[apart]
        f.r[:, apart] = rates(open_.m.beta)
    if pressure is not None:
        # contact that is entered presses, adhesion then opens: where rounding says no, from where it rises through the limit
        slope = f.b * np.cos(start) - f.a * np.sin(start) - (f.c * f.r).sum(axis=0)
        sinks = np.flatnonzero((letter != FREE) & (pressure == -s.p_0) & (slope <= 0))
        if sinks.size:
            f.rise(sinks, np.minimum(limit, start + _BRIEF))
    releasable = (letter == ADHESION) & (not s.bare)
    height = np.where(releasable, s.delta_0, np.inf)
    end, which = first_crossing(f, limit, height)
    change = np.empty((n, m))
    if touching.size:
        change[:, touching] = kernel.contact_increment(start[touching], end[touching], entry, pressed.m)
    if apart.size:
        change[:, apart] = kernel.relaxation_increment(start[apart], end[apart], z[:, apart], p[apart], open_.m)
    entered = np.flatnonzero((letter == ADHESION) & (which == LOWER))
    if entered.size:
        # the fastest mode moves within the rounding of the phase
        here, at, inside = s.among(entered), end[entered], (z + change)[:, entered]
        room = 4 * EPS * (1 + np.abs(at)) * np.abs((inside + here.m.J * here.p_0) * rates(here.m.beta)).max(axis=0)
        beyond = inside.sum(axis=0) - kernel.profile(at, here.D) - here.step
        change[here.m.beta.argmin(axis=0), entered] -= np.clip(beyond, -room, room)
    onto = np.where(s.snaps, CONTACT, ADHESION)
    met = np.where(contact, ADHESION, np.where(letter == FREE, onto, np.where(which == LOWER, CONTACT, FREE)))
    following = np.where((which == NONE) | (which == LOST), -1, met)
    snapped = (letter == FREE) & (following == CONTACT)
    pressure = np.where(letter == FREE, np.nan, -s.p_0)
    np.divide(-s.delta_0, s.m.J_0, out=pressure, where=snapped)
    return end, change, following, pressure, which == LOST


def _note(out: Period, i, letter, end, following):
    """Write the event that ends a zone of the points ``i`` into the record; a snap into contact is an onset and an entry."""
    edge, met = _EDGES[letter, following], following >= 0
    for which, rows in ((met, edge), ((edge == 0) & (following == CONTACT), np.ones_like(edge))):
        if which.any():
            there = rows[which], i[which]
            out.edges[there] = np.where(out.counts[there] == 0, end[which], out.edges[there])
            out.counts[there] += 1
    out.engaged[i[met]] = following[met] != FREE

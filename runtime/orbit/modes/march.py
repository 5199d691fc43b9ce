"""One period of a material point on a foundation with n times: zone after zone, each ended by its first event.

The state handed from zone to zone is ``z`` (n, N), continuous also where the pressure steps, and whether the point is engaged.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .crossing import LOST, LOWER, NONE, Field, first_crossing
from .problem import ModeStrips, rates

TWO_PI = 2 * np.pi
CONTACT, ADHESION, FREE = 0, 1, 2
#: zones in a period: more than seven were never met but by points that find no end of them
_MAX_ZONES = 12


@dataclass(slots=True)
class Period:
    """A period of N points. ``dz``: change of the state (accurate also where it is small), (n, N).

    ``edges``: phase of the last onset, entry, exit and release, NaN where none, (4, N); ``onsets``, ``contacts``,
    ``releases``: how many. Of onset and release, (2, N): ``slope`` of the gap just before, ``since`` when the zone lasted that
    the event ends, ``until`` when the one that it begins; ``z_since``: state at the start of the former, (2, n, N).
    ``smooth_onset``: a gap zone follows that, too. ``letters`` (zones, N) of the zones in turn, -1 where there are no more,
    and their ``ends`` (zones + 1, N), the start of the first one first. ``lost``: not followed to the end.
    """

    engaged_before: np.ndarray
    engaged: np.ndarray
    dz: np.ndarray
    edges: np.ndarray
    onsets: np.ndarray
    contacts: np.ndarray
    releases: np.ndarray
    slope: np.ndarray
    since: np.ndarray
    z_since: np.ndarray
    until: np.ndarray
    smooth_onset: np.ndarray
    letters: np.ndarray
    ends: np.ndarray
    lost: np.ndarray

    @classmethod
    def blank(cls, n: int, N: int) -> Period:
        """Records of N points with n times, nothing met."""
        nan, no = (lambda *shape: np.full((*shape, N), np.nan)), (lambda: np.zeros(N, bool))
        onsets, contacts, releases = np.zeros((3, N), int)
        return cls(no(), no(), np.zeros((n, N)), nan(4), onsets, contacts, releases, nan(2), nan(2), np.zeros((2, n, N)), nan(2),
                   no(), np.full((_MAX_ZONES, N), -1, np.int8), nan(_MAX_ZONES + 1), no())  # fmt: skip

    def take(self, index: np.ndarray) -> Period:
        """The records of the points ``index``."""
        return Period(*(getattr(self, name)[..., index] for name in self.__slots__))

    def among(self, index: np.ndarray) -> Period:
        """The same for an index that ascends and repeats nothing: these records where it is all of them."""
        return self if index.size == self.lost.size else self.take(index)

    def put(self, index: np.ndarray, other: Period) -> None:
        """Write the records ``other`` of the points ``index``."""
        for name in self.__slots__:
            getattr(self, name)[..., index] = getattr(other, name)

    onset, entry, exit, release = (property(lambda self, k=k: self.edges[k]) for k in range(4))

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
    y = z.sum(axis=0) - kernel.profile(phase, s.D)
    step = s.step
    if s.bare:
        engaged = np.ones(y.shape, bool)
    else:
        engaged = np.where(engaged, y <= s.delta_0 + step, y <= s.delta_0)
    return np.where(engaged, np.where(y < step, CONTACT, ADHESION), FREE), engaged


def march(kernel, s: ModeStrips, engaged, z, start) -> Period:
    """Follow every point from the phase ``start`` (N,) for one turn."""
    n, N = z.shape
    out = Period.blank(n, N)
    letter, out.engaged_before[:] = zone_at(kernel, s, engaged, z, start)
    out.engaged[:], out.ends[0] = out.engaged_before, start
    index, here, limit, pressure = np.arange(N), s, start + TWO_PI, None
    for number in range(_MAX_ZONES):
        if not index.size:
            break
        begin, zone_z = out.ends[number, index], z[:, index] + out.dz[:, index]
        end, following, slope, pressure = _one_zone(kernel, here, index, letter, begin, limit, zone_z, pressure, out)
        out.letters[number, index], out.ends[number + 1, index] = letter, end
        _note(out, index, letter, begin, end, zone_z, slope, following)
        rest = np.flatnonzero((following >= 0) & ~out.lost[index])
        index, letter, limit = index[rest], following[rest], limit[rest]
        here, pressure = here.among(rest), pressure[rest]
    out.lost[index] = True
    return out


def _one_zone(kernel, s: ModeStrips, index, letter, start, limit, z, pressure, out: Period):
    """Follow the points ``index`` through the zone they are in; returns its end, the letter of the next (-1: the period is
    over), the gap's slope at the end, and the pressure with which the next begins."""
    n, m = z.shape
    contact = letter == CONTACT
    p = np.where(letter == ADHESION, -s.p_0, 0.0)
    f = Field(start, np.empty(m), np.empty(m), np.zeros(m), np.empty((n, m)), np.empty((n, m)))
    touching, apart = np.flatnonzero(contact), np.flatnonzero(~contact)
    entry = None
    if touching.size:
        t = s.among(touching)
        level = (kernel.profile(start[touching], t.D) - z[:, touching].sum(axis=0)) / t.m.J_0
        p_in = level if pressure is None else np.where(np.isnan(pressure[touching]), level, pressure[touching])
        entry = kernel.overstress(z[:, touching], p_in, t.m)
        f.constant[touching] = t.p_0 + (t.D - 1)
        f.a[touching], f.b[touching] = kernel.storage(t.m), -kernel.loss(t.m)
        f.c[:, touching] = entry - kernel.saturated_overstress(start[touching], t.m)
        f.r[:, touching] = rates(t.m.alpha)
    if apart.size:
        t = s.among(apart)
        level = np.where(letter[apart] == FREE, t.delta_0, 0.0)
        f.constant[apart] = p[apart] - (t.D - 1) - level
        f.a[apart] = -1.0
        f.c[:, apart] = z[:, apart] - t.m.J * p[apart]
        f.r[:, apart] = rates(t.m.beta)
    releasable = (letter == ADHESION) & (not s.bare)
    height = np.where(releasable, s.delta_0, np.inf)
    end, which, slope = first_crossing(f, limit, height)
    out.lost[index] |= which == LOST
    if touching.size:
        t, i = s.among(touching), touching
        out.dz[:, index[i]] += kernel.contact_increment(start[i], end[i], entry, t.m)
    if apart.size:
        t, i = s.among(apart), apart
        out.dz[:, index[i]] += kernel.relaxation_increment(start[i], end[i], z[:, i], p[i], t.m)
    snaps = s.snaps
    met = np.where(
        contact, ADHESION, np.where(letter == FREE, np.where(snaps, CONTACT, ADHESION), np.where(which == LOWER, CONTACT, FREE))
    )
    following = np.where((which == NONE) | (which == LOST), -1, met)
    snapped = (letter == FREE) & (following == CONTACT)
    reach = np.divide(s.delta_0, s.m.J_0, out=np.zeros(m), where=snapped)
    pressure = np.where(snapped, -reach, -s.p_0)
    return end, following, slope, pressure


def _note(out: Period, i, letter, start, end, z, slope, following):
    """Write the event that ends a zone of the points ``i`` into the record."""
    onset, release = (letter == FREE) & (following >= 0), following == FREE
    enters, leaves = following == CONTACT, (letter == CONTACT) & (following >= 0)
    # zones begun by the events before
    for k, edge in ((0, out.onset), (1, out.release)):
        after = start == edge[i]
        out.until[k, i[after]] = end[after]
    after = start == out.onset[i]
    out.smooth_onset[i[after]] = letter[after] != CONTACT
    for k, which in ((0, onset), (1, release)):
        there = i[which]
        out.slope[k, there], out.since[k, there], out.z_since[k][:, there] = slope[which], start[which], z[:, which]
    for edge, which in zip(out.edges, (onset, enters, leaves, release), strict=True):
        edge[i[which]] = end[which]
    for count, which in ((out.onsets, onset), (out.contacts, enters), (out.releases, release)):
        count[i[which]] += 1
    out.engaged[i[onset]], out.engaged[i[release]] = True, False

"""One period of a material point on a foundation with n times: zone after zone, each ended by its first event.

The state handed from zone to zone is ``z`` (n, N), continuous also where the pressure steps, and whether the point is engaged.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from .crossing import LOST, LOWER, NONE, Field, first_crossing
from .problem import ModeStrips, rates

TWO_PI = 2 * np.pi
CONTACT, ADHESION, FREE = 0, 1, 2
_MAX_ZONES = 24
#: what of a period has a value for each time
STATES = ("dz", "z_from_onset", "z_from_release")


@dataclass(slots=True)
class Zone:
    """A zone of the strips ``index``: its letter's code, start, end (m,), state at the start ``z`` (n, m), and the next
    letter (-1: period over)."""

    index: np.ndarray
    letter: np.ndarray
    start: np.ndarray
    end: np.ndarray
    z: np.ndarray
    slope: np.ndarray
    following: np.ndarray

    def of(self, index: np.ndarray, keep=slice(None)) -> Zone:
        """The places ``keep`` of the zone as one of the strips ``index``."""
        return Zone(index, *(getattr(self, name)[..., keep] for name in Zone.__slots__[1:]))


@dataclass(slots=True)
class Period:
    """A period of N points. ``dz``: change of the state (accurate also where it is small), (n, N).

    ``onset``, ``entry``, ``exit``, ``release``: phase of the last of each event, NaN where none; ``onsets``,
    ``contacts``, ``releases``: how many. ``slope_onset``, ``slope_release``:
    of the gap just before. ``from_onset``, ``from_release``: where the zone began that the event ends,
    ``z_from_onset``, ``z_from_release``: state there; ``until_onset``, ``until_release``: where the zone ends that the
    event begins, ``smooth_onset``: that is a gap zone, too. ``lost``: not followed to the end.
    """

    engaged_before: np.ndarray
    engaged: np.ndarray
    dz: np.ndarray
    onset: np.ndarray
    entry: np.ndarray
    exit: np.ndarray
    release: np.ndarray
    onsets: np.ndarray
    contacts: np.ndarray
    releases: np.ndarray
    slope_onset: np.ndarray
    slope_release: np.ndarray
    from_onset: np.ndarray
    from_release: np.ndarray
    z_from_onset: np.ndarray
    z_from_release: np.ndarray
    until_onset: np.ndarray
    until_release: np.ndarray
    smooth_onset: np.ndarray
    lost: np.ndarray
    evaluations: np.ndarray
    zones: list[Zone] = field(default_factory=list)

    @classmethod
    def blank(cls, n: int, N: int) -> Period:
        """Records of N points with n times, nothing met."""
        no, count, nan, state = np.zeros(N, bool), np.zeros(N, int), np.full(N, np.nan), np.zeros((n, N))
        kinds = {"engaged_before": no, "engaged": no, "lost": no, "smooth_onset": no, "onsets": count}
        kinds |= {"contacts": count, "releases": count, "evaluations": np.zeros(N)} | dict.fromkeys(STATES, state)
        return cls(**{name: kinds.get(name, nan).copy() for name in cls.__slots__ if name != "zones"}, zones=[])

    def take(self, index: np.ndarray) -> Period:
        """The records of the points ``index``."""
        where = np.full(self.lost.size, -1)
        where[index] = np.arange(index.size)
        kept = [(zone, np.flatnonzero(where[zone.index] >= 0)) for zone in self.zones]
        zones = [zone.of(where[zone.index[keep]], keep) for zone, keep in kept if keep.size]
        return Period(*(getattr(self, name)[..., index] for name in self.__slots__ if name != "zones"), zones)

    def among(self, index: np.ndarray) -> Period:
        """The same for an index that ascends and repeats nothing: these records where it is all of them."""
        return self if index.size == self.lost.size else self.take(index)

    def put(self, index: np.ndarray, other: Period) -> None:
        """Write the records ``other`` of the points ``index``."""
        fresh = np.ones(self.lost.size, bool)
        fresh[index] = False
        kept = [(zone, np.flatnonzero(fresh[zone.index])) for zone in self.zones]
        self.zones = [zone.of(zone.index[keep], keep) for zone, keep in kept if keep.size]
        for name in self.__slots__:
            if name != "zones":
                getattr(self, name)[..., index] = getattr(other, name)
        self.zones += [zone.of(index[zone.index]) for zone in other.zones]

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
    out.engaged[:] = out.engaged_before
    index, here, phase, end = np.arange(N), s, np.array(start, float), start + TWO_PI
    where, limit = phase.copy(), end
    pressure = None
    for _ in range(_MAX_ZONES):
        if not index.size:
            break
        zone_z = z[:, index] + out.dz[:, index]
        zone, pressure = _one_zone(kernel, here, index, letter, where, limit, zone_z, pressure, out)
        out.zones.append(zone)
        going = (zone.following >= 0) & ~out.lost[index]
        _note(out, zone)
        rest = np.flatnonzero(going)
        index, letter, where, limit = index[rest], zone.following[rest], zone.end[rest], limit[rest]
        here, pressure = here.among(rest), pressure[rest]
    out.lost[index] = True
    return out


def _one_zone(kernel, s: ModeStrips, index, letter, start, limit, z, pressure, out: Period):
    """Follow the points ``index`` through the zone they are in; returns it and the pressure with which the next begins."""
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
    end, which, slope, spent = first_crossing(f, limit, height)
    out.evaluations[index] += spent
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
    return Zone(index, letter, start, end, z, slope, following), pressure


def _note(out: Period, zone: Zone):
    """Write the event that ends a zone into the record."""
    i, letter, following = zone.index, zone.letter, zone.following
    onset = (letter == FREE) & (following >= 0)
    release = following == FREE
    enters, leaves = following == CONTACT, (letter == CONTACT) & (following >= 0)
    for which, phases, count in (
        (onset, out.onset, out.onsets),
        (release, out.release, out.releases),
        (enters, out.entry, out.contacts),
        (leaves, out.exit, None),
    ):
        phases[i[which]] = zone.end[which]
        if count is not None:
            count[i[which]] += 1
    out.slope_onset[i[onset]], out.slope_release[i[release]] = zone.slope[onset], zone.slope[release]
    # zones begun by the events before
    after_onset, after_release = zone.start == out.onset[i], zone.start == out.release[i]
    out.until_onset[i[after_onset]], out.smooth_onset[i[after_onset]] = zone.end[after_onset], letter[after_onset] != CONTACT
    out.until_release[i[after_release]] = zone.end[after_release]
    out.from_onset[i[onset]], out.from_release[i[release]] = zone.start[onset], zone.start[release]
    out.z_from_onset[:, i[onset]], out.z_from_release[:, i[release]] = zone.z[:, onset], zone.z[:, release]
    out.engaged[i[onset]], out.engaged[i[release]] = True, False

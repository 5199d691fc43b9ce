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
LETTERS = "caf"
_MAX_ZONES = 24


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


@dataclass(slots=True)
class Period:
    """A period of N points. ``dz``: change of the state (accurate also where it is small), (n, N).

    ``onset``, ``entry``, ``exit``, ``release``: phase of the last of each event, NaN where none; ``onsets``,
    ``contacts``, ``releases``: how many. ``z_onset``, ``z_release``: state there. ``slope_onset``, ``slope_release``:
    of the gap just before. ``from_onset``, ``from_release``: where the zone began that the event ends,
    ``z_from_onset``, ``z_from_release``: state there; ``until_onset``, ``until_release``: where the zone ends that the
    event begins, ``smooth_onset``, ``smooth_release``: that is a gap zone, too. ``lost``: not followed to the end.
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
    z_onset: np.ndarray
    z_release: np.ndarray
    slope_onset: np.ndarray
    slope_release: np.ndarray
    from_onset: np.ndarray
    from_release: np.ndarray
    z_from_onset: np.ndarray
    z_from_release: np.ndarray
    until_onset: np.ndarray
    until_release: np.ndarray
    smooth_onset: np.ndarray
    smooth_release: np.ndarray
    lost: np.ndarray
    evaluations: np.ndarray
    zones: list[Zone] = field(default_factory=list)

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
    nan = lambda: np.full(N, np.nan)  # noqa: E731
    letter, now_engaged = zone_at(kernel, s, engaged, z, start)
    out = Period(
        np.array(now_engaged), np.array(now_engaged), np.zeros((n, N)), nan(), nan(), nan(), nan(),
        *(np.zeros(N, int) for _ in range(3)), np.zeros((n, N)), np.zeros((n, N)), nan(), nan(), nan(), nan(),
        np.zeros((n, N)), np.zeros((n, N)), nan(), nan(), *(np.zeros(N, bool) for _ in range(3)), np.zeros(N),
    )  # fmt: skip
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
        _note(out, zone, z[:, zone.index] + out.dz[:, zone.index])
        rest = np.flatnonzero(going)
        index, letter, where, limit = index[rest], zone.following[rest], zone.end[rest], limit[rest]
        here, pressure = here.take(rest), pressure[rest]
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
        t = s.take(touching)
        level = (kernel.profile(start[touching], t.D) - z[:, touching].sum(axis=0)) / t.m.J_0
        p_in = level if pressure is None else np.where(np.isnan(pressure[touching]), level, pressure[touching])
        entry = kernel.overstress(z[:, touching], p_in, t.m)
        f.constant[touching] = t.p_0 + (t.D - 1)
        f.a[touching], f.b[touching] = kernel.storage(t.m), -kernel.loss(t.m)
        f.c[:, touching] = entry - kernel.saturated_overstress(start[touching], t.m)
        f.r[:, touching] = rates(t.m.alpha)
    if apart.size:
        t = s.take(apart)
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
        t, i = s.take(touching), touching
        out.dz[:, index[i]] += kernel.contact_increment(start[i], end[i], entry, t.m)
    if apart.size:
        t, i = s.take(apart), apart
        out.dz[:, index[i]] += kernel.relaxation_increment(start[i], end[i], z[:, i], p[i], t.m)
    snaps = s.step >= s.delta_0
    met = np.where(
        contact, ADHESION, np.where(letter == FREE, np.where(snaps, CONTACT, ADHESION), np.where(which == LOWER, CONTACT, FREE))
    )
    following = np.where((which == NONE) | (which == LOST), -1, met)
    snapped = (letter == FREE) & (following == CONTACT)
    reach = np.divide(s.delta_0, s.m.J_0, out=np.zeros(m), where=snapped)
    pressure = np.where(snapped, -reach, -s.p_0)
    return Zone(index, letter, start, end, z, slope, following), pressure


def _note(out: Period, zone: Zone, z_end):
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
    out.z_onset[:, i[onset]], out.z_release[:, i[release]] = z_end[:, onset], z_end[:, release]
    begun = zone.start == out.onset[i], zone.start == out.release[i]  # by the event before this zone
    for which, until, smooth in zip(
        begun, (out.until_onset, out.until_release), (out.smooth_onset, out.smooth_release), strict=True
    ):
        until[i[which]], smooth[i[which]] = zone.end[which], letter[which] != CONTACT
    out.from_onset[i[onset]], out.from_release[i[release]] = zone.start[onset], zone.start[release]
    out.z_from_onset[:, i[onset]], out.z_from_release[:, i[release]] = zone.z[:, onset], zone.z[:, release]
    out.engaged[i[onset]], out.engaged[i[release]] = True, False

"""Second term of Eq. 13: what the levels below contribute in the contact of a strip, ``(1/l) int law[p(x)] dx``.

In contact ``p - p* + alpha p' = H - p*``: like every event function, p passes a given pressure upward at most once and downward
at most once, each in an arc known in closed form. So the contact is cut at the breaks of the law (pull-off, jumps, saturation)
and each part integrated by itself, on as many nodes as it needs.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from hystrip.solver import kernel_of

from .contact import Contact, contact_of
from .quadrature import interior_nodes, interleaved, mapped, mapped_weights, sum_errors
from .strips import Columns, SolvedStrips
from .table import LawTable

TWO_PI = 2 * np.pi
_FIRST, _LAST = 8, 32
_HALVINGS = 12
#: a part's share of the error that an average of strips is allowed, and parts integrated at a time
_SHARE, _CHUNK = 0.1, 8192


@dataclass(frozen=True)
class CarriedByLaws:
    """Contributions of the next level down. ``table`` holds its law for each group; the last column is an error estimate of
    friction.

    ``scales`` (q,): natural scales of the contributions. ``rtol``: accuracy of the averages that they go into.
    """

    table: LawTable
    rtol: float
    scales: np.ndarray

    def crossed(self, kernel, strips: SolvedStrips, group: np.ndarray) -> np.ndarray:
        """See ``strips.Carry``: how many breaks the greatest pressure exceeds, and how many the pressure exceeds all along (or at
        entry)."""
        crossed = np.zeros(group.size, int)
        index = np.flatnonzero(strips.solved.contact_fraction > 0)
        if index.size:
            contact = contact_of(kernel, strips, index)
            breaks = self.table.breaks[group[index]]
            top, least = (np.count_nonzero(breaks < p[:, None], axis=1) for p in (contact.p_peak, contact.p_least))
            crossed[index] = 1 + top + (breaks.shape[1] + 1) * least
        return crossed

    @property
    def passes(self) -> int:
        """See ``strips.Carry``: the greatest and the least pressure over each break."""
        return 2 * self.table.breaks.shape[1]

    def heights(self, kernel, strips: SolvedStrips, group: np.ndarray) -> np.ndarray:
        """See ``strips.Carry``."""
        out = np.full((group.size, self.passes), np.nan)
        index = np.flatnonzero(strips.solved.contact_fraction > 0)
        if index.size:
            contact = contact_of(kernel, strips, index)
            breaks = self.table.breaks[group[index]]
            out[index] = np.concatenate([p[:, None] - breaks for p in (contact.p_peak, contact.p_least)], axis=1)
        return out

    def passing(self, crossed: np.ndarray, other: np.ndarray) -> np.ndarray:
        """See ``strips.Carry``: the lowest break that one of the two passes and the other does not, by its greatest pressure or
        else its least."""
        size = self.table.breaks.shape[1]
        (least, top), (other_least, other_top) = (np.divmod(v - 1, size + 1) for v in (crossed, other))
        lower = np.where(top != other_top, np.minimum(top, other_top), size + np.minimum(least, other_least))
        return np.where((crossed > 0) & (other > 0) & (crossed != other), lower, -1)

    def over_contact(self, kernel, strips: SolvedStrips, group: np.ndarray) -> np.ndarray:
        """See ``strips.Carry``. The contributions are the law's quantities from friction on, then their error."""
        carried = np.zeros((group.size, self.scales.size))
        index = np.flatnonzero(strips.solved.contact_fraction > 0)
        if index.size:
            carried[index] = self._contributions(contact_of(kernel, strips, index), group[index]) / TWO_PI
        return carried

    def _contributions(self, contact: Contact, group) -> np.ndarray:
        table = self.table
        total = np.zeros((group.size, self.scales.size))
        breaks = table.breaks[group]
        reached = np.count_nonzero(breaks < contact.p_peak[:, None], axis=1)
        deepest = reached.max(initial=0)
        # phases between which the pressure exceeds each break, nested
        passes = [contact.passes(breaks[:, j], reached > j) for j in range(deepest)]
        parts = []
        for j, (up, down) in enumerate(passes):
            saturated = (reached > j) & (breaks[:, j] >= table.p_sat[group])
            total[saturated, :-1] += (down - up)[saturated, None] * table.saturated[group[saturated], 1:]
            rest = (reached > j) & ~saturated
            inner = rest & (reached > j + 1)
            next_up, next_down = passes[j + 1] if j + 1 < deepest else (up, down)
            for pick, low, high in ((rest & ~inner, up, down), (inner, up, next_up), (inner, next_down, down)):
                rows = np.flatnonzero(pick & (high > low))
                parts.append((rows, low[rows], high[rows]))
            # where the break lies is known as well as the law's pressures: that much of the jump may fall on the wrong side
            crossing = rest & (breaks[:, j] > contact.p_least)
            total[crossing, -1] += self._misplaced(contact, group, j, np.flatnonzero(crossing), up, down)
        if parts:
            rows, low, high = (np.concatenate(v) for v in zip(*parts, strict=True))
            self._integrate(contact, group, rows, low, high, total)
        return total

    def _misplaced(self, contact: Contact, group, j, rows, up, down):
        table, g = self.table, group[rows]
        shift = table.break_error[g, j] / contact.unit[rows]
        reach = np.zeros(rows.size)
        for phase in (up[rows], down[rows]):
            slope = np.abs(contact.slope(rows, phase))
            reach += np.minimum(np.divide(shift, slope, out=np.full(rows.size, np.inf), where=slope > 0), np.sqrt(shift))
        return table.jumps[g, j] * np.minimum(reach, down[rows] - up[rows])

    def _integrate(self, contact: Contact, group, rows, low, high, total):
        """Add the integrals of the law over parts [low, high] of the contacts ``rows``, smooth inside, with their errors."""
        for _ in range(_HALVINGS):
            again = []
            for start in range(0, rows.size, _CHUNK):
                some = slice(start, start + _CHUNK)
                left = self._attempt(contact, group, rows[some], low[some], high[some], total, last=False)
                again.append([v[some][left] for v in (rows, low, high)])
            rows, low, high = (np.concatenate(v) for v in zip(*again, strict=True)) if again else (rows, low, high)
            if not rows.size:
                return
            middle = 0.5 * (low + high)
            rows, low, high = np.tile(rows, 2), np.concatenate((low, middle)), np.concatenate((middle, high))
        self._attempt(contact, group, rows, low, high, total, last=True)

    def _attempt(self, contact: Contact, group, rows, low, high, total, last: bool):
        """Integrate on doubled nodes what converges; returns the indices of what does not (or takes it as it is)."""
        left, values, errors = np.arange(rows.size), None, None
        n = _FIRST
        while left.size:
            t = interior_nodes(n)
            fresh = t if values is None else t[0::2]
            i, width = rows[left], (high - low)[left]
            phase = low[left][:, None] + width[:, None] * mapped(fresh)
            p = contact.pressure(np.repeat(i, fresh.size), phase.ravel())
            new, new_errors = self.table(np.repeat(group[i], fresh.size), p)
            new = np.concatenate((p[:, None], new), axis=1).reshape(left.size, fresh.size, -1)
            new_errors = new_errors.reshape(left.size, fresh.size, 2)
            values = new if values is None else interleaved(new, values)
            errors = new_errors if errors is None else interleaved(new_errors, errors)
            law, w = values[:, :, 1:], mapped_weights(n)
            best = width[:, None] * (w @ law)
            noise = _SHARE * self.rtol * (1e-3 * self.scales[:-1] + np.abs(law).max(axis=1))
            miss = width[:, None] * sum_errors(law, noise)
            frictions = self.table.frictions
            own = width * self._own(values, errors, w)
            allowed = _SHARE * self.rtol * (width[:, None] * 1e-3 * self.scales[:-1] + np.abs(best))
            # there is no use in integrating better than the law is known
            done = ((miss <= allowed) | (miss <= own[:, None])).all(axis=1) | (last & (n == _LAST))
            np.add.at(total, i[done], np.column_stack((best, miss[:, frictions].sum(axis=1) + own))[done])
            left, values, errors = left[~done], values[~done], errors[~done]
            if n == _LAST:
                return left
            n *= 2
        return left

    def _own(self, values, errors, w):
        """Error that the law itself brings, per width: of its friction, and of the pressure it belongs to."""
        p, friction = values[:, :, 0], np.abs(values[:, :, 1:][:, :, self.table.frictions]).sum(axis=2)
        slope = np.divide(np.abs(np.diff(friction)), np.abs(np.diff(p)), out=np.zeros_like(p[:, 1:]), where=np.diff(p) != 0)
        between = np.minimum(slope * errors[:, 1:, 1], np.abs(np.diff(friction)))
        shifted = np.concatenate((between[:, :1], between), axis=1)
        return (errors[:, :, 0] + shifted) @ w


def peak_pressure(columns: Columns) -> np.ndarray:
    """Greatest local pressure of each column, Pa, (n,): at its crest, the most engaged strip; -inf without contact."""
    strips = columns.solve(np.arange(columns.size), np.zeros(columns.size))
    peak = np.full(columns.size, -np.inf)
    index = np.flatnonzero(strips.solved.contact_fraction > 0)
    if index.size:
        peak[index] = contact_of(kernel_of(columns.material), strips, index).p_peak
    return peak

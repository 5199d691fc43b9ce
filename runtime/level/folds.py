"""Where orbits with a free part end at a fold, as Newton alone foretells: strips next to one are dear, and this spares looks.

Newton finds such an orbit up to a thousandth of the way from where it ends, and none beyond. That it is the extremal one is not
asked: what comes of it is where to look.
"""

from __future__ import annotations

import numpy as np

from ..orbit.direct import certified
from ..orbit.groups import adhesive_cycle
from ..orbit.materials import kernel_of
from ..orbit.regimes import CODE
from ..orbit.solved import Record
from ..orbit.start import start
from .margins import POWERS, decisive, margins
from .strips import Columns, SolvedStrips
from .transitions import Aim, Guide, aimed

_GUIDE = Guide(decisive, POWERS)
#: orbits that end at a fold
_FOLDING = ("acaf", "afc", "af")
#: share of a bracket down to which Newton is asked, and amplitude, over the level's height, below which it is not
_NEAR, _FLAT = 1e-4, 1e-6


def folds(columns: Columns, at, low, high, code_low, code_high, width) -> Aim | None:
    """Where brackets [low, high], all (m,), change in which such an orbit gives way to no interaction; None if there are none.

    ``at(rows, x)``: columns, which of them, and theta at x of the brackets ``rows``. ``width``: how well it has to be known."""
    codes = np.stack((code_low, code_high)) % len(CODE)
    folding = np.isin(codes, [CODE[name] for name in _FOLDING])
    between = (codes == CODE["f"]).any(axis=0) & folding.any(axis=0)
    if columns.branch != "unloading" or hasattr(kernel_of(columns.material), "MODES") or not between.any():
        return None
    rows = np.flatnonzero(between)
    wavy = [columns.level.amplitude(at(rows, x[rows])[2]) > _FLAT * columns.level.h for x in (low, high)]
    rows = rows[np.logical_and(*wavy)]
    engaged = np.where(folding[0], *codes)[rows]

    def guess(line, x):
        found, known = np.full(x.size, CODE["f"]), np.full((x.size, POWERS.size), np.nan)
        for name in _FOLDING:
            pick = np.flatnonzero(engaged[line] == CODE[name])
            if pick.size:
                found[pick], known[pick] = _presumed(*at(rows[line[pick]], x[pick]), name)
        return found, known

    width = np.maximum(width, _NEAR * (high - low))
    aim, out = aimed(guess, _GUIDE, low[rows], high[rows], *codes[:, rows], width[rows]), Aim.nowhere(low.size)
    out.place[rows], out.doubt[rows] = aim.place, aim.doubt
    return out


def _presumed(columns: Columns, column, theta, sequence: str) -> tuple[np.ndarray, np.ndarray]:
    """Codes (m,) of strips, ``sequence`` where Newton finds such an orbit and free elsewhere, and margins of the former."""
    kernel, a = kernel_of(columns.material), columns.adhesion
    A = columns.level.amplitude(theta)
    D = columns.D[column] - columns.level.drop(theta)
    strips = columns.groups(columns.V[column], D / A, a.p_0 / columns.material.K / A, a.delta_0 / A)
    cycle = adhesive_cycle(kernel, strips)
    orbit, good, _ = certified(kernel, cycle, sequence, start(kernel, cycle, sequence))
    columns.work.solved += A.size
    record, found = Record(kernel, strips), np.flatnonzero(good)
    record.constant(np.flatnonzero(~good), "f", 0.0, 0.0, 0.0, 0.0)
    record.orbits(found, sequence, orbit.take(found))
    solved = record.solved
    presumed = SolvedStrips(solved, strips, {}, solved.p_mean, solved.tau_mean, kernel)
    return solved.code.astype(int), margins(kernel, presumed)

"""What traction does to a point that it reaches: the state just after, and the step of the load that drives it."""

from __future__ import annotations

from collections.abc import Mapping

import sympy as sp

from .check import zero
from .functions import Formula
from .kernel import Kernel, kernel
from .regime import Regime
from .stability import offsets, step_of_load
from .symbols import J, L, chi, delta_0, p_0

continuous = sp.Symbol("continuous", real=True)


def onset(regimes: Mapping[str, Regime]) -> tuple[Kernel, Kernel]:
    r"""The onset of adhesion, by the zones that meet there; F is the load that drives their event functions.

    adhesive_onset: Gap just after adhesion begins, and the step there of the load H + g - p. Where adhesion ends it steps
    back by as much.

    .. math:: g_d = \delta_0 - \chi J p_0,\quad [F] = (1 - \chi J)\,p_0

    snap_onset: Pressure above -p_0 just after a snap into contact, and the step there of the load, H + p_0 - q in contact.
    J must be above 0.

    .. math:: q_d = p_0 - \frac{\delta_0}{J},\quad [F] = \frac{\delta_0}{J} - \delta_0
    """
    state, step = _onset(regimes["acaf"])
    excess, snap = _onset(regimes["afc"])
    back = {sequence: offsets(row.zones[-1])[0] - offsets(row.zones[-2])[1] for sequence, row in regimes.items()}
    alone = _onset(regimes["af"])
    return (
        kernel(
            onset,
            Formula("adhesive_onset", (p_0, delta_0, J, L, chi), (state, p_0 * (continuous + L * chi)), ((continuous, 1 - chi),)),
            (state, step),
            zero("without contact it is the same", [state - alone[0], step - alone[1]]),
            zero("F steps back where adhesion ends", [back["acaf"] + step, back["af"] + step, back["afc"] + step.subs(chi, 1)]),
        ),
        kernel(onset, Formula("snap_onset", (p_0, delta_0, J, L), (excess, step_of_load(snap))), (excess, snap)),
    )


def _onset(regime: Regime):
    """The state in which the first zone is entered, and what its load exceeds that at the end of the last by."""
    first, last = regime.zones[0], regime.zones[-1]
    return first.entry, offsets(first)[0] - offsets(last)[1]

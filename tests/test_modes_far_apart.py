"""Strips on times that differ by ten decades, next to where their branch ends: there one time is over within the windows that
prove an orbit to be the first, or within the adhesion before a contact (``runtime/orbit/modes/windows.py``)."""

import numpy as np
import pytest
from oracle import modes as oracle

import hystrip

K = 1e9
#: how close to that end, in units of A + |D| + delta_0, strips are asked for
CLOSE = {"contact up to the release": 1e-4, "snap within rounding": 1e-6}
#: why windows did not lead to the orbit: branch, moduli, times, p_0, delta_0, l, A, D where the branch ends, V
STRIPS = {
    "contact ended at once": (
        "unloading",
        [32365000000.0, 106410000.0, 38181000.0],
        [1.8024e-12, 8.9636e-08, 0.012036],
        0.0064423,
        2.1474e-13,
        4.8752e-07,
        3.3064e-12,
        9.462471126167038e-15,
        6.0829e-06,
    ),
    "contact up to the release": (
        "loading",
        [24772000.0, 37772000000.0, 795230000.0, 355410000.0, 8346700000.0],
        [1.2232e-12, 1.9905e-09, 1.1189e-08, 0.003063, 0.0038814],
        211.49,
        2.012e-13,
        1e-05,
        1.6796e-08,
        3.2574499572616723e-09,
        0.0067241,
    ),
    "ten times without contact": (
        "loading",
        [
            7529700000.0,
            109160000000.0,
            13377000000.0,
            20684000000.0,
            38106000000.0,
            1188000000.0,
            4969300000.0,
            390560000000.0,
            145930000000.0,
            8351200000.0,
        ],
        [1.0521e-11, 2.2062e-11, 6.0716e-11, 1.2034e-08, 1.0457e-07, 1.3668e-07, 0.00010426, 0.00015361, 0.00026745, 0.00031469],
        0.069737,
        1.5909e-07,
        3.1884e-06,
        5.0959e-11,
        -1.5905685595373376e-07,
        0.00061324,
    ),
    "snap within rounding": (
        "loading",
        [393860000000.0, 6144900000.0, 34997000.0, 7065800000.0, 10235000000.0],
        [8.797e-12, 0.00021539, 0.00044962, 0.0020765, 0.049478],
        9.5628,
        4.6333e-11,
        1.3027e-06,
        7.1993e-10,
        7.220813704089909e-10,
        3.5636e-05,
    ),
    "bottleneck of ten times": (
        "unloading",
        [
            1314500000.0,
            352380000000.0,
            3963000000.0,
            1138900000.0,
            11133000.0,
            714390000000.0,
            344260000000.0,
            3940100000.0,
            167130000000.0,
            40242000.0,
        ],
        [1.7065e-12, 1.1057e-11, 1.7155e-11, 2.03e-11, 0.0002648, 0.00049414, 0.00062306, 0.0020116, 0.0051042, 0.03183],
        1.8792,
        1.1198e-10,
        1e-05,
        1.758e-09,
        -2.1536553242696844e-10,
        21.512,
    ),
    "short memory without contact": (
        "unloading",
        [5290800000.0, 607100000000.0, 32464000000.0],
        [2.0784e-09, 1.0914e-05, 0.0012897],
        0.88137,
        1.4311e-07,
        3.0916e-06,
        9.1512e-10,
        -1.4313691410062354e-07,
        2.1958e-05,
    ),
}


def solved(D, branch, moduli, times, p_0, delta_0, l, A, _, V):  # noqa: E741
    material, adhesion = hystrip.Prony(K, moduli, times), hystrip.Dugdale(p_0=p_0, delta_0=delta_0)
    return hystrip.solve_strip(material, adhesion, l=l, A=A, D=D, V=V, edge="constitutive", branch=branch)


@pytest.mark.parametrize("case", STRIPS)
def test_strips_ever_closer_to_the_end_of_a_branch_are_found(case):
    """The pressure steps where the branch ends; away from there it is that of the 50-digit march."""
    branch, moduli, times, p_0, delta_0, l, A, end, V = STRIPS[case]  # noqa: E741
    D = end + (A + abs(end)) * np.linspace(-0.02, 0.02, 8)
    first = p = solved(D, *STRIPS[case]).p_mean
    reach = A + abs(end) + delta_0
    for i in (0, -1):
        true = float(oracle.solve_si(K, moduli, times, V, l, A, D[i], p_0, delta_0, branch, digits=30).p_mean)
        assert first[i] == pytest.approx(true, abs=1e-9 * (abs(true) + K * A + p_0))
    while D[1] - D[0] > CLOSE.get(case, 1e-13) * reach:
        step = np.abs(np.diff(p)).argmax()
        assert abs(p[step + 1] - p[step]) > 1e-3 * np.abs(first).max()
        D = np.linspace(*D[step : step + 2], 8)
        p = solved(D, *STRIPS[case]).p_mean

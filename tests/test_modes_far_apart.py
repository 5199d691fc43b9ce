"""Strips on times that differ by ten decades, next to where their branch ends: there one time is over within the windows that
prove an orbit to be the first, or within the adhesion before a contact (``runtime/orbit/modes/windows.py``)."""

from dataclasses import replace

import numpy as np
import pytest
from marches import marched

import hystrip
from hystrip.orbit.foundation import foundation_of
from hystrip.orbit.modes.extremal import certified

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
    # nine come as close in three rounds, which are slow here, as eight in four
    n = 9 if case == "contact up to the release" else 8
    D = end + (A + abs(end)) * np.linspace(-0.02, 0.02, n)
    first = p = solved(D, *STRIPS[case]).p_mean
    reach = A + abs(end) + delta_0
    for i in (0, -1):
        true = marched("solve_si", K, moduli, times, V, l, A, D[i], p_0, delta_0, branch, 30).p_mean
        assert first[i] == pytest.approx(true, abs=1e-9 * (abs(true) + K * A + p_0))
    while D[1] - D[0] > CLOSE.get(case, 1e-13) * reach:
        step = np.abs(np.diff(p)).argmax()
        assert abs(p[step + 1] - p[step]) > 1e-3 * np.abs(first).max()
        D = np.linspace(*D[step : step + 2], n)
        p = solved(D, *STRIPS[case]).p_mean


def test_past_the_end_of_a_branch_links_are_shortened_until_they_hold():
    """Loading, behind where its orbit vanishes: saturated contact, which the march finds, too."""
    case = STRIPS["contact up to the release"]
    branch, moduli, times, p_0, delta_0, l, A, end, V = case  # noqa: E741
    D = end + (A + end) * np.linspace(-0.02, 0.02, 20)[8:14]
    found = solved(D, *case)
    true = [marched("solve_si", K, moduli, times, V, l, A, each, p_0, delta_0, branch, 30) for each in D]
    assert found.regime.tolist() == [each.sequence for each in true]
    assert found.p_mean == pytest.approx([each.p_mean for each in true], rel=1e-12)


#: contact ends, or begins, within rounding of what the state or a phase can tell: as ``STRIPS``
SHORT = {
    "saturation missed by 5e-14, three times alike": (
        "loading",
        [8384927903.018941, 354925371151.6566, 649338330.8648149],
        [8.135874972592146e-08, 9.966152444823257e-08, 1.2252346101663588e-07],
        7.78137e-05,
        1.62546e-13,
        1e-05,
        1.2142943899999308e-09,
        2.4285110819936266e-09,
        1.9174294590930402e-05,
    ),
    "saturation missed by 4e-12, adhesion 18 times what the profile presses": (
        "unloading",
        [51297032.38051403, 115753853968.27475, 297558068210.2359],
        [2.5771800981079484e-09, 3.4608350850287612e-09, 1.1622998481874256e-07],
        305.4867666031254,
        7.30986957903053e-08,
        1e-05,
        1.69e-08,
        -2.428605753296377e-07,
        0.114,
    ),
    "saturation missed by 1e-8, ten times": (
        "loading",
        [
            261209292710.7097,
            446385390050.13696,
            91089376628.3886,
            711040517.9221245,
            63259363.078338824,
            882053854101.649,
            1967642273.3198583,
            46150977.25650135,
            35976864.25087841,
            4224580666.6299,
        ],
        [
            5.723997199794357e-12,
            3.4672162152734676e-10,
            1.1487793802133844e-06,
            4.6625242865468615e-06,
            7.891745339794537e-06,
            5.136047834120532e-05,
            0.0002241976479389994,
            0.0006945960958078455,
            0.006524393889924508,
            0.046549823777430964,
        ],
        0.00114818,
        1.13801e-13,
        1e-05,
        2.824454501884596e-09,
        5.792204294337208e-09,
        1.8571980633835518e-06,
    ),
    "saturation missed by 1e-12, slow": (
        "unloading",
        [831942754709.2998, 637759486.3792528, 1460340773.3304648, 4992003724.955765, 43923431462.10814],
        [1.9023715827135204e-08, 3.3037174272092134e-05, 3.905314320809902e-05, 0.00011536574955743129, 0.013190481762742364],
        0.000418142,
        1.6713e-07,
        1e-05,
        7.428939825959682e-10,
        4.985473087203538e-08,
        3.8690289529293374,
    ),
    "saturation missed by 1e-12, glassy 1,300 times": (
        "loading",
        [
            166337997102.35962,
            207650691348.24435,
            49576854240.50391,
            110727418484.65991,
            384239270283.58966,
            323905516.3577983,
            8351400217.914627,
            65636754.08137737,
            354498875591.77716,
            213235402538.70645,
        ],
        [
            7.873229082425043e-10,
            4.693567418480023e-09,
            1.1372763738825938e-07,
            3.807823776089292e-06,
            1.398340750484603e-05,
            1.4238543037793951e-05,
            2.0382633297330978e-05,
            3.170539942123916e-05,
            6.673892058544214e-05,
            0.00045345710952990874,
        ],
        7.90094,
        1.74714e-08,
        1e-05,
        6.094026499476226e-11,
        7.044190237704207e-08,
        516.4542714160174,
    ),
    "a phase too coarse for the first time": (
        "loading",
        [13170816621.152796, 281655122.92985946, 143215789.93427086, 89288582791.997, 987100853.7211467],
        [8.252318450414386e-12, 6.475166269296897e-07, 5.9620486001361495e-06, 6.750636296845936e-06, 0.007565356629253167],
        115.814,
        1.68009e-08,
        1e-05,
        5.443988606787683e-08,
        -6.9298613292645204e-09,
        1.510326860423224e-06,
    ),
    "displacements rounded by more than the first time moves them": (
        "unloading",
        [11035410699.69891, 5744898963.132852, 10452740679.356115, 254134301632.25043, 58029856986.91192],
        [3.198424585134444e-12, 7.088813640037455e-12, 4.91446659530889e-08, 5.1787214852766845e-08, 0.02349547065418356],
        22449.7,
        6.41218e-11,
        1.64963e-07,
        4.14805553279812e-14,
        -2.2449699781513038e-05,
        5.919766340997114e-05,
    ),
    "Newton's method halves its steps at first, a branch stiff as glass": (
        "loading",
        [9836065573.77, 15409836065.6, 5901639344260000.0, 491803278.689],
        [4.3e-10, 5.60089502847e-09, 1.7e-06, 5.4e-06],
        28.19672131147541,
        6e-08,
        1.73e-07,
        4.08e-09,
        -1.718921205711263e-08,
        5.2e-06,
    ),
}


@pytest.mark.parametrize("case", SHORT)
def test_adhesion_that_hardly_lasts_is_found(case):
    branch, moduli, times, p_0, delta_0, l, A, at, V = SHORT[case]  # noqa: E741
    D = at + A * np.array([-1e-3, -1e-6, 0, 1e-6, 1e-3])
    found = solved(D, *SHORT[case])
    true = [marched("solve_si", K, moduli, times, V, l, A, each, p_0, delta_0, branch, 30) for each in D]
    assert found.regime.tolist() == [each.sequence for each in true]
    assert found.p_mean == pytest.approx([each.p_mean for each in true], rel=1e-12)


def test_a_narrow_contact_far_from_the_first_guess_is_found():
    """A foundation that hardly moves in a period: each turn narrows the contact of the forced orbit by two fifths only."""
    strip = (
        "loading",
        [1666666666670000.0, 466666666.667, 266666666.667],
        [0.14, 262.500833988, 1300.0],
        206.16128383866416,
        8.3e-08,
        0.0018,
        1.4092887514418412e-07,
        -7.4156984793030244e-09,
        3.0,
    )
    branch, moduli, times, p_0, delta_0, l, A, D, V = strip  # noqa: E741
    found = solved(D, *strip)
    true = marched("solve_si", K, moduli, times, V, l, A, D, p_0, delta_0, branch, 20)
    assert found.regime == true.sequence
    assert found.p_mean == pytest.approx(true.p_mean, rel=1e-12)


def test_edges_are_known_as_well_as_is_said():
    """Next to saturation: from any start Newton's method ends in the same orbit, but for what rounding leaves of pressures, which
    are displacements over ``J_0``."""
    moduli = [31015789220.0, 566303414.6, 25455017.56, 4189039032.0, 576524010500.0, 105510379.8, 52432292720.0]
    times = [2.537206869e-12, 3.534562524e-12, 5.252151931e-12, 3.686583657e-08, 6.844830864e-08, 8.802449044e-08]
    moduli, times = [*moduli, 883827083600.0, 2506121726.0, 140231124.6], [*times, 1.038310865e-07, 1.020859582e-05]
    foundation = foundation_of(hystrip.Prony(K, moduli, [*times, 0.0001534684317, 0.01366997248]))
    kernel, none, snaps = foundation.kernel, np.zeros(8), np.zeros(8, bool)
    kV = 2 * np.pi / 1e-5 * 0.00015530823555748394
    ratio = kernel.modulus_ratio(foundation.strips(np.full(8, kV), none, none, none, "constitutive", snaps).m)
    # strips that cling all along are strips without adhesion, pressed deeper
    strips = foundation.strips(np.full(8, kV), 1 + ratio * (1 - 1.3e-9), none, none, "constitutive", snaps)
    strips = replace(strips, bare=True)
    half = 2 * np.arcsin(np.sqrt(0.5 * 1.3e-9))
    end = np.pi - np.arctan2(kernel.loss(strips.m), kernel.storage(strips.m)) - half
    edges, good, known = certified(kernel, strips, "ac", np.stack((end - 2 * np.pi + np.linspace(2.1, 4, 8) * half, end)))
    assert good.all() and (known < 1e-6).all()
    assert (np.ptp(edges, axis=1) < known.min()).all()


def test_next_to_a_fold_strips_that_snap_into_contact_are_found():
    """Loading, next to where its orbit vanishes: as long as orbits of windows began contact up to 1e-7 behind their onset, links
    led past the orbit, which then could not be proven."""
    material = hystrip.Prony(
        208975415.64415836, (11426409443.46799, 16232989574.513561), (1.1143196794182948e-2, 1.2257516473601243e-2)
    )
    given = {"l": 1.8747093233059446e-07, "A": 3.2939664997913483e-09, "V": 2.592776106847628e-06, "edge": "constitutive"}
    near = np.concatenate((-np.geomspace(1e-6, 1e-15, 6), [0.0], np.geomspace(1e-15, 1e-9, 6)))
    adhesion = hystrip.Dugdale(p_0=20.754987763229657, delta_0=2.684556602516164e-10)
    found = hystrip.solve_strip(material, adhesion, D=1.912251733428962e-07 * (1 + near), branch="loading", **given)
    assert (found.regime == "afc").all() and (np.diff(found.tau_mean) >= 0).all()
    # one of so many is where that still tells
    many = hystrip.solve_strip(
        material, adhesion, D=1.912251733428962e-07 * (1 + np.geomspace(1e-16, 1e-9, 150)), branch="loading", **given
    )
    assert (many.regime == "afc").all()
    beyond = hystrip.solve_strip(material, adhesion, D=1.912251733428962e-07 * (1 + 1e-6), branch="loading", **given)
    assert beyond.regime == "ac"

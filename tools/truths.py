"""Draw scenes of one strip, solve them with the high-precision oracle, and store the answers as test data.

    python tools/truths.py [--out tests/data/truths.json] [--seed 1] [--candidates 12000] [--cell 32] [--folds 200]

Scenes have K = 1 Pa/m and A = 1 m, so the stored SI inputs are, but for the factor k V in the times, the dimensionless ones.
Kinds:
  wide       all groups log-uniform over the whole range;
  moderate   groups near 1, where several orbits coexist;
  limits     T_sigma = 0 or T_eps = T_sigma;
  fold       at distances down to the last bits from a penetration where the sequence of zones changes;
  threshold  exactly at an equality: which side counts is a convention, and the sequence may be read either way.
wide, moderate and limits are thinned to at most ``--cell`` scenes for each sequence, closure, branch and set of
coexisting orbits.

one_minus_slope refers to the return map of the orbit (see oracle.march.Solution): 0 at a fold.
Each row ends with how far p_mean, tau_mean and the fractions move when a group (T_sigma, T_eps - T_sigma, p_0, delta_0, D) is
off by 1e-15 of itself: what double precision can resolve. null: some neighbour is too close to a fold to be resolved.
"""

import argparse
import json
import math
import os
import random
import sys
from collections import Counter
from multiprocessing import Pool
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "tests"))

from oracle import march
from oracle.orbits import Unresolved

INPUTS = ("T_eps", "T_sigma", "V", "l", "D", "p_0", "delta_0", "edge", "branch")
MEANS = ("p_mean", "tau_mean", "contact_fraction", "adhesion_fraction")
COLUMNS = (
    "kind",
    *INPUTS,
    "sequence",
    "coexisting",
    *MEANS,
    *"abcd",
    "one_minus_slope",
    "p_spread",
    "tau_spread",
    "fraction_spread",
)
EDGES, BRANCHES = ("continuous", "constitutive"), ("unloading", "loading")
CHUNK = 20


# -- drawing -----------------------------------------------------------------------------------------------------------


def log_uniform(rng, low, high):
    return 10 ** rng.uniform(math.log10(low), math.log10(high))


def draw_groups(rng, kind):
    """(alpha, beta, P0, Delta) of a scene."""
    if kind == "wide":
        while True:
            alpha = log_uniform(rng, 1e-8, 1e8)
            beta = alpha * (1 + log_uniform(rng, 1e-9, 1e9))
            if beta <= 1e9:
                break
        P0, Delta = log_uniform(rng, 1e-6, 1e6), log_uniform(rng, 1e-6, 1e3)
    else:
        alpha = log_uniform(rng, 1e-3, 1e3)
        beta = alpha * (1 + log_uniform(rng, 1e-2, 1e4))
        P0, Delta = log_uniform(rng, 1e-3, 1e2), log_uniform(rng, 1e-3, 1e1)
    if kind == "limits":
        alpha = rng.choice((0.0, beta))
    return alpha, beta, (0.0 if rng.random() < 0.12 else P0), Delta


def thresholds(alpha, beta, P0, Delta):
    """Penetrations where something can change, in closed form: free, adhesion, release, saturation, no onset arc, and the
    range of the profile itself."""
    ratio = math.sqrt((1 + beta**2) / (1 + alpha**2))
    return -Delta, -P0, 2 - P0 - Delta, 1 + ratio - P0, 1 - math.hypot(1, beta) - Delta, 0.0, 2.0


def draw_penetration(rng, groups):
    """Penetration over A, from below no interaction to above saturation, often next to a threshold."""
    marks, way = thresholds(*groups), rng.random()
    if way < 0.45:
        return rng.uniform(min(marks[:4]) - 1, max(marks[:4]) + 1)
    if way < 0.8:
        return rng.choice(marks) + rng.choice((-1, 1)) * log_uniform(rng, 1e-6, 10)
    if way < 0.9:
        return rng.choice(marks[:4]) + rng.choice((-1, 1)) * log_uniform(rng, 1e-12, 1e-3)
    return rng.uniform(-1, 3)


def scene(rng, groups, delta):
    """SI inputs (K = A = 1) of the groups, as plain floats, at some wavelength and speed."""
    alpha, beta, P0, Delta = groups
    V, l = log_uniform(rng, 1e-3, 1e3), log_uniform(rng, 1e-3, 1e3)  # noqa: E741
    rate = 2 * math.pi / l * V
    # A zero difference of the times must stay zero.
    T_eps = beta / rate
    T_sigma = T_eps if alpha == beta else min(alpha / rate, T_eps)
    return {
        "T_eps": T_eps,
        "T_sigma": T_sigma,
        "V": V,
        "l": l,
        "D": delta,
        "p_0": P0,
        "delta_0": Delta,
        "edge": rng.choice(EDGES),
        "branch": rng.choice(BRANCHES),
    }


def draw(rng, kind):
    groups = draw_groups(rng, kind)
    return scene(rng, groups, draw_penetration(rng, groups))


def draw_threshold(rng):
    """A scene at an exact equality. Few bits in each number keep sums and products exact."""

    def short(low, high):
        return math.ldexp(rng.randrange(1 << 12, 1 << 13), rng.randint(low, high) - 12)

    alpha, beta, _, _ = draw_groups(rng, "moderate")
    P0, Delta = short(-5, 4), short(-5, 3)
    way = rng.randrange(4)
    if way == 3:  # snap-in just possible: J_0 p_0 = delta_0
        power = rng.randint(1, 6)
        Delta = math.ldexp(P0, -power)
        item = scene(rng, (alpha, beta, P0, Delta), rng.uniform(-1, 2))
        return item | {"T_eps": math.ldexp(item["T_sigma"], power), "edge": "constitutive"}
    delta = (-Delta, -P0, 2 - P0 - Delta)[way]
    if rng.random() < 0.1:
        P0 = delta = 0.0
    return scene(rng, (alpha, beta, P0, Delta), delta)


# -- solving -----------------------------------------------------------------------------------------------------------


def groups_of(item):
    inputs = {name: value for name, value in item.items() if name not in ("edge", "branch")}
    return march.groups(K=1, A=1, **inputs)


def answer(kind, item):
    """Row of a scene, without the spread."""
    found = march.solve_si(K=1, A=1, **item)
    orbits = march.coexisting(**groups_of(item), closure=item["edge"])
    return {
        "kind": kind,
        **item,
        "sequence": found.sequence,
        "coexisting": " ".join(orbit.sequence for orbit in orbits),
        **{name: float(getattr(found, name)) for name in MEANS},
        **{name: float(found.edges[name]) if name in found.edges else None for name in "abcd"},
        "one_minus_slope": float(f"{float(1 - found.slope):.2e}"),
    }


def spread(row):
    """The row, with the largest changes of its means under relative changes 1e-15 of one group."""
    item = {name: row[name] for name in INPUTS}
    exact = march.solve_si(K=1, A=1, **item)
    largest = {"p_spread": 0.0, "tau_spread": 0.0, "fraction_spread": 0.0}
    for changed in neighbours(item):
        try:
            found = march.solve_si(K=1, A=1, **changed)
        except Unresolved:
            largest = dict.fromkeys(largest, math.inf)
            break
        change = [float(abs(getattr(found, name) - getattr(exact, name))) for name in MEANS]
        change = [change[0], change[1], max(change[2:])]
        largest = {name: max(old, new) for (name, old), new in zip(largest.items(), change, strict=True)}
    return row | {name: float(f"{value:.1e}") if value < math.inf else None for name, value in largest.items()}


def neighbours(item):
    """Scenes with one group changed by 1e-15 of itself, in exact arithmetic."""
    with march.mp.workdps(march.DIGITS):
        T_sigma, lag = march.mp.mpf(item["T_sigma"]), march.mp.mpf(item["T_eps"]) - item["T_sigma"]
        for factor in (1 + march.mp.mpf("1e-15"), 1 - march.mp.mpf("1e-15")):
            if T_sigma:
                yield item | {"T_sigma": T_sigma * factor, "T_eps": T_sigma * factor + lag}
            if lag:
                yield item | {"T_eps": T_sigma + lag * factor}
            for name in ("p_0", "delta_0", "D"):
                if item[name]:
                    yield item | {name: march.mp.mpf(item[name]) * factor}


def candidates(task):
    """Rows of one chunk of free draws."""
    seed, chunk = task
    rng = random.Random(f"{seed} draw {chunk}")
    kinds = rng.choices(("wide", "moderate", "limits"), (5, 5, 1), k=CHUNK)
    return [answer(kind, draw(rng, kind)) for kind in kinds]


def at_threshold(task):
    seed, number = task
    return answer("threshold", draw_threshold(random.Random(f"{seed} threshold {number}")))


def near_change(task):
    """Rows on both sides of one penetration where the sequence changes, found by bisection."""
    seed, number = task
    rng = random.Random(f"{seed} fold {number}")
    groups = draw_groups(rng, rng.choice(("wide", "moderate", "moderate", "moderate")))
    marks = thresholds(*groups)
    item = scene(rng, groups, draw_penetration(rng, groups))

    def letters(delta):
        sequence = march.solve_si(K=1, A=1, **(item | {"D": delta})).sequence
        return sequence == "f" if number % 2 else "f" in sequence if number % 4 else sequence

    low, high = min(marks[:4]) - 1, max(marks[:4]) + 1
    before = letters(low)
    if low < item["D"] < high:  # start from one side of the drawn penetration
        low, high = (low, item["D"]) if letters(item["D"]) != before else (item["D"], high)
        before = letters(low)
    span, rows = high - low, []
    for _ in range(55):  # to neighbouring floats
        middle = low + (high - low) / 2
        try:
            low, high = (middle, high) if letters(middle) == before else (low, middle)
        except Unresolved:  # as good as found
            break
    for _ in range(4):  # mostly above: below there is often nothing
        distance = span * 10 ** rng.uniform(-17, -1)
        delta = high + distance if rng.random() < 0.8 else low - distance
        try:
            rows.append(answer("fold", item | {"D": delta}))
        except Unresolved:
            continue
    return rows


# -- choosing and storing ----------------------------------------------------------------------------------------------


def thin(rows, cell):
    """The first rows of each cell."""
    counts = Counter()
    for row in rows:
        key = row["sequence"], row["edge"], row["branch"], row["coexisting"]
        counts[key] += 1
        if counts[key] <= cell:
            yield row


def collect(pool, options):
    chunks = [(options.seed, chunk) for chunk in range(options.candidates // CHUNK)]
    rows = list(thin((row for part in pool.imap(candidates, chunks) for row in part), options.cell))
    print(f"{len(rows)} free draws kept", flush=True)
    for part in pool.imap(near_change, [(options.seed, number) for number in range(options.folds)]):
        rows.extend(part)
    rows.extend(pool.imap(at_threshold, [(options.seed, number) for number in range(options.thresholds)]))
    rows = list({tuple(row[name] for name in INPUTS): row for row in rows}.values())
    print(f"{len(rows)} scenes; measuring their spread", flush=True)
    return list(pool.imap(spread, rows, chunksize=8))


def write(path, rows, seed):
    """Write aside, then rename."""
    about = __doc__ + f"\nEvery row: K = A = 1. Lengths in units of A. Edges are phases k x. Seed {seed}."
    lines = ",\n".join(json.dumps([row[name] for name in COLUMNS], separators=(",", ":")) for row in rows)
    aside = path.with_name(path.name + ".new")
    aside.write_text(f'{{"about":{json.dumps(about)},\n"columns":{json.dumps(COLUMNS)},\n"rows":[\n{lines}\n]}}\n')
    os.replace(aside, path)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, default=ROOT / "tests" / "data" / "truths.json")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--candidates", type=int, default=12000, help="free draws before thinning")
    parser.add_argument("--cell", type=int, default=32, help="most scenes for one sequence, closure, branch and set of orbits")
    parser.add_argument("--folds", type=int, default=200, help="changes of sequence to surround with scenes")
    parser.add_argument("--thresholds", type=int, default=100, help="scenes at an exact equality")
    parser.add_argument("--processes", type=int, default=2)
    options = parser.parse_args()
    with Pool(options.processes) as pool:
        rows = collect(pool, options)
    write(options.out, rows, options.seed)
    print(f"{len(rows)} scenes, {options.out.stat().st_size} bytes: {dict(Counter(row['sequence'] for row in rows))}")


if __name__ == "__main__":
    main()

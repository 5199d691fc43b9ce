"""The reference march of strips with several relaxation times, and what it gave for those that tests hold the library against:
most of their time went to computing that again. A strip that is not stored is computed. All of them again, to see what changed:

    python tests/marches.py
"""

import json
import sys
from pathlib import Path
from types import SimpleNamespace

import numpy as np
from oracle import march, modes

PATH = Path(__file__).parent / "data" / "marches.json"
MEANS = ("p_mean", "tau_mean", "contact_fraction", "adhesion_fraction")
#: arguments as text -> sequence and means to double precision
STORED = {json.dumps(of): values for of, values in json.loads(PATH.read_text("utf-8"))} if PATH.exists() else {}


FUNCTIONS = {"solve": modes.solve, "solve_si": modes.solve_si, "solve_viscous": march.solve}


def computed(function, *of):
    """Sequence and means of a strip, from one of the ``FUNCTIONS`` of numbers, texts and lists of numbers."""
    found = FUNCTIONS[function](*of)
    return [found.sequence, *(float(getattr(found, name)) for name in MEANS)]


def marched(function, *of):
    """The same, as attributes, from what is stored if it is there."""
    of = [np.asarray(each).tolist() for each in of]
    known = json.dumps([function, *of])
    if known not in STORED:
        STORED[known] = computed(function, *of)
    return SimpleNamespace(**dict(zip(("sequence", *MEANS), STORED[known], strict=True)))


def again():
    """Run the tests that ask for marches without any that is stored, and store what they asked for."""
    import marches  # the tests' own module, not this one run as a program
    import pytest

    before = dict(marches.STORED)
    marches.STORED.clear()
    status = pytest.main([str(PATH.parents[1] / f"test_modes_{name}.py") for name in ("truths", "far_apart")])
    after = marches.STORED
    changed = [of for of in before.keys() & after.keys() if before[of] != after[of]]
    print(f"{len(after)} stored, {len(before.keys() - after.keys())} no longer asked for, changed:", *changed, sep="\n")
    PATH.write_text("[\n" + ",\n".join(f"[{of}, {json.dumps(after[of])}]" for of in sorted(after)) + "\n]\n", "utf-8")
    return status


if __name__ == "__main__":
    sys.exit(again())

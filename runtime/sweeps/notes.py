"""What about a sweep may be beyond the model or its material: said, not enforced."""

import re

import numpy as np

from ..errors import HystripError
from ..plausibility import notes
from .plan import RUN_KEYS, Plan, single

#: combinations that are looked at, evenly spread over those of a larger sweep
_LOOKED_AT = 200
#: numbers in a note, but that of a level: notes that differ in them alone are of one kind
_NUMBER = re.compile(r"(?<!level )\b\d[\d.]*(e[-+]?\d+)?")


def notes_of(plan: Plan) -> list[str]:
    """A sentence of each kind, with the first row of the table that it was found at."""
    keys = [axis.key for axis in plan.axes]
    fixed = [i for i, key in enumerate(keys) if key not in RUN_KEYS]
    together = plan.points_of_a_call
    calls = plan.size // together
    said: dict[str, str] = {}
    for call in np.unique(np.linspace(0, calls - 1, min(calls, _LOOKED_AT)).astype(int)):
        at = plan.coordinates(np.arange(call * together, (call + 1) * together))
        velocity = at[:, keys.index("velocity")] if "velocity" in keys else plan.base["velocity"]
        temperature = at[0, keys.index("temperature")] if "temperature" in keys else plan.base["temperature"]
        try:
            objects = single(plan.base, [keys[i] for i in fixed], at[0, fixed])
        except HystripError:  # said of the points themselves
            continue
        temperature = None if temperature is None else float(temperature)
        for note in notes(objects["material"], objects["levels"], velocity, temperature):
            said.setdefault(_NUMBER.sub("#", note), f"{note} (row {call * together})")
    return list(said.values())

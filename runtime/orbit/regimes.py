"""Regimes of a strip: the cyclic order of zones a material point meets, and what each order is called."""

import numpy as np

#: Zone sequence (f free, a adhesion, c contact; rotated to its alphabetically first form) and the field's name for it.
REGIMES = {
    "c": "saturated contact",
    "ac": "partial contact, saturated adhesion",
    "acaf": "partial contact, discrete adhesion zones",
    "afc": "partial contact, trailing adhesion only",
    "cf": "partial contact without adhesion",
    "af": "no contact, discrete adhesion zone",
    "a": "no contact, saturated adhesion",
    "f": "no interaction",
}

SEQUENCES = np.array(list(REGIMES))
CODE = {sequence: code for code, sequence in enumerate(REGIMES)}

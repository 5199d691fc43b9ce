"""Regimes of a strip, read from the table of the generated solver: zones and edges in the order a material point meets them."""

import numpy as np

from hystrip.generated.standard_linear_solid import REGIMES as GENERATED

#: Zone sequence (f free, a adhesion, c contact; rotated to its alphabetically first form) and the field's name for it. The
#: regime without adhesion, ``cf``, is that of saturated adhesion, ``ac``, at ``p_0 = 0``.
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
#: the regime whose boundary equations and means a sequence has, and the unknown edges of those
EQUATIONS = {sequence: "ac" if sequence == "cf" else sequence for sequence in REGIMES}
EDGES = {sequence: GENERATED[name]["edges"] for sequence, name in EQUATIONS.items()}
#: the same edges as those of an orbit: x is the onset (of contact, where nothing else is met)
ORBIT_EDGES = {sequence: "x" + "".join(edges[1:]) for sequence, edges in EDGES.items() if edges}


def _zones(sequence: str) -> tuple[str, str]:
    zones = GENERATED[EQUATIONS[sequence]]["zones"]
    letters = "".join(zone[0] for zone, *_ in zones)  # contact, adhesion, free
    # a contact that begins at the onset begins at b, too: there is no d
    starts = "".join("b" if zone == "contact" else start for zone, start, _ in zones)
    return (letters.replace("a", "f") if sequence == "cf" else letters), starts


#: of sequences with edges: zones in the order met from the first edge on, and the edges at which they begin
ZONES = {sequence: _zones(sequence) for sequence, edges in EDGES.items() if edges}

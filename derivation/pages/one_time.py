"""What the page of the paper's own foundation says in words."""

from __future__ import annotations

from ..displays import STATED
from ..emit import PARAMETER_MEANINGS
from ..outcome import Derivation
from ..regime import PERIODIC, Regime
from ..sequences import EQUATIONS
from . import misprints
from .wording import Wording, plainly

MEANINGS = dict([*EQUATIONS.values(), PERIODIC])
FIELDS = (
    ("s = -k x", "phase: grows in the time of a material point, which meets decreasing x"),
    ("u(s)", "rigid profile, with the crest at s = 0; w = u in contact"),
    ("w(s),\\quad p(s)", "displacement of the foundation and pressure on it"),
    ("g = w - u", "gap"),
    ("q = p + p_0", "pressure above the traction of adhesion; zero where contact ends"),
    ("z = w - J p", "what a material point carries across a step of p"),
    (
        "H(s) = u + \\beta u'",
        "load harmonic, forcing in the code: p + alpha p' in contact, and it drives the gap too",
    ),
)


def wording(derivation: Derivation) -> Wording:
    return Wording(
        PARAMETER_MEANINGS,
        misprints.misprints(derivation.steps),
        STATED,
        ("residual", "jacobian", "means", "onset_slope"),
        _conditions,
        fields=FIELDS,
        small=misprints.SMALL,
    )


def _conditions(regime: Regime) -> list[list[str]]:
    return [[MEANINGS[label], f"{plainly(term)} = 0"] for label, term in regime.equations]

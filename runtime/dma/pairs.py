"""Which two columns of a table give storage and loss modulus, and how."""

import numpy as np

from ..inputs.checks import LARGEST, SMALLEST

#: roles of two columns, in order of preference: where storage or loss follows from the absolute value, little may remain of it
PAIRS = (
    ("storage", "loss"),
    ("storage", "tan"),
    ("storage", "phase"),
    ("loss", "tan"),
    ("loss", "phase"),
    ("absolute", "tan"),
    ("absolute", "phase"),
    ("storage", "absolute"),
    ("loss", "absolute"),
)


def in_range(role: str, values: np.ndarray) -> tuple[np.ndarray, str]:
    """Which values of a column can be those of a solid, and the rule in words; SI units, phase angles in rad."""
    if role == "phase":
        return (values >= 0) & (values < np.pi / 2), "angles >= 0, below 90 degrees"
    least, rule = (0.0, "numbers >= 0") if role in ("loss", "tan") else (SMALLEST, "numbers > 0")
    good = (values >= least) & (values <= LARGEST)
    if (good | (values > 0)).all():  # but too large or small
        rule += f", in SI from {least:g} to {LARGEST:g}"
    return good, rule


def moduli(pair: tuple[str, str], values: dict[str, np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
    """Storage and loss modulus, (n,) each, in the unit of the columns.

    Storage is infinite where it does not follow, for a tan delta of zero; the other of an absolute value below its part is zero.
    """
    first, second = (values[role] for role in pair)
    if pair == ("storage", "loss"):
        return first, second
    if pair[1] == "absolute":
        share = first / second
        other = second * np.sqrt(np.maximum((1 - share) * (1 + share), 0))
        return (first, other) if pair[0] == "storage" else (other, first)
    tan = np.tan(second) if pair[1] == "phase" else second
    if pair[0] == "storage":
        return first, first * tan
    if pair[0] == "loss":
        return np.divide(first, tan, out=np.full(first.shape, np.inf), where=tan > 0), first
    size = first / np.hypot(1.0, tan)
    return size, size * tan

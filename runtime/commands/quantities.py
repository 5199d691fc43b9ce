"""Quantities on the command line: a number in SI, or text with a unit."""

from __future__ import annotations


def metres(text: str | None, option: str) -> float | None:
    """A length in m, or None if the option is not given. Raises InputError, naming the option."""
    from ..scene.quantity import to_si

    if text is None:
        return None
    try:
        given: float | str = float(text)
    except ValueError:
        given = text
    return to_si(given, "m", option)

"""Quantities on the command line: a number in SI, or text with a unit."""

from __future__ import annotations


def metres(text: str | None, option: str) -> float | None:
    """A length in m, or None if the option is not given. Raises InputError, naming the option."""
    from ..scene.quantity import to_si

    return None if text is None else to_si(number_or_text(text), "m", option)


def number_or_text(text: str) -> float | str:
    """A number, if the text is one; else the text, for a unit."""
    try:
        return float(text)
    except ValueError:
        return text

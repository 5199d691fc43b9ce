"""Quantities on the command line: a number in SI, or text with a unit."""


def quantity(text: str | None, unit: str, option: str) -> float | None:
    """A quantity in ``unit``, or None if the option is not given. Raises InputError, naming the option."""
    from ..scene.quantity import to_si

    if text is None:
        return None
    try:
        value: float | str = float(text)
    except ValueError:
        value = text
    return to_si(value, unit, option)

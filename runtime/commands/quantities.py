"""Quantities on the command line: a number in SI, or text with a unit."""


def metres(text: str | None, option: str) -> float | None:
    """A length in m, or None if the option is not given. Raises InputError, naming the option."""
    return _quantity(text, "m", option)


def pascals(text: str | None, option: str) -> float | None:
    """A pressure in Pa, or None if the option is not given. Raises InputError, naming the option."""
    return _quantity(text, "Pa", option)


def kelvins(text: str | None, option: str) -> float | None:
    """A temperature in K, or None if the option is not given. Raises InputError, naming the option."""
    return _quantity(text, "K", option)


def _quantity(text: str | None, unit: str, option: str) -> float | None:
    from ..scene.quantity import to_si

    return None if text is None else to_si(number_or_text(text), unit, option)


def number_or_text(text: str) -> float | str:
    """A number, if the text is one; else the text, for a unit."""
    try:
        return float(text)
    except ValueError:
        return text

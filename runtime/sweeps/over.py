"""Swept quantities given as text on the command line."""

from collections.abc import Sequence

import numpy as np

from ..errors import InputError
from ..scene.errors import SceneError
from ..scene.schema import Values, msgspec
from ..scene.toml import MOST, parse_toml
from ..scene.validate import values_in_si
from .plan import has_unit, written_unit


def over_of(texts: Sequence[str], half_space: bool = False) -> dict[str, np.ndarray]:
    """``KEY=VALUES`` -> values in SI by dotted key; values are written as in a scene, the brackets of a list may be left out.

    ``half_space``: for a scene whose material is one, of moduli in Pa. Raises :class:`InputError` for what is neither. Whether
    the scene has the key is checked by the sweep.
    """
    found = {}
    for text in texts:
        key, equals, written = (part.strip() for part in text.partition("="))
        if not (key and equals and written):
            raise InputError("--over", text, "KEY=VALUES, such as levels[0].h=[1e-6, 2e-6] or velocity=1e-3")
        if not has_unit(key):
            raise InputError("--over", key, "the dotted key of a quantity of the scene, such as material.times[0]")
        if key in found:
            raise InputError("--over", text, f"{key} once, with all its values")
        found[key] = values_in_si(_read(key, written), written_unit(key, half_space), key)
    return found


def _read(key: str, written: str):
    for attempt in (written, f"[{written}]"):
        try:
            read = parse_toml(f"values = {attempt}")
            if len(read) > 1:  # more lines than one
                break
            return msgspec.convert(read["values"], Values)
        except SceneError:
            continue
        except (msgspec.ValidationError, SystemError):  # the latter at integers of thousands of digits, up to msgspec 0.20
            break
    listed = f'a number, a text with its unit in quotes ("2 ms"), a list of at most {MOST} of these'
    raise InputError(key, written, f"{listed}, or {{start = ..., stop = ..., num = ...}}")

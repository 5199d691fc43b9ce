"""Arguments of functions, under the names of the options that they were given by."""

import contextlib
from collections.abc import Iterator, Mapping

from ..errors import InputError


@contextlib.contextmanager
def as_options(options: Mapping[str, str]) -> Iterator[None]:
    """Have an ``InputError`` about an argument name its option: ``options``, argument -> option."""
    try:
        yield
    except InputError as error:
        if error.field not in options:
            raise
        raise InputError(options[error.field], error.value, error.allowed) from None

"""Optional dependencies, loaded when used. A missing one is an error that names the extra."""

import importlib
from types import ModuleType

from .errors import MissingExtra


def require(module: str, extra: str, purpose: str) -> ModuleType:
    """Import and return an optional module.

    Parameters
    ----------
    module : dotted name of the module, e.g. ``"matplotlib.figure"``
    extra : the extra of hystrip that installs it, e.g. ``"plot"``
    purpose : what it is needed for, as the start of a sentence, e.g. ``"plotting"``

    Raises
    ------
    MissingExtra : the package is not installed
    """
    try:
        return importlib.import_module(module)
    except ModuleNotFoundError as error:
        # Only the optional package's own absence is ours to explain: a package that is installed but broken inside
        # has to show its own error.
        if error.name is None or error.name.split(".")[0] != module.split(".")[0]:
            raise
        name = module.split(".")[0]
        raise MissingExtra(
            f"{purpose} needs the package {name!r}, which is not installed; it comes with the extra {extra!r}: "
            f"pip install 'hystrip[{extra}]'",
            name=name,
        ) from None

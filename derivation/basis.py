"""What a further formula may be derived from: what the stages before it have derived and verified."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Basis:
    """The flows of the zones, complete contact, and the table of regimes; :mod:`.flows`, :mod:`.saturated`, :mod:`.regimes`."""

    flows: Any
    saturated: Any
    regimes: tuple[Any, ...]

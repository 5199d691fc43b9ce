"""Records of arrays, one element for each strip: some of the strips, and several records joined."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Self

import numpy as np


class Batch:
    """Base of dataclasses whose fields are arrays (n,), or such records themselves."""

    __slots__ = ()

    def take(self, index) -> Self:
        """The elements at ``index``: whatever an array takes as one."""
        return type(self)(*[getattr(self, name)[index] for name in self.__dataclass_fields__])

    __getitem__ = take

    def among(self, index: np.ndarray) -> Self:
        """The elements at ``index``, which ascends and repeats nothing: the record itself where these are all."""
        return self if index.size == self.size else self.take(index)

    def put(self, index, other: Self) -> None:
        """Overwrite the elements ``index`` with ``other``."""
        for name in self.__dataclass_fields__:
            getattr(self, name)[index] = getattr(other, name)

    __setitem__ = put

    @classmethod
    def joined(cls, parts: Sequence[Self]) -> Self:
        """The elements of all ``parts``, one part after another."""
        return cls(*(np.concatenate([getattr(part, name) for part in parts]) for name in cls.__dataclass_fields__))

    @property
    def size(self) -> int:
        return getattr(self, next(iter(self.__dataclass_fields__))).size


@dataclass
class Ranges(Batch):
    """Base of records of ranges from ``low`` to ``high`` of a coordinate, (n,)."""

    low: np.ndarray
    high: np.ndarray

    @property
    def width(self) -> np.ndarray:
        return self.high - self.low

    def evenly(self, t: np.ndarray) -> np.ndarray:
        """Places at the shares ``t`` (k,) of the width of each, (n, k)."""
        return self.low[:, None] + self.width[:, None] * t


def pick(value, index):
    """What belongs to the strips ``index`` of the last axis; a value or an axis of length one is shared and stays."""
    return value if np.ndim(value) == 0 or value.shape[-1] == 1 else value[..., index]


def at_points(constants):
    """Constants of strips as functions at phases (points, N) take them: what is had per mode, (n, N), as (n, 1, N)."""
    return [constant[:, None] if np.ndim(constant) > 1 else constant for constant in constants]

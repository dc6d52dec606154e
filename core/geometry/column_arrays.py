"""Base class for a structure of arrays, whose columns are selected and concatenated together."""
from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import Field
from typing import Any, ClassVar, TypeVar

import numpy as np

from ..support import breathe

Kind = TypeVar("Kind", bound="ColumnArrays")


class ColumnArrays:
    """Base class of dataclasses whose fields are arrays with one common axis, `counting_axis`: the last by default.

    A field may be a `ColumnArrays` itself. Fields of other types hold for all columns together.
    """

    __dataclass_fields__: ClassVar[dict[str, Field[Any]]]
    counting_axis: ClassVar[int] = -1

    def _values(self) -> Iterator[Any]:
        return (getattr(self, name) for name in self.__dataclass_fields__)

    def __len__(self) -> int:
        first = next(value for value in self._values() if isinstance(value, (np.ndarray, ColumnArrays)))
        return first.shape[self.counting_axis] if isinstance(first, np.ndarray) else len(first)

    def select(self: Kind, chosen: np.ndarray | slice) -> Kind:
        """Return the columns `chosen`: indices, a boolean mask or a slice."""
        if isinstance(chosen, np.ndarray) and chosen.dtype == bool:
            chosen = np.flatnonzero(chosen)
        return type(self)(*(self._chosen(value, chosen) for value in self._values()))

    def _chosen(self, value: Any, chosen: np.ndarray | slice) -> Any:
        if not isinstance(value, np.ndarray):
            return value.select(chosen) if isinstance(value, ColumnArrays) else value
        breathe()
        if isinstance(chosen, slice):
            return value[chosen if self.counting_axis == 0 else (..., chosen)]
        return value.take(chosen, axis=self.counting_axis, mode="wrap")  # faster, see `columns`

    @classmethod
    def joined(cls: type[Kind], parts: Sequence[Kind]) -> Kind:
        """Concatenate the columns of `parts`, at least one; other fields are taken from the first part."""
        return cls(*map(cls._together, zip(*(part._values() for part in parts))))

    @classmethod
    def _together(cls, values: tuple[Any, ...]) -> Any:
        if not isinstance(values[0], np.ndarray):
            return values[0].joined(values) if isinstance(values[0], ColumnArrays) else values[0]
        breathe()
        return np.concatenate(values, axis=cls.counting_axis)

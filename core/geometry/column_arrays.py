"""Arrays that hold the same things column by column: chosen, and put one behind another, all alike."""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import Field, replace
from typing import Any, ClassVar, TypeVar

import numpy as np

from ..support import breathe

Kind = TypeVar("Kind", bound="ColumnArrays")


class ColumnArrays:
    """What dataclasses share whose fields are arrays, of all of which one axis counts the same things: the last, or
    that which the class says. A field may be such a class itself; what is of another kind is told of all together."""

    __dataclass_fields__: ClassVar[dict[str, Field[Any]]]
    counting_axis: ClassVar[int] = -1

    def _columns(self) -> list[tuple[str, Any]]:
        held = [(name, getattr(self, name)) for name in self.__dataclass_fields__]
        return [(name, value) for name, value in held if isinstance(value, (np.ndarray, ColumnArrays))]

    def __len__(self) -> int:
        _, first = self._columns()[0]
        return first.shape[self.counting_axis] if isinstance(first, np.ndarray) else len(first)

    def select(self: Kind, chosen: np.ndarray | slice) -> Kind:
        """Those `chosen`, as indices, as a mask or as a slice."""
        if isinstance(chosen, np.ndarray) and chosen.dtype == bool:
            chosen = np.flatnonzero(chosen)
        return replace(self, **{name: self._chosen(value, chosen) for name, value in self._columns()})

    def _chosen(self, value: Any, chosen: np.ndarray | slice) -> Any:
        breathe()
        if isinstance(value, ColumnArrays):
            return value.select(chosen)
        if isinstance(chosen, slice):
            return value[chosen if self.counting_axis == 0 else (..., chosen)]
        return value.take(chosen, axis=self.counting_axis, mode="wrap")  # as `columns` does

    @classmethod
    def joined(cls: type[Kind], parts: Sequence[Kind]) -> Kind:
        """All of the parts, at least one, one part behind another."""
        return replace(parts[0], **{name: cls._together(value, [getattr(part, name) for part in parts])
                                    for name, value in parts[0]._columns()})

    @classmethod
    def _together(cls, first: Any, values: list[Any]) -> Any:
        breathe()
        return first.joined(values) if isinstance(first, ColumnArrays) else \
            np.concatenate(values, axis=cls.counting_axis)

"""Arrays that hold the same things column by column: chosen, and put one behind another, all alike."""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import Field, fields
from typing import Any, ClassVar, TypeVar

import numpy as np

Kind = TypeVar("Kind", bound="ColumnArrays")


class ColumnArrays:
    """What dataclasses share whose fields are arrays, of all of which the last axis counts the same things."""

    __dataclass_fields__: ClassVar[dict[str, Field[Any]]]

    def _arrays(self) -> list[np.ndarray]:
        return [getattr(self, field.name) for field in fields(self)]

    def __len__(self) -> int:
        return self._arrays()[0].shape[-1]

    def select(self: Kind, chosen: np.ndarray | slice) -> Kind:
        """Those `chosen`, as indices, as a mask or as a slice."""
        return type(self)(*(array[..., chosen] for array in self._arrays()))

    @classmethod
    def joined(cls: type[Kind], parts: Sequence[Kind]) -> Kind:
        """All of the parts, at least one, one part behind another."""
        return cls(*(np.concatenate(arrays, axis=-1) for arrays in zip(*(part._arrays() for part in parts))))

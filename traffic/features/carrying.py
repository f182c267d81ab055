"""State of a unit that follows its objects from frame to frame, as columns."""

from collections.abc import Mapping

import numpy as np
import numpy.typing as npt

from dyknow.streams.table import Column, Ids, positions_of

__all__ = ["CarriedColumns"]


class CarriedColumns:
    """Columns keyed by object id that are kept from one frame to the next.

    Objects that are missing from a frame are forgotten; new ones begin with the initial value.

    Args:
        initial: Column name to the value (and type) with which an object begins.
    """

    def __init__(self, initial: Mapping[str, np.generic]) -> None:
        self.ids: Ids = np.empty(0, dtype=np.int64)
        self._initial = dict(initial)
        self._columns: dict[str, Column] = {
            name: np.empty(0, dtype=value.dtype) for name, value in initial.items()
        }

    def align(self, ids: Ids) -> npt.NDArray[np.bool_]:
        """Rearrange the columns to the objects *ids*; return which of them are new."""
        old = positions_of(ids, self.ids)
        is_new = old < 0
        for name, initial in self._initial.items():
            column = np.full(len(ids), initial)
            column[~is_new] = self._columns[name][old[~is_new]]
            self._columns[name] = column
        self.ids = ids
        return is_new

    def __getitem__(self, name: str) -> Column:
        return self._columns[name]

    def __setitem__(self, name: str, column: Column) -> None:
        self._columns[name] = column

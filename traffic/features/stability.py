"""Attributes that change only when the new value has been stable for a while.

Noise in the position of a car makes its link and crossing oscillate near the border of an area
(Heintz 2009, section 8.7.4, figure 8.8). The filter lets a value through once it has held for
a set time. Unlike the thesis' filter it then dates the change back to its beginning, so that
the events of a turn keep their true times; the price is the same delay.
"""

from collections.abc import Iterable
from typing import Any

import numpy as np

from dyknow.streams.process import Reactive
from dyknow.streams.sample import Sample
from dyknow.streams.table import Column, Table
from dyknow.time import Duration, TimePoint
from traffic.features.carrying import CarriedColumns

__all__ = ["UNKNOWN", "StableFor"]

UNKNOWN = -2
"""The value of an attribute that has not been stable since its object appeared."""


class StableFor(Reactive):
    """Holds back the changes of some columns until they have been stable for *duration*.

    For each table that goes in, one comes out that is valid *duration* earlier and holds, for
    each object of the incoming one, the value that has been stable since then at the latest, or
    else the stable value before it. Objects begin as `UNKNOWN`. While an object is not observed
    (its column `observed` is false) its values stay as they are.

    Args:
        columns: Names of the integer or boolean columns, separated by spaces.
        duration: How long a new value must hold.
        keep: Names of columns that are passed on as they are, separated by spaces.
    """

    def __init__(self, *, columns: str, duration: Duration, keep: str = "") -> None:
        self._columns = tuple(columns.split())
        self._keep = tuple(keep.split())
        self._duration = duration
        self._state = CarriedColumns(
            {
                f"{kind} {name}": initial
                for name in self._columns
                for kind, initial in (
                    ("stable", np.int32(UNKNOWN)),
                    ("candidate", np.int32(UNKNOWN)),
                    ("since", np.int64(0)),
                )
            }
        )

    def push(self, now: TimePoint, inputs: tuple[Sample[Any], ...]) -> Iterable[Sample[Table]]:
        """Emit the values that are stable by the time of the newest table."""
        (sample,) = inputs
        table: Table = sample.value
        self._state.align(table.ids)
        observed = table["observed"] if "observed" in table else np.ones(len(table), dtype=bool)
        stable = {
            name: self._stabilise(name, table[name], observed, sample.valid_time)
            for name in self._columns
        }
        kept = {name: table[name] for name in self._keep}
        valid_time = TimePoint(sample.valid_time - self._duration)
        yield Sample(Table(table.sort, table.ids, {**stable, **kept}), valid_time, now)

    def _stabilise(
        self, name: str, values: Column, observed: Column, valid_time: TimePoint
    ) -> Column:
        state = self._state
        stable = state[f"stable {name}"]
        value = np.where(observed, values.astype(np.int32), stable)
        has_changed = value != state[f"candidate {name}"]
        since = np.where(has_changed, valid_time, state[f"since {name}"])
        stable = np.where(valid_time - since >= self._duration, value, stable)
        state[f"candidate {name}"] = value
        state[f"since {name}"] = since
        state[f"stable {name}"] = stable
        return stable

"""From a state, as a synchronisation makes it, to the values of features."""

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np

from dyknow.errors import FeatureError
from dyknow.monitoring.interpretation import Constant, Fluent, Origin
from dyknow.streams.sample import NO_VALUE
from dyknow.streams.selecting import find_field
from dyknow.streams.table import Table, positions_of
from dyknow.time import TimePoint

__all__ = ["StateReader"]


class StateReader:
    """Reads the values of features out of states, which are tuples of the values of streams."""

    def __init__(
        self,
        origins: Iterable[Origin],
        streams: Sequence[str],
        constants: Mapping[str, Constant],
        known: Mapping[str, Fluent] | None = None,
    ) -> None:
        """Read features by their origins.

        Args:
            origins: Where the values of the features come from.
            streams: The labels of the streams whose values make a state, in their order.
            constants: What is the same in every state.
            known: Features that the program knows itself.
        """
        self._known = dict(known or {})
        self._constants = dict(constants)
        place = {label: at for at, label in enumerate(streams)}
        self._plain: list[tuple[str, int]] = []
        self._fields: list[tuple[Origin, int]] = []
        rows: dict[int, list[Origin]] = {}
        for origin in origins:
            at = place[origin.stream]
            if origin.symbol is not None:
                rows.setdefault(at, []).append(origin)
            elif origin.path:
                self._fields.append((origin, at))
            else:
                self._plain.append((origin.feature, at))
        self._rows = {at: _Rows(found) for at, found in rows.items()}

    def read(self, state: tuple[Any, ...], time: TimePoint) -> dict[str, Any]:
        """Return the value of each feature in the state of a valid time, and the constants.

        Raises:
            FeatureError: A feature has no value in the state.
        """
        values: dict[str, Any] = dict(self._constants)
        for feature, at in self._plain:
            value = state[at]
            if value is NO_VALUE:
                raise FeatureError(feature, "a value", "none")
            values[feature] = value
        for origin, at in self._fields:
            values[origin.feature] = _field(origin, state[at])
        for at, rows in self._rows.items():
            values.update(rows.read(state[at]))
        for feature, fluent in self._known.items():
            values[feature] = fluent(time)
        return values


class _Rows:
    """Features of objects that have a row in a table."""

    def __init__(self, origins: Sequence[Origin]) -> None:
        self._origins = tuple(origins)
        self._ids: dict[str, list[int]] = {}

    def read(self, table: Any) -> Iterable[tuple[str, Any]]:
        """Return the features and their values; each object is looked for once."""
        if not isinstance(table, Table):
            first = self._origins[0]
            found = "none" if table is NO_VALUE else type(table).__name__
            raise FeatureError(first.feature, f"a table in '{first.stream}'", found)
        wanted = np.array(self._ids_in(table), dtype=np.int64)
        positions = positions_of(wanted, table.ids).tolist()
        return [
            (origin.feature, _of_row(origin, table, at))
            for origin, at in zip(self._origins, positions, strict=True)
        ]

    def _ids_in(self, table: Table) -> list[int]:
        """Return the id that each object has in tables of a sort; -1 if it is of another."""
        if table.sort not in self._ids:
            found = [table.id_of(str(origin.symbol)) for origin in self._origins]
            self._ids[table.sort] = [-1 if each is None else each for each in found]
        return self._ids[table.sort]


def _of_row(origin: Origin, table: Table, at: int) -> Any:
    if at < 0:
        raise FeatureError(origin.feature, f"a row of '{origin.symbol}'", "none in the table")
    column, *path = origin.path
    values = _named(origin, table, (column,))
    return _plain(_named(origin, values[at], tuple(path)))


def _field(origin: Origin, value: Any) -> Any:
    if value is NO_VALUE:
        raise FeatureError(origin.feature, "a value", "none")
    return _plain(_named(origin, value, origin.path))


def _named(origin: Origin, value: Any, path: tuple[str, ...]) -> Any:
    try:
        return find_field(value, path)
    except ValueError as fault:
        written = ".".join(origin.path)
        expected = f"a field '{written}' in the values of '{origin.stream}'"
        raise FeatureError(origin.feature, expected, str(fault)) from None


def _plain(value: Any) -> Any:
    return value.item() if isinstance(value, np.generic) else value

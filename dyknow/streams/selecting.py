"""Fields picked out of the values of a stream, for the values that meet conditions.

`select ... from ... where ...` is an operation of the stream specification language of Heintz,
*Semantically Grounded Stream Reasoning Integrated with ROS*, section III. It works on values
that have fields: mappings, named tuples, dataclasses, and tables, where conditions pick rows and
fields are columns.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields, is_dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from dyknow.streams.process import Reactive
from dyknow.streams.sample import NO_VALUE, Sample
from dyknow.streams.table import Table
from dyknow.streams.values import are_equal
from dyknow.time import TimePoint

__all__ = ["Condition", "Field", "FieldPath", "NamePattern", "Select", "field_names", "find_field"]

FieldPath = tuple[str, ...]
"""The way to a field: `("a", "b")` is the field `b` of the field `a`, written `a.b`."""

NamePattern = tuple[str | FieldPath, ...]
"""A name whose parts are texts and fields: `("F", ("C",))` is `F%C%`, F and the value of C."""


_COMPARABLE: dict[str, tuple[type, ...]] = {
    "i": (int, float),
    "u": (int, float),
    "f": (int, float),
    "b": (bool,),
    "U": (str,),
}
"""What the elements of an array can be compared with at once, by the kind of the array."""


@dataclass(frozen=True, slots=True)
class Field:
    """A field to be taken over, and what it is called from then on.

    Attributes:
        path: Where it stands.
        name: Its new name; None to keep the path as it is written.
    """

    path: FieldPath
    name: NamePattern | None = None


@dataclass(frozen=True, slots=True)
class Condition:
    """What a field must be equal to.

    Attributes:
        path: Where the field stands.
        value: What it must be.
    """

    path: FieldPath
    value: Any


class Select(Reactive):
    """Emits, for each sample that meets all conditions, the fields asked for, under their names.

    Both times of a sample stay as they are. The value is a mapping from name to field, in the
    order asked for; out of a table, a table of the rows that meet the conditions, which may be
    none. Of any other value that does not meet them nothing is emitted, nor of `NO_VALUE`.
    Numbers are equal if they are the same number, whatever their type. If no field is asked for,
    the value keeps its fields and its form.

    Raises:
        ValueError: While it works: a value lacks a field, or two fields come out under one name.
    """

    def __init__(self, fields: Sequence[Field], conditions: Sequence[Condition] = ()) -> None:
        self._fields = tuple(fields)
        self._conditions = tuple(conditions)

    def push(self, now: TimePoint, inputs: tuple[Sample[Any], ...]) -> tuple[Sample[Any], ...]:
        """Emit what is wanted of the new sample."""
        (sample,) = inputs
        value = sample.value
        if value is NO_VALUE:
            return ()
        if isinstance(value, Table):
            selected: Any = self._of_table(value)
        elif all(_equals(find_field(value, one.path), one.value) for one in self._conditions):
            selected = self._of_value(value)
        else:
            return ()
        return (Sample(selected, sample.valid_time, now),)

    def _of_value(self, value: Any) -> Any:
        if not self._fields:
            return value
        named = [(_name(one, value), find_field(value, one.path)) for one in self._fields]
        return _without_repetition(named)

    def _of_table(self, table: Table) -> Table:
        for condition in self._conditions:
            table = table.select(_rows_equal(_column(table, condition.path), condition.value))
        if not self._fields:
            return table
        named = [(self._name_in(table, one), _column(table, one.path)) for one in self._fields]
        return Table(table.sort, table.ids, _without_repetition(named))

    def _name_in(self, table: Table, field: Field) -> str:
        pattern = (".".join(field.path),) if field.name is None else field.name
        return "".join(
            one if isinstance(one, str) else self._common_text(table, one) for one in pattern
        )

    def _common_text(self, table: Table, path: FieldPath) -> str:
        """Return what the column at *path* is in all rows, or would have to be, as text."""
        required = {str(one.value) for one in self._conditions if one.path == path}
        texts = sorted({str(one) for one in _column(table, path)} or required)
        if len(texts) > 1:
            name, found = ".".join(path), " and ".join(texts)
            raise ValueError(f"a column has one name, but '{name}' is {found} in its rows")
        return texts[0] if texts else ""


def find_field(value: Any, path: FieldPath) -> Any:
    """Return the field of *value* at *path*.

    Raises:
        ValueError: There is no such field.
    """
    for at, name in enumerate(path):
        names = field_names(value)
        if name not in names:
            there = f" in '{'.'.join(path[:at])}'" if at else ""
            known = f"expected one of {', '.join(names)}" if names else "the value has no fields"
            raise ValueError(f"no field '{name}'{there}: {known}")
        value = value[name] if isinstance(value, Mapping | Table) else getattr(value, name)
    return value


def field_names(value: Any) -> Sequence[str]:
    """Return the names of the fields of a value, none if it has no fields."""
    if isinstance(value, Table):
        return list(value.columns)
    if isinstance(value, Mapping):
        return [name for name in value if isinstance(name, str)]
    if isinstance(value, tuple):
        return tuple(getattr(value, "_fields", ()))
    return [one.name for one in fields(value)] if is_dataclass(value) else ()


def _equals(found: Any, wanted: Any) -> bool:
    if isinstance(found, bool | np.bool_) or isinstance(wanted, bool):
        return are_equal(_plain(found), wanted)
    if isinstance(found, int | float | np.number) and isinstance(wanted, int | float):
        return bool(found == wanted)
    return are_equal(_plain(found), wanted)


def _rows_equal(column: npt.NDArray[Any], wanted: Any) -> npt.NDArray[np.bool_]:
    if column.ndim == 1 and type(wanted) in _COMPARABLE.get(column.dtype.kind, ()):
        rows: npt.NDArray[np.bool_] = column == wanted
        return rows
    return np.fromiter((_equals(one, wanted) for one in column), bool, len(column))


def _column(table: Table, path: FieldPath) -> npt.NDArray[Any]:
    if path == ("id",) and "id" not in table:
        return table.ids
    column: npt.NDArray[Any] = find_field(table, path[:1])
    if len(path) == 1:
        return column
    return _array([find_field(one, path[1:]) for one in column])


def _array(values: list[Any]) -> npt.NDArray[Any]:
    """Return an array of one value per row, of numbers if they are numbers."""
    if all(isinstance(value, int | float | str) for value in values):
        return np.array(values)
    column = np.empty(len(values), dtype=object)
    column[:] = values
    return column


def _name(field: Field, value: Any) -> str:
    if field.name is None:
        return ".".join(field.path)
    parts = (one if isinstance(one, str) else str(find_field(value, one)) for one in field.name)
    return "".join(parts)


def _without_repetition(named: list[tuple[str, Any]]) -> dict[str, Any]:
    selected = dict(named)
    if len(selected) < len(named):
        names = [name for name, _ in named]
        twice = next(name for name in names if names.count(name) > 1)
        raise ValueError(f"two fields come out under the name '{twice}'")
    return selected


def _plain(value: Any) -> Any:
    return value.item() if isinstance(value, np.generic) else value

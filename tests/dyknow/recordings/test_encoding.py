"""Values become messages of protocol buffers and come back to the last bit."""

from typing import Any

import numpy as np
import pytest
from google.protobuf import descriptor_pb2, descriptor_pool, message_factory
from hypothesis import given, settings
from hypothesis import strategies as st

from dyknow.recordings.decoding import reader_of
from dyknow.recordings.encoding import MisfitError, writer_of
from dyknow.recordings.layout import (
    EMPTY,
    Layout,
    grown,
    layout_from_plain,
    plain_from_layout,
)
from dyknow.recordings.schemas import schema_of_samples, type_name
from dyknow.streams.sample import NO_VALUE
from dyknow.streams.table import Table
from tests.support.recorded import are_identical, plain_values, tables


def layout_of(*values: Any) -> Layout:
    """Return the layout that writes all of *values*."""
    layout = EMPTY
    for value in values:
        layout = grown(layout, value)
    return layout


def copied(value: Any, layout: Layout) -> Any:
    """Return *value*, written and read again."""
    data = writer_of(layout)(value)
    return reader_of(layout, {})(data, 0, len(data))


def seen_by_viewers(value: Any, layout: Layout) -> Any:
    """Return the message that the library of protocol buffers makes of *value* by its schema."""
    pool = descriptor_pool.DescriptorPool()
    for file in descriptor_pb2.FileDescriptorSet.FromString(schema_of_samples("s", layout)).file:
        pool.Add(file)  # type: ignore[no-untyped-call]
    kind = message_factory.GetMessageClass(pool.FindMessageTypeByName(type_name("s")))
    return kind.FromString(writer_of(layout)(value))


@settings(derandomize=True, deadline=None, max_examples=120)
@given(plain_values())
def test_every_plain_value_comes_back(value: Any) -> None:
    """Whatever can be written is read again with the same types and the same bits."""
    assert are_identical(copied(value, layout_of(value)), value)


@settings(derandomize=True, deadline=None, max_examples=60)
@given(st.lists(plain_values(), min_size=1, max_size=5))
def test_grown_layouts_write_all_that_they_have_grown_from(values: list[Any]) -> None:
    """One layout writes every value that it has seen, and survives being written itself."""
    layout = layout_from_plain(plain_from_layout(layout_of(*values)))

    assert all(are_identical(copied(value, layout), value) for value in values)


@settings(derandomize=True, deadline=None, max_examples=80)
@given(plain_values())
def test_library_of_protocol_buffers_knows_every_field(value: Any) -> None:
    """By our schema the library reads our bytes, leaves none over, and writes as many."""
    layout = layout_of(value)
    message = seen_by_viewers(value, layout)

    again = message.SerializeToString()
    message.DiscardUnknownFields()
    assert message.SerializeToString() == again
    read = reader_of(layout, {})(again, 0, len(again))
    assert are_identical(read, value)


@settings(derandomize=True, deadline=None, max_examples=40)
@given(tables(sort="car"))
def test_library_sees_the_numbers_of_tables(table: Table) -> None:
    """Each column of numbers is a repeated field with these numbers, row by row."""
    message = seen_by_viewers(table, layout_of(table))

    assert list(message.value.ids) == table.ids.tolist()
    fields = message.value.DESCRIPTOR.fields[1:]
    assert len(fields) == len(table.columns)
    for field, column in zip(fields, table.columns.values(), strict=True):
        if column.dtype.kind in "iub" or column.dtype.str[1:] in {"f4", "f8"}:
            shown = np.array(list(getattr(message.value, field.name)), dtype=column.dtype)
            np.testing.assert_array_equal(shown, column.ravel())


@pytest.mark.parametrize(
    ("value", "shown"),
    [
        (1.5, 1.5),
        (-7, -7),
        (True, True),
        ("far", "far"),
        (b"\0", b"\0"),
        (1 << 70, "0x400000000000000000"),
        (np.float32(0.5), 0.5),
        (np.int8(-3), -3),
    ],
)
def test_simple_values_are_fields(value: Any, shown: Any) -> None:
    """A viewer finds a simple value in the field `value`."""
    message = seen_by_viewers(value, layout_of(value))

    assert message.value == shown


def test_absent_values_are_not_shown_as_zero() -> None:
    """None leaves the field of the value unset, which is not the same as a number 0."""
    layout = layout_of(0.0, None)

    assert seen_by_viewers(None, layout).WhichOneof("value_kind") is None
    assert seen_by_viewers(0.0, layout).WhichOneof("value_kind") == "value"


def test_items_of_one_kind_are_packed_and_of_several_kinds_told_apart() -> None:
    """States of numbers are a list of numbers; a state of other things has an item for each."""
    numbers: Any = seen_by_viewers((1.0, 2.0), layout_of((1.0, 2.0)))
    mixed: Any = seen_by_viewers((1.0, "a"), layout_of((1.0, "a")))

    assert list(numbers.value.items) == [1.0, 2.0]
    assert [item.WhichOneof("value_kind") for item in mixed.value.items] == ["value", "value_text"]


@pytest.mark.parametrize(
    ("known", "other"),
    [
        (1.0, 1),
        (1, 1 << 64),
        ("a", b"a"),
        ((1,), [1]),
        ((1,), (1.0,)),
        ((1,), (1 << 64,)),
        ((1, 2), (1, None)),
        ({"a": 1}, {"b": 1}),
        ({"a": 1}, {"a": "x"}),
        (Table("car", [1], {}), Table("bus", [1], {})),
        (Table("car", [1], {"x": np.ones(1)}), Table("car", [1], {"x": np.ones((1, 2))})),
        (Table("car", [1], {"x": np.ones(1)}), Table("car", [1], {"x": np.ones(1, "f4")})),
        (np.ones(1), np.ones(1, "i4")),
        (1.0, NO_VALUE),
        (1.0, None),
    ],
)
def test_other_values_do_not_fit(known: Any, other: Any) -> None:
    """A layout refuses what it has not seen; grown by that, it writes both."""
    layout = layout_of(known)

    with pytest.raises(MisfitError):
        writer_of(layout)(other)
    larger = grown(layout, other)
    assert are_identical(copied(other, larger), other)
    assert are_identical(copied(known, larger), known)


def test_equal_values_make_equal_bytes() -> None:
    """The order in which a set was filled does not show in its bytes."""
    layout = layout_of({"a"})

    assert writer_of(layout)({"b", "a", "c"}) == writer_of(layout)({"c", "b", "a"})


def test_keys_that_come_and_go_do_not_grow_the_layout() -> None:
    """Dictionaries with other keys than the first are pairs, however many keys there are."""
    layout = layout_of({"car1": 1.0}, {"car1": 1.0, "car2": 2.0})

    assert layout_of({"car1": 1.0}, {"car1": 1.0, "car2": 2.0}, {"car3": 3.0}) == layout


@pytest.mark.parametrize("value", [object(), np.ma.array([1]), np.zeros(1, [("a", "f8")]), 1 + 2j])
def test_what_has_no_codec_is_refused(value: object) -> None:
    """Values of types that nobody knows cannot be recorded, and the message names the type."""
    with pytest.raises(TypeError, match=r"codec|cannot be recorded"):
        grown(EMPTY, value)


def test_broken_text_is_refused() -> None:
    """Half a surrogate pair is not Unicode and cannot be written."""
    with pytest.raises(UnicodeError):
        writer_of(layout_of("a"))("\ud800")

"""Fields picked out of the values of a stream."""

from collections import namedtuple
from dataclasses import dataclass

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from dyknow.streams.sample import NO_VALUE, Sample
from dyknow.streams.selecting import Condition, Field, Select, field_names, find_field
from dyknow.streams.table import Table
from dyknow.streams.values import are_equal
from dyknow.time import TimePoint
from tests.support.laws import assert_unit_laws
from tests.support.streams import ms, run_unit

END = ms(1000)


def _stream(*values):
    return [Sample(value, ms(10 * at), ms(10 * at + 5)) for at, value in enumerate(values)]


def _selected(select, *values):
    return run_unit(select, _stream(*values), until=END)


def _field(path, *name):
    return Field(tuple(path.split(".")), name or None)


def test_figure_2_two_fields_of_some_samples():
    """`select A, D as F%C% from S1 where B = 2` takes A, and D under F and the value of C."""
    select = Select([_field("A"), _field("D", "F", ("C",))], [Condition(("B",), 2)])
    s1 = [
        {"A": 1, "B": 2, "C": 3, "D": 4},
        {"A": 5, "B": 1, "C": 7, "D": 8},
        {"A": 9, "B": 2, "C": 11, "D": 12},
    ]

    made = _selected(select, *s1)

    assert [sample.value for sample in made] == [{"A": 1, "F3": 4}, {"A": 9, "F11": 12}]
    assert [(s.valid_time, s.available_time) for s in made] == [
        (ms(0), ms(5)),
        (ms(20), ms(25)),
    ]


def test_all_conditions_must_be_met():
    """Conditions are joined by `and`."""
    select = Select([_field("a")], [Condition(("b",), 1), Condition(("c",), "x")])

    made = _selected(
        select, {"a": 1, "b": 1, "c": "y"}, {"a": 2, "b": 2, "c": "x"}, {"a": 3, "b": 1, "c": "x"}
    )

    assert [sample.value for sample in made] == [{"a": 3}]


def test_a_select_that_nothing_meets_emits_nothing():
    """There are no samples, not samples without fields; nor is anything said of no value."""
    select = Select([_field("a")], [Condition(("a",), 5)])

    assert _selected(select, {"a": 1}, {"a": "5"}, NO_VALUE) == []


@dataclass(frozen=True)
class _Pose:
    position: dict
    heading: float


_Car = namedtuple("_Car", ["pose", "name"])


def test_fields_have_fields():
    """A path leads through mappings, named tuples and dataclasses; its text is the name."""
    value = {"car": _Car(_Pose({"x": 1.5, "y": 2.5}, 0.0), "car3")}
    select = Select([_field("car.pose.position.x"), _field("car.name", "who")])

    (made,) = _selected(select, value)

    assert made.value == {"car.pose.position.x": 1.5, "who": "car3"}
    assert find_field(value, ("car", "pose", "heading")) == 0.0


def test_a_name_can_be_made_of_several_fields():
    """Texts and fields alternate in a pattern as they like."""
    select = Select([_field("v", ("a",), "_of_", ("b", "c"))])

    (made,) = _selected(select, {"v": 1, "a": "speed", "b": {"c": "car3"}})

    assert made.value == {"speed_of_car3": 1}


CARS = Table(
    "car",
    [3, 7, 9],
    {
        "lane": np.array(["A1", "B2", "A1"]),
        "speed": np.array([10.0, 20.0, 30.0]),
        "pose": np.array([{"x": 1}, {"x": 2}, {"x": 3}], dtype=object),
    },
)


def test_out_of_a_table_rows_and_columns_are_taken():
    """Conditions pick the rows; fields are columns, and stay those of the same objects."""
    select = Select(
        [_field("speed", "v"), _field("pose.x"), _field("id")], [Condition(("lane",), "A1")]
    )

    (made,) = _selected(select, CARS)

    expected = {"v": np.array([10.0, 30.0]), "pose.x": np.array([1, 3]), "id": np.array([3, 9])}
    assert are_equal(made.value, Table("car", [3, 9], expected))


def test_a_table_may_have_no_rows_left():
    """That there are no such objects at a time is worth saying."""
    select = Select([_field("speed")], [Condition(("lane",), "C3")])

    (made,) = _selected(select, CARS)

    assert len(made.value) == 0
    assert list(made.value.columns) == ["speed"]


def test_a_column_is_named_after_a_field_that_all_rows_share():
    """What the rows do not agree on cannot name a column of all of them."""
    named = [_field("speed", "speed_on_", ("lane",))]

    (made,) = _selected(Select(named, [Condition(("lane",), "A1")]), CARS)

    assert list(made.value.columns) == ["speed_on_A1"]
    (none,) = _selected(Select(named, [Condition(("lane",), "C3")]), CARS)
    assert list(none.value.columns) == ["speed_on_C3"]
    with pytest.raises(ValueError, match="a column has one name, but 'lane' is A1 and B2 in its"):
        _selected(Select(named), CARS)


@pytest.mark.parametrize(
    ("select", "value", "message"),
    [
        (Select([_field("b")]), {"a": 1}, "no field 'b': expected one of a"),
        (
            Select([_field("a")], [Condition(("c",), 1)]),
            {"a": 1},
            "no field 'c': expected one of a",
        ),
        (Select([_field("a.b")]), {"a": {"c": 1}}, "no field 'b' in 'a': expected one of c"),
        (Select([_field("a.b")]), {"a": 1}, "no field 'b' in 'a': the value has no fields"),
        (Select([_field("a")]), (1, 2), "no field 'a': the value has no fields"),
        (Select([_field("wheels")]), CARS, "no field 'wheels': expected one of lane, speed, pose"),
        (
            Select([_field("a", "x"), _field("b", "x")]),
            {"a": 1, "b": 2},
            "two fields come out under the name 'x'",
        ),
    ],
)
def test_a_field_that_is_not_there_is_named(select, value, message):
    """A misspelt field is a fault, not a condition that nothing meets."""
    with pytest.raises(ValueError, match=r".") as caught:
        _selected(select, value)

    assert str(caught.value) == message


@pytest.mark.parametrize(
    ("found", "wanted", "is_equal"),
    [
        (np.int64(2), 2, True),
        (2.0, 2, True),
        (np.float64(2.5), 2, False),
        (True, True, True),
        (np.bool_(True), True, True),
        (1, True, False),
        (True, 1, False),
        (np.str_("a"), "a", True),
        ("2", 2, False),
    ],
)
def test_numbers_are_equal_whatever_their_type(found, wanted, is_equal):
    """What counts is the number; truth values and texts are no numbers."""
    select = Select([_field("a")], [Condition(("a",), wanted)])

    (rows,) = _selected(select, Table("thing", [1], {"a": np.array([found])}))

    assert bool(_selected(select, {"a": found})) is is_equal
    assert bool(len(rows.value)) is is_equal


_VALUES = st.fixed_dictionaries({name: st.integers(0, 2) for name in "abc"})


@settings(derandomize=True, deadline=None, max_examples=60)
@given(st.lists(_VALUES, max_size=6), st.integers(0, 2))
def test_select_keeps_what_a_comprehension_keeps(values, wanted):
    """A select is a filter and a projection; out of a table it is that of its rows."""
    select = [_field("a"), _field("b", "x")], [Condition(("c",), wanted)]
    expected = [{"a": one["a"], "x": one["b"]} for one in values if one["c"] == wanted]
    columns = {name: np.array([one[name] for one in values], dtype=int) for name in "abc"}
    table = Table("thing", range(len(values)), columns)

    (made,) = _selected(Select(*select), table)

    assert [sample.value for sample in _selected(Select(*select), *values)] == expected
    assert [made.value.row(number) for number in made.value.ids] == expected


def test_select_keeps_the_laws():
    """Select is a unit like any other."""
    given_stream = _stream({"a": 1}, {"a": 2}, NO_VALUE, {"a": 1})

    assert_unit_laws(
        lambda: Select([_field("a")], [Condition(("a",), 1)]),
        given_stream,
        until=TimePoint(ms(100)),
        tick=ms(7),
    )


def test_the_names_of_fields():
    """Mappings, tables, named tuples and dataclasses have fields, other values have none."""
    assert list(field_names({"a": 1, 2: 3})) == ["a"]
    assert list(field_names(CARS)) == ["lane", "speed", "pose"]
    assert list(field_names(_Car(1, 2))) == ["pose", "name"]
    assert list(field_names(_Pose({}, 0.0))) == ["position", "heading"]
    assert list(field_names((1, 2))) == list(field_names("text")) == []


def test_without_fields_the_value_stays_as_it_is():
    """Conditions still choose samples, and rows of tables."""
    select = Select([], [Condition(("k",), 2)])
    kept, lost = {"k": 2, "v": 1}, {"k": 3, "v": 1}
    table = Table("car", np.array([1, 2]), {"k": np.array([2, 3])})

    values = [
        sample.value
        for value in (kept, lost, table)
        for sample in select.push(ms(1), (Sample(value, ms(1), ms(1)),))
    ]

    assert values[0] is kept
    assert [list(each.ids) for each in values[1:]] == [[1]]

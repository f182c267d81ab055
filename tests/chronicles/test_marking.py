"""Objects about which something was recognised."""

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from chronicles.events import Recognition
from chronicles.marking import RecognitionMarks
from dyknow.streams.sample import END_OF_TIME, NO_SAMPLE, Heartbeat, Sample
from dyknow.streams.table import Table
from dyknow.time import Duration, TimePoint
from tests.support.streams import ms

_COLUMNS = ("recognised", "n_recognised", "recognised_at")


def _recognition(at: int, car: str, chronicle: str = "act", name: str = "car") -> Recognition:
    """Return the recognition of something that began and ended a second before it was certain."""
    happened = ms(at - 1000)
    return Recognition(chronicle, {name: car}, {"t": happened}, (), happened, happened, ms(at))


def _cars(*ids: int, **columns: Any) -> Table:
    return Table("car", ids, {name: np.array(column) for name, column in columns.items()})


def _told(samples: Any) -> list[tuple[float, dict[int, tuple[Any, ...]]]]:
    """Return the marks in tables, by object; times in milliseconds."""
    return [(one.valid_time / 1e6, _rows(one.value)) for one in samples]


def _rows(table: Table) -> dict[int, tuple[Any, ...]]:
    if not table.columns:
        return {}
    names = [*_COLUMNS, *(("present",) if "present" in table else ())]
    rows = zip(*(table[name].tolist() for name in names), strict=True)
    return dict(zip(table.ids.tolist(), rows, strict=True))


def _pushed(unit: RecognitionMarks, time: int, *values: Any) -> list[Any]:
    """Push what is new at an instant; None for what is not new."""
    return _told(unit.push(ms(time), tuple(_sample(value, time) for value in values)))


def _sample(value: Any, time: int) -> Sample[Any]:
    if value is None:
        return NO_SAMPLE
    valid = value[0].recognised_at if isinstance(value, tuple) else ms(time)
    return Sample(value, valid, ms(time))


def _beat(unit: RecognitionMarks, time: int, until: float) -> list[Any]:
    return _told(unit.beat(ms(time), 1, Heartbeat(ms(until), ms(time))))


def test_a_table_waits_until_the_recognitions_up_to_its_time_are_known():
    """What is recognised at the time of a table counts in it, once its heartbeat has come."""
    unit = RecognitionMarks(arguments="car")

    assert _pushed(unit, 100, _cars(1, 2), None) == []
    assert _pushed(unit, 120, None, (_recognition(100, "car2"),)) == []
    assert _beat(unit, 140, 99) == []
    assert _beat(unit, 150, 100) == [
        (100.0, {1: (False, 0, -1), 2: (True, 1, 100_000_000)}),
    ]


def test_what_counts_is_when_a_recognition_became_certain():
    """An act that was over a second ago marks the table of when it was recognised, once."""
    unit = RecognitionMarks(arguments="car")
    _beat(unit, 0, END_OF_TIME / 1e6)
    recognitions = Sample((_recognition(1500, "car1"),), ms(1500), ms(1500))

    assert _pushed(unit, 1000, _cars(1), None) == [(1000.0, {1: (False, 0, -1)})]
    unit.push(ms(1500), (NO_SAMPLE, recognitions))
    assert _pushed(unit, 2000, _cars(1), None) == [(2000.0, {1: (True, 1, 1_500_000_000)})]
    assert _pushed(unit, 3000, _cars(1), None) == [(3000.0, {1: (False, 1, 1_500_000_000)})]


def test_with_a_largest_delay_no_heartbeat_is_needed():
    """A table is out that time after it was valid."""
    unit = RecognitionMarks(arguments="car", max_delay=Duration(ms(50)))

    assert _pushed(unit, 100, _cars(1), None) == []
    assert unit.due() == ms(150)
    assert _told(unit.advance(ms(150))) == [(100.0, {1: (False, 0, -1)})]


def test_only_some_arguments_and_chronicles_count():
    """Arguments of other names, other chronicles and unknown objects mark nothing."""
    unit = RecognitionMarks(arguments="car1 c", chronicles=("act",), max_delay=Duration(0))
    made = (
        _recognition(100, "car1", name="car1"),
        _recognition(100, "car2", name="car2"),
        _recognition(100, "car3", "other", "c"),
        _recognition(100, "truck4", name="c"),
        _recognition(100, "car5", name="c"),
        _recognition(100, "car05", name="c"),
    )

    ((_, rows),) = _pushed(unit, 100, _cars(1, 2, 3, 4), made)

    assert [each for each, (recognised, *_) in rows.items() if recognised] == [1]
    assert unit.n_unknown == 3


def test_objects_stay_as_they_were_for_as_long_as_they_are_remembered():
    """Only those with a mark stay; who comes back has the marks it had."""
    unit = RecognitionMarks(arguments="car", max_delay=Duration(0), remember=Duration(ms(300)))
    observed = {"observed": [True, True], "speed": [3.0, 4.0]}
    _pushed(unit, 100, _cars(1, 2, **observed), (_recognition(100, "car1"),))

    ((_, table),) = [
        (one.valid_time, one.value)
        for one in unit.push(ms(200), (Sample(_cars(), ms(200), ms(200)), NO_SAMPLE))
    ]
    assert set(table.columns) == {"speed", "present", *_COLUMNS}
    assert _rows(table) == {1: (False, 1, 100_000_000, False)}
    assert table["speed"].tolist() == [3.0]
    late = (_recognition(300, "car2"),)
    assert _pushed(unit, 300, _cars(), late)[0][1][2] == (True, 1, 300_000_000, False)
    back = _pushed(unit, 350, _cars(2, observed=[True], speed=[1.0]), None)[0][1]
    assert back == {2: (False, 1, 300_000_000, True), 1: (False, 1, 100_000_000, False)}
    assert list(_pushed(unit, 401, _cars(2, observed=[True], speed=[1.0]), None)[0][1]) == [2]


def test_a_table_of_nothing_may_be_without_columns():
    """Who makes tables may not know their columns before there is an object; nor do we."""
    for remember in (0, 300):
        unit = RecognitionMarks(
            arguments="car", max_delay=Duration(0), remember=Duration(ms(remember))
        )
        (sample,) = unit.push(ms(0), (_sample(_cars(), 0), NO_SAMPLE))
        assert not sample.value.columns
        (sample,) = unit.push(ms(10), (_sample(_cars(1, speed=[2.0]), 10), NO_SAMPLE))
        assert len(sample.value) == 1


def test_something_must_be_named_to_be_marked():
    """Without the name of a parameter nothing could ever be marked."""
    with pytest.raises(ValueError, match="at least one name of a parameter"):
        RecognitionMarks(arguments=" ")


@settings(derandomize=True, deadline=None, max_examples=60)
@given(
    st.lists(st.sets(st.integers(1, 4)), min_size=1, max_size=8),
    st.lists(
        st.tuples(st.integers(0, 80), st.integers(0, 25), st.integers(1, 4)),
        max_size=8,
        unique_by=lambda drawn: drawn[0] + drawn[1],
    ),
)
def test_marks_are_those_that_a_look_at_everything_gives(
    tables: list[set[int]], drawn: list[tuple[int, int, int]]
) -> None:
    """Whatever the delays: what was recognised between the times of two tables marks the later."""
    unit = RecognitionMarks(arguments="car", max_delay=Duration(ms(25)))
    arrivals: dict[int, list[Any]] = {}
    for number, ids in enumerate(tables):
        arrivals.setdefault(10 * number, [NO_SAMPLE, NO_SAMPLE])[0] = Sample(
            _cars(*sorted(ids)), ms(10 * number), ms(10 * number)
        )
    for valid, delay, car in drawn:
        found = Sample((_recognition(valid, f"car{car}"),), ms(valid), ms(valid + delay))
        arrivals.setdefault(valid + delay, [NO_SAMPLE, NO_SAMPLE])[1] = found
    told = []
    for time in range(200):
        if time in arrivals:
            told += _told(unit.push(ms(time), tuple(arrivals[time])))
        told += _told(unit.advance(ms(time)))

    assert told == [
        (10.0 * number, {car: _naive(car, number, tables, drawn) for car in sorted(ids)})
        for number, ids in enumerate(tables)
    ]


def _naive(
    car: int, number: int, tables: list[set[int]], drawn: list[tuple[int, int, int]]
) -> tuple[bool, int, int]:
    """Return the marks of a car in a table: of what was recognised while it has been there."""
    begin = number
    while begin > 0 and car in tables[begin - 1]:
        begin -= 1
    since = 10 * (begin - 1)
    times = [valid for valid, _, one in drawn if one == car and since < valid <= 10 * number]
    newest = [valid for valid in times if valid > 10 * (number - 1)]
    latest = TimePoint(-1) if not times else ms(max(times))
    return bool(newest), len(times), latest

"""From columns to events."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from chronicles.events import Event
from dyknow.streams.sample import Sample
from dyknow.streams.table import Table
from dyknow.time import TimePoint
from traffic.features.changes import Changes
from traffic.features.stability import UNKNOWN

LINKS = ("a-b", "b-c")


def events_of(*tables: Table) -> list[Event]:
    """Push tables one nanosecond apart and return all events."""
    unit = Changes({"link": LINKS}, of="cars", arguments="car")
    events: list[Event] = []
    for i, table in enumerate(tables):
        time = TimePoint(i)
        (sample,) = unit.push(time, (Sample(table, time, time),))
        events.extend(sample.value)
    return events


def cars(**link_by_car: int) -> Table:
    """A table of cars named c1, c2, … with their links."""
    ids = [int(name[1:]) for name in link_by_car]
    return Table("car", ids, {"link": np.array(list(link_by_car.values()), dtype=np.int32)})


def test_a_first_value_is_a_change_from_unknown():
    """An object that appears brings its first values."""
    assert events_of(cars(c3=0)) == [Event("cars.link", ("car3",), None, "a-b", TimePoint(0))]


def test_an_unchanged_value_is_no_event():
    """Reporting the same value again says nothing."""
    assert len(events_of(cars(c3=0), cars(c3=0))) == 1


def test_no_value_has_a_name():
    """The value -1 is named after the column."""
    assert events_of(cars(c3=0), cars(c3=-1))[1].to_value == "no_link"


def test_what_goes_becomes_unknown():
    """An object that vanishes takes its values with it."""
    assert events_of(cars(c3=0), cars())[1:] == [
        Event("cars.link", ("car3",), "a-b", None, TimePoint(1))
    ]


def test_unknown_values_of_objects_that_go_are_no_events():
    """What was never known is not lost."""
    assert events_of(cars(c3=UNKNOWN), cars()) == []


def test_pairs_have_two_arguments():
    """Tables with first and second are about two objects."""
    columns = {"first": np.array([1]), "second": np.array([2]), "behind": np.array([True])}
    (event,) = events_of(Table("car_relation", [12], columns))

    assert (event.attribute, event.arguments) == ("cars.behind", ("car1", "car2"))
    assert (event.from_value, event.to_value) == (None, "true")


FRAMES = st.lists(
    st.dictionaries(st.integers(1, 4), st.sampled_from([UNKNOWN, -1, 0, 1]), max_size=4),
    max_size=12,
)


@settings(derandomize=True, deadline=None, max_examples=100)
@given(FRAMES)
def test_replaying_the_events_gives_the_values(frames):
    """Whoever applies the changes in order knows every value at every time."""
    tables = [cars(**{f"c{car}": link for car, link in frame.items()}) for frame in frames]
    name = {-1: "no_link", 0: "a-b", 1: "b-c"}
    known: dict[str, str | None] = {}
    events = events_of(*tables)
    for i, frame in enumerate(frames):
        for event in (e for e in events if e.time == i):
            assert known.get(event.arguments[0]) == event.from_value
            known[event.arguments[0]] = event.to_value
        expected = {f"car{car}": name[link] for car, link in frame.items() if link != UNKNOWN}
        assert {car: value for car, value in known.items() if value is not None} == expected

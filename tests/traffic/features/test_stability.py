"""Values that have been stable for a while."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from dyknow.streams.sample import Sample
from dyknow.streams.table import Table
from dyknow.time import MILLISECOND, Duration, TimePoint
from traffic.features.stability import UNKNOWN, StableFor

PERIOD = 100 * MILLISECOND


def stabilised(values: list[int], duration: int, observed: list[bool] | None = None) -> list[int]:
    """Run one object through the filter, a value every 100 ms."""
    unit = StableFor(columns="link", duration=Duration(duration))
    result = []
    for i, value in enumerate(values):
        now = TimePoint(i * PERIOD)
        columns = {"link": np.array([value])}
        if observed is not None:
            columns["observed"] = np.array([observed[i]])
        (out,) = unit.push(now, (Sample(Table("car", [7], columns), now, now),))
        assert out.valid_time == now - duration
        result.append(int(out.value["link"][0]))
    return result


def stable_by_definition(values: list[int], n_periods: int) -> list[int]:
    """Return the last value that stood for *n_periods* + 1 samples in a row, naively."""
    result = []
    for i in range(len(values)):
        ends = [k for k in range(n_periods, i + 1) if len(set(values[k - n_periods : k + 1])) == 1]
        result.append(values[ends[-1]] if ends else UNKNOWN)
    return result


def test_a_value_that_lasts_shorter_than_the_duration_is_never_seen():
    """A flicker into the crossing and back leaves no trace."""
    assert stabilised([1, 1, 1, 2, 1, 1, 1, 1], 200 * MILLISECOND) == [-2, -2, 1, 1, 1, 1, 1, 1]


def test_a_change_is_dated_back_to_its_beginning():
    """The table that first shows a new value is valid when the value began."""
    values = stabilised([1, 1, 1, 2, 2, 2], 200 * MILLISECOND)

    first = values.index(2)
    assert first * PERIOD - 200 * MILLISECOND == 3 * PERIOD


def test_values_of_unobserved_objects_stay():
    """What is only predicted changes no attribute."""
    seen = [True] * 3 + [False] * 4
    assert stabilised([1, 1, 1, 2, 2, 2, 2], 200 * MILLISECOND, seen)[-1] == 1


@settings(derandomize=True, deadline=None, max_examples=100)
@given(st.lists(st.integers(0, 2), max_size=30), st.integers(1, 4))
def test_the_filter_agrees_with_its_definition(values, n_periods):
    """For every sequence the filter gives the last value that lasted long enough."""
    expected = stable_by_definition(values, n_periods)

    assert stabilised(values, n_periods * PERIOD) == expected


def test_objects_are_filtered_independently_of_their_order():
    """Rearranged rows, newcomers and leavers do not disturb the others."""
    unit = StableFor(columns="link", duration=Duration(PERIOD))
    frames = [([1, 2], [5, 6]), ([2, 3, 1], [6, 9, 5]), ([1, 3], [5, 9])]
    for i, (ids, links) in enumerate(frames):
        now = TimePoint(i * PERIOD)
        table = Table("car", ids, {"link": np.array(links)})
        (out,) = unit.push(now, (Sample(table, now, now),))

    assert out.value["link"].tolist() == [5, 9]

"""Whether cars travel, decided afterwards."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from dyknow.streams.sample import Sample
from dyknow.streams.table import Table
from dyknow.time import MILLISECOND, SECOND, Duration, TimePoint
from traffic.features.stability import UNKNOWN
from traffic.features.travelling import Travelling

PERIOD = 100 * MILLISECOND


def unit(*, over: int = 20, within: int = 0) -> Travelling:
    """Return a unit for the limit of 3 m/s; durations in periods."""
    return Travelling(
        speed=3.0, over=Duration(over * PERIOD), certainty=0.0, within=Duration(within * PERIOD)
    )


def travelling(speeds: list[float], *, believed: list[float] | None = None, over: int = 20):
    """Drive a car at these true speeds, one a period; return the times and the codes."""
    places = np.concatenate([[0.0], np.cumsum(speeds[:-1])]) * PERIOD / SECOND
    told = believed if believed is not None else speeds
    process, found = unit(over=over), []
    for i, (place, speed) in enumerate(zip(places, told, strict=True)):
        at = TimePoint(i * PERIOD)
        columns = {
            "position": np.array([[place, 0.0]]),
            "speed": np.array([speed]),
            "speed_variance": np.array([0.01]),
        }
        for out in process.push(at, (Sample(Table("car", [1], columns), at, at),)):
            assert out.available_time == at
            found.append((out.valid_time, int(out.value["travelling"][0])))
    return found


def test_each_table_comes_out_once_half_of_the_way_later():
    """A table is decided on when it is known how the cars went on, and none is left out."""
    found = travelling([10.0] * 30)

    assert found == [(TimePoint(i * PERIOD), 1) for i in range(20)]


def test_the_way_tells_what_the_filter_has_not_seen_yet():
    """A car that brakes stops travelling half a second before the filter believes it to."""
    braking = [10.0] * 15 + [0.0] * 40
    believed = [10.0] * 15 + [10.0 - 0.5 * i for i in range(20)] + [0.0] * 20

    found = travelling(braking, believed=believed)

    first = next(time for time, code in found if code == 0)
    filtered = next(i for i, speed in enumerate(believed) if speed < 3) * PERIOD
    assert 15 * PERIOD <= first <= filtered - 5 * PERIOD


def test_a_new_car_is_judged_by_its_speed():
    """Of a car that has not been known long enough the speed itself decides."""
    cars = {
        "position": np.zeros((2, 2)),
        "speed": np.array([9.0, 3.0]),
        "speed_variance": np.full(2, 0.01),
    }
    (out,) = unit(over=0).push(
        TimePoint(0), (Sample(Table("car", [4, 5], cars), TimePoint(0), TimePoint(0)),)
    )

    assert out.value["travelling"].tolist() == [1, UNKNOWN]


@settings(derandomize=True, deadline=None, max_examples=50)
@given(st.lists(st.integers(0, 100), min_size=1, max_size=60, unique=True), st.integers(0, 10))
def test_every_table_comes_out_once_in_order(times, half):
    """However irregular the tables are, those come out that are old enough, and no other."""
    process = unit(over=2 * half)
    table = Table("car", [], {name: np.empty(0) for name in ("speed", "speed_variance")})
    table = table.with_columns(position=np.empty((0, 2)))
    ordered = [TimePoint(time * PERIOD) for time in sorted(times)]

    found = [
        out.valid_time for at in ordered for out in process.push(at, (Sample(table, at, at),))
    ]

    assert found == [time for time in ordered if time + half * PERIOD <= ordered[-1]]

"""Cars as they are measured, and relations by the direction between them."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from dyknow.streams.sample import Sample
from dyknow.streams.table import Table
from dyknow.time import SECOND, TimePoint
from networks.reading import read_road_map
from traffic.bundled import data_folder
from traffic.features.angular import AngularRelations
from traffic.features.unfiltered import UnfilteredCars

points = st.tuples(st.floats(-40, 40), st.floats(-40, 40))
angles = st.floats(-math.pi, math.pi)


def percepts(positions: list[tuple[float, float]], seconds: float) -> Sample[Table]:
    """Return percepts of so many cars at a time."""
    time = TimePoint(int(seconds * SECOND))
    n = len(positions)
    columns = {
        "position": np.array(positions, dtype=np.float64).reshape(n, 2),
        "observed_at": np.full(n, time, dtype=np.int64),
    }
    return Sample(Table("percept", np.arange(n), columns), time, time)


@pytest.fixture(scope="module")
def avenue():
    """Return the map of a straight avenue."""
    return read_road_map(data_folder() / "networks" / "avenue" / "avenue.net.xml")


@pytest.mark.parametrize("sign", [1, -1])
def test_forward_is_along_the_road_the_way_the_car_goes(avenue, sign):
    """The velocity is the difference of two positions; it decides between two directions."""
    unit = UnfilteredCars(avenue)
    road = 0
    start = avenue.point_at([road], np.array([50.0]))[0]
    heading = avenue.heading_at([road], np.array([50.0]))[0]
    step = sign * 5 * np.array([math.cos(heading + 0.3), math.sin(heading + 0.3)])

    first, second = percepts([tuple(start)], 0), percepts([tuple(start + step)], 0.5)
    (before,) = unit.push(first.valid_time, (first,))
    (after,) = unit.push(second.valid_time, (second,))

    assert before.value["speed"][0] == 0
    assert after.value["velocity"][0] == pytest.approx(step / 0.5)
    assert after.value["forward"][0] == pytest.approx(
        [sign * math.cos(heading), sign * math.sin(heading)], abs=0.02
    )


@settings(derandomize=True, deadline=None, max_examples=200)
@given(st.lists(st.tuples(points, angles), min_size=2, max_size=5))
def test_relations_are_quarters_of_the_circle(cars):
    """Pair by pair, the angle decides; each pair within reach has exactly one relation."""
    n = len(cars)
    columns = {
        "position": np.array([point for point, _ in cars]),
        "forward": np.array([(math.cos(a), math.sin(a)) for _, a in cars]),
    }
    sample = Sample(Table("car", np.arange(n), columns), TimePoint(0), TimePoint(0))
    (out,) = AngularRelations(distance=50).push(TimePoint(0), (sample,))
    found = {
        (int(first), int(second)): [name for name in names if out.value[name][row]]
        for names in [("behind", "in_front", "left", "right")]
        for row, (first, second) in enumerate(
            zip(out.value["first"], out.value["second"], strict=True)
        )
    }

    for i, ((x1, y1), forward) in enumerate(cars):
        for j, ((x2, y2), _) in enumerate(cars):
            near = i != j and math.hypot(x1 - x2, y1 - y2) <= 50
            assert ((i, j) in found) == near
            if not near or math.hypot(x1 - x2, y1 - y2) < 1e-6:
                continue
            turned = math.remainder(math.atan2(y1 - y2, x1 - x2) - forward, 2 * math.pi)
            degrees = math.degrees(turned)
            if min(abs(abs(degrees) - border) for border in (0, 45, 135, 180)) < 1e-6:
                continue
            expected = (
                "in_front" if abs(degrees) < 45 else "behind" if abs(degrees) > 135
                else "left" if degrees > 0 else "right"
            )  # fmt: skip
            assert found[i, j] == [expected]

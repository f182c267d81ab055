"""The definition of overtaking in the face of oncoming traffic, on hand-made cases."""

import numpy as np
import pytest

from dyknow.streams.table import Table
from dyknow.time import MILLISECOND, TimePoint
from networks.reading import read_road_map
from networks.roads import RoadMap
from tests.support.true_places import true_places
from traffic.bundled import data_folder
from traffic.sumo.simulation import Frame
from traffic.truth.facing_traffic import FacingTrafficWatcher
from traffic.truth.manoeuvres import TrueManoeuvre

STEP = 200 * MILLISECOND
SPEEDS = np.array([20.0, 10.0, 12.0])


@pytest.fixture(scope="module")
def avenue() -> RoadMap:
    """Return the map of an avenue along the x axis, on which the south side leads east."""
    return read_road_map(data_folder() / "networks" / "avenue" / "avenue.net.xml")


def watch(avenue: RoadMap, *, meeting: float, side: float = 1.75) -> list[TrueManoeuvre]:
    """Let car 0 pass car 1 at x = 0 and time 6 s, at y = *side*; it meets car 2 at *meeting*."""
    watcher, found = FacingTrafficWatcher(avenue), []
    for i in range(60):
        time = i * 0.2
        x = np.array([20.0 * (time - 6), 10.0 * (time - 6), 0.0])
        x[2] = 20.0 * (meeting - 6) + 12.0 * (meeting - time)
        aside = side if 3 <= time <= 9 else -1.75
        columns = {
            "position": np.column_stack([x, [aside, -1.75, 1.75]]),
            "heading": np.array([0.0, 0.0, np.pi]),
            "speed": SPEEDS,
            "length": np.full(3, 4.0),
        }
        vehicles = Table("vehicle", [0, 1, 2], columns)
        direction = np.array([1.0, 1.0, -1.0])
        places = true_places(
            3,
            link=np.zeros(3, dtype=np.int32),
            direction=direction,
            progress=direction * (x + 500.0),
        )
        frame = Frame(TimePoint(i * STEP), vehicles, Table("vehicle", [0, 1, 2], {}))
        found += watcher.observe(frame, places)
    return found + watcher.finish()


def test_who_is_on_the_other_side_four_seconds_before_meeting_faces_traffic(
    avenue: RoadMap,
) -> None:
    """It takes as long as the overtake, and names who comes."""
    (found,) = watch(avenue, meeting=10.0)

    assert (found.kind, found.vehicles) == ("overtake_facing_traffic", (0, 1, 2))
    assert 5 < found.begin / 1e9 < 6 < found.end / 1e9 < 7


def test_with_room_or_on_the_own_side_nobody_is_faced(avenue: RoadMap) -> None:
    """Who meets somebody six seconds after being back, or never left its side, had room."""
    assert watch(avenue, meeting=15.0) == []
    assert watch(avenue, meeting=10.0, side=-5.25) == []

"""Ground truth of recorded poses on the networks that come with the program."""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import cache

import numpy as np

from dyknow.streams.table import Table
from dyknow.time import SECOND, Duration, TimePoint
from networks.reading import read_road_map
from networks.roads import RoadMap
from traffic.bundled import data_folder
from traffic.sumo.simulation import Frame
from traffic.truth.ground_truth import GroundTruth
from traffic.truth.manoeuvres import TrueManoeuvre
from traffic.truth.watchers import WATCHERS

Pose = tuple[int, str, float, float, float]
"""Vehicle, lane, metres along it, metres to the left of it, speed."""

NO_TIME = Duration(0)
EVERYWHERE = np.array([[-2000, -2000], [2000, -2000], [2000, 2000], [-2000, 2000]])
NORTH_HALF = np.array([[-2000, 8], [2000, 8], [2000, 2000], [-2000, 2000]])
ELSEWHERE = np.array([[5000, 0], [6000, 0], [6000, 1000], [5000, 1000]])


@cache
def road_map(name: str) -> RoadMap:
    """Return the map of a bundled network."""
    return read_road_map(data_folder() / "networks" / name / f"{name}.net.xml")


def frames(name: str, moments: Sequence[Sequence[Pose]], lanes: list[str]) -> Iterator[Frame]:
    """Yield a frame each second in which vehicles of 4 m are on lanes."""
    columns = road_map(name).lane_columns
    for time, poses in enumerate(moments):
        ids, names, along, left, speed = zip(*poses, strict=True)
        lanes.extend(lane for lane in names if lane not in lanes)
        index = np.array([columns.names.index(lane) for lane in names])
        s, d = np.array(along), np.array(left)
        flip = np.array([speed_ < 0 for speed_ in speed])
        heading = columns.lines.heading_at(index, s) + np.where(flip, np.pi, 0.0)
        vehicles = {
            "position": columns.lines.at(index, s, d),
            "heading": heading,
            "speed": np.abs(speed),
            "length": np.full(len(ids), 4.0),
        }
        hidden = {"lane": np.array([lanes.index(lane) for lane in names], dtype=np.int32)}
        yield Frame(
            TimePoint(time * SECOND),
            Table("vehicle", ids, vehicles),
            Table("vehicle", ids, hidden),
        )


def watch(
    name: str,
    moments: Sequence[Sequence[Pose]],
    footprint: np.ndarray | None = None,
    margin: Duration = NO_TIME,
) -> list[TrueManoeuvre]:
    """Return the truth about the moments, a second apart: turns, and overtakes on either side."""
    lanes: list[str] = []
    wanted = [kind for kind in WATCHERS if kind.startswith("turn_") or kind == "overtake"]
    kinds = {kind: replace(WATCHERS[kind], margin=margin) for kind in wanted}
    truth = GroundTruth(road_map(name), lanes, kinds)
    for frame in frames(name, moments, lanes):
        truth.observe(frame, footprint)
    return truth.manoeuvres()


LEFT_TURN: list[list[Pose]] = [
    [(0, "north_centre_1", 100.0, 0.0, 8.0)],
    [(0, "north_centre_1", 110.0, 0.0, 8.0)],
    [(0, ":centre_3_0", 2.0, 0.0, 8.0)],
    [(0, ":centre_20_0", 8.0, 0.0, 8.0)],
    [(0, "centre_east_1", 2.0, 0.0, 8.0)],
    [(0, "centre_east_1", 12.0, 0.0, 8.0)],
]
PASSING: list[list[Pose]] = [
    [(0, "west_junction_0", 800.0, 0.0, 20.0), (1, "west_junction_0", 830.0, 0.0, 10.0)],
    [(0, "west_junction_0", 820.0, 0.0, 20.0), (1, "west_junction_0", 840.0, 0.0, 10.0)],
    [(0, "junction_west_0", 942.6, 0.0, -20.0), (1, "west_junction_0", 850.0, 0.0, 10.0)],
    [(0, "junction_west_0", 922.6, 0.0, -20.0), (1, "west_junction_0", 860.0, 0.0, 10.0)],
    [(0, "junction_west_0", 902.6, 0.0, -20.0), (1, "west_junction_0", 870.0, 0.0, 10.0)],
    [(0, "west_junction_0", 900.0, 0.0, 20.0), (1, "west_junction_0", 880.0, 0.0, 10.0)],
]


def test_a_left_turn_passes_two_lanes_inside_the_crossing() -> None:
    """A turn that SUMO splits into two internal lanes is one turn."""
    (found,) = watch("crossing", LEFT_TURN)

    assert found.kind == "turn_left"
    assert found.place == ("north-centre", "centre", "east-centre")
    assert (found.begin, found.end, found.in_view) == (2 * SECOND, 4 * SECOND, True)


def test_an_overtaker_on_the_opposite_lane_stays_on_its_link() -> None:
    """Positions along the link do not jump when SUMO puts a car on the other direction's lane."""
    (found,) = watch("rural", PASSING)

    assert (found.kind, found.vehicles) == ("overtake", (0, 1))
    assert (found.begin, found.end) == (2 * SECOND, 4 * SECOND)


def test_oncoming_cars_overtake_nobody() -> None:
    """Cars that meet travel in different directions."""
    meeting: list[list[Pose]] = [
        [
            (0, "west_junction_0", 800.0 + 20 * i, 0.0, 20.0),
            (1, "junction_west_0", 930.0 + 20 * i, 0.0, 20.0),
        ]
        for i in range(6)
    ]

    assert watch("rural", meeting) == []


def test_a_manoeuvre_is_in_view_if_its_vehicles_are_all_the_while() -> None:
    """What a footprint covers from begin to end counts, nothing less."""
    (whole,) = watch("crossing", LEFT_TURN, EVERYWHERE)
    (cut,) = watch("crossing", LEFT_TURN, NORTH_HALF)
    (away,) = watch("crossing", LEFT_TURN, ELSEWHERE)

    assert [whole.in_view, cut.in_view, away.in_view] == [True, False, False]


def test_a_margin_asks_for_more_than_the_manoeuvre() -> None:
    """With a margin, the time before and after has to be in view as well."""
    moments = [*LEFT_TURN, LEFT_TURN[-1]]

    (enough,) = watch("crossing", moments, EVERYWHERE, Duration(2 * SECOND))
    (too_short,) = watch("crossing", moments, EVERYWHERE, Duration(3 * SECOND))

    assert [enough.in_view, too_short.in_view] == [True, False]


def test_only_what_is_wanted_is_known() -> None:
    """Of the kinds that one watcher tells, those that nobody asked for are left out."""
    lanes: list[str] = []
    truth = GroundTruth(road_map("rural"), lanes, {"overtake_left": WATCHERS["overtake_left"]})
    for frame in frames("rural", PASSING, lanes):
        truth.observe(frame)

    assert [each.kind for each in truth.manoeuvres()] == ["overtake_left"]

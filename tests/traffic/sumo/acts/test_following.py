"""Drivers keep the time gaps that they were told."""

from pathlib import Path

import numpy as np
import pytest

from dyknow.time import SECOND, Duration
from networks.reading import read_road_map
from tests.support.staging import frames, rural
from traffic.scenarios import find_scenario
from traffic.scenarios.acts import AnyAct
from traffic.scenarios.acts.following import CloseUp, Column, Tail, Tailgate

pytestmark = pytest.mark.sumo

COMMON = {"types": {"car": 1}, "route": ("west_junction",), "times": (0,)}


def seconds(value: float) -> tuple[Duration, Duration]:
    """Return a range of one duration."""
    return Duration(round(value * SECOND)), Duration(round(value * SECOND))


def time_gaps(act: AnyAct, folder: Path, n: int) -> np.ndarray:
    """Return the time gaps in a row of *n* vehicles, frame by frame, once all have come in."""
    road_map = read_road_map(find_scenario("rural").network or "")
    run, _ = frames(rural(act, seconds=40), folder)
    rows = []
    for frame in run:
        vehicles = frame.vehicles
        if len(vehicles) == n:
            road = np.full(n, road_map.roads.index("west_junction"))
            s, _ = road_map.project(vehicles["position"], road)
            length, speed = vehicles["length"], vehicles["speed"]
            rows.append((s[:-1] - s[1:] - (length[:-1] + length[1:]) / 2) / speed[1:])
    return np.array(rows)


def test_who_tailgates_comes_close_and_stays_so(tmp_path: Path) -> None:
    """After some seconds the time gap is what was said, and never less."""
    act = Tailgate(kind="tailgate", speed=(12, 12), time_gap=seconds(0.4), **COMMON)

    gaps = time_gaps(act, tmp_path, 2)

    assert gaps[-100:] == pytest.approx(0.4, abs=0.06)
    assert gaps.min() > 0.3


def test_a_column_keeps_its_gaps(tmp_path: Path) -> None:
    """Each vehicle is at its time gap behind the one ahead."""
    act = Column(kind="column", speed=(9, 9), number=(4, 4), time_gap=seconds(1.5), **COMMON)

    gaps = time_gaps(act, tmp_path, 4)

    assert gaps.shape[1] == 3
    assert gaps[-50:] == pytest.approx(1.5, abs=0.15)


def test_who_closes_up_does_so_for_a_moment(tmp_path: Path) -> None:
    """The time gap falls to what was said and rises again."""
    act = CloseUp(
        kind="close_up", speed=(11, 11), distance=seconds(1.6), time_gap=seconds(0.6),
        moment=seconds(0.5), pause=seconds(6), **COMMON,
    )  # fmt: skip

    (gaps,) = time_gaps(act, tmp_path, 2).T

    nearest = int(np.argmin(gaps[:200]))
    assert gaps[nearest] == pytest.approx(0.6, abs=0.08)
    assert np.count_nonzero(gaps[:200] < 0.7) < 35
    assert gaps[:nearest].max() > 1.4
    assert gaps[nearest:].max() > 1.3


def test_a_tail_comes_in_some_time_later(tmp_path: Path) -> None:
    """The second vehicle is there when the lag is over, on its own route."""
    act = Tail(
        kind="tail", lag=seconds(4), tail_route=("junction_west",),
        **COMMON | {"route": ("west_junction",)},
    )  # fmt: skip

    run, _ = frames(rural(act, seconds=12), tmp_path)

    counts = [len(frame.vehicles) for frame in run]
    first, second = counts.index(1), counts.index(2)
    assert (second - first) / 10 == pytest.approx(4, abs=0.3)
    (x, _), (other, _) = run[second].vehicles["position"]
    assert x < 0 < other

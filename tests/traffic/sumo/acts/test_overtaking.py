"""Drivers who overtake, break it off, or keep beside another do what was said."""

from pathlib import Path

import numpy as np
import pytest

from dyknow.time import SECOND, Duration
from tests.support.staging import CAR, frames
from traffic.scenarios import Scenario, find_scenario
from traffic.scenarios.acts import AnyAct
from traffic.scenarios.acts.overtaking import AbortOvertake, DriveBeside, Oncoming, Overtake
from traffic.sumo.simulation import Frame

pytestmark = pytest.mark.sumo

WHO = {
    "types": {"car": 1}, "others": {"car": 1}, "route": ("west_east",), "times": (0,),
    "speed": (10, 10), "place": (150, 150), "gap": (8, 8), "aside": 3.5,
    "going": (Duration(2 * SECOND),) * 2,
}  # fmt: skip


def avenue(act: AnyAct, folder: Path, seconds: int = 45) -> list[Frame]:
    """Return the frames of an act on an avenue without other traffic."""
    network = find_scenario("overtaking").network
    scenario = Scenario(
        name="overtaking", network=network, duration=Duration(seconds * SECOND),
        step_length=Duration(SECOND // 10), vehicle_types=(CAR,), acts=(act,),
    )  # fmt: skip
    return frames(scenario, folder)[0]


def placed(run: list[Frame]) -> tuple[np.ndarray, np.ndarray]:
    """Return how far the second vehicle is ahead of the first, and to its left, frame by frame."""
    both = [frame.vehicles["position"][:2] for frame in run if len(frame.vehicles) >= 2]
    offset = np.array([position[1] - position[0] for position in both])
    return offset[:, 0], offset[:, 1]


def seconds(duration: float) -> tuple[Duration, Duration]:
    """Return a range of one duration."""
    return (Duration(int(duration * SECOND)),) * 2


def test_who_overtakes_goes_aside_passes_and_comes_back(tmp_path: Path) -> None:
    """Smoothly, beside the other by what was said, and on its lane when it is in front."""
    run = avenue(Overtake(kind="overtake", faster=(6, 6), ahead=(8, 8), **WHO), tmp_path)

    ahead, left = placed(run)
    beside = np.abs(ahead) < 3.5
    assert beside.any()
    np.testing.assert_allclose(left[beside], 3.5, atol=0.1)
    np.testing.assert_allclose(left[ahead > 40], 0.0, atol=0.3)
    assert np.abs(np.diff(left)).max() < 0.5


def test_who_comes_towards_meets_the_driver_in_time(tmp_path: Path) -> None:
    """About so long after the driver begins to come back."""
    oncoming = Oncoming(
        types={"car": 1}, route=("east_west",), lane=1, speed=(12, 12), spare=seconds(3)
    )
    act = Overtake(kind="overtake", faster=(6, 6), ahead=(8, 8), oncoming=oncoming, **WHO)
    run = avenue(act, tmp_path)

    gap, offset, times = [], [], []
    for frame in run:
        if len(frame.vehicles) >= 3:
            x = frame.vehicles["position"]
            gap.append(x[2, 0] - x[1, 0])
            offset.append(x[1, 1] - x[0, 1])
            times.append(frame.time / SECOND)
    returning = next(i for i in range(len(gap)) if i and max(offset[:i]) > 3.4 > offset[i])
    met = next(i for i, each in enumerate(gap) if each < 0)
    assert times[met] - times[returning] == pytest.approx(3.0, abs=0.8)


def test_who_comes_makes_room_for_who_is_on_its_side(tmp_path: Path) -> None:
    """Both pass each other side by side, although the driver is not back on its lane yet."""
    oncoming = Oncoming(
        types={"car": 1}, route=("east_west",), lane=1, speed=(12, 12), spare=seconds(0.5)
    )
    who = {**WHO, "lane": 1}
    act = Overtake(kind="overtake", faster=(6, 6), ahead=(8, 8), oncoming=oncoming, **who)
    run = avenue(act, tmp_path)

    met = [frame.vehicles for frame in run if len(frame.vehicles) >= 3]
    offset = np.array([cars["position"][2] - cars["position"][1] for cars in met])
    level = np.abs(offset[:, 0]) < 6
    assert level.any()
    assert offset[level, 1].min() > 2.2
    assert min(cars["speed"][2] for cars in met) > 3.5


def test_who_breaks_off_gets_level_and_falls_back_as_often_as_drawn(tmp_path: Path) -> None:
    """Never in front, and behind the other on its lane in between."""
    act = AbortOvertake(
        kind="abort_overtake", attempts=(2, 2), level=(-1, -1), faster=(4, 4),
        staying=seconds(1), waiting=seconds(1.5), **WHO,
    )  # fmt: skip
    ahead, left = placed(avenue(act, tmp_path, 50))

    level = (ahead > -3).astype(int)
    assert np.count_nonzero(np.diff(level) == 1) == 2
    assert ahead[: np.flatnonzero(level)[-1]].max() < 4.0
    np.testing.assert_allclose(left[ahead > -4], 3.5, atol=0.2)


def test_who_keeps_beside_stays_within_the_sway(tmp_path: Path) -> None:
    """Neither overtakes nor falls back."""
    act = DriveBeside(
        kind="drive_beside", sway=(2, 2), period=seconds(8), duration=seconds(15), **WHO
    )
    ahead, left = placed(avenue(act, tmp_path))

    beside = left > 3.4
    assert np.count_nonzero(beside) > 150
    assert np.abs(ahead[beside][30:]).max() < 3.5

"""A system at work tells what went wrong, and keeps to a pace without another outcome."""

import numpy as np
import pytest

from dyknow.errors import ProcessError
from dyknow.runtime.clock import WallClock
from dyknow.time import MILLISECOND, SECOND, Duration
from networks.reading import read_road_map
from tests.support.standing_cars import StandingCars
from traffic.bundled import data_folder
from traffic.system import MonitoringSystem, specification_from
from traffic.watching import Told, Watch
from traffic.world import World

CROSSING = data_folder() / "networks" / "crossing" / "crossing.net.xml"
PERCEPTS = """
source vehicles vehicles
strmgen vehicles = vehicles
compunit percepts NoisyPositions(vehicles)
"""


def watched(text, seconds=1, **options):
    """Let a system of three standing cars run for some seconds; return its result."""
    world = World(read_road_map(CROSSING), StandingCars(), None, np.random.default_rng(1))
    specification = specification_from(PERCEPTS + text, "x.kpl")
    system = MonitoringSystem(world, {}, specification=specification)
    told = Told("x", {}, duration=Duration(seconds * SECOND), deadline=Duration(40 * MILLISECOND))
    return Watch(system, None).complete(told, lambda *_: None, **options)


def test_violations_are_counted_by_stream():
    """Frames come every 40 ms, so that every 30 ms one is missing; each is counted once."""
    result = watched("""
        strmgen percepts[a] = NoisyPositions(vehicles with sample every 30, error = 0)
        strmgen percepts[b] = NoisyPositions(vehicles, error = 0)
        stream a = percepts[a] with any update
        stream b = percepts[b] with sample every 40, max delay 0
        """)

    assert set(result.violations) == {"percepts[a]/1"}
    assert result.violations["percepts[a]/1"] > 10


def test_a_process_that_fails_and_ends_is_told():
    """The rest goes on, where the specification says so; without that the run ends."""
    text = """
        compunit any StableFor(any)
        strmgen percepts = NoisyPositions(vehicles, error = 0)
        strmgen steady = StableFor(percepts, columns = nothing, duration = 1){}
        stream percepts = percepts
        stream steady = steady
        """
    result = watched(text.replace("{}", " on failure end"))

    (failure,) = result.failures
    assert failure.startswith("process 'steady' failed at 0 ms: KeyError: 'nothing'")
    with pytest.raises(ProcessError, match="'steady' failed at 0 ms"):
        watched(text.replace("{}", ""))


def test_real_time_changes_nothing_but_the_pace():
    """A second takes a second; how late the work was done is measured."""
    text = "strmgen percepts = NoisyPositions(vehicles, error = 3)\nstream p = percepts"
    fast, paced = watched(text), watched(text, real_time=True)

    assert fast.timing.lateness is None
    assert paced.timing.lateness is not None
    assert paced.timing.lateness.max_ms >= paced.timing.lateness.mean_ms >= 0
    assert paced.timing.wall_s >= 1
    assert fast.model_copy(update={"timing": None}) == paced.model_copy(update={"timing": None})


class _Late(WallClock):
    """A clock by which all work is late, and for which nobody waits."""

    def await_instant(self, instant):
        """Return at once."""

    def finish(self, instant):
        """Call the work 100 ms late."""
        self.last_lateness = Duration(100 * MILLISECOND)


def test_work_that_falls_behind_lets_streams_stand_back(monkeypatch):
    """After a second of being late a stream is sampled less often, if it says that it may be."""
    monkeypatch.setattr("traffic.watching.WallClock", _Late)
    text = """
        parameter slack = 40
        strmgen percepts = NoisyPositions(
            vehicles with sample every 40 up to slack under load, error = 0)
        stream p = percepts
        """
    firm = watched(text, seconds=3, real_time=True)
    yielding = watched(text.replace("slack = 40", "slack = 80"), seconds=3, real_time=True)

    assert firm.timing.lateness.period_changes == 0
    assert yielding.timing.lateness.period_changes == 1
    assert yielding.violations == {}

"""Frames that are kept and played again."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from dyknow.streams.table import Table
from dyknow.streams.values import are_equal
from dyknow.time import MILLISECOND, TimePoint
from traffic.sumo.replayed import FrameKeeper, FramePacer, ReplayedSimulation
from traffic.sumo.simulation import Frame

VEHICLES = st.lists(st.sets(st.integers(0, 4)), max_size=6)


class Simulation:
    """Vehicles that come and go, each numbered when it comes, on lanes that are named likewise."""

    def __init__(self, frames):
        self.names: list[str] = []
        self.lanes: list[str] = []
        self._frames = list(frames)
        self._n_steps = 0

    def step(self):
        """Return the next frame."""
        if self._n_steps == len(self._frames):
            return None
        names = sorted(f"v{number}" for number in self._frames[self._n_steps])
        self.names += [name for name in names if name not in self.names]
        lane = f"lane{self._n_steps % 2}"
        if lane not in self.lanes:
            self.lanes.append(lane)
        ids = [self.names.index(name) for name in names]
        n = len(ids)
        time = TimePoint(self._n_steps * 40 * MILLISECOND)
        self._n_steps += 1
        return Frame(
            time,
            Table("vehicle", ids, {"position": np.full((n, 2), self._n_steps / 7)}),
            Table(
                "vehicle",
                ids,
                {
                    "lane": np.full(n, self.lanes.index(lane), dtype=np.int32),
                    "lane_position": np.arange(n) / 3,
                },
            ),
        )

    def close(self):
        """Nothing is held."""


def frames_of(simulation):
    """Yield all frames with the names that are known at each."""
    while (frame := simulation.step()) is not None:
        yield frame, list(simulation.names), list(simulation.lanes)


@settings(derandomize=True, deadline=None, max_examples=50)
@given(VEHICLES)
def test_a_replay_gives_the_same_frames_and_names(vehicles):
    """What comes back is what was kept, and names are known no earlier and no later."""
    simulation = Simulation(vehicles)
    keeper = FrameKeeper(simulation)
    samples = []
    while (frame := simulation.step()) is not None:
        samples.append(keeper.sample(frame))

    replayed = list(frames_of(ReplayedSimulation(iter(samples))))
    original = list(frames_of(Simulation(vehicles)))

    assert len(replayed) == len(original)
    for (one, *names), (other, *others) in zip(replayed, original, strict=True):
        assert one.time == other.time
        assert are_equal(one.vehicles, other.vehicles)
        assert are_equal(one.hidden, other.hidden)
        assert names == others


def test_a_closed_replay_is_over():
    """After closing there are no more frames."""
    simulation = Simulation([{1}])
    sample = FrameKeeper(simulation).sample(simulation.step())
    replay = ReplayedSimulation(iter([sample]))

    replay.close()

    assert replay.step() is None


@settings(derandomize=True, deadline=None, max_examples=100)
@given(VEHICLES, st.lists(st.integers(0, 300), max_size=8).map(sorted))
def test_frames_are_shown_at_the_pace_of_a_run(vehicles, instants):
    """At an instant those are known that a source would have been asked for before it."""
    frames: list[Frame] = []
    pacer = FramePacer(Simulation(vehicles), [frames.append])
    times = [40 * step for step in range(len(vehicles))]

    for now in instants:
        pacer.advance(TimePoint(now * MILLISECOND))
        known = len([time for time in times if time < now]) + 1
        assert [frame.time for frame in frames] == [t * MILLISECOND for t in times[:known]]
    pacer.finish()

    assert len(frames) == len(vehicles)

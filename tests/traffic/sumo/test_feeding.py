"""One simulation as several sources."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from dyknow.streams.table import Table
from dyknow.time import TimePoint
from networks.signals import Signals, SignalState
from traffic.sumo.feeding import FrameFeed, SignalMemory
from traffic.sumo.simulation import Frame

LANES = ("a_0", "b_0", "c_0")
"""As the simulator numbers them; the map knows two of them, and another one."""

SIGNALS = Signals(
    names=("b_0", "a_0", "d_0"),
    lane=np.arange(3),
    crossing=np.zeros(3, dtype=np.int32),
    lines=np.zeros((3, 2, 2)),
    heading=np.zeros(3),
)


def frame(number, states):
    """Return a frame in which the signals of all lanes show *states*."""
    nobody = Table("vehicle", (), {})
    signals = Table("signal", (0, 1, 2), {"state": np.array(states, dtype=np.int8)})
    return Frame(TimePoint(number * 40), nobody, nobody, signals)


class Simulation:
    """Gives certain frames."""

    lanes = LANES
    names = ()

    def __init__(self, frames):
        self._frames = iter(frames)
        self.n_steps = 0

    def step(self):
        """Return the next frame."""
        self.n_steps += 1
        return next(self._frames, None)

    def close(self):
        """Hold nothing."""


@settings(derandomize=True, deadline=None, max_examples=100)
@given(st.lists(st.tuples(*[st.sampled_from(list(SignalState))] * 3), min_size=1, max_size=8))
def test_each_signal_has_been_so_since_it_last_changed(history):
    """In the order of the map; what the simulator does not know is off."""
    memory = SignalMemory(LANES, SIGNALS)
    for i, states in enumerate(history):
        table = memory.table(frame(i, states))

        known = [[each[1] for each in history], [each[0] for each in history]]
        for row, shown in enumerate(known):
            so_far = [SignalState.OFF, *shown[: i + 1]]
            changes = [k for k in range(1, len(so_far)) if so_far[k] != so_far[k - 1]]
            assert table["state"][row] == so_far[-1]
            assert table["since"][row] == (40 * (changes[-1] - 1) if changes else 0)
        assert table["state"][2] == SignalState.OFF
        assert table.ids.tolist() == [0, 1, 2]


@settings(derandomize=True, deadline=None, max_examples=50)
@given(st.integers(0, 5), st.randoms(use_true_random=False))
def test_both_sources_get_all_frames_whoever_asks_first(count, random):
    """The simulation makes each step once, and observers see it before anyone else."""
    simulation = Simulation([frame(i, (1, 2, 3)) for i in range(count)])
    feed = FrameFeed(simulation, SIGNALS)
    seen = []
    feed.observers.append(lambda each: seen.append(each.time))
    sources = {"vehicles": feed.vehicles.samples(), "signals": feed.signals.samples()}
    got = {name: [] for name in sources}
    asked = {name: next(source, None) for name, source in sources.items()}
    while any(sample is not None for sample in asked.values()):
        name = random.choice([name for name, sample in asked.items() if sample is not None])
        got[name].append(asked[name].valid_time)
        assert asked[name].valid_time in seen
        asked[name] = next(sources[name], None)

    assert got["vehicles"] == got["signals"] == seen == [40 * i for i in range(count)]

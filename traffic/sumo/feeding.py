"""One simulation as several sources: vehicles and signals, step by step together."""

from collections import deque
from collections.abc import Callable, Iterator, Sequence

import numpy as np
import numpy.typing as npt

from dyknow.streams.process import Source
from dyknow.streams.sample import Sample
from dyknow.streams.table import Column, Table
from dyknow.time import TimePoint
from networks.signals import Signals, SignalState
from traffic.sumo.simulation import SIGNAL, Frame, Simulation

__all__ = ["FrameFeed", "SignalMemory"]


class FrameFeed:
    """Shows the frames of a simulation to sources and observers; whoever asks first makes a step.

    Attributes:
        vehicles: The source of the tables of vehicles.
        signals: The source of the tables of signals, as `SignalMemory` makes them.
        observers: Who is shown each frame before it enters the network.

    Args:
        simulation: Where the frames come from.
        signals: Of the map.
    """

    def __init__(self, simulation: Simulation, signals: Signals) -> None:
        self.observers: list[Callable[[Frame], None]] = []
        self._simulation = simulation
        self._current: Frame | None = None
        self._waiting: list[deque[Frame]] = []
        memory = SignalMemory(simulation.lanes, signals)
        self.vehicles: Source = _Part(self, lambda frame: frame.vehicles)
        self.signals: Source = _Part(self, memory.table)

    def frames(self) -> Iterator[Frame]:
        """Yield every frame; who asks late begins with the one that was made last."""
        mine: deque[Frame] = deque() if self._current is None else deque([self._current])
        self._waiting.append(mine)
        while mine or self._step():
            yield mine.popleft()

    def _step(self) -> bool:
        """Let everyone have the next frame, and return whether there is one."""
        frame = self._simulation.step()
        if frame is None:
            return False
        self._current = frame
        for observe in self.observers:
            observe(frame)
        for waiting in self._waiting:
            waiting.append(frame)
        return True


class SignalMemory:
    """Makes a table of the signals of a map of each frame.

    The id is the number of the signal on the map. Columns: `state` (n,), int8, what it shows, a
    `SignalState`; `since` (n,), int64, time of the frame in which it began to; `observed` (n,),
    all true. A signal of which the simulator knows nothing is off.

    Args:
        lanes: Name of each lane number of the frames; may grow.
        signals: Of the map.
    """

    def __init__(self, lanes: Sequence[str], signals: Signals) -> None:
        n = len(signals)
        self._lanes = lanes
        self._row = {name: row for row, name in enumerate(signals.names)}
        self._ids = np.arange(n, dtype=np.int64)
        self._state = np.full(n, SignalState.OFF, dtype=np.int8)
        self._since = np.zeros(n, dtype=np.int64)
        self._known: tuple[npt.NDArray[np.int64], npt.NDArray[np.intp]] | None = None

    def table(self, frame: Frame) -> Table:
        """Return the table of a frame; all frames, in order."""
        rows = self._rows(frame.signals.ids)
        state = self._state.copy()
        state[rows[rows >= 0]] = frame.signals["state"][rows >= 0]
        changed = state != self._state
        self._since = np.where(changed, frame.time, self._since)
        self._state = state
        columns: dict[str, Column] = {
            "state": state,
            "since": self._since,
            "observed": np.ones(len(state), dtype=np.bool_),
        }
        return Table(SIGNAL, self._ids, columns)

    def _rows(self, lanes: npt.NDArray[np.int64]) -> npt.NDArray[np.intp]:
        """Return the signal on the map of each lane number, or -1."""
        if self._known is None or not np.array_equal(self._known[0], lanes):
            rows = [self._row.get(self._lanes[lane], -1) for lane in lanes.tolist()]
            self._known = lanes, np.array(rows, dtype=np.intp)
        return self._known[1]


class _Part:
    """A source of what one sort of processes wants of each frame."""

    def __init__(self, feed: FrameFeed, part: Callable[[Frame], Table]) -> None:
        self._feed = feed
        self._part = part

    def samples(self) -> Iterator[Sample[Table]]:
        """Yield a part of each frame, available at once."""
        for frame in self._feed.frames():
            time = TimePoint(frame.time)
            yield Sample(self._part(frame), time, time)

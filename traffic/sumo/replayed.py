"""A simulation that took place before: kept as samples, and played again for the score.

What is kept holds the truth, so it stands in a stream of its own, which no process may take:
only scoring reads it.
"""

from collections.abc import Callable, Iterator, Sequence
from typing import Any

from dyknow.streams.sample import Sample
from dyknow.streams.table import Table
from dyknow.time import TimePoint
from traffic.sumo.simulation import VEHICLE, Frame, Simulation

__all__ = ["TRUTH", "FrameKeeper", "FramePacer", "ReplayedSimulation"]

TRUTH = "truth/vehicles"
"""The name of the stream in which frames are kept."""

_HIDDEN = ("lane", "lane_position")

Kept = tuple[Table, tuple[str, ...], tuple[str, ...], Table]
"""The columns of both tables of a frame, the names of vehicles and lanes that are new, and the
signals, which recordings of earlier versions do not have."""


class FrameKeeper:
    """Turns the frames of a simulation into samples that can be kept.

    Args:
        simulation: Where the frames come from; it names vehicles and lanes.
    """

    def __init__(self, simulation: Simulation) -> None:
        self._simulation = simulation
        self._n_names = 0
        self._n_lanes = 0

    def sample(self, frame: Frame) -> Sample[Kept]:
        """Return the sample of the next frame."""
        names = tuple(self._simulation.names[self._n_names :])
        lanes = tuple(self._simulation.lanes[self._n_lanes :])
        self._n_names += len(names)
        self._n_lanes += len(lanes)
        table = frame.vehicles.with_columns(**frame.hidden.columns)
        return Sample((table, names, lanes, frame.signals), frame.time, frame.time)


class ReplayedSimulation:
    """The same frames again (`traffic.sumo.simulation.Simulation`).

    Args:
        samples: As a `FrameKeeper` made them, in their order; read lazily.
    """

    def __init__(self, samples: Iterator[Sample[Any]]) -> None:
        self._samples = samples
        self._names: list[str] = []
        self._lanes: list[str] = []

    @property
    def names(self) -> Sequence[str]:
        """The simulator's own id of each vehicle, by the id in the tables."""
        return self._names

    @property
    def lanes(self) -> Sequence[str]:
        """The name of each lane, by its number in frames."""
        return self._lanes

    def step(self) -> Frame | None:
        """Return the next frame, or None after the last."""
        sample = next(self._samples, None)
        if sample is None:
            return None
        table, names, lanes, *signals = sample.value
        self._names += names
        self._lanes += lanes
        seen = {name: column for name, column in table.columns.items() if name not in _HIDDEN}
        hidden = {name: table[name] for name in _HIDDEN}
        return Frame(
            sample.valid_time,
            Table(VEHICLE, table.ids, seen),
            Table(VEHICLE, table.ids, hidden),
            *signals,
        )

    def close(self) -> None:
        """End the replay."""
        self._samples = iter(())


class FramePacer:
    """Shows the frames of a replay to those who know the truth, at the pace of a run.

    A simulation that feeds a network is asked for its next frame when all work at the time of
    the last one is done. So, between two frames, the later one is known already.

    Args:
        simulation: Where the frames come from.
        observers: Who is shown them.
    """

    def __init__(
        self, simulation: Simulation, observers: Sequence[Callable[[Frame], None]]
    ) -> None:
        self._simulation = simulation
        self._observers = observers
        self._last = TimePoint(-1)
        self._has_ended = False

    def advance(self, now: TimePoint) -> None:
        """Show the frames up to the first one that is not before *now*."""
        while self._last < now and not self._has_ended:
            self._show()

    def finish(self) -> None:
        """Show all other frames."""
        while not self._has_ended:
            self._show()

    def _show(self) -> None:
        frame = self._simulation.step()
        if frame is None:
            self._has_ended = True
            return
        self._last = frame.time
        for observe in self._observers:
            observe(frame)

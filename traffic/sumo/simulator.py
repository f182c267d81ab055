"""SUMO in this process, read once per step into columns.

The plain getters of libsumo are faster than its subscriptions (so says SUMO's issue 14101 too),
and what never changes is asked once per vehicle. One simulation per process.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import numpy.typing as npt

from dyknow.streams.table import Table
from dyknow.time import SECOND, Duration, TimePoint, text_from_duration
from traffic.errors import SimulatorError
from traffic.scenarios.model import VehicleType
from traffic.sumo.acts.director import Beginning, Director
from traffic.sumo.acts.stage import Stage
from traffic.sumo.bodies import Bodies
from traffic.sumo.colours import random_colours
from traffic.sumo.libraries import load_simulator
from traffic.sumo.output import CapturedOutput
from traffic.sumo.signals import SignalReader
from traffic.sumo.simulation import VEHICLE, Frame, class_code, headings_of

__all__ = ["SumoSettings", "SumoSimulation"]

_NO_POSITION = -1e9
_DEFAULT_COLOUR = (255, 255, 0)


@dataclass(frozen=True, slots=True)
class SumoSettings:
    """How a simulator is run.

    Attributes:
        configuration: SUMO's configuration file, which says everything else.
        messages: File for what SUMO prints.
        step_length: Simulated time between two frames.
        duration: When the last frame is due, from time 0.
        warm_up: How long SUMO runs before time 0.
        vehicle_types: Of vehicles that come in with acts; SUMO has been given their base types.
        acts: When which acts begin.
    """

    configuration: Path
    messages: Path
    step_length: Duration
    duration: Duration
    warm_up: Duration
    vehicle_types: Sequence[VehicleType] = ()
    acts: Sequence[Beginning] = ()


class SumoSimulation:
    """A running SUMO (`traffic.sumo.simulation.Simulation`).

    Time 0 is the begin that the configuration names, plus the warm-up. The frame of a time holds
    what SUMO's own output files hold for it. Close it, best in a `with` block: SUMO writes its
    files when it ends.

    Args:
        settings: What to run.
        colours: Draws a colour for each vehicle whose type has none of its own.

    Raises:
        SimulatorError: SUMO cannot start; what it said is part of the message.
    """

    def __init__(self, settings: SumoSettings, colours: np.random.Generator) -> None:
        self._settings = settings
        self._output: CapturedOutput | None = CapturedOutput(settings.messages)
        self._libsumo = load_simulator()
        self._faults = (self._libsumo.TraCIException, self._libsumo.FatalTraCIError)
        self._lanes = _Numbers()
        self._vehicles = _Vehicles(self._libsumo, self._lanes, colours)
        self._director = Director(settings.acts)
        step_length = settings.step_length / SECOND
        self._stage = Stage(self._libsumo, settings.vehicle_types, step_length)
        self._n_steps = 0
        self._call("SUMO cannot start", self._start)

    @property
    def names(self) -> Sequence[str]:
        """SUMO's id of each vehicle, by the id in the tables."""
        return self._vehicles.names

    @property
    def lanes(self) -> Sequence[str]:
        """SUMO's id of each lane, by its number in frames."""
        return self._lanes.names

    @property
    def time(self) -> TimePoint:
        """The time of the next frame."""
        return TimePoint(self._n_steps * self._settings.step_length)

    def step(self) -> Frame | None:
        """Let SUMO compute the next step and return it, or None after the last.

        Raises:
            SimulatorError: SUMO gave up.
        """
        if self._output is None or self.time > self._settings.duration:
            return None
        at = text_from_duration(self.time)
        frame: Frame = self._call(f"SUMO failed at {at} ms", self._advance)
        self._n_steps += 1
        return frame

    def close(self) -> None:
        """End SUMO, which then completes its files."""
        if self._output is None:
            return
        self._stage.end()
        try:
            with self._output.capture():
                self._libsumo.close()
        except self._faults as error:
            raise SimulatorError("SUMO failed at its end", [str(error)]) from error
        finally:
            self._output.close()
            self._output = None

    def __enter__(self) -> "SumoSimulation":
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _start(self) -> None:
        settings = self._settings
        step = f"{settings.step_length / SECOND:.9f}".rstrip("0")
        self._libsumo.start(
            ["sumo", "-c", str(settings.configuration), "--step-length", step, "--no-step-log"]
        )
        self._signals = SignalReader(self._libsumo, self._lanes.of)
        n_before = settings.warm_up // settings.step_length
        for i in range(-n_before, 0):
            self._step_to(TimePoint(i * settings.step_length))

    def _step_to(self, time: TimePoint) -> None:
        """Let SUMO make the frame of *time*, after the acts have had their say."""
        if self._settings.acts:
            self._director.step(self._stage, time / SECOND)
        self._libsumo.simulationStep()

    def _advance(self) -> Frame:
        self._step_to(self.time)
        return self._vehicles.read(self.time, self._signals.read())

    def _call(self, doing: str, function: Any) -> Any:
        """Call *function*; if SUMO objects, end SUMO and say all it said."""
        if self._output is None:
            raise SimulatorError("the simulation is closed")
        try:
            with self._output.capture():
                return function()
        except self._faults as error:
            detail = [*str(error).splitlines(), *self._output.lines()]
            self._abandon()
            said = [line.strip() for line in dict.fromkeys(detail) if line.strip()]
            raise SimulatorError(doing, said) from error
        except SimulatorError:  # of an act
            self._abandon()
            raise

    def _abandon(self) -> None:
        try:
            self.close()
        except SimulatorError:
            return  # the first error is the one that matters


class _Vehicles:
    """Reads the state of all vehicles; remembers what never changes."""

    def __init__(
        self, libsumo: ModuleType, lanes: "_Numbers", colours: np.random.Generator
    ) -> None:
        self._api: Any = libsumo.vehicle
        self._generator = colours
        self._lanes = lanes
        self.names: list[str] = []
        self._number: dict[str, int] = {}
        self._size = np.empty((64, 3))
        self._colour = np.empty((64, 3), dtype=np.uint8)
        self._class = np.empty(64, dtype=np.int8)
        self._bodies = Bodies()

    def read(self, time: TimePoint, signals: Table) -> Frame:
        """Return the state of all vehicles that are somewhere, and of *signals*."""
        api = self._api
        names: Sequence[str] = api.getIDList()
        numbers = self._numbers(names)
        front = np.array(list(map(api.getPosition, names)), dtype=np.float64).reshape(-1, 2)
        angle = np.array(list(map(api.getAngle, names)), dtype=np.float64)
        speed = np.array(list(map(api.getSpeed, names)), dtype=np.float64)
        along = np.array(list(map(api.getLanePosition, names)), dtype=np.float64)
        lane = np.array([*map(self._lanes.of, map(api.getLaneID, names))], dtype=np.int32)
        length, width, height = self._size[numbers].T
        heading = self._bodies.headings(numbers, front, headings_of(angle), length)
        forward = np.column_stack([np.cos(heading), np.sin(heading)])
        vehicles = Table(
            VEHICLE,
            numbers,
            {
                "position": front - forward * (length / 2)[:, None],
                "heading": heading,
                "speed": speed,
                "length": length,
                "width": width,
                "height": height,
                "colour": self._colour[numbers],
                "vehicle_class": self._class[numbers],
            },
        )
        hidden = Table(VEHICLE, numbers, {"lane": lane, "lane_position": along})
        somewhere = front[:, 0] > _NO_POSITION
        if not somewhere.all():
            vehicles, hidden = vehicles.select(somewhere), hidden.select(somewhere)
        return Frame(time, vehicles, hidden, signals)

    def _numbers(self, names: Sequence[str]) -> npt.NDArray[np.int64]:
        find = self._number.get
        numbers = [find(name, -1) for name in names]
        if -1 in numbers:
            numbers = [
                self._register(name) if n < 0 else n
                for n, name in zip(numbers, names, strict=True)
            ]
        return np.array(numbers, dtype=np.int64)

    def _register(self, name: str) -> int:
        number = len(self.names)
        self.names.append(name)
        self._number[name] = number
        if number == len(self._class):
            self._size = np.resize(self._size, (2 * number, 3))
            self._colour = np.resize(self._colour, (2 * number, 3))
            self._class = np.resize(self._class, 2 * number)
        api = self._api
        self._size[number] = api.getLength(name), api.getWidth(name), api.getHeight(name)
        self._class[number] = class_code(api.getVehicleClass(name))
        colour = api.getColor(name)[:3]
        own = random_colours(self._generator, 1)[0] if colour == _DEFAULT_COLOUR else colour
        self._colour[number] = own
        return number


class _Numbers:
    """Numbers lanes in the order in which they come up.

    Attributes:
        names: Of the lanes, by number.
    """

    def __init__(self) -> None:
        self.names: list[str] = []
        self._number: dict[str, int] = {"": -1}

    def of(self, name: str) -> int:
        """Return the number of a lane, -1 for none."""
        number = self._number.get(name)
        if number is None:
            number = self._number[name] = len(self.names)
            self.names.append(name)
        return number

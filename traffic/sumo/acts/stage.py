"""Where acts take place: the simulator, as far as a performance needs it."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from types import ModuleType
from typing import Any

import numpy as np

from traffic.errors import SimulatorError
from traffic.scenarios.model import VehicleType
from traffic.sumo.acts.paths import Path
from traffic.sumo.vehicle_types import base_name, drawn_type

__all__ = ["Entrance", "Stage"]

_BEST = "best"


@dataclass(frozen=True, slots=True)
class Entrance:
    """How a vehicle comes on stage, as soon as there is room.

    Attributes:
        vehicle_type: Name in the scenario.
        roads: That the vehicle passes; between two that do not touch, the fastest way.
        lane: On the first road, counted from the outer side; None for the best one.
        place: Of the front bumper on the first road, metres; None for its begin.
        speed: m/s; None for as fast as is allowed and safe.
    """

    vehicle_type: str
    roads: tuple[str, ...]
    lane: int | None = None
    place: float | None = None
    speed: float | None = None


class Stage:
    """The simulator while acts are performed in it.

    Attributes:
        api: The module libsumo, for whatever has no method here.
        step_length: Seconds.
        now: Time of the frame that the coming step makes, seconds; negative in the warm-up.
        vehicles: SUMO's ids of all vehicles that are there, in SUMO's order.
        reserved: Points that performances have chosen to stand at.

    Args:
        libsumo: The running simulator.
        vehicle_types: Of the scenario; SUMO has been given their base types.
        step_length: Seconds.
    """

    def __init__(
        self, libsumo: ModuleType, vehicle_types: Sequence[VehicleType], step_length: float
    ) -> None:
        self.api: Any = libsumo
        self.step_length = step_length
        self.now = 0.0
        self.vehicles: tuple[str, ...] = ()
        self.reserved: list[tuple[float, float]] = []
        self._present: frozenset[str] = frozenset()
        self._types: Mapping[str, VehicleType] = {each.name: each for each in vehicle_types}
        self._n_entered = 0

    def begin_step(self, now: float) -> None:
        """Take note of the time and of the vehicles that are there."""
        self.now = now
        self.vehicles = tuple(self.api.vehicle.getIDList())
        self._present = frozenset(self.vehicles)

    def end(self) -> None:
        """Take note that the simulator is gone: nobody is there any more."""
        self.vehicles, self._present = (), frozenset()

    def is_here(self, vehicle: str) -> bool:
        """Whether a vehicle has come in and not left."""
        return vehicle in self._present

    def enter(self, entrance: Entrance, generator: np.random.Generator) -> str:
        """Let a vehicle come in and return its id; it draws its size, colour and driver.

        It is there after one of the next steps, when there is room for it.
        """
        name = f"{entrance.vehicle_type}.act{self._n_entered}"
        self._n_entered += 1
        self._make_type(name, entrance.vehicle_type, generator)
        self.api.route.add(name, self.ways(entrance.roads))
        self.api.vehicle.add(
            name,
            name,
            name,
            departLane=_BEST if entrance.lane is None else str(entrance.lane),
            departPos="base" if entrance.place is None else f"{entrance.place:.3f}",
            departSpeed="max" if entrance.speed is None else f"{self._slowed(name, entrance):.3f}",
        )
        return name

    def _slowed(self, vehicle_type: str, entrance: Entrance) -> float:
        """Return the speed at which a vehicle may come in; above its limit SUMO gives up."""
        limit: float = self.api.lane.getMaxSpeed(f"{entrance.roads[0]}_{entrance.lane or 0}")
        factor: float = self.api.vehicletype.getSpeedFactor(vehicle_type)
        return min(entrance.speed or 0.0, limit * factor)

    def ways(self, roads: Sequence[str]) -> list[str]:
        """Return all roads from the first to the last of *roads*.

        Raises:
            SimulatorError: No way leads from one of them to the next.
        """
        found = [roads[0]]
        for first, second in pairwise(roads):
            edges = self.api.simulation.findRoute(first, second).edges
            if not edges:
                raise SimulatorError(f"no way leads from the road '{first}' to '{second}'")
            found.extend(edges[1:])
        return found

    def lane_path(self, roads: Sequence[str], lane: int = 0) -> Path:
        """Return the middle line of lanes along *roads*, smooth, through the crossings between.

        Args:
            roads: That touch one another.
            lane: On the last road, counted from the outer side.

        Raises:
            SimulatorError: No lanes follow one another like this.
        """
        lanes = self._lanes_to(f"{roads[-1]}_{lane}", list(roads[:-1]))
        if not lanes:
            raise SimulatorError(f"no lanes lead along {list(roads)} to lane {lane} of the last")
        points = [point for each in lanes for point in self.api.lane.getShape(each)]
        return Path.along(np.array(points, dtype=np.float64))

    def _lanes_to(self, last: str, roads: list[str]) -> list[str]:
        """Return lanes, crossings included, one on each of *roads*, that lead to lane *last*."""
        if not roads:
            return [last] if last in self.api.lane.getIDList() else []
        road = roads[-1]
        for number in range(self.api.edge.getLaneNumber(road)):
            lane = f"{road}_{number}"
            inside = self._inside(lane, last)
            before = self._lanes_to(lane, roads[:-1]) if inside is not None else []
            if inside is not None and before:
                return [*before, *inside, last]
        return []

    def _inside(self, lane: str, target: str) -> list[str] | None:
        """Return the lanes inside the crossing between two lanes, None if there is no way."""
        for link in self.api.lane.getLinks(lane):
            if link[0] != target:
                continue
            inside: list[str] = []
            following = link[4]
            while following:
                inside.append(following)
                following = self.api.lane.getLinks(following)[0][4]
            return inside
        return None

    def _make_type(self, name: str, vehicle_type: str, generator: np.random.Generator) -> None:
        drawn = drawn_type(name, self._types[vehicle_type], generator)
        api = self.api.vehicletype
        api.copy(base_name(vehicle_type), name)
        api.setLength(name, float(drawn["length"]))
        api.setWidth(name, float(drawn["width"]))
        api.setHeight(name, float(drawn["height"]))
        api.setMaxSpeed(name, float(drawn["maxSpeed"]))
        api.setSpeedFactor(name, float(drawn["speedFactor"]))
        api.setSpeedDeviation(name, float(drawn["speedDev"]))
        api.setColor(name, (*map(int, drawn["color"].split(",")), 255))

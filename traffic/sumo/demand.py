"""The traffic of a scenario, drawn vehicle by vehicle and written in SUMO's route format.

Every vehicle has its own vehicle type, so that no two have quite the same length, colour or
driver. Arrivals are Poisson processes.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace

import numpy as np

from dyknow.time import SECOND
from traffic.scenarios.model import (
    Circulation,
    Flow,
    Scenario,
    Trips,
    TurnShares,
)
from traffic.sumo.topology import Topology
from traffic.sumo.vehicle_types import drawn_type, element

__all__ = ["Departure", "departures", "route_document"]

_FASTEST_FACTOR = 1.3
_TRIES = 100


@dataclass(frozen=True, slots=True)
class Departure:
    """A vehicle that is to come.

    Attributes:
        time: Seconds after SUMO's begin.
        vehicle_type: Name in the scenario.
        roads: That the vehicle passes; SUMO fills in the way between two that do not touch.
        inside: Whether the vehicle starts somewhere on the first road, not at its begin.
    """

    time: float
    vehicle_type: str
    roads: tuple[str, ...]
    inside: bool


def departures(
    scenario: Scenario, topology: Topology, generator: np.random.Generator
) -> list[Departure]:
    """Draw the vehicles of *scenario*, in order of time."""
    until = (scenario.warm_up + scenario.duration) / SECOND
    drawn: list[Departure] = []
    for flow in scenario.flows:
        drawn.extend(_of_flow(flow, until, generator))
    for trips in scenario.trips:
        drawn.extend(_of_trips(trips, until, topology, generator))
    for circulation in scenario.circulations:
        latest = scenario.warm_up / SECOND / 2
        for departure in _of_circulation(circulation, until, topology, generator):
            drawn += [replace(departure, time=latest * generator.random())]
    return sorted(drawn, key=lambda departure: departure.time)


def route_document(
    scenario: Scenario, drawn: list[Departure], generator: np.random.Generator
) -> str:
    """Return SUMO's route file for *drawn*; each vehicle draws its size, driver and colour."""
    types = {vehicle_type.name: vehicle_type for vehicle_type in scenario.vehicle_types}
    lines = ['<?xml version="1.0" encoding="UTF-8"?>', "<routes>"]
    for i, departure in enumerate(drawn):
        name = f"{departure.vehicle_type}.{i}"
        drawn_attributes = drawn_type(name, types[departure.vehicle_type], generator)
        lines.append(element("vType", drawn_attributes))
        lines.append(_journey(name, departure))
    lines.append("</routes>\n")
    return "\n".join(lines)


def _arrivals(
    rate_per_hour: float, until: float, generator: np.random.Generator
) -> Iterator[float]:
    time = generator.exponential(3600 / rate_per_hour)
    while time < until:
        yield time
        time += generator.exponential(3600 / rate_per_hour)


def _of_flow(flow: Flow, until: float, generator: np.random.Generator) -> Iterator[Departure]:
    for time in _arrivals(flow.rate_per_hour, until, generator):
        yield Departure(time, _draw_type(flow.types, generator), flow.route, inside=False)


def _of_trips(
    trips: Trips, until: float, topology: Topology, generator: np.random.Generator
) -> Iterator[Departure]:
    for time in _arrivals(trips.rate_per_hour, until, generator):
        roads = _random_pair(topology, trips.min_distance, generator)
        if roads is not None:
            yield Departure(time, _draw_type(trips.types, generator), roads, inside=False)


def _of_circulation(
    circulation: Circulation, until: float, topology: Topology, generator: np.random.Generator
) -> Iterator[Departure]:
    room = topology.length * topology.n_lanes
    for start in generator.choice(len(room), size=circulation.vehicles, p=room / room.sum()):
        roads = _random_walk(topology, int(start), circulation.turns, until, generator)
        yield Departure(0.0, _draw_type(circulation.types, generator), roads, inside=True)


def _random_pair(
    topology: Topology, min_distance: float, generator: np.random.Generator
) -> tuple[str, str] | None:
    """Return two roads, the second reachable from the first, or None if none are found."""
    for _ in range(_TRIES):
        first, last = generator.integers(len(topology.roads), size=2)
        distance = float(np.hypot(*(topology.middle[first] - topology.middle[last])))
        if first != last and distance >= min_distance and topology.reaches(int(first), int(last)):
            return topology.roads[first], topology.roads[last]
    return None


def _random_walk(
    topology: Topology,
    start: int,
    turns: TurnShares,
    lasting: float,
    generator: np.random.Generator,
) -> tuple[str, ...]:
    """Return roads that even a fast driver cannot pass within *lasting* seconds."""
    weight = turns.model_dump()
    road, time, walk = start, 0.0, [topology.roads[start]]
    while time < lasting and topology.ways[road]:
        ways = topology.ways[road]
        weights = np.array([weight[way] for way in ways.values()]) + 1e-9
        road = int(generator.choice(list(ways), p=weights / weights.sum()))
        time += topology.length[road] / (topology.speed[road] * _FASTEST_FACTOR)
        walk.append(topology.roads[road])
    return tuple(walk)


def _draw_type(weights: Mapping[str, float], generator: np.random.Generator) -> str:
    shares = np.array(list(weights.values()))
    return str(generator.choice(list(weights), p=shares / shares.sum()))


def _journey(name: str, departure: Departure) -> str:
    head = {"id": name, "type": name, "depart": f"{departure.time:.2f}"}
    first, *between, last = (departure.roads[0], *departure.roads[1:-1], departure.roads[-1])
    if departure.inside:
        where = {"departPos": "random_free", "departLane": "random", "departSpeed": "0"}
        route = element("route", {"edges": " ".join(departure.roads)}).strip()
        return element("vehicle", head | where).replace("/>", f">{route}</vehicle>")
    where = {"departLane": "best", "departSpeed": "max", "from": first, "to": last}
    via = {"via": " ".join(between)} if between else {}
    return element("trip", head | where | via)

"""Symbols survive gaps in view on a bend, in dense traffic."""

from collections import defaultdict

import numpy as np
import pytest

from anchoring.cars import Car
from anchoring.links import LinkSettings
from anchoring.on_road_objects import OnRoadObject
from anchoring.processes import LinkProcess
from anchoring.structures import ObjectLinkageStructures
from anchoring.world_objects import WorldObject
from dyknow.mtl.parser import parse_formula
from dyknow.streams.sample import Sample
from dyknow.time import milliseconds, seconds
from networks.assembling import road_map_from_parts
from networks.building import Road, network_parts
from tests.anchoring.drives import percepts

LENGTH, ARC = 230.0, 90.0
DURATION = 18.0


def _bend(radius):
    """Return a road of two lanes each way with an arc in its middle."""
    angle, straight = ARC / radius, (LENGTH - ARC) / 2
    turned = np.linspace(0.0, angle, 31)
    arc = np.column_stack([np.sin(turned), 1 - np.cos(turned)]) * radius
    end = arc[-1] + straight * np.array([np.cos(angle), np.sin(angle)])
    places = {"w": (-straight, 0.0), "e": (float(end[0]), float(end[1]))}
    corners = tuple((float(x), float(y)) for x, y in arc)
    return road_map_from_parts(network_parts(places, [Road("w", "e", 2, corners)]))


def _link(unit, establish, reestablish, maintain, remove_after):
    settings = LinkSettings(
        parse_formula(establish),
        parse_formula(reestablish),
        parse_formula(maintain),
        seconds(remove_after),
    )
    return LinkProcess(unit, settings)


def _chain(roads):
    return (
        _link(
            WorldObject(),
            "eventually [200, oo] true",
            "always [0, 200] (xydist(from, to) < 5 and deviation(from, to) < 3)",
            "true",
            1,
        ),
        _link(
            OnRoadObject(roads),
            "eventually [0, oo] always [0, 500] on_road(from)",
            "eventually [0, 500] (xydist(from, to) < 10 and deviation(from, to) < 3.5)",
            "always eventually [0, 10000] always [0, 1000] on_road(from)",
            30,
        ),
        _link(
            Car(roads),
            "eventually [0, oo] (length(from) >= 1.5 and length(from) <= 20 and speed(from) > 1)",
            "false",
            "true",
            60,
        ),
    )


class _Traffic:
    """Vehicles in three lanes at about 15 m/s, some of them hidden for a while."""

    def __init__(self, roads, rng, hidden) -> None:
        self._roads, self._rng, self._hidden = roads, rng, hidden
        east, west = roads.roads.index("w_e"), roads.roads.index("e_w")
        columns = []
        for road, beside in ((east, 1.6), (east, -1.6), (west, 1.6)):
            begin = -LENGTH / 15.0
            while begin < DURATION:
                columns.append((begin, 15 + 0.4 * rng.normal(), road, beside))
                begin += 1.5 * rng.uniform(1.2, 2.6)
        self._begin, self._speed, road, self._beside = np.array(columns).T
        self._road = road.astype(int)
        self._eastwards = self._road == east
        self._percept = np.full(len(columns), -1)
        self._next = 1

    def percepts_at(self, time, now):
        """Return the percepts, and which vehicle each is of."""
        s = (time - self._begin) * self._speed
        length = self._roads.road_length[self._road]
        from_west = np.where(self._eastwards, s, length - s)
        seen = (s > 0) & (s < length) & ~self._hidden(time, from_west)
        new = np.flatnonzero(seen & (self._percept < 0))
        self._percept[~seen] = -1
        self._percept[new] = self._next + np.arange(len(new))
        self._next += len(new)
        (rows,) = np.nonzero(seen)
        places = self._roads.point_at(self._road[rows], s[rows], self._beside[rows])
        table = percepts(self._percept[rows], places + self._rng.normal(size=places.shape), now)
        table.columns["covariance"] = np.tile(np.eye(2), (len(rows), 1, 1))
        return table, dict(zip(table.ids.tolist(), rows.tolist(), strict=True))


def _symbols(roads, traffic):
    """Return for each vehicle its (time, symbol or None) whenever it was seen."""
    chain = _chain(roads)
    structures = ObjectLinkageStructures([process.history for process in chain])
    seen_as = defaultdict(list)
    for k in range(int(DURATION * 10)):
        now = milliseconds(100 * k)
        table, vehicle_of = traffic.percepts_at(k / 10, now)
        sample = Sample(table, now, now)
        for process in chain:
            (sample,) = process.push(now, (sample,))
        symbol_of = {}
        for car in sample.value.ids[sample.value["observed"]].tolist():
            symbols = structures.structure_of(f"car{car}", now).symbols
            symbol_of[int(symbols[-1].removeprefix("percept"))] = symbols[0]
        for percept, vehicle in vehicle_of.items():
            seen_as[vehicle].append((k / 10, symbol_of.get(percept)))
    return seen_as


def _over_gaps(seen_as):
    """Return for each gap of a vehicle that was a car its symbols before and after."""
    for sightings in seen_as.values():
        for i in range(1, len(sightings)):
            if sightings[i][0] - sightings[i - 1][0] < 1.2:
                continue
            after = [symbol for _, symbol in sightings[i : i + 15] if symbol is not None]
            if sightings[i - 1][1] is not None and len(sightings) - i >= 15:
                yield sightings[i - 1][1], after[-1] if after else None


def _bridge(time, from_west):
    return (from_west > 100.0) & (from_west < 130.0)


def _blackouts(time, from_west):
    return np.full(len(from_west), 7.0 <= time < 9.0 or 13.0 <= time < 15.0)


@pytest.mark.slow
@pytest.mark.parametrize("radius", [120.0, 60.0])
@pytest.mark.parametrize("hidden", [_bridge, _blackouts])
def test_vehicles_hidden_on_a_bend_keep_their_symbols(radius, hidden):
    """At least 95 % of the vehicles hidden for 2 s keep their symbol, and none are swapped."""
    roads = _bend(radius)
    traffic = _Traffic(roads, np.random.default_rng(int(radius)), hidden)

    seen_as = _symbols(roads, traffic)

    gaps = list(_over_gaps(seen_as))
    assert len(gaps) >= 12
    assert sum(before == after for before, after in gaps) >= 0.95 * len(gaps)
    owners = defaultdict(set)
    for vehicle, sightings in seen_as.items():
        for _, symbol in sightings:
            owners[symbol].add(vehicle)
    del owners[None]
    assert all(len(vehicles) == 1 for vehicles in owners.values())

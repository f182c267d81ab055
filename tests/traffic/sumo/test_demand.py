"""The traffic that scenarios ask for."""

import xml.etree.ElementTree as ET
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from dyknow.time import MINUTE, Duration
from traffic.scenarios import Scenario, find_scenario
from traffic.scenarios.model import Circulation, Flow, Trips, TurnShares, VehicleType
from traffic.sumo.demand import departures, route_document
from traffic.sumo.topology import Topology, read_topology

CROSSING = find_scenario("crossing")


@pytest.fixture(scope="module")
def topology() -> Topology:
    """Return the roads of the town."""
    assert CROSSING.network is not None
    return read_topology(CROSSING.network)


def scenario(**demand: object) -> Scenario:
    """Return ten minutes in the town, with the demand given."""
    types = (VehicleType(name="car"), VehicleType(name="bus", vehicle_class="bus"))
    return Scenario(
        name="s",
        network=CROSSING.network,
        duration=Duration(10 * MINUTE),
        vehicle_types=types,
        **demand,
    )


def test_the_town_has_every_way(topology: Topology) -> None:
    """At the four-way crossing one can go left, right, straight on and back."""
    (road,) = [i for i, name in enumerate(topology.roads) if name == "north_centre"]

    ways = {topology.roads[after]: way for after, way in topology.ways[road].items()}

    assert ways == {
        "centre_east": "left",
        "centre_south": "straight",
        "centre_west": "right",
        "centre_north": "uturn",
    }


def test_a_flow_has_its_rate(topology: Topology) -> None:
    """At 600 vehicles in an hour about a hundred come in ten minutes, of both types."""
    flow = Flow(route=("north_east",), rate_per_hour=600, types={"car": 3, "bus": 1})

    drawn = departures(scenario(flows=(flow,)), topology, np.random.default_rng(1))

    assert 70 <= len(drawn) <= 130
    assert all(0 <= departure.time < 600 for departure in drawn)
    buses = sum(departure.vehicle_type == "bus" for departure in drawn)
    assert 0.1 < buses / len(drawn) < 0.4


def test_trips_lead_from_road_to_road(topology: Topology) -> None:
    """The two roads differ, and are as far apart as asked for."""
    trips = Trips(rate_per_hour=600, types={"car": 1}, min_distance=200)

    drawn = departures(scenario(trips=(trips,)), topology, np.random.default_rng(1))

    index = {name: i for i, name in enumerate(topology.roads)}
    ends = np.array([[index[road] for road in departure.roads] for departure in drawn])
    middle = topology.middle[ends]
    assert len(drawn) > 70
    assert (np.hypot(*(middle[:, 0] - middle[:, 1]).T) >= 200).all()


@given(st.integers(0, 2**32), st.floats(0, 1), st.floats(0, 1))
@settings(derandomize=True, deadline=None, max_examples=20)
def test_circulating_cars_follow_connections(seed: int, left: float, uturn: float) -> None:
    """Each road of a random walk follows the last, and turns of weight 0 are hardly taken."""
    assert CROSSING.network is not None
    roads = read_topology(CROSSING.network)
    turns = TurnShares(left=left, uturn=uturn, right=0.0, straight=0.5)
    circulation = Circulation(vehicles=3, types={"car": 1}, turns=turns)

    drawn = departures(scenario(circulations=(circulation,)), roads, np.random.default_rng(seed))

    index = {name: i for i, name in enumerate(roads.roads)}
    for departure in drawn:
        walk = [index[road] for road in departure.roads]
        ways = [roads.ways[a][b] for a, b in pairwise(walk)]
        choices = [set(roads.ways[a].values()) for a in walk[:-1]]
        forced = [ways[i] for i in range(len(ways)) if "straight" in choices[i]]
        assert "right" not in forced


def test_every_vehicle_is_different() -> None:
    """Lengths and colours vary, within the ranges of the type; the same seed draws the same."""
    assert CROSSING.network is not None
    topology = read_topology(CROSSING.network)

    def draw(seed: int) -> str:
        generator = np.random.default_rng(seed)
        return route_document(CROSSING, departures(CROSSING, topology, generator), generator)

    document = draw(1)

    types = ET.fromstring(document).findall("vType")
    cars = [t for t in types if t.get("id", "").startswith("car.")]
    assert len({t.get("length") for t in cars}) > len(cars) / 2
    assert len({t.get("color") for t in types}) > len(types) / 2
    assert all(3.8 <= float(t.get("length", 0)) <= 5.2 for t in cars)
    assert draw(1) == document != draw(2)

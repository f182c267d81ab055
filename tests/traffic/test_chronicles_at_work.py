"""Chronicles that come and go in a system at work, declared in KPL."""

from collections.abc import Iterator

import numpy as np
import pytest

from chronicles.events import Recognition
from dyknow.errors import LabelInUseError
from dyknow.kpl.network import Network
from dyknow.streams.sample import Sample
from dyknow.streams.table import Table
from dyknow.time import MILLISECOND, SECOND, TimePoint
from networks.reading import read_road_map
from networks.roads import RoadMap
from tests.support.standing_cars import StandingCars
from traffic.bundled import data_folder
from traffic.system import MonitoringSystem, specification_from
from traffic.world import World

CROSSING = data_folder() / "networks" / "crossing" / "crossing.net.xml"
ATTRIBUTES = """
source cars attributes
source events link_turns
compunit events Changes(any)
strmgen attributes = attributes
strmgen link_turns = link_turns
strmgen car_changes = Changes(attributes, of = cars, arguments = car)
stream car_changes = car_changes
stream link_turns = link_turns
"""
TURNS = """
compunit recognitions Chronicles(events, ...)
strmgen turns = Chronicles(
    link_turns with from 0, car_changes with monotone order, file = turns, max_delay = 500)
stream recognised_turns = turns
"""
TWICE = """
compunit events RecognitionEvents(recognitions)
strmgen turn_events = RecognitionEvents(turns)
strmgen both = Chronicles(turn_events with monotone order, file = "{file}", max_delay = 500)
stream recognised_both = both
"""
BOTH = """
attribute {turn}[?c, ?from, ?crossing, ?to]
chronicle both[?c1, ?c2] {{
    event({turn}[?c1, ?l1, ?x, ?l2]:(?, ?), t1)
    event({turn}[?c2, ?l1, ?x, ?l2]:(?, ?), t2)
    t1 < t2 <= t1 + 15 s
}}
"""


class Turning:
    """A source of the attributes of cars, of which one turns every ten seconds, all alike.

    Args:
        road_map: Where they drive.
    """

    def __init__(self, road_map: RoadMap) -> None:
        (first, crossing, last), self.turn = next(
            (place, turn.value)
            for place, turn in road_map.turn_names.items()
            if turn.value == "left"
        )
        self._places = (
            (road_map.links.index(first), -1),
            (-1, road_map.crossings.index(crossing)),
            (road_map.links.index(last), -1),
        )

    def samples(self) -> Iterator[Sample[Table]]:
        """Yield a table ten times a second, for a minute."""
        for number in range(600):
            time = TimePoint(number * 100 * MILLISECOND)
            ids = np.arange(1, 7)
            phase = np.clip(time // SECOND - 10 * (ids - 1) - 3, 0, 2)
            place = np.array(self._places)[phase]
            columns = {
                "link": place[:, 0],
                "crossing": place[:, 1],
                "moving": np.ones(len(ids), dtype=np.bool_),
            }
            yield Sample(Table("car", ids, columns), time, time)


class AtWork:
    """A system whose cars turn one after the other, and what has been recognised in it."""

    def __init__(self) -> None:
        road_map = read_road_map(CROSSING)
        world = World(road_map, StandingCars(), None, np.random.default_rng(1))
        system = MonitoringSystem(
            world,
            {},
            specification=specification_from(ATTRIBUTES, "attributes.kpl"),
            sources={"attributes": lambda: Turning(road_map)},
        )
        self.turn = f"turn_{Turning(road_map).turn}"
        self.network: Network = system.network
        self.found: list[tuple[str, float, str]] = []

    def add(self, text: str, output: str) -> None:
        """Add declarations and listen to an output of theirs."""
        self.network.add(text)
        self.network.subscribe(output, self._note)

    def run(self, seconds: float) -> list[tuple[str, float, str]]:
        """Go on until some time; return what has been recognised since this was last asked."""
        self.network.kernel.run(TimePoint(round(seconds * SECOND)))
        found, self.found = self.found, []
        return found

    def _note(self, sample: Sample[tuple[Recognition, ...]]) -> None:
        for each in sample.value:
            cars = [value for name, value in each.arguments.items() if name.startswith("c")]
            self.found.append((each.chronicle, each.recognised_at / SECOND, " ".join(cars)))


def test_chronicles_are_configured_and_taken_out_while_a_system_works():
    """A generator of recognitions can be added, removed, and added again."""
    at_work = AtWork()
    turn = at_work.turn

    assert at_work.run(8) == []
    at_work.add(TURNS, "recognised_turns")
    assert at_work.run(20) == [(turn, 15.0, "car2")]
    at_work.network.remove(["stream recognised_turns", "strmgen turns"])
    assert at_work.run(40) == []
    assert "turns" not in at_work.network.kernel.processes
    at_work.add("strmgen" + TURNS.partition("strmgen")[2], "recognised_turns")
    assert at_work.run(60) == [(turn, 45.0, "car5"), (turn, 55.0, "car6")]


def test_recognitions_of_one_process_are_events_of_another(tmp_path):
    """Who is used by another cannot be removed before it."""
    at_work = AtWork()
    file = tmp_path / "both.chronicle"
    file.write_text(BOTH.format(turn=at_work.turn), encoding="utf-8")
    at_work.add(TURNS, "recognised_turns")
    at_work.add(TWICE.format(file=file), "recognised_both")

    found = at_work.run(30)

    assert [each for each in found if each[0] == "both"] == [
        ("both", 15.0, "car1 car2"),
        ("both", 25.0, "car2 car3"),
    ]
    with pytest.raises(LabelInUseError, match="'turns' is in use"):
        at_work.network.remove(["stream recognised_turns", "strmgen turns"])
    at_work.network.remove(["stream recognised_both", "strmgen both", "strmgen turn_events"])
    at_work.network.remove(["stream recognised_turns", "strmgen turns"])

"""The chronicles in data/chronicles, each behaviour recognised once and its look-alikes not."""

from collections import Counter
from collections.abc import Iterable
from pathlib import Path

import pytest

from chronicles.events import Event, Recognition
from chronicles.models import models_from_chronicles
from chronicles.parser import read_chronicles
from chronicles.recognition import Recogniser
from dyknow.time import TimePoint, milliseconds

LIBRARY = Path(__file__).parents[2] / "data" / "chronicles"

RELATIONS = {
    ("l1", "x", "l2"): "left",
    ("l2", "x", "l1"): "right",
    ("l1", "x", "l3"): "straight",
    ("l1", "x", "l1"): "uturn",
    ("l2", "x", "l2"): "uturn",
    ("l3", "x2", "l4"): "right",
    ("l1", "x9", "l2"): "left",  # another crossing that connects the same links
}


class World:
    """The attributes of one stream, told as changes."""

    def __init__(self, file: str) -> None:
        models = models_from_chronicles(read_chronicles(LIBRARY / f"{file}.chronicle"))
        self.recogniser = Recogniser(models)
        self.found: list[Recognition] = []
        self._values: dict[tuple[str, tuple[str, ...]], str | None] = {}

    def tell(self, time: float, changes: Iterable[tuple[str, str]]) -> None:
        """Set attributes, written `cars.link c1`, at a time in milliseconds."""
        events = []
        at = TimePoint(milliseconds(time))
        for what, value in changes:
            name, *arguments = what.split()
            key = (name, tuple(arguments))
            before = self._values.get(key)
            if before != value:
                events.append(Event(name, tuple(arguments), before, value, at))
                self._values[key] = value
        self.found += self.recogniser.push(at, events)

    def names(self) -> list[str]:
        """Return what has been recognised, after ten more minutes."""
        self.found += self.recogniser.advance(TimePoint(milliseconds(10**7)))
        return [recognition.chronicle for recognition in self.found]


@pytest.fixture
def crossing() -> World:
    """Return a world in which the map is known and car c1 drives on l1."""
    world = World("turns")
    relations = [(f"links.{turn} {a} {x} {b}", "true") for (a, x, b), turn in RELATIONS.items()]
    world.tell(0, relations)
    world.tell(
        500,
        [("cars.link c1", "l1"), ("cars.crossing c1", "no_crossing"), ("cars.moving c1", "true")],
    )
    return world


ON_L2 = [("cars.link c1", "l2"), ("cars.crossing c1", "no_crossing")]
IN_X = [("cars.link c1", "no_link"), ("cars.crossing c1", "x")]
OFF_ROAD = [("cars.link c1", "no_link"), ("cars.crossing c1", "no_crossing")]


@pytest.mark.parametrize(("l2", "turn"), [("l2", "left"), ("l3", "straight"), ("l1", "uturn")])
def test_each_turn_is_recognised_when_the_car_gets_onto_the_second_link(crossing, l2, turn):
    """A turn through the crossing is recognised once, with its links and times."""
    crossing.tell(5000, IN_X)
    crossing.tell(8000, [("cars.link c1", l2), ("cars.crossing c1", "no_crossing")])
    crossing.tell(8100, [])

    assert crossing.names() == [f"turn_{turn}"]
    (found,) = crossing.found
    assert found.arguments == {"c": "c1", "l1": "l1", "x": "x", "l2": l2}
    assert (found.begin, found.end) == (milliseconds(5000), milliseconds(8000))
    assert found.recognised_at <= milliseconds(8001)


@pytest.mark.parametrize("lead", [-1000, -400, 0, 700, 2900])
@pytest.mark.parametrize("tail", [-1000, 0, 1000])
def test_link_and_crossing_may_change_in_either_order(crossing, lead, tail):
    """The crossing may be entered and left before or after the links change."""
    changes = [
        (5000, ("cars.link c1", "no_link")),
        (5000 + lead, ("cars.crossing c1", "x")),
        (8000 + tail, ("cars.crossing c1", "no_crossing")),
        (8000, ("cars.link c1", "l2")),
    ]
    for time, change in sorted(changes):
        crossing.tell(time, [change])

    assert crossing.names() == ["turn_left"]


def test_a_car_that_waits_in_the_crossing_turns(crossing):
    """Two minutes of standing in the crossing do not end a turn."""
    crossing.tell(5000, IN_X)
    crossing.tell(6000, [("cars.moving c1", "false")])
    crossing.tell(125_000, [("cars.moving c1", "true")])
    crossing.tell(130_000, ON_L2)

    assert crossing.names() == ["turn_left"]


def test_a_crossing_entered_twice_is_passed_once(crossing):
    """Seeming to leave the crossing for a while does not make a second turn."""
    crossing.tell(5000, IN_X)
    crossing.tell(6000, OFF_ROAD)
    crossing.tell(7000, IN_X)
    crossing.tell(8000, ON_L2)

    assert crossing.names() == ["turn_left"]


def test_the_same_turn_can_be_made_again(crossing):
    """A car that comes back to the first link and turns again has turned twice."""
    crossing.tell(5000, IN_X)
    crossing.tell(8000, ON_L2)
    crossing.tell(20_000, IN_X)
    crossing.tell(23_000, [("cars.link c1", "l1"), ("cars.crossing c1", "no_crossing")])
    crossing.tell(40_000, IN_X)
    crossing.tell(43_000, ON_L2)

    assert crossing.names() == ["turn_left", "turn_right", "turn_left"]


@pytest.mark.parametrize("between", [[], [OFF_ROAD]])
def test_a_turn_that_was_not_seen_in_the_crossing_is_predicted(crossing, between):
    """Going from link to link without a crossing seen is a turn that must have happened."""
    for changes in between:
        crossing.tell(7000, changes)
    crossing.tell(8000, [("cars.link c1", "l3"), ("cars.crossing c1", "no_crossing")])

    assert crossing.names() == ["turn_straight_predicted"]


def test_no_turn_is_predicted_through_a_crossing_that_was_avoided(crossing):
    """A turn seen through one crossing is not predicted through another one as well."""
    crossing.tell(5000, IN_X)
    crossing.tell(8000, ON_L2)

    assert crossing.names() == ["turn_left"]


def test_a_car_first_seen_in_a_crossing_makes_no_turn(crossing):
    """Without a first link there is no turn."""
    crossing.tell(1000, [("cars.link c2", "no_link"), ("cars.crossing c2", "x")])
    crossing.tell(3000, [("cars.link c2", "l2"), ("cars.crossing c2", "no_crossing")])

    assert crossing.names() == []


def test_an_earlier_visit_is_not_taken_for_the_beginning(crossing):
    """Only the last link before the crossing begins a turn."""
    crossing.tell(5000, IN_X)
    crossing.tell(8000, ON_L2)
    crossing.tell(9000, OFF_ROAD)
    crossing.tell(12_000, [("cars.link c1", "l7")])
    crossing.tell(15_000, IN_X)
    crossing.tell(18_000, [("cars.link c1", "l3"), ("cars.crossing c1", "no_crossing")])

    assert crossing.names() == ["turn_left"]


def test_a_car_pushed_over_the_line_by_noise_makes_no_uturn(crossing):
    """A standing car that seems to enter the crossing and come back has not turned round."""
    crossing.tell(5000, [("cars.moving c1", "false")])
    crossing.tell(6000, IN_X)
    crossing.tell(9000, [("cars.link c1", "l1"), ("cars.crossing c1", "no_crossing")])
    crossing.tell(20_000, [("cars.moving c1", "true")])
    crossing.tell(21_000, IN_X)
    crossing.tell(24_000, ON_L2)

    assert crossing.names() == ["turn_left"]


def test_cars_that_are_gone_leave_nothing_behind(crossing):
    """When a car is gone, what was known about it is forgotten; what the map says is not."""
    crossing.tell(5000, IN_X)
    gone = [("cars.link c1", None), ("cars.crossing c1", None), ("cars.moving c1", None)]
    crossing.tell(6000, gone)
    crossing.names()

    left = crossing.recogniser.partial_instances()
    assert {tuple(one.instants) for one in left} == {("t0",)}
    assert not any("c" in one.values for one in left)


@pytest.fixture
def road() -> World:
    """Return a world in which both cars move and c1 is behind c2."""
    world = World("overtakes")
    world.tell(0, [("cars.travelling c1", "true"), ("cars.travelling c2", "true")])
    world.tell(100, relation("behind"))
    return world


def relation(name: str) -> list[tuple[str, str]]:
    """Return how c1 and c2 are placed, c1 being *name* of c2."""
    mirrored = {"behind": "in_front", "in_front": "behind", "beside": "beside"}
    places = [(place, str(place == name).lower()) for place in mirrored]
    return [
        change
        for place, value in places
        for change in (
            (f"car_relations.{place} c1 c2", value),
            (f"car_relations.{mirrored[place]} c2 c1", value),
        )
    ]


def test_an_overtake_is_recognised_when_the_overtaker_is_in_front(road):
    """Behind, beside, in front is one overtake, of the one by the other."""
    road.tell(200_000, relation("beside"))
    road.tell(203_000, relation("in_front"))

    assert [one.recognised_at for one in road.found] == [milliseconds(203_000)]
    assert road.names() == ["overtake"]
    (found,) = road.found
    assert found.arguments == {"car1": "c1", "car2": "c2"}
    assert (found.begin, found.end) == (milliseconds(200_000), milliseconds(203_000))


def test_flickering_relations_make_one_overtake(road):
    """Noise at both ends of an overtake does not multiply it."""
    for time, place in enumerate(
        ["beside", "behind", "beside", "behind", "beside", "in_front", "beside", "in_front"]
    ):
        road.tell(1000 + 300 * time, relation(place))

    assert road.names() == ["overtake"]


def test_passing_a_queue_is_no_overtake(road):
    """A car that passes one that stands, or that stood in between, overtakes nobody."""
    road.tell(1000, relation("beside"))
    road.tell(1500, [("cars.travelling c2", "false")])
    road.tell(2000, [("cars.travelling c2", "true")])
    road.tell(3000, relation("in_front"))

    assert road.names() == []


def test_changing_places_without_being_beside_is_no_overtake(road):
    """Two symbols that are mixed up do not overtake each other."""
    road.tell(1000, relation("in_front"))

    assert road.names() == []


def test_an_overtake_that_takes_too_long_or_is_broken_off_is_none(road):
    """Being in front a minute after being behind, or behind again, is no overtake."""
    road.tell(1000, relation("beside"))
    road.tell(61_001, relation("in_front"))
    road.tell(70_000, relation("beside"))
    road.tell(71_000, relation("in_front"))

    assert road.names() == []


def test_moving_cars_do_not_multiply(road):
    """The instances kept grow with the cars and not with their pairs."""
    for i in range(200):
        road.tell(1000 + i, [(f"cars.travelling d{i}", "true")])

    waiting = Counter(each.chronicle for each in road.recogniser.partial_instances())
    assert set(waiting.values()) == {2 * 202}

"""Broken off, unseen and reckless overtakes in data/chronicles, and their look-alikes."""

import pytest

from chronicles.events import Event, Recognition
from chronicles.models import models_from_chronicles
from chronicles.parser import read_chronicles
from chronicles.recognition import Recogniser
from dyknow.time import TimePoint, milliseconds
from traffic.bundled import data_folder

Change = tuple[str, str | None]


class Road:
    """Two cars on a road, told as relations of the first to the second; both files know them."""

    def __init__(self) -> None:
        files = [
            data_folder() / "chronicles" / f"{name}.chronicle"
            for name in ("overtakes", "reckless_overtakes")
        ]
        models = [
            model for file in files for model in models_from_chronicles(read_chronicles(file))
        ]
        self.recogniser = Recogniser(models)
        self.found: list[Recognition] = []
        self._values: dict[str, str | None] = {}
        self.tell(0, "cars.travelling c1", "cars.travelling c2", "cars.travelling c3")
        self.tell(0, "cars.link c1", "cars.link c2", to="l")

    def tell(self, time: int, *what: str, to: str | None = "true") -> None:
        """Set attributes at a time in milliseconds."""
        at = TimePoint(milliseconds(time))
        events = []
        for each in what:
            name, *arguments = each.split()
            was, self._values[each] = self._values.get(each), to
            if was != to:
                events.append(Event(name, tuple(arguments), was, to, at))
        self.found += self.recogniser.push(at, tuple(events))

    def relate(self, time: int, *true: str, unknown: bool = False) -> None:
        """Let exactly these relations of c1 to c2 be true, or all unknown."""
        names = (
            "behind", "in_front", "in_line", "beside", "beside_left", "beside_right",
            "beside_wrong",
        )  # fmt: skip
        of = {name: f"car_relations.{name} c1 c2" for name in names}
        if unknown:
            self.tell(time, *of.values(), to=None)
            return
        self.tell(time, *(of[name] for name in names if name not in true), to="false")
        self.tell(time, *(of[name] for name in true))

    def names(self) -> list[str]:
        """Return what has been recognised in the end, in alphabetical order."""
        self.found += self.recogniser.advance(TimePoint(milliseconds(10**7)))
        return sorted(recognition.chronicle for recognition in self.found)


@pytest.fixture
def road() -> Road:
    """Return a road on which c1 drives behind c2, in line with it."""
    road = Road()
    road.relate(100, "behind", "in_line")
    return road


def attempt(road: Road, begin: int) -> None:
    """Let c1 leave the line, get beside c2 and come back behind it."""
    road.relate(begin, "behind")
    road.relate(begin + 2000, "beside", "beside_left")
    road.relate(begin + 5000, "behind")
    road.relate(begin + 7000, "behind", "in_line")


def test_the_side_of_an_overtake_is_seen_while_both_are_beside(road):
    """An overtake on the left is two recognitions, and no reckless one."""
    road.relate(1000, "behind")
    road.relate(3000, "beside", "beside_left")
    road.relate(5000, "in_front")

    assert road.names() == ["overtake", "overtake_left"]


def test_an_overtake_on_the_wrong_side_is_reckless(road):
    """What is wrong about it is the side on which it was beside the other."""
    road.relate(1000, "behind")
    road.relate(3000, "beside", "beside_right", "beside_wrong")
    road.relate(5000, "in_front")

    assert road.names() == ["overtake", "overtake_right", "overtake_wrong_side"]


def test_passing_that_nobody_saw_is_predicted(road):
    """Behind, then unknown, then in front, with both on their link and driving."""
    road.relate(1000, unknown=True)
    road.relate(9000, "in_front", "in_line")

    assert road.names() == ["overtake_predicted"]


def test_what_happened_on_another_link_is_not_predicted(road):
    """A crossing lies in between, in which the one may have taken another way."""
    road.relate(1000, unknown=True)
    road.tell(2000, "cars.link c1", "cars.link c2", to="no_link")
    road.tell(4000, "cars.link c1", "cars.link c2", to="l2")
    road.relate(9000, "in_front", "in_line")

    assert road.names() == []


def test_an_overtake_that_is_broken_off_is_told_when_the_car_is_back_in_line(road):
    """Out of the line, beside, behind again, and in line."""
    attempt(road, 1000)

    assert road.names() == ["overtake_aborted"]
    assert (road.found[0].begin, road.found[0].end) == (milliseconds(1000), milliseconds(8000))


@pytest.mark.parametrize(("before", "found"), [(0, 1), (400, 1), (1000, 1), (1100, 0)])
def test_who_swings_out_late_may_be_level_before_it_is_seen_out_of_the_line(road, before, found):
    """Up to a second before; whoever is level in line for longer is a mistake about who is who."""
    road.relate(3000 - before, "beside", "in_line")
    road.relate(3000, "beside", "beside_left")
    road.relate(6000, "behind")
    road.relate(8000, "behind", "in_line")

    assert road.names() == ["overtake_aborted"] * found


def test_a_change_of_lanes_behind_another_is_nothing_broken_off(road):
    """Who never gets beside the other has not begun to overtake it."""
    road.relate(1000, "behind")
    road.relate(6000, "behind", "in_line")

    assert road.names() == []


def test_driving_beside_each_other_is_nothing_broken_off(road):
    """Now a little ahead and now a little behind, on two lanes, without coming back into line."""
    road.relate(1000, "behind")
    for time in range(3000, 30_000, 4000):
        road.relate(time, "beside", "beside_left")
        road.relate(time + 2000, "behind")

    assert road.names() == []


def test_who_succeeds_in_the_end_has_broken_nothing_off(road):
    """Being in front before being in line again is an overtake."""
    road.relate(1000, "behind")
    road.relate(3000, "beside", "beside_left")
    road.relate(5000, "in_front")
    road.relate(7000, "in_front", "in_line")

    assert road.names() == ["overtake", "overtake_left"]


@pytest.mark.parametrize(("period", "reckless"), [(10_000, 1), (70_000, 0)])
def test_three_attempts_within_two_minutes_are_reckless(road, period, reckless):
    """Counted from the end of the first to that of the third; slower ones are patience."""
    for i in range(3):
        attempt(road, 1000 + i * period)

    names = road.names()
    assert names.count("overtake_aborted") == 3
    assert names.count("overtake_again_and_again") == reckless


def test_two_attempts_are_not_reckless(road):
    """One may change one's mind twice."""
    attempt(road, 1000)
    attempt(road, 20_000)

    assert road.names() == ["overtake_aborted"] * 2


@pytest.mark.parametrize(("time", "reckless"), [(2000, True), (4500, True), (9000, False)])
def test_facing_traffic_while_overtaking_is_reckless(road, time, reckless):
    """From going out to being in front; who comes later met nobody who overtook."""
    road.relate(1000, "behind")
    facing = "car_meetings.facing c1 c3"
    before, after = [t for t in (3000, 5000) if t < time], [t for t in (3000, 5000) if t >= time]
    steps = {3000: ("beside", "beside_left"), 5000: ("in_front",)}
    for each in before:
        road.relate(each, *steps[each])
    road.tell(time, facing)
    for each in after:
        road.relate(each, *steps[each])

    names = road.names()
    assert "overtake" in names
    assert ("overtake_facing_traffic" in names) == reckless

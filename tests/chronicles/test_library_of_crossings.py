"""Chronicles about crossings and directions: each behaviour recognised, look-alikes not."""

from tests.chronicles.test_library import World


def signals() -> World:
    """Return a world in which the signal s is green, then red from 10 s to 40 s."""
    world = World("signals")
    world.tell(0, [("signals.state s", "green"), ("cars.over c", "no_over")])
    world.tell(0, [("cars.beyond c", "no_beyond")])
    return world


def red(world: World) -> None:
    """Turn the signal red at 10 s."""
    world.tell(7_000, [("signals.state s", "yellow")])
    world.tell(10_000, [("signals.state s", "red")])


def test_a_red_light_is_run() -> None:
    """A car passes the line two seconds after the signal has turned, and goes on."""
    world = signals()
    red(world)
    world.tell(12_000, [("cars.over c", "s")])
    world.tell(12_400, [("cars.beyond c", "s")])

    assert world.names() == ["red_light"]


def test_passing_on_yellow_or_just_as_it_turns_is_no_offence() -> None:
    """It takes a second of red."""
    for time in (9_000, 10_500):
        world = signals()
        red(world) if time > 10_000 else world.tell(7_000, [("signals.state s", "yellow")])
        world.tell(time, [("cars.over c", "s")])
        world.tell(time + 400, [("cars.beyond c", "s")])
        world.tell(20_000, [("signals.state s", "green")])
        assert world.names() == []


def test_who_waits_past_the_line_for_green_runs_no_light() -> None:
    """The car gets beyond only when the signal is not red any more."""
    world = signals()
    red(world)
    world.tell(15_000, [("cars.over c", "s")])
    world.tell(40_000, [("signals.state s", "green")])
    world.tell(41_000, [("cars.beyond c", "s")])

    assert world.names() == []


def test_only_the_last_passing_of_the_line_counts() -> None:
    """A car that seems to pass, come back and pass again runs one light."""
    world = signals()
    red(world)
    world.tell(15_000, [("cars.over c", "s")])
    world.tell(17_000, [("cars.over c", "no_over")])
    world.tell(19_000, [("cars.over c", "s")])
    world.tell(19_500, [("cars.beyond c", "s")])

    assert world.names() == ["red_light"]
    assert world.found[0].begin == 19_000_000_000


def test_the_signal_of_another_lane_does_not_matter() -> None:
    """What is red is not what the car passes."""
    world = signals()
    red(world)
    world.tell(11_000, [("signals.state other", "green")])
    world.tell(15_000, [("cars.over c", "other")])
    world.tell(15_400, [("cars.beyond c", "other")])

    assert world.names() == []


def crossing(*told: tuple[float, str, str]) -> World:
    """Return a world in which a car gets into the crossing x at 5 s, and more is told."""
    world = World("crossings")
    world.tell(0, [("cars.crossing c", "no_crossing"), ("cars.standing c", "false")])
    world.tell(5_000, [("cars.crossing c", "x")])
    for time, what, value in told:
        world.tell(time, [(what, value)])
    return world


def test_who_stands_for_five_seconds_stops_in_the_crossing() -> None:
    """It is known as soon as five seconds are over."""
    world = crossing((7_000, "cars.standing c", "true"))

    assert world.names() == ["stop_in_crossing"]
    assert world.found[0].recognised_at == 12_000_000_000


def test_short_stops_and_stops_outside_are_none() -> None:
    """Who moves off earlier, has left the crossing, or stands before it, has not stopped there."""
    short = crossing((7_000, "cars.standing c", "true"), (11_500, "cars.standing c", "false"))
    left = crossing((6_000, "cars.crossing c", "no_crossing"), (7_000, "cars.standing c", "true"))
    before = World("crossings")
    before.tell(0, [("cars.crossing c", "no_crossing"), ("cars.standing c", "true")])
    before.tell(60_000, [("cars.crossing c", "x")])

    assert short.names() == left.names() == before.names() == []


def test_who_stands_at_the_border_stays_where_he_came_to_rest() -> None:
    """Noise makes a car that stands seem to leave and come back; it stops once."""
    world = crossing(
        (7_000, "cars.standing c", "true"),
        (9_000, "cars.crossing c", "no_crossing"),
        (10_000, "cars.crossing c", "x"),
    )

    assert world.names() == ["stop_in_crossing"]


def test_two_stops_in_one_crossing_are_two() -> None:
    """Whoever moves in between."""
    world = crossing(
        (7_000, "cars.standing c", "true"),
        (13_000, "cars.standing c", "false"),
        (14_000, "cars.standing c", "true"),
    )

    assert world.names() == ["stop_in_crossing"] * 2


def wrong(*told: tuple[float, str, str]) -> World:
    """Return a world in which a car is on the wrong side from 10 s, and more is told."""
    world = World("wrong_way")
    world.tell(0, [("cars.wrong_side c", "false"), ("car_relations.behind c d", "true")])
    world.tell(10_000, [("cars.wrong_side c", "true")])
    for time, what, value in told:
        world.tell(time, [(what, value)])
    return world


def test_who_stays_on_the_wrong_side_drives_the_wrong_way() -> None:
    """For five seconds, while nobody is overtaken."""
    assert wrong((16_000, "cars.wrong_side c", "false")).names() == ["wrong_way"]
    assert wrong((14_000, "cars.wrong_side c", "false")).names() == []


def test_who_overtakes_does_not() -> None:
    """Drawing level with one that it was behind is enough, whenever in the stretch."""
    world = wrong(
        (18_000, "car_relations.behind c d", "false"), (20_000, "cars.wrong_side c", "false")
    )

    assert world.names() == []


def test_short_stretches_do_not_add_up() -> None:
    """Twice four seconds are not eight."""
    world = wrong(
        (14_000, "cars.wrong_side c", "false"),
        (15_000, "cars.wrong_side c", "true"),
        (19_000, "cars.wrong_side c", "false"),
    )

    assert world.names() == []

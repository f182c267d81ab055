"""Object linkage structures lead from a symbol down to its percepts."""

from anchoring.structures import LinkHistory, ObjectLinkageStructures


def _three_levels():
    world, road, cars = LinkHistory(), LinkHistory(), LinkHistory()
    world.make("world_object1", "percept1", 0)
    world.remove("world_object1", 40)
    world.make("world_object2", "percept2", 50)
    road.make("on_road_object1", "world_object1", 10)
    road.remove("on_road_object1", 40)
    road.make("on_road_object1", "world_object2", 60)
    cars.make("car1", "on_road_object1", 20)
    return ObjectLinkageStructures([world, road, cars])


def test_a_structure_names_the_object_on_each_level():
    """At a time at which it is anchored, a car leads to one percept."""
    structure = _three_levels().structure_of("car1", 30)

    assert structure.symbols == ("car1", "on_road_object1", "world_object1", "percept1")
    assert [link.lower for link in structure.links] == list(structure.symbols[1:])


def test_a_structure_ends_where_a_link_is_missing():
    """While no world object feeds it, an on-road object is the lowest of its structure."""
    structures = _three_levels()

    assert structures.structure_of("car1", 45).symbols == ("car1", "on_road_object1")
    assert structures.structure_of("car1", 5).symbols == ("car1",)


def test_percepts_are_found_with_their_times():
    """A car's percepts come with the stretches of time in which it rested on them."""
    links = _three_levels().percepts_of("car1", 0, 100)

    assert [(link.upper, link.lower, link.begin, link.end) for link in links] == [
        ("car1", "percept1", 20, 40),
        ("car1", "percept2", 60, 100),
    ]


def test_percepts_are_cut_to_the_time_asked_for():
    """Percepts before and after the stretch of time asked for are left out."""
    structures = _three_levels()

    assert [link.lower for link in structures.percepts_of("car1", 70, 80)] == ["percept2"]
    assert structures.percepts_of("car1", 42, 55) == ()


def test_histories_answer_from_both_ends():
    """The links of a lower object are found as well as those of an upper one."""
    history = LinkHistory()
    history.make("car1", "percept1", 0)
    history.remove("car1", 10)
    history.make("car1", "percept2", 20)
    history.make("car2", "percept1", 30)

    assert [link.lower for link in history.of_upper("car1")] == ["percept1", "percept2"]
    assert [link.upper for link in history.of_lower("percept1")] == ["car1", "car2"]
    assert history.of_upper("car9") == ()
    assert len(list(history)) == 3

"""What the symbols of a specification stand for, and what its own names say of its streams."""

import numpy as np
import pytest

from dyknow.errors import SpecificationErrors
from networks.reading import read_road_map
from traffic.bundled import data_folder
from traffic.system import (
    MonitoringSystem,
    image_labels,
    labels_of_sort,
    outputs_behind,
    outputs_of,
    outputs_of_sort,
    read_specification,
    sort_of,
    specification_from,
)
from traffic.world import World, generators_of

CROSSING = data_folder() / "networks" / "crossing" / "crossing.net.xml"
LINK = """
source percepts seen
compunit world_objects WorldObject(percepts)
compunit any Made(any)
strmgen percepts = seen
strmgen world_objects = link(percepts, {unit}, establish = true, reestablish = false,
    maintain = true{settings})
stream world_objects = world_objects
"""


class Nothing:
    """A source of no samples."""

    def samples(self):
        """Yield nothing."""
        return iter(())


def system_of(text):
    """Return a system without cameras."""
    world = World(
        read_road_map(CROSSING), Nothing(), None, np.random.Generator(np.random.PCG64(1))
    )
    sources = {"seen": Nothing}
    return MonitoringSystem(
        world, {}, specification=specification_from(text, "x.kpl"), sources=sources
    )


def test_images_are_told_by_their_sorts():
    """Also states of them; outputs without them are those of a run."""
    specification = read_specification()

    assert image_labels(specification) == {
        "colour_images", "thermal_images", "sync(colour_images, thermal_images)",
    }  # fmt: skip
    assert outputs_of(specification)[:4] == (
        "percepts", "cars", "recognised_turns", "recognised_overtakes",
    )  # fmt: skip


def test_streams_are_found_by_their_sorts():
    """Of outputs and of generators, through links and parameters in labels."""
    specification = read_specification()

    assert outputs_of_sort(specification, "cars") == ("cars",)
    assert outputs_of_sort(specification, "percepts") == ("percepts",)
    assert labels_of_sort(specification, "cars") == ("cars", "moving_cars")
    assert sort_of(specification, "percepts[vision]") == "percepts"
    assert sort_of(specification, "nothing") == "any"


def test_what_is_made_of_a_stream_is_found():
    """Whatever lies between, and in whichever view."""
    specification = read_specification()

    assert outputs_behind(specification, ["cars"])[:3] == (
        "cars", "recognised_turns", "recognised_overtakes",
    )  # fmt: skip
    assert outputs_behind(specification, ["car_relations"])[:1] == ("recognised_overtakes",)
    assert "percepts" in outputs_behind(specification, ["percepts[vision]"])


@pytest.mark.parametrize(
    ("unit", "settings", "message"),
    [
        ("WorldObject", "", "a link process needs the setting 'remove_after'"),
        ("WorldObject", ", remove_after = 1 s, keep = 3", "a link process has no setting 'keep'"),
        (
            "Made",
            ", remove_after = 1 s",
            "expected one of WorldObject, OnRoadObject, Car, RecklessDriver to be",
        ),
    ],
)
def test_faulty_links_have_a_place(unit, settings, message):
    """What is at fault in a specification of one's own is said like any other fault."""
    with pytest.raises(SpecificationErrors) as caught:
        system_of(LINK.format(unit=unit, settings=settings))

    (fault,) = caught.value.exceptions
    assert message in str(fault)
    assert fault.report().startswith("x.kpl:6:")


def test_files_that_units_read_are_known():
    """Each once, in the order in which they were read."""
    system = system_of(
        """
        source events link_turns
        strmgen events = link_turns
        compunit recognitions Chronicles(events, ...)
        strmgen turns = Chronicles(events, file = turns, max_delay = 500)
        strmgen again = Chronicles(events, file = turns, max_delay = 100)
        stream turns = turns
        stream again = again
        """
    )

    assert [path.name for path in system.files] == ["turns.chronicle"]


def test_a_file_that_has_changed_is_read_again(tmp_path):
    """What a process keeps of the files of one run is not used for others of the same name."""
    path = tmp_path / "mine.chronicle"
    turns = (data_folder() / "chronicles" / "turns.chronicle").read_text(encoding="utf-8")
    text = f"""
        source events link_turns
        strmgen events = link_turns
        compunit recognitions Chronicles(events, ...)
        strmgen turns = Chronicles(events, file = "{path}", max_delay = 500)
        stream turns = turns
        """
    names = []
    for written in (turns, turns.replace("turn_left", "turn_back"), turns):
        path.write_text(written, encoding="utf-8")
        names.append(system_of(text).chronicles)

    assert names[0] == names[2] != names[1]
    assert "turn_back" in names[1]


SIGNALS = """
parameter patience = 2 s
source events link_turns
strmgen events = link_turns
compunit recognitions Chronicles(events, ...)
strmgen signals = Chronicles(events, file = signals, max_delay = 500{settings})
stream signals = signals
"""


def test_parameters_of_a_chronicle_file_are_settings():
    """As a time, a number of milliseconds, a text for what is negative, or a parameter of KPL."""
    text = 'red_for = patience, red_at_most = 9000, passing = "3 s"'
    system = system_of(SIGNALS.format(settings=f", {text}"))
    said = {each["label"]: each["process"] for each in system.network.description["generators"]}

    assert system.chronicles == ("red_light",)
    assert said["signals"].endswith('red_for = 2000 ms, red_at_most = 9000, passing = "3 s")')


@pytest.mark.parametrize(
    ("settings", "place", "message"),
    [
        ("red_fr = 2", "x.kpl:6:", "has no parameter 'red_fr'; did you mean 'red_for'? (it has "),
        ("red_for = soon", "x.kpl:6:", "must be of sort 'time or number', found 'name'"),
        ("red_for = true", "x.kpl:6:", "must be of sort 'time or number', found 'truth value'"),
        ("red_for = [1]", "x.kpl:6:", "must be of sort 'time or number', found 'list'"),
        ('red_for = "soon"', "x.kpl:6:", "expected a duration such as"),
        ("red_for = 1 us", "x.kpl:6:", "is finer than a millisecond"),
        ("red_for = 1.5", "x.kpl:6:", "is finer than a millisecond"),
        ("red_for = 20 min", "/signals.chronicle:", "can never be recognised"),
    ],
)
def test_unfit_parameters_of_a_chronicle_file_have_a_place(settings, place, message):
    """In the specification, or in the chronicle file if it is one of the constraints there."""
    with pytest.raises(SpecificationErrors) as caught:
        system_of(SIGNALS.format(settings=f", {settings}"))

    (fault,) = caught.value.exceptions
    assert message in str(fault)
    assert place in fault.report()


def test_a_parameter_is_not_called_like_a_setting_of_the_unit(tmp_path):
    """The fault is one of the chronicle file, when this unit reads it."""
    path = tmp_path / "own.chronicle"
    path.write_text(
        "parameter max_delay = 3\nmessage m\n"
        "chronicle c { event(m, t) noevent(m, (t + 1, t + max_delay)) }\n"
    )
    text = SIGNALS.replace("file = signals", f'file = "{path}"').format(settings="")
    with pytest.raises(SpecificationErrors) as caught:
        system_of(text)

    (fault,) = caught.value.exceptions
    assert "has a setting 'max_delay' of its own" in str(fault)
    assert "own.chronicle:1:1" in fault.report()


def test_one_seed_gives_the_same_chance_again():
    """In traffic and in sensors, and each its own."""
    (traffic, sensors), (again, _) = generators_of(3), generators_of(3)
    drawn = traffic.integers(1 << 60)

    assert drawn == again.integers(1 << 60)
    assert drawn != sensors.integers(1 << 60)

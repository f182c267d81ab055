"""Configuration and mediation at work: Heintz (2009), sections 3.3.3 and 3.3.4."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from dyknow.errors import ProcessError
from dyknow.streams.sample import NO_VALUE
from dyknow.streams.table import Table
from tests.support.networks import Collector, network_of, samples_at
from tests.support.streams import ms

CARS = """
source ids tracked
source pos uav_tracker
source pos car2_tracker
source pos car5_tracker
source object attention
compunit dist Distance(pos, pos)
strmgen car_ids = tracked
strmgen pos[uav] = uav_tracker
strmgen pos[car2] = car2_tracker
strmgen pos[car5] = car5_tracker
strmgen cur_car = attention
"""
TIMES = range(0, 60, 10)
STREAMS = {
    "uav_tracker": " ".join(f"{time}:1" for time in TIMES),
    "car2_tracker": " ".join(f"{time}:2{time // 10}" for time in TIMES),
    "car5_tracker": " ".join(f"{time}:5{time // 10}" for time in TIMES),
    "tracked": [],
    "attention": "",
}
DISTANCES = """
for each car in car_ids {
    strmgen dist[car, uav] = Distance(pos[car], pos[uav])
    stream dist[car] = dist[car, uav]
}
"""


def test_figures_3_4_and_3_5_a_configuration_process():
    """A refinement process exists for each identifier in the newest set, no longer than that."""
    sets = samples_at({10: {"car2"}, 30: {"car2", "car5"}, 40: {"car5"}})
    network = network_of(CARS + DISTANCES, {**STREAMS, "tracked": sets})
    collector = Collector(network)

    assert network.outputs == ()
    found = collector.run(ms(20))
    assert network.kernel.labels[-1] == "dist[car2, uav]"
    assert [p.provider for p in network.kernel.streams if p.receiver == "dist[car2, uav]"] == [
        "pos[car2]",
        "pos[uav]",
    ]
    collector.run(ms(30))
    assert network.kernel.labels[-2:] == ("dist[car2, uav]", "dist[car5, uav]")
    found = collector.run()
    assert found == {"dist[car2]": "20:21 30:22 40:23", "dist[car5]": "40:53 50:54"}
    assert network.outputs == ("dist[car5]",)
    assert "dist[car2, uav]" not in network.kernel.labels


def test_figures_3_6_and_3_7_a_mediation_process():
    """One stream generator has the content of pos[car5], and later that of pos[car8]."""
    text = """
    source object attention
    source pos p5
    source pos p8
    strmgen cur_car = attention
    strmgen pos[car5] = p5
    strmgen pos[car8] = p8
    strmgen pos_of_cur_car = merge(pos[car] for each car in cur_car)
    stream position = pos_of_cur_car
    """
    network = network_of(
        text, {"attention": "5:car5 25:car8", "p5": "10:a 20:b 30:c", "p8": "10:x 20:y 30:z 40:w"}
    )

    assert Collector(network).run() == {"position": "10:a 20:b 30:z 40:w"}
    description = network.description["generators"]
    (mediation,) = [each for each in description if each["kind"] == "mediation"]
    assert mediation["inputs"] == [
        {"number": 1, "provider": "cur_car", "policy": ""},
        {"number": 2, "provider": "pos[car8]", "policy": ""},
    ]
    assert mediation["sort"] == "pos"


def test_the_streams_of_all_members_are_merged():
    """What is merged may itself come and go with the members, in the same instant."""
    sets = samples_at({10: {"car2"}, 30: {"car2", "car5"}, 40: {"car5"}})
    text = CARS + DISTANCES + "stream all = merge(dist[c, uav] for each c in car_ids)"
    network = network_of(text, {**STREAMS, "tracked": sets}, outputs=["all"])

    assert Collector(network).run() == {"all": "20:21 30:22 40:23 40:53@40+1 50:54"}
    assert network.outputs == ("all",)


def test_a_member_may_be_a_label():
    """With a stream of labels, the mediation takes whatever it says."""
    text = CARS + "stream chosen = merge(which for each which in cur_car)"
    said = samples_at({5: "pos[car2]", 25: "pos[ car5 ]", 45: ["pos[car2]", "pos[uav]"]})
    network = network_of(text, {**STREAMS, "attention": said})

    assert Collector(network).run() == {"chosen": "10:21 20:22 30:53 40:54 50:25 50:1@50+1"}


def test_a_block_over_tables_with_views_of_their_objects():
    """A table stands for the objects in it; a block inside a block exists once for each pair."""
    text = """
    source cars tracker
    source ids others
    compunit speed Echo(object(cars))
    strmgen cars = tracker
    strmgen others = others
    for each car in cars {
        strmgen speed[car] = Echo(cars[car])
        for each other in others {
            stream speeds[car, other] = sync(speed[car], speed[car])
        }
    }
    stream speed3 = select v from cars[car3]
    """
    tables = samples_at(
        {
            time: Table("car", ids, {"v": np.array(ids) * 10.0})
            for time, ids in {0: [3], 10: [3, 7], 20: [7], 30: [3, 7]}.items()
        }
    )
    network = network_of(text, {"tracker": tables, "others": samples_at({0: ("o", "p")})})
    collector = Collector(network)
    collector.run()

    values = {name: [s.value for s in found] for name, found in collector.samples.items()}
    assert values.pop("speed3") == [{"v": 30.0}] * 3
    assert values == {
        "speeds[car3, o]": [({"v": 30.0}, {"v": 30.0})],
        "speeds[car3, p]": [({"v": 30.0}, {"v": 30.0})],
        "speeds[car7, o]": [({"v": 70.0}, {"v": 70.0})] * 2,
        "speeds[car7, p]": [({"v": 70.0}, {"v": 70.0})] * 2,
    }


def test_a_member_waits_for_labels_that_do_not_exist():
    """Nothing half is built for it; when the label is declared, it is built."""
    network = network_of(CARS + DISTANCES, {**STREAMS, "tracked": samples_at({10: ["car9"]})})
    collector = Collector(network)

    collector.run(ms(20))
    assert network.waiting == {"car car9 of car_ids": ["pos[car9]"]}
    assert network.outputs == ()
    network.add("strmgen pos[car9] = car5_tracker")
    assert network.waiting == {}
    assert network.outputs == ("dist[car9]",)
    assert collector.run()["dist[car9]"].endswith("30:52 40:53 50:54")


@pytest.mark.parametrize(
    ("newest", "reason"),
    [
        (3, "expected a set of objects, or one, found 3"),
        ({"car 2"}, "expected the name of an object, found 'car 2'"),
        ([2], r"expected the names of objects, found \[2\]"),
        (["uav"], r"there is a stream generator called 'pos\[uav\]' already"),
    ],
)
def test_what_is_no_set_of_objects_is_a_failure_of_the_block(newest, reason):
    """The message says what came and what was expected; or that a label is taken."""
    text = (
        CARS
        + "for each car in car_ids { strmgen pos[car] = uav_tracker stream pos[car] = pos[car] }"
    )
    network = network_of(text, {**STREAMS, "tracked": samples_at({10: newest})})

    with pytest.raises(ProcessError, match=f"'for each car in car_ids' failed at 10 ms: {reason}"):
        network.kernel.run()


@pytest.mark.parametrize(
    ("said", "reason"),
    [
        ("pos[", "expected a label such as"),
        ("chosen", "depends on 'chosen'"),
        (3, "expected a set of objects, or one, found 3"),
    ],
)
def test_a_mediation_refuses_what_it_cannot_take(said, reason):
    """A text that is no label, or a stream that the mediation itself feeds."""
    text = CARS + "strmgen chosen = merge(w for each w in cur_car) stream chosen = chosen"
    network = network_of(text, {**STREAMS, "attention": samples_at({10: said})})

    with pytest.raises(ProcessError, match="'chosen' failed at 10 ms: .*" + reason):
        network.kernel.run()


def test_no_value_is_the_empty_set():
    """When a stream of sets says that it knows nothing, there are no members."""
    sets = samples_at({10: {"car2"}, 20: NO_VALUE})
    network = network_of(CARS + DISTANCES, {**STREAMS, "tracked": sets})

    assert Collector(network).run() == {"dist[car2]": "20:21"}
    assert network.outputs == ()


MEMBERS = ["car2", "car5", "uav"]


@settings(derandomize=True, deadline=None, max_examples=40)
@given(
    sets=st.dictionaries(
        st.integers(0, 11).map(lambda time: 5 * time),
        st.sets(st.sampled_from(MEMBERS)).map(frozenset),
        max_size=8,
    )
)
def test_blocks_and_mediations_have_what_the_newest_set_before_says(sets):
    """A sample comes through if its object was in the newest set of an earlier instant."""
    text = (
        CARS.replace("strmgen pos[uav]", "compunit pos Echo(pos) strmgen pos[uav]")
        + "for each car in car_ids { strmgen e[car] = Echo(pos[car]) stream e[car] = e[car] }"
        + "stream merged = merge(pos[car] for each car in car_ids)"
        + "stream echoed = merge(e[car] for each car in car_ids)"
    )
    sets = dict(sorted(sets.items()))
    network = network_of(text, {**STREAMS, "tracked": samples_at(sets)})
    collector = Collector(network)
    collector.run()

    expected = []
    for time in TIMES:
        newest = next((sets[t] for t in reversed(sets) if t < time), frozenset())
        expected += [(time, member) for member in MEMBERS if member in newest]
    trackers = {member: STREAMS[f"{member}_tracker"].split() for member in MEMBERS}
    wanted = [f"{trackers[member][time // 10]}" for time, member in expected]
    for name in ("merged", "echoed"):
        found = [f"{s.valid_time // 1_000_000}:{s.value}" for s in collector.samples[name]]
        assert sorted(found) == sorted(wanted)
    for member in MEMBERS:
        found = [s.valid_time // 1_000_000 for s in collector.samples.get(f"e[{member}]", [])]
        assert found == [time for time, each in expected if each == member]
    last = next(reversed(sets.values()), frozenset())
    assert set(network.outputs) == {"merged", "echoed", *(f"e[{each}]" for each in last)}
    assert {label for label in network.kernel.labels if label.startswith("e[")} == {
        f"e[{each}]" for each in last
    }

"""Networks that are changed while they run."""

import json
from contextlib import suppress

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from dyknow.errors import (
    KPLSyntaxError,
    LabelAlreadyExistsError,
    LabelInUseError,
    NoSuchLabelError,
    PolicyNotSupportedError,
    ServiceError,
    SpecificationErrors,
)
from dyknow.kpl.description import NetworkChange
from dyknow.kpl.implementations import Implementations
from dyknow.kpl.parser import parse_specification
from dyknow.kpl.printer import text_from
from tests.support.networks import Collector, Distance, Echo, network_of, samples_at
from tests.support.streams import ms, text

TEXT = """
parameter period = 20
source n numbers
source n others
compunit n Echo(any)
compunit n Distance(n, n)
strmgen a = numbers
strmgen b = others
strmgen echo[a] = Echo(a with monotone order)
strmgen distance = Distance(echo[a], b with max delay 50)
stream out = distance with any change
"""
SOURCES = {
    "numbers": "0:9 10:8 20:7 30:6 40:5 50:4",
    "others": "0:1 20:2 40:3",
}


def _network(extra="", **options):
    return network_of(TEXT + extra, SOURCES, **options)


def test_more_can_be_declared_while_the_network_runs():
    """What the new output needs is built, and shares what is there; it begins from then on."""
    network = _network()
    collector = Collector(network)

    collector.run(ms(20))
    network.add("strmgen more = Echo(distance) stream more = more")
    found = collector.run()

    assert found["more"] == "30:4 40:2 50:1"
    assert network.kernel.labels == ("a", "echo[a]", "b", "distance", "more")
    assert collector.changes == [(20, NetworkChange(built=["more"], opened=["more"]))]
    assert text_from(network.specification).endswith(
        "strmgen more = Echo(distance)\nstream more = more\n"
    )


def test_more_symbols_can_come_to_stand_for_something():
    """What is provided counts from then on, for what is declared from then on."""
    network = _network()
    network.provide(Implementations(units={"Again": Echo}))
    network.add("compunit n Again(n) strmgen again = Again(b) stream again = again")
    network.provide(Implementations(units={"Again": Distance}))

    assert Collector(network).run()["again"] == "0:1 20:2 40:3"
    assert set(network.declarations.generators) == {"a", "b", "echo[a]", "distance", "again"}


def test_a_change_asked_for_within_an_instant_is_made_at_its_end():
    """A receiver may change the network that it is called by."""
    network = _network()
    seen = []

    def receive(sample):
        seen.append(sample)
        if sample.valid_time == ms(20):
            network.add("stream again = distance")
            network.subscribe("again", seen.append)

    network.subscribe("out", receive)
    network.kernel.run()

    assert text(seen) == "0:8 10:7 20:5 30:4 30:4 40:2 40:2 50:1 50:1"


def test_what_is_wrong_with_an_addition_leaves_the_network_as_it_was():
    """Faults are those of the whole specification, each with its place; nothing is built."""
    network = _network()
    before = network.description, network.specification

    with pytest.raises(SpecificationErrors) as caught:
        network.add("strmgen a = numbers stream x = y\nstrmgen z = Echo(", name="more.kpl")
    assert [fault.span.place for fault in caught.value.exceptions] == ["more.kpl:2:18"]
    with pytest.raises(SpecificationErrors) as caught:
        network.add("strmgen a = numbers stream x = y", name="more.kpl")
    assert [fault.message for fault in caught.value.exceptions] == [
        "stream generator 'a' is already declared at <specification>:7:9",
        "no stream generator called 'y'",
    ]
    with pytest.raises(SpecificationErrors, match="1 fault"):
        network.add("source n nobody strmgen n = nobody stream n = n")
    assert (network.description, network.specification) == before
    network.add("stream x = a", outputs=[])
    assert network.outputs == ("out",)


def test_what_is_removed_is_taken_out_of_the_network():
    """With it goes what it alone needs and has no label; what is declared stays."""
    network = _network("stream both = sync(a, b)")
    collector = Collector(network)
    collector.run(ms(20))

    network.remove(["stream both", "out"])
    assert network.outputs == ()
    assert network.kernel.labels == ("a", "echo[a]", "b", "distance")
    assert collector.run(ms(30))["out"] == "0:8 10:7 20:5"
    network.remove(["echo[a]", "distance", "parameter period", "compunit Distance", "Echo"])
    assert network.kernel.labels == ("a", "b")
    assert text_from(network.specification) == (
        "source n numbers\nsource n others\nstrmgen a = numbers\nstrmgen b = others\n"
    )
    network.add("stream a = a")
    collector.run()
    assert text(collector.samples["a"]) == "40:5 50:4"


@pytest.mark.parametrize(
    ("names", "message"),
    [
        ("a", "'a' is in use by 'echo[a]'"),
        (["a", "echo[a]"], "'echo[a]' is in use by 'distance'"),
        ("Echo", "'Echo' is in use by 'echo[a]'"),
        ("numbers", "'numbers' is in use by 'a'"),
        ("distance", "'distance' is in use by 'out'"),
    ],
)
def test_what_others_need_is_not_removed(names, message):
    """They are named; nothing is changed."""
    network = _network()
    before = network.description, network.specification

    with pytest.raises(LabelInUseError) as caught:
        network.remove(names)

    assert str(caught.value) == message
    assert (network.description, network.specification) == before


def test_what_somebody_has_subscribed_to_is_not_removed():
    """A subscription made at the kernel counts as well."""
    network = _network()
    network.kernel.subscribe("distance", print)

    with pytest.raises(LabelInUseError, match="'distance' is in use by 'output'"):
        network.remove(["out", "distance"])
    assert network.outputs == ("out",)


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("ehco[a]", "nothing is declared that is called 'ehco[a]'; did you mean 'echo[a]'?"),
        ("strmgen x", "nothing is declared that is called 'strmgen x'"),
        ("both", "'both' may be 'strmgen both', 'stream both'; expected one of them"),
    ],
)
def test_what_is_to_be_removed_must_be_clear(name, message):
    """An unknown name, or one that two declarations have, is a mistake of the caller."""
    network = _network("strmgen both = Echo(a) stream both = both")

    with pytest.raises(ServiceError) as caught:
        network.remove(name)

    assert str(caught.value).startswith(message)


def test_a_parameter_in_use_is_not_removed():
    """The declarations that use it are named."""
    network = _network("stream slow = a with sample every period")

    with pytest.raises(LabelInUseError, match="'period' is in use by 'slow'"):
        network.remove("period")


def test_a_policy_is_replaced_in_the_specification_and_at_work():
    """Outputs with all who have subscribed, and inputs of processes."""
    network = _network()
    collector = Collector(network)
    collector.run(ms(10))

    network.replace_policy("out", "from 0 to 35")
    network.replace_policy(("echo[a]", 1), "sample every 20")
    found = collector.run()

    assert found == {"out": "0:8 10:7 30:4"}
    printed = text_from(network.specification)
    assert "stream out = distance with from 0 to 35\n" in printed
    assert "strmgen echo[a] = Echo(a with sample every 20)\n" in printed
    inputs = {each["label"]: each["inputs"] for each in network.description["generators"]}
    assert inputs["echo[a]"] == [{"number": 1, "provider": "a", "policy": "sample every 20"}]


@pytest.mark.parametrize(
    ("target", "policy", "error", "message"),
    [
        ("oot", "", ServiceError, "no output stream called 'oot'; did you mean 'out'"),
        (("echo", 1), "", NoSuchLabelError, "called 'echo'"),
        (("distance", 3), "", ServiceError, "'distance' has inputs 1 to 2, found 3"),
        (("a", 1), "", ServiceError, "'a' has no input with a policy of its own"),
        (("j", 1), "", ServiceError, "a synchronisation without a label has a state policy"),
        ("out", "sample evry 3", KPLSyntaxError, "expected 'every', found 'evry'"),
        ("out", "sample every 0", SpecificationErrors, "1 fault"),
        ("p", "max delay 3", SpecificationErrors, "1 fault"),
    ],
)
def test_a_policy_that_cannot_be_is_refused(target, policy, error, message):
    """An unknown stream, no policy, or one that cannot be kept; nothing is changed."""
    network = _network(
        "strmgen j = Echo(sync(a, b)) strmgen p = Echo(a) with max delay 5 stream p = p"
    )
    before = network.description, network.specification

    with pytest.raises(error, match=message.replace("(", r"\(")):
        network.replace_policy(target, policy)
    assert (network.description, network.specification) == before


BLOCK = """
source ids members
strmgen members = members
for each m in members {
    strmgen e[m] = Echo(a)
    stream e[m] = e[m] with any change
    for each k in members { stream inner[m, k] = e[m] }
}
strmgen merged = merge(e[m] for each m in members)
stream merged = merged
"""


def _network_with_members(**options):
    sources = {**SOURCES, "members": samples_at({0: ["x"], 25: ["x", "y"]})}
    return network_of(TEXT + BLOCK, sources, **options)


def test_policies_inside_blocks_are_replaced_for_all_members():
    """For those that exist as well as for those that come later."""
    network = _network_with_members()
    collector = Collector(network)
    collector.run(ms(10))

    network.replace_policy(("e[m]", 1), "to 40")
    network.replace_policy("e[m]", "to 30")
    network.replace_policy(("merged", 2), "to 20")
    found = collector.run()

    assert found["e[x]"] == "10:8 20:7 30:6"
    assert found["e[y]"] == "30:6"
    assert found["inner[y, x]"] == "30:6 40:5"
    assert found["merged"] == "10:8 20:7"


def test_a_block_is_removed_with_all_that_exists_for_its_members():
    """Mediations let go of its streams; it is called by its first words."""
    network = _network_with_members()
    with pytest.raises(LabelInUseError, match="'for each m in members' is in use by 'merged'"):
        network.remove("for each m in members")
    network.add("strmgen e[z] = Echo(b)")
    collector = Collector(network)
    collector.run(ms(30))

    network.remove("for each m in members")
    found = collector.run()

    assert found["merged"] == "10:8 20:7 30:6 30:6@30+1"
    assert network.outputs == ("out", "merged")
    assert network.kernel.labels == ("a", "echo[a]", "b", "distance", "members", "merged", "e[z]")
    network.remove(["stream merged", "strmgen merged", "e[z]"])
    assert network.kernel.labels == ("a", "echo[a]", "b", "distance", "members")


def test_a_generator_that_members_use_is_not_removed():
    """What members use is known only from what has been built for them."""
    block = BLOCK.replace("Echo(a)", "Echo(p[m])").replace("for each k", "for each j")
    sources = {**SOURCES, "members": samples_at({0: ["x"]})}
    network = network_of(TEXT + block.replace("m, k", "m, j") + "strmgen p[x] = Echo(a)", sources)
    network.add("strmgen p[y] = Echo(a)")
    network.kernel.run(ms(10))

    with pytest.raises(LabelInUseError, match=r"'p\[x\]' is in use by 'e\[x\]'"):
        network.remove("p[x]")


def test_a_label_of_a_member_is_not_declared_again():
    """The member was there first."""
    network = _network_with_members()
    network.kernel.run(ms(10))

    with pytest.raises(LabelAlreadyExistsError, match=r"called 'e\[x\]' already"):
        network.add("strmgen e[x] = Echo(a) stream z = e[x]")


def test_streams_are_subscribed_to_when_they_exist():
    """An output that is there for a member later is not there before."""
    network = _network_with_members()

    with pytest.raises(ServiceError, match=r"no output stream called 'e\[x\]'"):
        network.subscribe("e[x]", print)
    network.kernel.run(ms(0))
    network.subscribe("e[x]", print).end()


def test_only_wanted_outputs_of_a_block_are_made():
    """They are chosen by the name that is written in the block."""
    network = _network_with_members(outputs=["e[m]"])
    network.kernel.run()

    assert network.outputs == ("e[x]", "e[y]")
    assert set(network.kernel.labels) == {"a", "members", "e[x]", "e[y]"}


def test_the_description_is_plain_data():
    """It survives JSON, and says of each process what is written of it."""
    network = _network(
        "strmgen s = sync(a, select x from b) with max delay 3 on failure end stream s = s"
    )

    description = json.loads(json.dumps(network.description))

    assert description == network.description
    generators = {each.pop("label"): each for each in description["generators"]}
    assert generators["echo[a]"] == {
        "kind": "unit",
        "process": "Echo(a with monotone order)",
        "sort": "n",
        "inputs": [{"number": 1, "provider": "a", "policy": "monotone order"}],
        "output_policy": "",
        "on_failure": "stop",
    }
    assert generators["s"]["kind"] == "synchronisation"
    assert generators["s"]["sort"] == "state(n, n)"
    assert generators["s"]["output_policy"] == "max delay 3"
    assert generators["s"]["on_failure"] == "end"
    assert generators["select x from b"]["kind"] == "selection"
    assert description["outputs"] == [
        {"name": "out", "provider": "distance", "policy": "any change"},
        {"name": "s", "provider": "s", "policy": ""},
    ]


def test_a_promise_reaches_the_running_generator():
    """A policy that the promise excludes is refused to whoever subscribes."""
    network = _network("strmgen p = Echo(a) with max delay 5 stream p = p")
    wanted = network.kernel.streams[0].policy.__class__(max_delay=ms(1))

    with pytest.raises(PolicyNotSupportedError):
        network.kernel.subscribe("p", print, wanted)


def test_parts_of_a_specification_can_be_added_as_trees():
    """A tree does as well as a text."""
    network = _network()

    network.add(parse_specification("stream more = a"))

    assert network.outputs == ("out", "more")


def test_a_process_may_end_alone():
    """With `on failure end` the rest goes on."""
    text = """
    source n numbers
    compunit n Distance(n, n)
    strmgen a = numbers
    strmgen broken = Distance(a, a) on failure end
    stream broken = broken
    stream a = a
    """
    network = network_of(text, {"numbers": "0:1 10:x 20:3"})
    failures = []
    network.kernel.subscribe_failures(failures.append)

    assert Collector(network).run() == {"broken": "0:0", "a": "0:1 10:x 20:3"}
    assert [failure.label for failure in failures] == ["broken"]


PARTS = [
    "strmgen c = Echo(a)",
    "strmgen d = Echo(sync(c, b) with use latest)",
    "strmgen e = merge(c, Echo_b)".replace("Echo_b", "b with to 20"),
    "strmgen f = Echo(select * from merge(a, b))",
    "stream c = c",
    "stream d = d",
    "stream e = e with any change",
    "stream f = f",
    "stream joined = sync(merge(a, b), c) with use latest",
]


@settings(derandomize=True, deadline=None, max_examples=60)
@given(st.lists(st.tuples(st.booleans(), st.sampled_from(PARTS)), max_size=14))
def test_a_changed_network_is_that_of_its_specification(steps):
    """Whatever was added and removed before, it gives what a new one gives."""
    base = "source n s1 source n s2 compunit n Echo(any) strmgen a = s1 strmgen b = s2 "
    sources = {"s1": "0:1 10:2 20:3", "s2": "5:x 15:y 25:z"}
    network = network_of(base, sources)
    for is_addition, part in steps:
        with suppress(SpecificationErrors, ServiceError):
            if is_addition:
                network.add(part)
            else:
                network.remove(part.partition(" = ")[0])

    declared = text_from(network.specification)
    fresh = network_of(declared, sources)

    assert set(fresh.outputs) == set(network.outputs)
    assert Collector(fresh).run() == Collector(network).run()
    taken = {stream.provider for stream in network.kernel.streams}
    for label in network.kernel.labels:
        assert f"strmgen {label} = " in declared or label in taken

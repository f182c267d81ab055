"""Chronicles over the streams of networks that are declared in KPL."""

from collections.abc import Iterable
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from chronicles.attributes import AttributeInterpretation
from chronicles.events import Event, Recognition, event_from_recognition
from chronicles.models import models_from_chronicles
from chronicles.parser import parse_chronicles
from chronicles.reasoning import ChronicleReasoner
from chronicles.recognition import Recogniser
from chronicles.registering import (
    ChronicleAlreadyRegisteredError,
    NoSuchChronicleError,
    RecognitionSettings,
)
from dyknow.errors import LabelInUseError, PrototypeAlreadyExistsError, SpecificationErrors
from dyknow.kpl.printer import text_from
from dyknow.streams.policy import Constraint
from dyknow.streams.sample import NO_VALUE, Heartbeat, Sample
from dyknow.streams.table import Table
from dyknow.time import Duration
from tests.support.networks import network_of, samples_at
from tests.support.streams import ms

SPEED = """
source text class1
source text class2
strmgen speed_class[car1] = class1
strmgen speed_class[car2] = class2
stream first = speed_class[car1]
stream second = speed_class[car2]
"""
SLOWS = "chronicle slows[?c] { event(speed_class[?c]:(fast, slow), t) }"
STARTS = "chronicle starts[?c] { event(speed_class[?c]:(?, fast), t) }"
CARS = """
source cars cars
strmgen cars = cars
"""


def speeds(first: dict[float, Any], second: dict[float, Any], **options: Any) -> ChronicleReasoner:
    """Return a reasoner over the speed classes of two cars."""
    sources = {"class1": samples_at(first), "class2": samples_at(second)}
    return ChronicleReasoner(network_of(SPEED, sources), **options)


def cars(tables: dict[float, Any], **options: Any) -> ChronicleReasoner:
    """Return a reasoner over tables of cars."""
    return ChronicleReasoner(network_of(CARS, {"cars": samples_at(tables)}), **options)


def table(*ids: int, **columns: Any) -> Table:
    """Return a table of cars."""
    return Table("car", ids, {name: np.array(column) for name, column in columns.items()})


def heard(reasoner: ChronicleReasoner, name: str) -> list[tuple[float, str]]:
    """Return a list to which what is recognised is added: when, and of whom."""
    found: list[tuple[float, str]] = []

    def receive(sample: Sample[tuple[Recognition, ...]]) -> None:
        times = [each.recognised_at / 1e6 for each in sample.value]
        found.extend(zip(times, map(_who, sample.value), strict=True))

    reasoner.subscribe(name, receive)
    return found


def _who(recognition: Recognition) -> str:
    return " ".join(recognition.arguments.values())


def test_an_attribute_is_every_stream_of_its_name():
    """Changes of the values of `speed_class[X]` are events, for each object X."""
    reasoner = speeds({0: "fast", 200: "slow"}, {100: "slow", 300: "fast", 400: "slow"})

    assert reasoner.register(SLOWS) == ("slows",)
    found = heard(reasoner, "slows")
    reasoner.network.kernel.run()

    assert found == [(200.0, "car1"), (400.0, "car2")]
    registration = reasoner.chronicles["slows"]
    assert registration.streams == ("speed_class[car1]", "speed_class[car2]")


def test_the_first_value_is_a_change_from_unknown():
    """A repeated value is none; a value that is lost can be found again."""
    reasoner = speeds({0: "fast", 100: "fast", 200: NO_VALUE, 300: "fast"}, {})
    reasoner.register(STARTS)
    found = heard(reasoner, "starts")

    reasoner.network.kernel.run()

    assert found == [(0.0, "car1"), (300.0, "car1")]


def test_columns_of_tables_are_attributes_of_their_objects():
    """A row that appears comes from unknown; one that vanishes is unknown, as is NaN."""
    reasoner = cars(
        {
            0: table(1, 2, lane=[0.0, 3.0]),
            100: table(2, 1, lane=[4.0, 0.0]),
            200: table(2, lane=[np.nan]),
            300: table(2, lane=[np.nan]),
            400: NO_VALUE,
        }
    )
    reasoner.register("chronicle change[?c, ?v] { event(cars.lane[?c]:(?, ?v), t) }")
    reasoner.register("chronicle loss[?c, ?v] { event(cars.lane[?c]:(?v, ?), t) }")
    changes, losses = heard(reasoner, "change"), heard(reasoner, "loss")

    reasoner.network.kernel.run()

    assert changes == [(0.0, "car1 0.0"), (0.0, "car2 3.0"), (100.0, "car2 4.0")]
    assert losses == [(100.0, "car2 3.0"), (200.0, "car1 0.0"), (200.0, "car2 4.0")]


def test_an_interpretation_says_what_attributes_objects_and_values_are_called():
    """The rows of a table of pairs are about two cars; numbers have names."""
    pairs = """
    source pairs pairs
    strmgen pairs = pairs
    """
    rows = {"first": np.array([3]), "second": np.array([7])}
    tables = {
        time: Table("pair", [0], {**rows, "lane": np.array([lane])})
        for time, lane in ((0, 0), (100, 1))
    }
    reasoner = ChronicleReasoner(
        network_of(pairs, {"pairs": samples_at(tables)}),
        AttributeInterpretation(
            features={"lane": "pairs.lane"},
            objects={"pairs": ["car%first%", "car%second%"]},
            values={"lane": ["left", "right"].__getitem__},
        ),
    )
    reasoner.register("chronicle change[?a, ?b, ?v] { event(lane[?a, ?b]:(left, ?v), t) }")
    found = heard(reasoner, "change")

    reasoner.network.kernel.run()

    assert found == [(100.0, "car3 car7 right")]


def test_messages_and_events_come_from_streams_too():
    """Each sample of a declared message is one; a stream of events is told by name."""
    told = Event("alarm", ("north",), None, None, ms(300))
    reasoner = ChronicleReasoner(
        network_of(
            """
            source flash flash
            source events events
            strmgen flash[uav1] = flash
            strmgen events = events
            """,
            {"flash": samples_at({0: 1, 100: 1}), "events": samples_at({300: (told,)})},
        ),
        AttributeInterpretation({"alarm": "events"}),
    )
    reasoner.register(
        """
        message flash[?uav]
        message alarm[?place]
        chronicle both[?uav, ?place] { event(flash[?uav], t1) event(alarm[?place], t2) t1 < t2 }
        """
    )
    found = heard(reasoner, "both")

    reasoner.network.kernel.run()

    assert found == [(300.0, "uav1 north"), (300.0, "uav1 north")]


def users(reasoner: ChronicleReasoner, label: str) -> list[str]:
    """Return who receives the samples of a generator."""
    streams = reasoner.network.kernel.streams
    return [str(each.receiver) for each in streams if each.provider == label]


def quoted(text: str) -> str:
    """Return *text* as KPL writes it."""
    return f'"{text}"'


def ordered(number: int) -> str:
    """Return a speed class in order of valid time."""
    return f"speed_class[car{number}] with monotone order"


def recognising(name: str) -> str:
    """Return the process of a chronicle over both speed classes."""
    return f"RecogniseChronicle(changes_1, changes_2, name = {quoted(name)})"


def test_what_is_declared_for_a_chronicle_is_taken_back():
    """The declarations are KPL; two chronicles over one attribute share one stream."""
    reasoner = speeds({0: "fast"}, {})
    before = len(reasoner.network.specification.declarations)
    reasoner.register(SLOWS)
    reasoner.register(STARTS)

    declared = [text_from(each) for each in reasoner.network.specification.declarations[before:]]
    assert declared == [
        "compunit events AttributeChanges(any)",
        "compunit recognitions RecogniseChronicle(events, ...)",
        f"strmgen changes_1 = AttributeChanges({ordered(1)}, name = {quoted('changes_1')})",
        f"strmgen changes_2 = AttributeChanges({ordered(2)}, name = {quoted('changes_2')})",
        f"strmgen recognitions[slows] = {recognising('slows')}",
        "stream recognitions[slows] = recognitions[slows]",
        f"strmgen recognitions[starts] = {recognising('starts')}",
        "stream recognitions[starts] = recognitions[starts]",
    ]
    assert users(reasoner, "speed_class[car1]") == ["changes_1"]
    reasoner.withdraw("slows")
    assert users(reasoner, "speed_class[car1]") == ["changes_1"]
    reasoner.withdraw("starts")
    assert users(reasoner, "speed_class[car1]") == []
    assert len(reasoner.network.specification.declarations) == before


def test_chronicles_come_and_go_while_the_network_runs():
    """A new chronicle knows the present values, as changes from unknown; a withdrawn one ends."""
    reasoner = speeds({0: "fast", 300: "slow", 500: "fast"}, {100: "fast", 300: "slow"})
    found: dict[str, list[tuple[float, str]]] = {}

    def change(now: int) -> None:
        if now == ms(100):
            reasoner.network.kernel.change(join)
        if now == ms(300):
            reasoner.withdraw("slows")

    def join() -> None:
        for name, text in (("starts", STARTS), ("slows", SLOWS)):
            reasoner.register(text)
            found[name] = heard(reasoner, name)

    reasoner.network.kernel.run(on_time=change)

    assert found["starts"] == [(0.0, "car1"), (100.0, "car2"), (500.0, "car1")]
    assert found["slows"] == []
    assert list(reasoner.chronicles) == ["starts"]


def test_what_a_late_chronicle_knows_does_not_depend_on_others():
    """It is the same whether the changes of its streams have been found for others or not."""
    told = []
    for first in ((), (STARTS,)):
        reasoner = speeds({0: "fast", 200: "slow"}, {50: "slow", 400: "fast"})
        for text in first:
            reasoner.register(text)
        reasoner.network.kernel.run(ms(100))
        reasoner.register("chronicle is[?c, ?v] { event(speed_class[?c]:(?, ?v), t) }")
        found = heard(reasoner, "is")
        reasoner.network.kernel.run()
        told.append(found)

    assert told[0] == told[1]
    assert told[0][:2] == [(0.0, "car1 fast"), (50.0, "car2 slow")]


def test_recognitions_are_attributes_of_other_chronicles():
    """They may be registered together or apart; who is used cannot be withdrawn."""
    twice = """
    chronicle twice[?c] {
        event(slows[?c]:(?, ?), t1)
        event(slows[?c]:(?, ?), t2)
        t1 < t2
    }
    """
    for texts in ([twice + SLOWS], [SLOWS, twice]):
        reasoner = speeds({0: "fast", 100: "slow", 200: "fast", 300: "slow"}, {})
        for text in texts:
            reasoner.register(text)
        found = heard(reasoner, "twice")
        reasoner.network.kernel.run()

        assert found == [(300.0, "car1")]
        with pytest.raises(LabelInUseError, match=r"'recognitions\[slows\]' is in use"):
            reasoner.withdraw("slows")
        reasoner.withdraw("twice")
        reasoner.withdraw("slows")


def test_streams_of_different_delays_are_put_in_order():
    """What the streams promise about their delays, or the settings, says how long to wait."""
    pattern = """
    chronicle pair {
        event(a:(?, on), t1)
        event(b:(?, on), t2)
        t1 < t2
    }
    """
    late = [Sample("on", ms(100), ms(150))]
    for promise, settings_given in (
        (" with max delay 60", None),
        ("", RecognitionSettings(Duration(ms(60)))),
    ):
        text = f"source x a source x b strmgen a = a{promise} strmgen b = b{promise}"
        network = network_of(text, {"a": late, "b": samples_at({120: "on"})})
        reasoner = ChronicleReasoner(network, settings=settings_given)
        reasoner.register(pattern)
        found = heard(reasoner, "pair")
        network.kernel.run(ms(300))

        assert found == [(120.0, "")]
        assert reasoner.chronicles["pair"].max_delay == ms(60)
        assert reasoner.chronicles["pair"].unit.n_late == 0


def test_without_a_promise_what_comes_too_late_is_left_out():
    """As in the thesis, samples count as they arrive; what is out of order does not."""
    network = network_of(
        "source x a source x b strmgen a = a strmgen b = b",
        {"a": [Sample("on", ms(100), ms(150))], "b": samples_at({120: "on"})},
    )
    reasoner = ChronicleReasoner(network)
    reasoner.register("chronicle pair { event(a:(?, on), t1) event(b:(?, on), t2) }")
    found = heard(reasoner, "pair")

    network.kernel.run()

    assert found == []
    assert reasoner.chronicles["pair"].unit.n_late == 1


def test_samples_beyond_the_largest_delay_are_violations():
    """The policy of the settings is that of the stream."""
    network = network_of("source x a strmgen a = a", {"a": [Sample("on", ms(0), ms(80))]})
    reasoner = ChronicleReasoner(network, settings=RecognitionSettings(Duration(ms(60))))
    reasoner.register("chronicle seen { event(a:(?, on), t) }")
    found = heard(reasoner, "seen")
    told: list[Any] = []
    network.kernel.subscribe_violations(told.append)

    network.kernel.run(ms(500))

    assert found == []
    assert [each.violation.constraint for each in told] == [Constraint.DELAY]


def test_samples_without_a_discrete_value_are_violations():
    """A list is not discrete, a text is no table; what comes next is compared with the last."""
    reasoner = cars({0: table(1, lane=[[1, 2]]), 100: "none", 200: table(1, lane=[3])})
    reasoner.register("chronicle change[?c, ?v] { event(cars.lane[?c]:(?, ?v), t) }")
    found = heard(reasoner, "change")
    told: list[str] = []
    reasoner.network.kernel.subscribe_violations(lambda each: told.append(each.violation.reason))

    reasoner.network.kernel.run()

    assert found == [(200.0, "car1 3")]
    assert len(told) == 2
    assert "one value in each row" in told[0]
    assert "a table in 'cars', found str" in told[1]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("event(sped_class[?c]:(?, slow), t)", r"nearest is 'speed_class'"),
        ("event(speed_class[?c, ?c]:(?, slow), t)", r"called 'speed_class\[...\]'"),
        ("event(cars[?c]:(?, slow), t)", r"a column of the tables of 'cars', as in 'cars.COLUMN'"),
        ("event(cars.a[?c, ?c]:(?, slow), t)", r"how 2 objects are called in the rows of 'cars'"),
        ("event(crew[?c]:(?, slow), t)", r"that is always there, not only for the members"),
        ("event(renamed[?c, ?c]:(?, slow), t)", r"a label with 2 objects, found 'speed_class"),
    ],
)
def test_an_attribute_without_a_stream_is_a_fault_with_a_place(text, message):
    """Nothing is registered then."""
    specification = (
        SPEED
        + CARS
        + """
    source set set
    strmgen set = set
    for each c in set { strmgen crew[c] = class1 }
    """
    )
    sources = {"class1": "", "class2": "", "cars": "", "set": ""}
    reasoner = ChronicleReasoner(
        network_of(specification, sources),
        AttributeInterpretation({"renamed": "speed_class[car1]"}),
    )

    with pytest.raises(SpecificationErrors) as caught:
        reasoner.register(f"chronicle x[?c] {{ {text} }}")

    (fault,) = caught.value.exceptions
    assert fault.span.start > 0
    with pytest.raises(type(fault), match=message):
        raise fault
    assert reasoner.chronicles == {}


def test_a_limit_on_partial_instances_is_kept():
    """Of two cars that are fast only the later one is followed."""
    text = """
    chronicle stop[?c] {
        event(speed_class[?c]:(?, fast), t1)
        event(speed_class[?c]:(fast, ?), t2)
        t1 < t2 <= t1 + 1000
    }
    """
    for limit, expected in ((None, 2), (1, 1)):
        reasoner = speeds({0: "fast"}, {100: "fast"}, settings=RecognitionSettings(limit=limit))
        reasoner.register(text)
        reasoner.network.kernel.run()
        unit = reasoner.chronicles["stop"].unit
        assert len(unit.recogniser.partial_instances()) == expected


def test_names_are_given_once_and_known():
    """One reasoner for each network; names of chronicles are their own."""
    reasoner = speeds({}, {})
    reasoner.register(SLOWS)

    with pytest.raises(ChronicleAlreadyRegisteredError, match="'slows' is recognised already"):
        reasoner.register(models_from_chronicles(parse_chronicles(SLOWS)))
    with pytest.raises(NoSuchChronicleError, match="did you mean 'slows'"):
        reasoner.withdraw("slow")
    with pytest.raises(NoSuchChronicleError):
        reasoner.subscribe("starts", print)
    with pytest.raises(ValueError, match="at least one chronicle"):
        reasoner.register("")
    with pytest.raises(PrototypeAlreadyExistsError):
        ChronicleReasoner(reasoner.network)
    with pytest.raises(ValueError, match="for the feature 'a'"):
        AttributeInterpretation({"a": "b c"})
    with pytest.raises(ValueError, match="names of objects"):
        AttributeInterpretation(objects={"a": "car%first%"})


CHANGES = st.lists(
    st.tuples(
        st.sampled_from(("class1", "class2", "light")),
        st.integers(0, 60),
        st.integers(0, 8),
        st.sampled_from("abc"),
    ),
    max_size=14,
)
PATTERNS = """
chronicle pass[?c] {
    event(speed_class[?c]:(?, a), t1)
    event(light:(?, b), t2)
    event(speed_class[?c]:(?x, ?y), t3)
    noevent(light:(?, c), (t1, t3))
    t1 <= t2 <= t3 <= t1 + 40
}
chronicle quiet[?c] {
    event(speed_class[?c]:(?, ?), t1)
    noevent(speed_class[?c]:(?, ?), (t1 + 1, t1 + 20))
}
chronicle both[?c] {
    event(pass[?c]:(?, ?), t1)
    event(quiet[?c]:(?, ?), t2)
    t1 <= t2 <= t1 + 30
}
"""


@settings(derandomize=True, deadline=None, max_examples=60)
@given(CHANGES, st.booleans())
def test_the_streams_come_to_what_their_changes_come_to(
    drawn: list[tuple[str, int, int, str]], is_promised: bool
) -> None:
    """Whatever the delays: as if all changes were told to a recogniser in order of valid time."""
    streams = {name: in_order(name, drawn) for name in ("class1", "class2", "light")}
    promise = " with max delay 8" if is_promised else ""
    network = network_of(
        f"""
        source text class1
        source text class2
        source text light
        strmgen speed_class[car1] = class1{promise}
        strmgen speed_class[car2] = class2{promise}
        strmgen light = light{promise}
        """,
        {
            name: samples if is_promised else with_heartbeats(samples)
            for name, samples in streams.items()
        },
    )
    reasoner = ChronicleReasoner(network)
    found: list[Recognition] = []
    for name in reasoner.register(PATTERNS):
        reasoner.subscribe(name, lambda sample: found.extend(sample.value))

    network.kernel.run(ms(300))

    assert sorted(map(key, found)) == sorted(map(key, naive(streams)))


def in_order(name: str, drawn: Iterable[tuple[str, int, int, str]]) -> list[Sample[str]]:
    """Return a stream in strict order whose samples have the delays drawn."""
    by_time = {valid: (delay, value) for one, valid, delay, value in drawn if one == name}
    samples: list[Sample[str]] = []
    for valid, (delay, value) in sorted(by_time.items()):
        available = max(ms(valid + delay), samples[-1].available_time + 1 if samples else 0)
        if available <= ms(valid + 8):
            samples.append(Sample(value, ms(valid), type(ms(0))(available)))
    return samples


def with_heartbeats(samples: list[Sample[str]]) -> list[Any]:
    """Return a stream that says from time to time how far it is complete."""
    beats = [Heartbeat(ms(time - 8) - 1, ms(time)) for time in range(0, 300, 3)]
    return sorted([*beats, *samples], key=lambda each: each.available_time)


def naive(streams: dict[str, list[Sample[str]]]) -> list[Recognition]:
    """Return what one recogniser finds in the changes of all streams, in order of time."""
    names = {"class1": ("speed_class", ("car1",)), "class2": ("speed_class", ("car2",))}
    events: list[Event] = []
    for name, samples in streams.items():
        attribute, arguments = names.get(name, ("light", ()))
        last = None
        for sample in samples:
            if sample.value != last:
                time = sample.valid_time
                events.append(Event(attribute, arguments, last, sample.value, time))
                last = sample.value
    recogniser = Recogniser(models_from_chronicles(parse_chronicles(PATTERNS)))
    found: list[Recognition] = []
    for time in sorted({event.time for event in events}):
        found += recogniser.push(time, [event for event in events if event.time == time])
    return found + recogniser.advance(ms(300))


def key(recognition: Recognition) -> tuple[Any, ...]:
    """Return what makes a recognition the same as another."""
    event = event_from_recognition(recognition)
    return event.attribute, event.arguments, recognition.recognised_at, recognition.begin


SWAP = """
chronicle swap[?c, ?d] {
    event(speed_class[?c]:(?, ?x), t1)
    event(speed_class[?d]:(?x, ?), t2)
    t1 <= t2 <= t1 + 30
}
"""


@settings(derandomize=True, deadline=None, max_examples=60)
@given(CHANGES, st.integers(0, 70), st.integers(0, 70), st.booleans())
def test_late_and_withdrawn_chronicles_find_what_is_theirs(
    drawn: list[tuple[str, int, int, str]], begins: int, lasts: int, has_company: bool
) -> None:
    """From the present values on, up to the end, whoever else looks at the streams."""
    streams = {name: in_order(name, drawn) for name in ("class1", "class2")}
    promise = " with max delay 8"
    network = network_of(
        f"""
        source text class1
        source text class2
        strmgen speed_class[car1] = class1{promise}
        strmgen speed_class[car2] = class2{promise}
        stream first = speed_class[car1]
        stream second = speed_class[car2]
        """,
        {name: list(samples) for name, samples in streams.items()},
    )
    reasoner = ChronicleReasoner(network)
    if has_company:
        reasoner.register(STARTS)
    network.kernel.run(ms(begins))
    reasoner.register(SWAP)
    found: list[Recognition] = []
    reasoner.subscribe("swap", lambda sample: found.extend(sample.value))
    network.kernel.run(ms(begins + lasts))
    reasoner.withdraw("swap")
    network.kernel.run(ms(300))

    expected = swaps(streams, begins)
    told = [key(each) for each in found]
    sure = [key(each) for each in expected if each.recognised_at + ms(8) <= ms(begins + lasts)]
    assert len(set(told)) == len(told)
    assert set(sure) <= set(told) <= {key(each) for each in expected}


def swaps(streams: dict[str, list[Sample[str]]], begins: int) -> list[Recognition]:
    """Return all swaps in what is new after some time, and in the values that there are then."""
    events: list[Event] = []
    for name, samples in streams.items():
        before = [each for each in samples if each.available_time <= ms(begins)]
        last = None
        for sample in [*before[-1:], *samples[len(before) :]]:
            if sample.value != last:
                car = name.replace("class", "car")
                events.append(Event("speed_class", (car,), last, sample.value, sample.valid_time))
                last = sample.value
    recogniser = Recogniser(models_from_chronicles(parse_chronicles(SWAP)))
    return [
        recognition
        for time in sorted({event.time for event in events})
        for recognition in recogniser.push(time, [each for each in events if each.time == time])
    ]

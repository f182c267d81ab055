"""Synchronisations, selections and mergings in KPL, at work."""

from itertools import pairwise

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from dyknow.kpl.check import faults_of_text
from dyknow.kpl.parser import parse_policy, parse_specification
from dyknow.kpl.policies import policy_from_constraints
from dyknow.kpl.states import policy_of_states, state_policy_from_constraints, synchroniser
from dyknow.streams.joining import Latest
from dyknow.streams.policy import Order, Policy, SampleEvery
from dyknow.streams.state_policy import Occasion, Settling, StateApproximation, StatePolicy
from dyknow.streams.synchronisation import Synchronisation
from tests.support.networks import Collector, network_of, samples_at
from tests.support.streams import ms

UAV = """
source speed speedometer
source winch winch_sensor
strmgen speed[uav1] = speedometer
strmgen winch[uav1] = winch_sensor
"""
TABLE_7_1 = {
    "speedometer": "1000:s1@1010 1100:s2@1110 1200:s3@1280 1300:s4@1320",
    "winch_sensor": "1050:w1@1120 1150:w2@1170 1250:w3@1260",
}


def test_definition_7_8_6_a_state_stream_generator():
    """The declaration of the thesis makes the states of its table 7.2."""
    text = UAV + (
        "strmgen s = state(speed[uav1] with sample every 100, max delay 100,"
        " winch[uav1] with sample every 100, max delay 100) with from 1050 to 1250,"
        " sample every 100, use most recent, delay before approximation 100, max delay 100"
        " stream s = s"
    )
    found = Collector(network_of(text, TABLE_7_1)).run()

    assert found == {"s": "1050:('s1', 'w1')@1120 1150:('s2', 'w2')@1170 1250:('s3', 'w3')@1280"}


def test_the_word_of_the_thesis_means_the_same():
    """`state(...)` and `sync(...)` are one construct."""
    one = parse_specification(UAV + "strmgen s = state(speed[uav1]) with use latest")

    assert one == parse_specification(UAV + "strmgen s = sync(speed[uav1]) with use latest")


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("", StatePolicy()),
        ("any update, no approximation, max delay oo", StatePolicy()),
        ("any change", StatePolicy(occasion=Occasion.ANY_CHANGE)),
        (
            "all updates, use linear, capacity 5",
            StatePolicy(
                occasion=Occasion.ALL_UPDATES, approximation=StateApproximation.LINEAR, capacity=5
            ),
        ),
        ("sample every common period", StatePolicy(occasion=Occasion.SAMPLED)),
        (
            "sample every 2, max delay 3, at max delay, from 1 to 5",
            StatePolicy(
                occasion=Occasion.SAMPLED,
                period=ms(2),
                max_delay=ms(3),
                settling=Settling.AT_MAX_DELAY,
                start=ms(1),
                end=ms(5),
            ),
        ),
        (
            "use most recent, delay before approximation 3",
            StatePolicy(
                approximation=StateApproximation.MOST_RECENT, delay_before_approximation=ms(3)
            ),
        ),
    ],
)
def test_each_constraint_says_its_part_of_the_state_policy(text, expected):
    """What is left out has the defaults of a state policy."""
    assert state_policy_from_constraints(parse_policy(text)) == expected


def test_use_latest_chooses_the_other_family_of_joins():
    """It waits for nothing; all other state policies make reproducible joins."""
    latest = synchroniser(["a"], parse_policy("use latest, any change"), [Policy()])
    reproducible = synchroniser(["a"], parse_policy("use most recent"), [Policy()])

    assert isinstance(latest, Latest)
    assert isinstance(reproducible, Synchronisation)
    with pytest.raises(ValueError, match="waits for nothing"):
        synchroniser(["a"], parse_policy("use latest, max delay 3"), [Policy()])


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("", Policy(order=Order.STRICT)),
        ("use latest", Policy(order=Order.MONOTONE)),
        ("use latest, sample every 5", Policy(change=SampleEvery(ms(5)), order=Order.STRICT)),
        ("max delay 3, to 9", Policy(order=Order.STRICT, max_delay=ms(3), end=ms(9))),
    ],
)
def test_what_a_stream_of_states_keeps_follows_from_its_state_policy(text, expected):
    """That is what its generator promises."""
    assert policy_of_states(parse_policy(text)) == expected


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("sync(a, a) with strict order", "'strict order' is not for sync"),
        ("sync(a, a) with sample every 3 deviation 1", "states are sampled exactly"),
        ("sync(a, a) with sample every 3 up to 9 under load", "states are sampled exactly"),
        ("sync(a, a) with max delay 3, max delay 4", "there are two delay constraints"),
        ("sync(a, a) with all updates", "'all updates' needs an approximation"),
        ("sync(a, a) with at max delay", "'at max delay' needs a finite 'max delay'"),
        ("sync(a, a) with sample every common period", "period"),
        ("a with all updates", "'all updates' is for sync(...) alone"),
        ("a with use latest", "'use latest' is for sync(...) alone"),
        ("merge(a) with capacity 3", "'capacity 3' is for sync(...) alone"),
        ("select x from a with at max delay", "'at max delay' is for sync(...) alone"),
        ("a with sample every 3 deviation 3", "the deviation must be"),
        ("a with sample every 3 up to 4 under load", "the longest period must be a multiple"),
        ("a with sample every 3 up to 2 under load", "the longest period must be a multiple"),
        ("a with from 5 to 3", "the stream would end at 3 before it begins at 5"),
    ],
)
def test_policies_that_nothing_can_keep_are_faults(text, message):
    """As outputs, as inputs, and as declarations of generators."""
    base = "source n s strmgen a = s "
    (fault,) = faults_of_text(f"{base} stream x = {text}")
    assert message in fault.message
    if not text.startswith("a "):
        (fault,) = faults_of_text(f"{base} strmgen x = {text}")
        assert message in fault.message


def test_figure_2_fields_are_selected_and_renamed():
    """A and D, if B is 2; D is called F and what C is (Heintz 2013, section III)."""
    text = "source n s1 strmgen s1 = s1 stream out = select A, D as F%C% from s1 where B = 2"
    rows = {
        1: {"A": 1, "B": 2, "C": 3, "D": 4},
        2: {"A": 5, "B": 6, "C": 7, "D": 8},
        3: {"A": 9, "B": 2, "C": "x", "D": 0},
    }
    collector = Collector(network_of(text, {"s1": samples_at(rows)}))
    collector.run()

    assert [sample.value for sample in collector.samples["out"]] == [
        {"A": 1, "F3": 4},
        {"A": 9, "Fx": 0},
    ]


def test_figure_3_streams_are_merged():
    """Every sample of both, as long as the result keeps its policy."""
    text = """
    source n s1 source n s2 strmgen s1 = s1 strmgen s2 = s2
    stream all = merge(s1, s2)
    stream ordered = merge(s1, s2) with monotone order
    """
    network = network_of(text, {"s1": "1:a 3:b 5:c", "s2": "2:x 4:y@5 5:z@6"})

    assert Collector(network).run() == {
        "all": "1:a 2:x 3:b 5:c 4:y@5+1 5:z@6",
        "ordered": "1:a 2:x 3:b 5:c 5:z@6",
    }
    assert list(network.kernel.labels).count("merge(s1, s2)") == 1


def test_figure_4_streams_are_synchronised():
    """With a sample period of 2, the value with the latest valid time before stands for one."""
    text = """
    source n s1 source n s2 strmgen s1 = s1 strmgen s2 = s2
    strmgen s3 = sync(s1, s2) with sample every 2, use most recent, from 2 to 6
    stream s3 = s3
    stream sums = select s1 as a, s2 as b from s3 where s2 = x
    """
    collector = Collector(network_of(text, {"s1": "1:a 2:b 3:c 5:d 7:e", "s2": "1:x 4:y 6:x 8:z"}))

    assert collector.run()["s3"] == "2:('b', 'x')@4 4:('c', 'y')@5 6:('d', 'x')@7"
    assert [sample.value for sample in collector.samples["sums"]] == [
        {"a": "b", "b": "x"},
        {"a": "d", "b": "x"},
    ]


def test_fields_of_states_are_called_after_their_labels():
    """By the feature, with the objects if it is not alone; an unknown field is a fault."""
    base = UAV + "strmgen speed[uav2] = speedometer strmgen s = "
    joined = "sync(speed[uav1], speed[uav2], winch[uav1], merge(winch[uav1]))"
    good = "stream x = select speed_uav1, speed_uav2.v, winch, input4 from "

    assert faults_of_text(f"{base}{joined} {good} s") == []
    assert faults_of_text(f"{base}{joined} {good} {joined}") == []
    messages = [
        fault.message
        for fault in faults_of_text(f"{base}{joined} stream x = select sped from s where winc = 3")
    ]
    assert messages == [
        "no field called 'sped'",
        "no field called 'winc'; did you mean 'winch'?",
    ]


TIMES = st.lists(st.integers(0, 12), max_size=6, unique=True).map(sorted)


@settings(derandomize=True, deadline=None, max_examples=60)
@given(one=TIMES, other=TIMES, period=st.integers(1, 4))
def test_a_sampled_merging_has_the_samples_of_the_union(one, other, period):
    """What KPL makes of streams is what the policy makes of all their samples together."""
    text = f"""
    source n s1 source n s2 strmgen s1 = s1 strmgen s2 = s2
    strmgen m = merge(s1, s2)
    stream named = m with sample every {period}
    stream unnamed = merge(s1, s2) with sample every {period}
    """
    given = {"s1": [*one], "s2": [*other]}
    sources = {name: " ".join(f"{time}:{name}" for time in times) for name, times in given.items()}
    found = Collector(network_of(text, sources)).run()

    assert found["named"] == found["unnamed"]
    union = sorted({*one, *other})
    times = [float(word.split(":")[0]) for word in found["named"].split()]
    assert set(times) <= set(union)
    assert all((after - before) % period == 0 for before, after in pairwise(times))


def test_the_policy_of_an_operation_is_its_receivers():
    """A policy behind `merge(...)` or a selection is kept by what comes out of it."""
    text = "stream x = select * from merge(a with to 3, b) where k = 2 with max delay 5"
    (declaration,) = parse_specification(text).declarations

    assert policy_from_constraints(declaration.stream.constraints) == Policy(max_delay=ms(5))
    merging = declaration.stream.provider.provider
    assert policy_from_constraints(merging.streams[0].constraints) == Policy(end=ms(3))

"""What policies mean: the examples of Heintz (2009), sections 4.5.1 and 4.5.4."""

import pytest

from dyknow.streams.approximation import extend
from dyknow.streams.conformance import (
    is_maximal,
    is_substream,
    satisfies,
    term_violations,
    violations,
)
from dyknow.streams.domain import computed_stream, source_stream, values
from dyknow.streams.policy import (
    ANY_CHANGE,
    Approximation,
    Constraint,
    Order,
    Policy,
    SampleEvery,
)
from dyknow.streams.sample import NO_SAMPLE, Sample
from dyknow.time import TimePoint
from tests.support.streams import ms, stream, text

F1 = stream("200:p1@250 300:p2@325 400:p3@430 500:p4@505")
F2 = stream("100:p6@150 180:p7@250 400:p8@480")
F3 = stream("400:s3@510")
F4 = stream("100:s6@300")
F5 = stream("300:p2@345 400:p3@460")
"""The streams of example 4.5.1; times are milliseconds."""
END = ms(1000)


def test_example_4_5_1_an_interpretation_gives_each_feature_a_stream():
    """The streams of both features are what the sources say and what the unit may compute."""
    features = {"pos": {"o3": F1, "o4": F2}, "speed": {"o3": F3, "o4": F4}}

    def speed_estimate(time, inputs, state):
        (position,) = inputs
        number = position.value.removeprefix("p")
        return Sample(f"s{number}", position.valid_time, TimePoint(time)), state

    speeds = computed_stream(speed_estimate, features["pos"]["o3"])
    assert text(speeds) == "200:s1@250 300:s2@325 400:s3@430 500:s4@505"
    assert is_substream(features["speed"]["o3"], speeds)
    late = computed_stream(speed_estimate, features["pos"]["o4"])
    assert [sample.value for sample in late] == ["s6", "s7", "s8"]
    assert is_substream(features["speed"]["o4"], late)


def test_example_4_5_2_the_values_of_a_source_are_of_its_sort():
    """The positions of the first car are among the ten positions of the domain."""
    positions = {f"p{number}" for number in range(1, 11)}

    assert set(values(F1)) == {"p1", "p2", "p3", "p4"}
    assert set(values(F1)) <= positions
    assert values([NO_SAMPLE, *F3]) == ["s3"]


def test_example_4_5_3_a_generator_has_the_samples_of_its_source():
    """The stream of `pos[car1]` has the samples of the function that `pos_car1` denotes."""
    source = {sample.available_time: sample for sample in F1}

    generated = source_stream(lambda time: source.get(time, NO_SAMPLE), map(ms, range(600)))

    assert generated == F1


def test_example_4_5_4_a_substream_may_be_later_and_have_less():
    """Both samples of f5 are in f1 with an earlier available time."""
    assert is_substream(F5, F1)
    assert not is_substream(stream("300:p2@300"), F1)
    assert not is_substream(stream("300:p1@345"), F1)


def test_example_4_5_5_a_policy_is_kept_or_not():
    """The positions are 100 apart, and the first one is 50 late."""
    assert satisfies(F1, Policy(change=SampleEvery(ms(100))))
    assert not satisfies(F1, Policy(max_delay=ms(40)))


def test_example_4_5_6_a_stream_of_every_second_position():
    """Every second position, a little later, is one of the streams that the term allows."""
    f = stream("200:p1@280 400:p3@480")
    policy = Policy(change=SampleEvery(ms(200)))

    assert is_substream(f, F1)
    assert satisfies(f, policy)
    assert is_maximal(f, F1, policy, END)
    assert is_maximal(stream("300:p2@345 500:p4@600"), F1, policy, END)
    assert not is_maximal(f[:1], F1, policy, END)
    assert not is_maximal(f[1:], F1, policy, END)


@pytest.mark.parametrize(
    ("samples", "policy", "constraint"),
    [
        ("0:a 100:b 250:c", Policy(change=SampleEvery(ms(100))), Constraint.CHANGE),
        ("0:a 149:b", Policy(change=SampleEvery(ms(200), ms(50))), Constraint.CHANGE),
        ("0:a 251:b", Policy(change=SampleEvery(ms(200), ms(50))), Constraint.CHANGE),
        ("0:a 250:b", Policy(change=SampleEvery(ms(100), longest=ms(300))), Constraint.CHANGE),
        ("0:a 400:b", Policy(change=SampleEvery(ms(100), longest=ms(300))), Constraint.CHANGE),
        ("0:a 0:a@1", Policy(change=ANY_CHANGE), Constraint.CHANGE),
        ("0:a 5:b@20", Policy(max_delay=ms(10)), Constraint.DELAY),
        ("0:a 20:b", Policy(start=ms(5)), Constraint.DURATION),
        ("0:a 20:b", Policy(end=ms(5)), Constraint.DURATION),
        ("5:a 3:b@6", Policy(order=Order.MONOTONE), Constraint.ORDER),
        ("5:a 5:b@6", Policy(order=Order.STRICT), Constraint.ORDER),
    ],
)
def test_every_constraint_can_be_violated(samples, policy, constraint):
    """A violation names the kind of constraint that is broken, the definition and the sample."""
    (violation,) = violations(stream(samples), policy)

    assert violation.constraint is constraint
    assert violation.definition == "4.5.11"
    assert violation.sample is not None


@pytest.mark.parametrize(
    ("samples", "policy"),
    [
        ("0:a 0:b@1 1:b", Policy(change=ANY_CHANGE)),
        ("0:a 10:b@20", Policy(max_delay=ms(10))),
        ("5:a 10:b", Policy(start=ms(5), end=ms(10))),
        ("5:a 5:b@6", Policy(order=Order.MONOTONE)),
        ("5:a 3:b@6 3:b@7", Policy()),
        ("0:a 150:b 400:c 600:d", Policy(change=SampleEvery(ms(200), ms(50)))),
        ("0:a 100:b 300:c 600:d", Policy(change=SampleEvery(ms(100), longest=ms(300)))),
    ],
)
def test_limits_belong_to_what_is_allowed(samples, policy):
    """A sample exactly at a limit keeps the policy."""
    assert satisfies(stream(samples), policy)


@pytest.mark.parametrize(
    ("change", "expected"),
    [
        (SampleEvery(ms(100)), "expected the sample with valid time 200"),
        (
            SampleEvery(ms(100), ms(10)),
            "expected the sample with valid time 200, give or take 10",
        ),
        (
            SampleEvery(ms(100), longest=ms(200)),
            "expected the sample with valid time 200 or 300",
        ),
    ],
)
def test_a_violation_says_where_and_why(change, expected):
    """Place and reason are for the person who must find the fault."""
    (violation,) = violations(stream("0:a 100:b 250:c@260"), Policy(change=change))

    assert violation.valid_time == ms(250)
    assert violation.noticed_at == ms(260)
    assert violation.reason == expected


@pytest.mark.parametrize(
    ("part", "policy", "definition", "reason"),
    [
        (
            "200:p1@250 300:p2@325 400:p3@325 500:p4@505",
            Policy(),
            "4.3.5",
            "the available time is not later than 325 of the sample before it",
        ),
        (
            "200:p1@250 300:p2@325 400:p9@430 500:p4@505",
            Policy(),
            "4.5.9",
            "the generator has no sample of this valid time and value",
        ),
        (
            "200:p1@249 300:p2@325 400:p3@430 500:p4@505",
            Policy(),
            "4.5.9",
            "the generator has this sample no earlier than 250",
        ),
        (
            "200:p1@250 300:p2@325 500:p4@505",
            Policy(),
            "4.5.10",
            "the policy would let this sample through",
        ),
        (
            "200:p1@250 400:p3@430 500:p4@505",
            Policy(max_delay=ms(100), order=Order.STRICT),
            "4.5.10",
            "the policy would let this sample through",
        ),
        (
            "200:p1@251 300:p2@325 400:p3@430 500:p4@505",
            Policy(max_delay=ms(50)),
            "4.5.11",
            "expected a delay of at most 50, found 51",
        ),
    ],
)
def test_a_stream_that_its_term_does_not_allow_is_told_what_it_breaks(
    part, policy, definition, reason
):
    """Each violation names the definition that is broken and says what was expected."""
    found = term_violations(stream(part), F1, policy, END)

    assert (definition, reason) in [(one.definition, one.reason) for one in found]


@pytest.mark.parametrize(
    "policy",
    [
        Policy(),
        Policy(order=Order.STRICT, max_delay=ms(50)),
        Policy(change=SampleEvery(ms(100))),
        Policy(change=ANY_CHANGE),
    ],
)
def test_a_stream_that_hands_on_everything_in_time_is_allowed(policy):
    """Where the policy asks for nothing to be left out, the whole stream is what it allows."""
    assert term_violations(F1, F1, policy, END) == []


def test_a_sample_that_is_lost_in_a_gap_is_found():
    """A stream may have gaps; what lies in them on the grid and could have been had may not."""
    policy = Policy(change=SampleEvery(ms(100)))
    whole = stream("0:a 300:b 600:c")

    assert [v.definition for v in term_violations(whole, whole, policy, END)] == [
        "4.5.11",
        "4.5.11",
    ]
    lost = term_violations(stream("0:a 600:c"), whole, policy, END)
    assert [(v.definition, v.valid_time) for v in lost] == [
        ("4.5.10", ms(300)),
        ("4.5.11", ms(600)),
    ]


def test_with_approximation_a_stream_may_not_end_before_its_time():
    """What was due before the end of the execution must be there, and what was not need not."""
    policy = Policy(
        approximation=Approximation.MOST_RECENT,
        change=SampleEvery(ms(100)),
        max_delay=ms(50),
        start=ms(0),
    )
    given = stream("0:a 100:b@120")

    assert text(extend(given, policy, ms(300))) == "0:a 100:b@120 200:b 300:b"
    made = stream("0:a 100:b@120")
    assert term_violations(made, given, policy, ms(249)) == []
    (violation,) = term_violations(made, given, policy, ms(250))
    assert (violation.definition, violation.valid_time) == ("4.5.10", ms(200))

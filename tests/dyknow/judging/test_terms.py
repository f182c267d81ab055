"""Whether a stream is one of those that its term allows."""

from dataclasses import replace
from itertools import permutations
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from dyknow.judging.declared import DeclaredStream
from dyknow.judging.judgement import Breach
from dyknow.judging.terms import TermBreaches, policy_breaches
from dyknow.runtime.generators import Label
from dyknow.streams.conformance import term_violations
from dyknow.streams.policy import (
    ANY_CHANGE,
    Approximation,
    Constraint,
    Order,
    Policy,
    SampleEvery,
    Violation,
)
from dyknow.streams.sample import Sample
from dyknow.streams.values import are_equal
from dyknow.time import Duration, TimePoint
from tests.support.policies import adapted, approximating_policies, policies, streams
from tests.support.streams import ms, stream, text

EVERY_100 = Policy(change=SampleEvery(Duration(ms(100))))
RECENT = Policy(
    approximation=Approximation.MOST_RECENT,
    change=SampleEvery(Duration(ms(100))),
    max_delay=Duration(ms(50)),
    start=TimePoint(0),
)
END = ms(1000)
Samples = list[Sample[Any]]


def breaches(given: Samples, found: Samples, policy: Policy) -> list[Breach]:
    """Return all breaches of a stream that was found where *given* was to be adapted."""
    term = DeclaredStream.input(Label("receiver"), 1, Label("given"), policy)
    made, published = adapted(given, policy, END)
    of_term = TermBreaches(term, found, given, made, END).all()
    return [*of_term, *policy_breaches(term, found, published)]


@pytest.mark.parametrize(
    ("found", "definition", "expected", "instead"),
    [
        (
            "0:a 200:c",
            "4.5.10",
            "the sample valid at 100 and available at 100: 'b'",
            "it left out",
        ),
        ("0:a 100:x 200:c", "4.5.9", "'b'", "'x'"),
        ("0:a 100:b 200:c@210", "4.5.10", "available time 200", "available time 210"),
        ("0:a 100:b@90 200:c", "4.5.9", "available time 100 at the earliest", "available time 90"),
        ("0:a 99:b@100 200:c", "4.5.9", "valid time 100", "valid time 99"),
        ("0:a 100:b 100:b@150 200:c", "4.5.9", "each sample once", "the sample again"),
        ("0:a 100:b 150:z 200:c", "4.5.9", "a sample of 'given'", "'z'"),
        ("100:b 200:c", "4.5.10", "the sample valid at 0 and available at 0: 'a'", "it left out"),
        (
            "0:a 100:b",
            "4.5.10",
            "the sample valid at 200 and available at 200: 'c'",
            "it left out",
        ),
        ("", "4.5.10", "the sample valid at 0 and available at 0: 'a'", "it left out"),
    ],
)
def test_each_breach_is_named(found: str, definition: str, expected: str, instead: str) -> None:
    """A breach has its definition, and says what was expected and found."""
    (breach, *_) = breaches(stream("0:a 100:b 200:c"), stream(found), Policy())

    assert (breach.definition, breach.expected, breach.found) == (definition, expected, instead)


@pytest.mark.parametrize(
    ("policy", "found"),
    [
        (Policy(order=Order.STRICT), "0:a 100:b@150 200:c"),
        (Policy(max_delay=Duration(ms(10))), "0:a 200:c"),
        (Policy(change=SampleEvery(Duration(ms(200)))), "0:a 200:c"),
        (replace(EVERY_100, start=ms(100)), "100:b@150 200:c"),
        (RECENT, "0:a 100:b@150 200:c 300:c@350 400:c@450"),
    ],
)
def test_what_a_policy_allows_is_no_breach(policy: Policy, found: str) -> None:
    """What a policy makes of a stream is correct, to the end of the execution."""
    given_stream = stream("0:a 100:b@150 200:c")
    if policy is RECENT:
        found = text(adapted(given_stream, policy, END)[0])
        assert found.startswith("0:a 100:b@150 200:c 300:c@350")

    assert breaches(given_stream, stream(found), policy) == []


def test_another_choice_that_the_policy_allows_is_no_breach() -> None:
    """The definition leaves open which of two samples of one valid time is left out."""
    policy = Policy(order=Order.STRICT)
    given_stream = stream("0:a 100:b 100:c@110")

    assert text(adapted(given_stream, policy, END)[0]) == "0:a 100:b"
    assert breaches(given_stream, stream("0:a 100:c@110"), policy) == []


def test_a_gap_is_no_breach_if_it_was_published() -> None:
    """What is missing under `sample every` may be missing if a violation says so."""
    term = DeclaredStream.input(Label("receiver"), 1, Label("given"), EVERY_100)
    found = stream("0:a 200:c")
    violation = Violation(Constraint.CHANGE, ms(100), ms(200), "no sample of valid time 100")

    (breach,) = policy_breaches(term, found, [])
    assert breach.definition == "4.5.11"
    assert breach.valid_time == ms(200)
    assert breach.found.endswith("and no violation published")
    assert list(policy_breaches(term, found, [violation])) == []


@settings(derandomize=True, deadline=None, max_examples=200)
@given(streams(), policies() | approximating_policies())
def test_what_an_adapter_makes_is_correct(samples: Samples, policy: Policy) -> None:
    """Whatever comes, the stream that an adapter makes has no breaches."""
    made, _ = adapted(samples, policy, END)

    assert breaches(samples, made, policy) == []


@st.composite
def altered(draw: st.DrawFn, samples: Samples) -> Samples:
    """Draw a stream that is much like another one."""
    made: Samples = []
    for sample in samples:
        kind = draw(st.sampled_from(["keep", "keep", "keep", "drop", "value", "later", "sooner"]))
        available = sample.available_time + ms({"later": 5, "sooner": -5}.get(kind, 0))
        value = "ab".replace(sample.value, "") if kind == "value" else sample.value
        if kind != "drop":
            made.append(Sample(value, sample.valid_time, TimePoint(available)))
    return made


@settings(derandomize=True, deadline=None, max_examples=400)
@given(
    streams(size=4),
    policies().filter(lambda policy: policy.period is None),
    st.data(),
)
def test_the_judgement_is_that_of_the_definition(
    samples: Samples, policy: Policy, data: st.DataObject
) -> None:
    """A stream is correct if and only if the definitions allow it and nothing is held back."""
    kept = data.draw(st.just(adapted(samples, policy, END)[0]) | st.just(samples))
    found = data.draw(altered(kept))

    is_allowed = not term_violations(found, samples, policy, END)
    assert (breaches(samples, found, policy) == []) == (is_allowed and _is_part(found, samples))


def _is_part(found: Samples, samples: Samples) -> bool:
    """Return, by brute force, whether every sample is one of *samples* and none is there twice."""
    return any(
        all(
            one.available_time == other.available_time
            and one.valid_time == other.valid_time
            and are_equal(one.value, other.value)
            for one, other in zip(found, choice, strict=True)
        )
        for choice in permutations(samples, len(found))
    )


def test_repetitions_that_were_left_out_are_not_missed() -> None:
    """A repetition would not fit in under `any change`."""
    policy = Policy(change=ANY_CHANGE)

    assert breaches(stream("0:a 0:a@10 100:b"), stream("0:a 100:b"), policy) == []

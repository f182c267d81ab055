"""States of whatever is there."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from dyknow.streams.joining import Latest
from dyknow.streams.policy import Constraint
from dyknow.streams.sample import NO_VALUE, Sample
from dyknow.streams.state_policy import Occasion, Settling, StateApproximation, StatePolicy
from dyknow.streams.stream import available_times, most_recent_at
from dyknow.time import TimePoint
from tests.support.laws import assert_unit_laws
from tests.support.policies import streams
from tests.support.streams import ms, run_unit, stream, text

RECENT = StateApproximation.MOST_RECENT
SPEED = "1000:s1@1010 1100:s2@1110 1200:s3@1280 1300:s4@1320"
WINCH = "1050:w1@1120 1150:w2@1170 1250:w3@1260"


def _run(policy, *notations):
    unit = Latest([f"s{n}" for n in range(len(notations))], policy)
    states = run_unit(unit, *map(stream, notations), until=ms(2000))
    for state in states:
        state.value = "".join("-" if value is NO_VALUE else value for value in state.value)
    return text(states), unit.take_violations()


def test_each_arrival_makes_a_state_of_what_is_there():
    """It is valid at the highest valid time so far; there is none before all have a value."""
    states, violations = _run(StatePolicy(), SPEED, WINCH)

    assert states == ("1100:s2w1@1120 1150:s2w2@1170 1250:s2w3@1260 1250:s3w3@1280 1300:s4w3@1320")
    assert violations == []


def test_the_latest_values_on_a_grid():
    """What is there at each time-point is not what was valid then (thesis, 7.8.1)."""
    policy = StatePolicy(Occasion.SAMPLED, ms(100), start=ms(1050), end=ms(1350))

    states, (violation,) = _run(policy, SPEED, WINCH)

    assert states == "1050:s1- 1150:s2w1 1250:s2w2 1350:s4w3"
    assert violation.reason == "no value of 's1'"


def test_a_grid_begins_with_the_first_arrival():
    """Time-points at which no input has said anything have no state."""
    policy = StatePolicy(Occasion.SAMPLED, ms(100), end=ms(300))

    states, _ = _run(policy, "0:a@130", "0:b@200")

    assert states == "200:ab 300:ab"


def test_a_state_without_a_change_is_left_out():
    """Under 'any change' a state has another value than the one before."""
    states, _ = _run(StatePolicy(Occasion.ANY_CHANGE), "0:a 1:a 2:b", "0:c")

    assert states == "0:ac 2:bc"


def test_a_state_of_all_updates_has_news_of_every_input():
    """The inputs wait for the slowest of them."""
    states, _ = _run(
        StatePolicy(Occasion.ALL_UPDATES, approximation=RECENT), "0:a 1:b 2:c 3:d", "0:x 2:y"
    )

    assert states == "0:ax 2:cy"


def test_a_sample_that_is_older_than_the_last_one_is_published():
    """It changes nothing, and is not lost unseen."""
    states, (violation,) = _run(StatePolicy(), "5:a 3:b@6", "0:c")

    assert states == "5:ac"
    assert violation.constraint is Constraint.ORDER
    assert violation.sample.value == "b"
    assert violation.reason == "'s0' is out of order: it has reached 5"


def test_states_outside_the_duration_are_not_made():
    """Start and end are those of the policy."""
    states, _ = _run(StatePolicy(start=ms(1), end=ms(2)), "0:a 1:b 2:c 3:d", "0:x")

    assert states == "1:bx 2:cx"


@pytest.mark.parametrize(
    ("names", "policy", "reason"),
    [
        ("", StatePolicy(), "at least one input"),
        ("a", StatePolicy(max_delay=ms(1)), "waits for nothing and looks at nothing later"),
        ("a", StatePolicy(approximation=StateApproximation.LINEAR), "waits for nothing"),
        (
            "a",
            StatePolicy(max_delay=ms(1), settling=Settling.AT_MAX_DELAY),
            "'use most recent', the change and the duration can be",
        ),
        ("a", StatePolicy(Occasion.SAMPLED), "need a sample period of their own"),
    ],
)
def test_what_would_have_no_effect_is_refused(names, policy, reason):
    """Every constraint that is accepted does something."""
    with pytest.raises(ValueError, match=reason):
        Latest(names, policy)


@settings(derandomize=True, deadline=None, max_examples=150)
@given(streams(), streams())
def test_states_hold_the_most_recent_values(one, other):
    """At each arrival that is not out of order: most recent at, definition 4.3.11."""
    made = run_unit(Latest("ab"), one, other, until=ms(1000))

    expected = []
    for now in sorted(available_times(one, other)):
        recent = [most_recent_at(given, TimePoint(1 << 60), now) for given in (one, other)]
        has_news = any(sample.available_time == now for sample in recent)
        if has_news and all(sample.valid_time >= 0 for sample in recent):
            time = max(sample.valid_time for sample in recent)
            expected.append(Sample(tuple(sample.value for sample in recent), time, now))
    assert made == expected


@settings(derandomize=True, deadline=None, max_examples=100)
@given(
    streams(),
    streams(),
    st.sampled_from(
        [
            StatePolicy(),
            StatePolicy(Occasion.ANY_CHANGE, start=ms(20)),
            StatePolicy(Occasion.ALL_UPDATES, end=ms(90), approximation=RECENT),
            StatePolicy(Occasion.SAMPLED, ms(30), start=ms(10)),
        ]
    ),
)
def test_latest_keeps_the_laws_of_units(one, other, policy):
    """It is repeatable, does not depend on ticks, and the future does not change the past."""
    assert_unit_laws(lambda: Latest("ab", policy), one, other, until=ms(200), tick=ms(7))

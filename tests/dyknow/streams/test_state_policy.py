"""How states are made, as a value."""

import pytest

from dyknow.streams.state_policy import (
    CAPACITY,
    Occasion,
    Settling,
    StateApproximation,
    StatePolicy,
)
from tests.support.streams import ms

RECENT = StateApproximation.MOST_RECENT


def test_without_constraints_states_are_those_of_common_times():
    """Nothing is approximated, and nothing is given up before it is certain."""
    policy = StatePolicy()

    assert policy.occasion is Occasion.ANY_UPDATE
    assert not policy.is_approximated
    assert not policy.is_sampled
    assert policy.max_delay is None
    assert policy.capacity == CAPACITY


def test_linear_approximation_is_an_approximation():
    """Both kinds of approximation may stand for a sample."""
    assert StatePolicy(approximation=StateApproximation.LINEAR).is_linear
    assert StatePolicy(approximation=StateApproximation.LINEAR).is_approximated
    assert StatePolicy(approximation=RECENT).is_approximated
    assert not StatePolicy(approximation=RECENT).is_linear


@pytest.mark.parametrize(
    ("settings", "reason"),
    [
        ({"occasion": Occasion.SAMPLED, "period": 0}, "the sample period must be positive"),
        ({"period": ms(10)}, "'any update' has no sample period"),
        ({"start": ms(-1)}, "no time-point lies before 0"),
        ({"start": ms(20), "end": ms(10)}, "the states would end at 10 before they begin at 20"),
        ({"end": ms(-1)}, "the states would end at -1 before they begin at 0"),
        ({"max_delay": ms(-1)}, "the maximal delay must not be negative"),
        (
            {"approximation": RECENT, "delay_before_approximation": ms(-1)},
            "the delay before approximation must not be negative",
        ),
        (
            {
                "approximation": RECENT,
                "delay_before_approximation": ms(20),
                "max_delay": ms(10),
            },
            "20 has no effect: the maximal delay of 10 has passed by then",
        ),
        ({"delay_before_approximation": ms(1)}, "needs an approximation"),
        ({"occasion": Occasion.ALL_UPDATES}, "'all updates' needs an approximation"),
        ({"settling": Settling.AT_MAX_DELAY}, "'at max delay' needs a finite 'max delay'"),
        (
            {
                "settling": Settling.AT_MAX_DELAY,
                "max_delay": ms(10),
                "approximation": RECENT,
                "delay_before_approximation": ms(5),
            },
            "leaves 'delay before approximation' without effect",
        ),
        ({"capacity": 0}, "the capacity must be at least 1, found 0"),
    ],
)
def test_contradictions_are_refused(settings, reason):
    """Each constraint that cannot be kept, or could have no effect, is named."""
    with pytest.raises(ValueError, match=reason):
        StatePolicy(**settings)


def test_all_contradictions_are_told_at_once():
    """Who has made two mistakes learns of both."""
    with pytest.raises(ValueError, match="no sample period; 'at max delay' needs"):
        StatePolicy(period=ms(10), settling=Settling.AT_MAX_DELAY)

"""Instants that remember where they come from."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from dyknow.mtl.instants import FUTURE, PAST
from dyknow.mtl.moments import Moment, PlainComparisons, RecordedComparisons

check = settings(derandomize=True, deadline=None, max_examples=200)
GAPS = st.lists(st.integers(1, 6), min_size=2, max_size=4)
QUESTIONS = st.lists(
    st.tuples(st.integers(0, 4), st.integers(0, 4), st.integers(-15, 15)), max_size=12
)


def times_of(gaps):
    """Times of states from the last one backwards, and the new one, the gaps apart."""
    past = [0]
    for gap in gaps[:-1]:
        past.append(past[-1] - gap)
    return [*past, gaps[-1]]


def asked(comparisons, questions, n):
    """The answers to the questions that are about n states."""
    return [comparisons.are_closer(i % n, j % n, bound) for i, j, bound in questions]


@check
@given(GAPS, QUESTIONS)
def test_answers_are_right_and_questions_recorded_once(gaps, questions):
    """Recording changes no answer, and nothing that is recorded follows from the rest."""
    times = times_of(gaps)
    comparisons = RecordedComparisons(times)

    expected = asked(PlainComparisons(times), questions, len(times))
    assert asked(comparisons, questions, len(times)) == expected
    recorded = list(comparisons.record)
    assert asked(comparisons, questions, len(times)) == expected
    assert comparisons.record == recorded


@check
@given(GAPS, QUESTIONS, st.lists(GAPS, max_size=20))
def test_the_record_decides_all_answers(gaps, questions, others):
    """Other times that agree with the record give the same answers to all questions."""
    times = times_of(gaps)
    comparisons = RecordedComparisons(times)
    answers = asked(comparisons, questions, len(times))

    for other in map(times_of, others):
        if len(other) == len(times):
            agree = all(
                (other[i] - other[j] < bound) == closer
                for i, j, bound, closer in comparisons.record
            )
            same = asked(PlainComparisons(other), questions, len(times)) == answers
            assert same or not agree


@check
@given(GAPS, st.integers(0, 3), st.integers(0, 3), st.integers(-9, 9), st.integers(-9, 9))
def test_a_moment_is_the_integer_that_it_stands_for(gaps, i, j, first, second):
    """Arithmetic and comparisons give what they give for plain instants."""
    times = times_of(gaps)
    n = len(times)
    comparisons = RecordedComparisons(times)
    one = Moment.make(i % n, 0, times, comparisons) + first
    other = 2 + Moment.make(j % n, second, times, comparisons) - 2
    plain, reference = times[i % n] + first - times[-1], times[j % n] + second - times[-1]

    assert (int(one), int(other)) == (plain, reference)
    assert (one < other, one <= other, one == other) == (
        plain < reference,
        plain <= reference,
        plain == reference,
    )
    assert (one > second, second >= one, one != first) == (
        plain > second,
        second >= plain,
        plain != first,
    )
    assert max(one, other, first) == max(plain, reference, first)


def test_no_bound_is_compared_without_a_record():
    """What is compared with the end of time needs no times."""
    times = [0, -3, 5]
    comparisons = RecordedComparisons(times)
    moment = Moment.make(1, 2, times, comparisons)

    assert PAST < moment < FUTURE
    assert moment not in (PAST, FUTURE)
    assert moment > PAST
    assert moment != "now"
    assert comparisons.record == []


def test_moments_are_not_looked_up():
    """A set would compare moments by their values without a record."""
    times = [0, 1]
    with pytest.raises(TypeError, match="moments are compared, never looked up"):
        {Moment.make(0, 0, times, PlainComparisons(times))}

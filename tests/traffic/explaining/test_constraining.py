"""Constraints are told with what they came to."""

import re

from hypothesis import given, settings
from hypothesis import strategies as st

from chronicles.parser import parse_chronicles
from chronicles.syntax import Comparison, Within
from dyknow.time import MILLISECOND
from traffic.explaining.constraining import constraint_explained
from traffic.explaining.wording import constraint_text

INSTANTS = ("t1", "t2", "t3")
_BRACKET = re.compile(r"(.+) in \[(-?\d+), (-?\d+)\]")


def statement(text):
    """Return the constraint that *text* says."""
    events = " ".join(f"event(e, {name})" for name in INSTANTS)
    (chronicle,) = parse_chronicles(f"message e chronicle c {{ {events} {text} }}").chronicles
    (found,) = (s for s in chronicle.statements if isinstance(s, Comparison | Within))
    return found


def explained(text, **times):
    """Return what a constraint came to at times in milliseconds."""
    nanoseconds = {name: time * MILLISECOND for name, time in times.items()}
    return constraint_explained(statement(text), nanoseconds)


instant = st.sampled_from(INSTANTS)
offset = st.integers(0, 4)
operands = st.one_of(
    instant,
    st.builds("{} + {}".format, instant, st.integers(1, 4)),
    st.builds("{} - {}".format, instant, instant),
    st.integers(0, 6).map(str),
)
texts = st.one_of(
    st.builds(
        "{} {} {} {} {}".format,
        instant,
        st.sampled_from(["<", "<=", "="]),
        operands,
        st.sampled_from(["<", "<=", ">", ">="]),
        operands,
    ),
    st.builds("{} - {} in [{}, {}]".format, instant, instant, offset, st.integers(4, 8)),
)


def naive(text, times):
    """Return whether a constraint holds, as Python reads it."""
    match = _BRACKET.fullmatch(text)
    if match is not None:
        said = f"{match[2]} <= {match[1]} <= {match[3]}"
    else:
        said = re.sub(r" = ", " == ", text)
    return bool(eval(said, {}, dict(times)))


@given(texts, st.tuples(*[st.integers(0, 8)] * 3))
@settings(derandomize=True, deadline=None, max_examples=600)
def test_a_constraint_holds_exactly_when_it_is_true(text, moments):
    """As Python reads what is written; then each length that is told keeps its bounds."""
    times = dict(zip(INSTANTS, moments, strict=True))

    told = explained(text, **times)

    assert told.holds == naive(text, times)
    assert all(within(term) for term in told.terms) or not told.holds
    assert all(term.ms >= 0 for term in told.terms if "−" in term.text)


def within(term):
    """Return whether a length of time keeps its bounds."""
    at_least = term.least is None or term.least <= term.ms
    return at_least and (term.most is None or term.ms <= term.most)


def test_lengths_are_told_with_their_bounds():
    """Two bounds of one length are one sentence, in units that people use."""
    told = explained("t1 <= t2 <= t1 + 1 min", t1=4900, t2=8000, t3=0)

    assert constraint_text(told) == "t2 − t1 = 3.1 s, at least 0 and at most 1 min"
    assert told.holds


def test_a_violated_constraint_says_so():
    """What does not hold is told as it is."""
    told = explained("t2 - t1 in [0, 500]", t1=0, t2=700, t3=0)

    assert constraint_text(told) == "t2 − t1 = 700 ms, at least 0 and at most 500 ms"
    assert not told.holds

"""Sets of instants against sets of integers."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from dyknow.mtl import instants as i

LEAST, MOST = -60, 60
WINDOW = range(LEAST, MOST)


def members(instants):
    """The instants of the window that are in the set, as integers."""
    return {t for start, end in i.pieces(instants) for t in WINDOW if start <= t < end}


@st.composite
def sets(draw):
    """Sets within -20..20, some without bounds."""
    bounds = sorted(draw(st.sets(st.integers(-20, 20), max_size=6)))
    if len(bounds) % 2:
        bounds = [i.PAST, *bounds] if draw(st.booleans()) else [*bounds, i.FUTURE]
    return tuple(bounds)


DURATIONS = st.tuples(st.integers(0, 8), st.none() | st.integers(0, 8))
check = settings(derandomize=True, deadline=None, max_examples=150)


def bounds_of(durations):
    """The shortest and the longest of two durations, given as the first and the difference."""
    least, length = durations
    return least, i.FUTURE if length is None else least + length


@check
@given(sets(), sets())
def test_boolean_operations_are_those_of_sets(one, other):
    """Intersection, union, difference and complement agree with sets of integers."""
    assert members(i.both(one, other)) == members(one) & members(other)
    assert members(i.either(one, other)) == members(one) | members(other)
    assert members(i.without(one, other)) == members(one) - members(other)
    assert members(i.complement(one)) == set(WINDOW) - members(one)


@check
@given(sets(), sets())
def test_equal_sets_are_equal_tuples(one, other):
    """Every operation gives the one way to write its result."""
    assert i.either(one, other) == i.either(other, one)
    assert i.complement(i.complement(one)) == one
    assert i.either(i.both(one, other), i.without(one, other)) == one


@check
@given(sets(), st.integers(-25, 25))
def test_runs_and_first_members_are_found(instants, start):
    """The next instant inside, and the next instant outside, agree with going one by one."""
    inside = members(instants)

    first = next((t for t in range(start, MOST) if t in inside), i.FUTURE)
    end = next((t for t in range(start, MOST) if t not in inside), i.FUTURE)
    assert i.first_from(instants, start) == first
    assert i.run_end(instants, start) == end


@check
@given(sets(), DURATIONS)
def test_what_lies_before_and_after_agrees_with_the_definition(instants, durations):
    """Before: some witness within the durations to come; after: some within those gone by."""
    least, most = bounds_of(durations)
    inside = {t for s, e in i.pieces(instants) for t in range(-200, 200) if s <= t < e}

    gone = {t for t in WINDOW if any(t + least <= w <= t + most for w in inside)}
    come = {t for t in WINDOW if any(w + least <= t <= w + most for w in inside)}
    assert members(i.before(instants, least, most)) == gone
    assert members(i.after(instants, least, most)) == come


@check
@given(sets(), sets(), DURATIONS)
def test_until_agrees_with_its_definition(left, right, durations):
    """A witness within the durations, and the left set up to but not including it."""
    least, most = bounds_of(durations)
    wide = range(-30, 100)
    ways = {t for s, e in i.pieces(left) for t in wide if s <= t < e}
    goals = {t for s, e in i.pieces(right) for t in wide if s <= t < e}

    def holds(t):
        for w in wide:
            if w >= t + least and w <= t + most and w in goals:
                return True
            if w >= t and w not in ways:
                return False
        return False

    narrow = range(-30, 30)
    found = members(i.until(left, right, least, most)) & set(narrow)
    assert found == {t for t in narrow if holds(t)}


def test_everything_has_nothing_outside():
    """The whole of time and the empty set are each other's complement."""
    assert i.complement(i.EVERYTHING) == i.EMPTY
    assert i.complement(i.EMPTY) == i.EVERYTHING


@pytest.mark.parametrize("instants", [(), (3, 5), (i.PAST, 5), (3, i.FUTURE)])
def test_shifting_there_and_back_changes_nothing(instants):
    """Bounds move together; no bound stays no bound."""
    assert i.shift(i.shift(instants, 7), -7) == instants

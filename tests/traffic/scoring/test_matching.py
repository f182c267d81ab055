"""Pairs of recognitions and true manoeuvres."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import linear_sum_assignment

from dyknow.time import Duration
from traffic.scoring.matching import Episode, match

# Claims of one key do not contain each other in practice: all last equally long.
SPANS = st.lists(
    st.builds(
        lambda k, b: Episode((k, (1,), ()), b, b + 3), st.sampled_from("ab"), st.integers(0, 30)
    ),
    max_size=8,
)


def largest_number_of_pairs(claims: list[Episode], truths: list[Episode], tolerance: int) -> int:
    """Solve the assignment in full."""
    fits = np.array(
        [
            [
                c.key == t.key and c.begin <= t.end + tolerance and t.begin <= c.end + tolerance
                for t in truths
            ]
            for c in claims
        ],
        dtype=float,
    ).reshape(len(claims), len(truths))
    rows, columns = linear_sum_assignment(-fits)
    return int(fits[rows, columns].sum())


@settings(derandomize=True, deadline=None, max_examples=200)
@given(SPANS, SPANS, st.integers(0, 3))
def test_as_many_pairs_as_possible_are_made(claims, truths, tolerance):
    """Greedy matching in order of time is as good as an optimal assignment."""
    pairs = match(claims, truths, dict.fromkeys("ab", Duration(tolerance)))

    assert len(pairs) == largest_number_of_pairs(claims, truths, tolerance)
    assert len(set(pairs.values())) == len(pairs)
    assert all(claims[i].key == truths[j].key for i, j in pairs.items())


def test_what_is_too_far_apart_in_time_does_not_match():
    """The same manoeuvre of the same vehicle a minute later is another one."""
    key = ("turn_left", (1,), ("a", "x", "b"))

    assert match([Episode(key, 60, 63)], [Episode(key, 0, 3)], {"turn_left": Duration(5)}) == {}


def test_each_kind_has_its_own_tolerance():
    """Two claims that are equally late, of kinds of which one allows for that."""
    claims = [Episode((kind, (1,), ()), 10, 12) for kind in "ab"]
    truths = [Episode((kind, (1,), ()), 0, 4) for kind in "ab"]

    assert match(claims, truths, {"a": Duration(5), "b": Duration(6)}) == {1: 1}

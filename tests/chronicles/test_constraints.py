"""Simple temporal networks against trying all times."""

from itertools import product

from hypothesis import given, settings
from hypothesis import strategies as st

from chronicles.constraints import UNBOUNDED, Bound, TemporalNetwork, bounds_of, floor_to_instant
from chronicles.parser import parse_chronicles
from chronicles.syntax import TemporalConstraint

NAMES = ("a", "b", "c", "d")


def constraint(text: str) -> TemporalConstraint:
    """Return a temporal constraint."""
    statement = parse_chronicles(f"chronicle x {{ {text} }}").chronicles[0].statements[0]
    assert isinstance(statement, TemporalConstraint)
    return statement


def limits_of(text: str) -> set[tuple[str, str, int]]:
    """Return the bounds of a constraint, in milliseconds."""
    return {(b.later, b.earlier, b.limit // 1_000_000) for b in bounds_of(constraint(text))}


def test_strictly_later_is_one_instant_later():
    """`a < b` says that b is at least a millisecond later; `<=` allows the same instant."""
    assert limits_of("a < b") == {("a", "b", -1)}
    assert limits_of("a <= b + 5") == {("a", "b", 5)}
    assert limits_of("a = b") == {("a", "b", 0), ("b", "a", 0)}


def test_chains_and_intervals_bound_each_pair():
    """A chain compares neighbours; an interval has two ends, of which either may be missing."""
    assert limits_of("a < b <= c") == {("a", "b", -1), ("b", "c", 0)}
    assert limits_of("10 <= b - a <= 30") == {("a", "b", -10), ("b", "a", 30)}
    assert limits_of("b - a in [-1 s, 2 s]") == {("b", "a", 2000), ("a", "b", 1000)}
    assert limits_of("b - a in ]-oo, 100[") == {("b", "a", 99)}
    assert limits_of("a - b > c - b + 2") == {("c", "a", -3)}


bounds = st.tuples(st.sampled_from(NAMES), st.sampled_from(NAMES), st.integers(-3, 3)).filter(
    lambda bound: bound[0] != bound[1]
)


@settings(derandomize=True, deadline=None, max_examples=100)
@given(st.lists(bounds, max_size=7))
def test_minimal_limits_are_the_largest_differences_of_all_solutions(
    drawn: list[tuple[str, str, int]],
) -> None:
    """A network is consistent if times exist, and each finite limit is reached by some of them."""
    any_constraint = constraint("a <= b")
    network = TemporalNetwork(NAMES, [Bound(*bound, any_constraint) for bound in drawn])
    solutions = [
        times
        for times in ({**dict(zip("bcd", rest, strict=True)), "a": 0} for rest in RESTS)
        if all(times[later] - times[earlier] <= limit for later, earlier, limit in drawn)
    ]

    assert network.consistent == bool(solutions)
    assert network.consistent == (not network.contradiction())
    if solutions:
        for earlier, later in product(NAMES, repeat=2):
            limit = network.limit(earlier, later)
            largest = max(times[later] - times[earlier] for times in solutions)
            assert largest <= limit
            assert limit in (largest, UNBOUNDED)


RESTS = list(product(range(-9, 10), repeat=3))


def test_a_contradiction_names_only_the_constraints_on_its_circle():
    """What has nothing to do with the contradiction is not named."""
    constraints = [constraint(t) for t in ("a < b", "b < c", "c < d", "d - b <= 1", "a <= d")]
    network = TemporalNetwork(NAMES, [b for c in constraints for b in bounds_of(c)])

    assert set(network.contradiction()) == set(constraints[1:4])


def test_long_contradictions_do_not_overflow():
    """Contradictory bounds tighten each other without end; the limits stay in range."""
    names = [f"t{i}" for i in range(60)]
    any_constraint = constraint("a <= b")
    drawn = [
        Bound(a, b, -(1 << 57), any_constraint) for a, b in product(names, repeat=2) if a != b
    ]

    network = TemporalNetwork(names, drawn)

    assert not network.consistent
    assert len(network.contradiction()) == 1


def test_times_are_rounded_down_to_instants():
    """An instant is a millisecond, also before zero."""
    assert [floor_to_instant(t) for t in (0, 999_999, 1_000_000, -1)] == [0, 0, 10**6, -(10**6)]

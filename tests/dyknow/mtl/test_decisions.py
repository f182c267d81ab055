"""Decision trees over differences of times."""

from hypothesis import given, settings
from hypothesis import strategies as st

from dyknow.mtl.decisions import DecisionTree
from dyknow.mtl.moments import RecordedComparisons

TIMES = st.lists(st.integers(1, 9), min_size=3, max_size=3)
BOUNDS = st.lists(
    st.tuples(st.integers(0, 2), st.integers(0, 2), st.integers(-9, 9)), min_size=1, max_size=6
)


def decide(times, bounds):
    """An algorithm whose course depends on comparisons; its record, result, and kept times."""
    comparisons = RecordedComparisons(times)
    at, taken = 0, []
    for _ in range(3):
        closer = comparisons.are_closer(*bounds[at % len(bounds)])
        taken.append(closer)
        at = 2 * at + 1 + closer
    return comparisons.record, "".join("yn"[not t] for t in taken), (2, *range(sum(taken) % 3))


@settings(derandomize=True, deadline=None, max_examples=150)
@given(st.lists(TIMES, min_size=1, max_size=25), BOUNDS)
def test_what_was_seen_is_found_again(many, bounds):
    """A tree gives for all times what the algorithm does, or nothing if that was never seen."""
    tree = DecisionTree()
    for first, second, third in many:
        times = (first, first - second, first + third)
        record, result, kept = decide(times, bounds)
        expected = (result, tuple(times[k] for k in kept))
        rule = tree.compiled(2)
        assert tree.find(times) == rule(times[2], times[:2])
        assert tree.find(times) in {None, expected}
        if tree.find(times) is None:
            tree.add(record, result, kept)
        assert tree.find(times) == expected == tree.compiled(2)(times[2], times[:2])


def test_a_tree_without_branches_has_one_answer():
    """Where nothing was compared the result is the same for all times."""
    tree = DecisionTree()
    assert tree.find((5,)) is None
    assert tree.compiled(1)(5, (0,)) is None
    tree.add([], "always", (1, 0))

    assert tree.find((4, 9)) == ("always", (9, 4))
    assert tree.compiled(1)(9, (4,)) == ("always", (9, 4))


def test_very_deep_branches_are_not_compiled():
    """A function has only so many levels; what lies deeper is still found in the tree."""
    tree = DecisionTree()
    for depth in range(60):
        record = [(1, 0, bound, False) for bound in range(depth)]
        tree.add([*record, (1, 0, depth, True), (1, 0, depth - 1, True)], f"a{depth}", (1,))
        tree.add([*record, (1, 0, depth, True), (1, 0, depth - 1, False)], f"b{depth}", (1,))

    rule = tree.compiled(1)
    assert tree.find((0, 55)) == rule(55, (0,)) == ("b56", (55,))
    assert tree.size == 120


def test_leaves_are_compiled_when_they_are_used():
    """Counting the uses says when a function is worth making again."""
    tree = DecisionTree()
    tree.add([(1, 0, 5, True)], "near", (1,))
    assert tree.is_worth_compiling()
    tree.compiled(1)
    assert not tree.is_worth_compiling()
    tree.add([(1, 0, 5, False)], "far", (1,))
    assert tree.is_worth_compiling()

"""Instants that need not be remembered because others are at least as good.

An operator waits for one of many past instants to become a witness. If its right side can only
come to hold at one of them if it also holds at another, whatever comes, the first need not be
remembered. Of `eventually f` without a bound the earlier of two instants is never worse, of
`always f` the later one; and where f is known to be false, or true, at all that tells the two
apart, either will do. Without this the memory of unbounded operators would grow for ever.

Only neighbours are compared: an instant and the one before it among those waited for, which is a
nanosecond before, or the last one of the interval before.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

from dyknow.mtl.instants import (
    EMPTY,
    EVERYTHING,
    FUTURE,
    Instants,
    between,
    both,
    either,
    pieces,
    run_end,
    shift,
    without,
)
from dyknow.mtl.knowledge import Knowledge
from dyknow.mtl.nodes import TRUTH, All, GraphNode, Literal, UntilNode

__all__ = ["redundant"]


def redundant(
    nodes: Sequence[GraphNode],
    literal: Literal,
    waiting: Instants,
    known: Sequence[Knowledge],
    *,
    keep_earlier: bool,
) -> Instants:
    """Return instants at which it need not be waited for a literal, as others are as good.

    Args:
        nodes: The nodes of the formula.
        literal: What is waited for.
        waiting: The past instants at which it may still turn out to hold.
        known: What is known about each node.
        keep_earlier: Whether an instant must not be given up for a later one.
    """
    relation = _Relation(nodes, known, _Neighbours.among(waiting), earlier_wins=True)
    gone = relation.later_instants(literal)
    if keep_earlier:
        return gone
    left = without(waiting, gone)
    relation = _Relation(nodes, known, _Neighbours.among(left), earlier_wins=False)
    return either(gone, relation.earlier_instants(literal))


@dataclass(frozen=True, slots=True)
class _Neighbours:
    """Instants that are compared with the one before them.

    Attributes:
        inner: Instants that directly follow another one.
        gaps: The others: the one before, and the instant.
    """

    inner: Instants
    gaps: tuple[tuple[int, int], ...]

    @classmethod
    def among(cls, waiting: Instants) -> "_Neighbours":
        """Return the neighbours of a set."""
        found = pieces(waiting)
        inner: Instants = EMPTY
        for start, end in found:
            inner += between(start + 1, end)
        return cls(inner, tuple((one[1] - 1, other[0]) for one, other in pairwise(found)))


_Linked = tuple[Instants, list[bool]]
"""Instants that directly follow one that is as good, and for each gap whether that holds."""


class _Relation:
    """Which of two neighbours is at least as good as the other."""

    def __init__(
        self,
        nodes: Sequence[GraphNode],
        known: Sequence[Knowledge],
        neighbours: _Neighbours,
        *,
        earlier_wins: bool,
    ) -> None:
        self._nodes = nodes
        self._known = known
        self._neighbours = neighbours
        self._earlier_wins = earlier_wins

    def later_instants(self, literal: Literal) -> Instants:
        """Return the instants that the one before them is as good as."""
        inner, linked = self._linked(literal)
        found = [gap[1] for gap, also in zip(self._neighbours.gaps, linked, strict=True) if also]
        return either(inner, _points(found))

    def earlier_instants(self, literal: Literal) -> Instants:
        """Return the instants that the one after them is as good as."""
        inner, linked = self._linked(literal)
        found = [gap[0] for gap, also in zip(self._neighbours.gaps, linked, strict=True) if also]
        return either(shift(inner, -1), _points(found))

    def _linked(self, literal: Literal) -> _Linked:
        """Return where it is the right one of two neighbours that is as good for a literal."""
        node, negated = self._nodes[literal >> 1], literal & 1
        inner, gaps = self._by_knowledge(self._known[literal >> 1].of(literal))
        match node:
            case All(literals) if literals:
                parts = [self._linked(part ^ negated) for part in literals]
                also = _everywhere(parts)
            case UntilNode() if bool(negated) == self._earlier_wins:
                also = self._by_later_reach(node)
            case UntilNode():
                also = self._by_earlier_reach(node)
            case _:
                return inner, gaps
        return either(inner, also[0]), [a or b for a, b in zip(gaps, also[1], strict=True)]

    def _by_knowledge(self, known: Knowledge) -> _Linked:
        """Return where the literal is true at the better instant, or false at the other one."""
        before, now = known.true, known.false
        if not self._earlier_wins:
            before, now = now, before
        inner, gaps = self._neighbours.inner, self._neighbours.gaps
        either_one = either(both(shift(before, 1), inner), both(now, inner))
        return either_one, [_has(before, one) or _has(now, other) for one, other in gaps]

    def _by_later_reach(self, node: UntilNode) -> _Linked:
        """Return where an operator at the later instant reaches all that the earlier one does.

        What only the earlier one reaches lies before, and the right side is false there.
        """
        false = self._known[node.right >> 1].of(node.right).false
        return self._covered(shift(false, -node.least))

    def _by_earlier_reach(self, node: UntilNode) -> _Linked:
        """Return where an operator at the earlier instant reaches all that the later one does.

        The left side is true in between, and what only the later one reaches lies behind: there
        is nothing if there is no bound, or the right side is false there.
        """
        left = EVERYTHING
        if node.left != TRUTH:
            left = self._known[node.left >> 1].of(node.left).true
        inner, gaps = self._covered(left)
        if node.most != FUTURE:
            false = shift(self._known[node.right >> 1].of(node.right).false, -node.most)
            inner = both(inner, false)
            pairs = zip(gaps, self._neighbours.gaps, strict=True)
            gaps = [also and run_end(false, one + 1) > other for also, (one, other) in pairs]
        return inner, gaps

    def _covered(self, cover: Instants) -> _Linked:
        """Return where a set has all instants from one neighbour up to before the other."""
        inner, gaps = self._neighbours.inner, self._neighbours.gaps
        return both(shift(cover, 1), inner), [run_end(cover, one) >= two for one, two in gaps]


def _everywhere(parts: Sequence[_Linked]) -> _Linked:
    inner, gaps = parts[0]
    for other, also in parts[1:]:
        inner = both(inner, other)
        gaps = [a and b for a, b in zip(gaps, also, strict=True)]
    return inner, gaps


def _has(instants: Instants, instant: int) -> bool:
    return run_end(instants, instant) > instant


def _points(instants: Sequence[int]) -> Instants:
    """Return the set of ascending single instants."""
    found: Instants = EMPTY
    for instant in instants:
        found = either(found, (instant, instant + 1))
    return found

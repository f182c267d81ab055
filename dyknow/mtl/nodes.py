"""The nodes of a formula graph, and literals.

There are four kinds of node: the constant, atoms, conjunctions, and `until`; everything else is
said with these and negation. A *literal* is a node or its negation, written as the integer
`2 * node + 1` if negated and `2 * node` if not.
"""

from dataclasses import dataclass

__all__ = [
    "FALSITY",
    "SAMPLED",
    "TRUTH",
    "All",
    "GraphNode",
    "Literal",
    "Proposition",
    "UntilNode",
]

Literal = int
TRUTH: Literal = 0
FALSITY: Literal = 1


@dataclass(frozen=True, slots=True)
class Proposition:
    """An atom, by its number, or `SAMPLED`."""

    atom: int


SAMPLED = -1
"""In place of the number of an atom: whether the instant is the time-point of a state."""


@dataclass(frozen=True, slots=True)
class All:
    """The conjunction of two or more literals; of none, it is true."""

    literals: tuple[Literal, ...]


@dataclass(frozen=True, slots=True)
class UntilNode:
    """`left until [least, most] right`; `most` may be `FUTURE`."""

    least: int
    most: int
    left: Literal
    right: Literal


GraphNode = Proposition | All | UntilNode

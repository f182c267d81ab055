"""What is left of a formula after some states, and how one more state changes it.

The time model is `hold` (see `dyknow.mtl.semantics`). A new state brings two things: the state
before it has held up to one nanosecond before the new one, and the new one holds at its own
instant. Progression as in Heintz (2009), definition 7.5.3, would go through the instants one by
one or in steps of a common divisor of all times; here whole intervals are taken at once, which
is exact for any times. Therefore a residual is kept not as a formula but as what a formula
would say:

- for each operator `until` at the top level (an *obligation*), the instants that can still be its
  witness; those at which the right side is known to be false are gone;
- for each node below, the past instants at which it is known to be true or known to be false,
  as far as an undecided operator above still asks for them.

All instants are relative to the last state. Instants are only ever compared with one another
and moved by durations of the formula, so that what is done here can be watched and done again
for other times (`dyknow.mtl.rules`).
"""

from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

from dyknow.mtl.domination import redundant
from dyknow.mtl.graph import FormulaGraph
from dyknow.mtl.instants import (
    EMPTY,
    FUTURE,
    PAST,
    Instants,
    after,
    before,
    between,
    both,
    complement,
    either,
    first_from,
    run_end,
    until,
    without,
)
from dyknow.mtl.knowledge import NOTHING, Knowledge
from dyknow.mtl.nodes import TRUTH, All, GraphNode, Literal, Proposition, UntilNode
from dyknow.mtl.syntax import TimeModel, Verdict

__all__ = ["Obligation", "Progression", "Residual"]

_NOW: Instants = (0, 1)
_PAST: Instants = (PAST, 1)


@dataclass(frozen=True, slots=True)
class Obligation:
    """An undecided operator at the top level.

    Attributes:
        witnesses: The instants at which the right side may still make it true.
        left_from: The first instant at which the left side is not yet known to be true.
    """

    witnesses: Instants
    left_from: int


_ObligationState = Obligation | Verdict
"""An obligation, or what has been decided; `UNDECIDED` where the others decide without it."""


@dataclass(frozen=True, slots=True)
class Residual:
    """What is left of a formula.

    Attributes:
        obligations: For each operator or state formula at the top level, its state.
        knowledge: For each node of the graph, what is known and still asked for.
        held: For each node of the graph, whether it is a state formula that holds from now
            until the next state.
    """

    obligations: tuple[_ObligationState, ...]
    knowledge: tuple[Knowledge, ...]
    held: tuple[bool, ...]

    def mapped(self, new: Callable[[int], int]) -> "Residual":
        """Return the same with each finite bound of a set of instants replaced by another."""
        return Residual(
            tuple(
                o
                if isinstance(o, Verdict)
                else Obligation(_mapped(o.witnesses, new), _mapped_bound(o.left_from, new))
                for o in self.obligations
            ),
            tuple(
                Knowledge(_mapped(k.true, new), _mapped(k.false, new)) if k.true or k.false else k
                for k in self.knowledge
            ),
            self.held,
        )


class Progression:
    """How the residuals of one formula follow from one another.

    Attributes:
        owed: The operators and state formulas at the top level, as positive literals.
        longest: The sum of all finite durations in the formula.
    """

    def __init__(self, graph: FormulaGraph) -> None:
        self._graph = graph
        self._nodes = list(enumerate(graph.nodes))
        self.owed = tuple(dict.fromkeys(self._top_level(graph.root)))
        self.longest = sum(2 + _finite_bounds(node) for node in graph.nodes)
        self._place = {literal: at for at, literal in enumerate(self.owed)}
        self._users = _count_users(graph)
        between_states = graph.plain_values(0, sampled=False)
        self._between = between_states if graph.time_model is TimeModel.POINTS else None

    def _top_level(self, literal: Literal) -> Iterator[Literal]:
        """Yield the nodes that say something about the first instant, as positive literals."""
        number = literal >> 1
        node = self._graph.nodes[number]
        if isinstance(node, All) and self._graph.temporal[number]:
            for inner in node.literals:
                yield from self._top_level(inner)
        else:
            yield 2 * number

    def first(self, bits: int) -> Residual:
        """Return what is left after the first state, the atoms of which have the truth *bits*."""
        held = self._graph.plain_values(bits)
        obligations = tuple(self._first_obligation(literal >> 1, held) for literal in self.owed)
        nothing = (NOTHING,) * len(self._nodes)
        return self._looked_at(Residual(obligations, nothing, tuple(held)), held, EMPTY)

    def _first_obligation(self, number: int, held: list[bool]) -> _ObligationState:
        node = self._graph.nodes[number]
        if isinstance(node, UntilNode):
            end = FUTURE if node.most == FUTURE else node.most + 1
            return Obligation(between(node.least, end), 0)
        return Verdict.TRUE if held[number] else Verdict.FALSE

    def next(self, residual: Residual, bits: int, last: int) -> Residual:
        """Return what is left after one more state.

        Args:
            residual: What was left after the state before; all its instants are relative to
                the new state.
            bits: The truth of atom number i in bit i.
            last: The instant of the state before, relative to the new one: below 0.
        """
        held = self._graph.plain_values(bits)
        return self._looked_at(residual, held, between(last + 1, 0))

    def verdict(self, residual: Residual) -> Verdict:
        """Return what is known about the whole formula."""
        return self._value(self._graph.root, residual.obligations)

    def _looked_at(self, moved: Residual, held: list[bool], interval: Instants) -> Residual:
        """Take in what held over *interval* and what holds now."""
        known = self._learnt(moved, held, interval)
        obligations = tuple(
            self._decided(literal >> 1, obligation, known)
            for literal, obligation in zip(self.owed, moved.obligations, strict=True)
        )
        relevant = set(self._relevant(self._graph.root, obligations))
        obligations = tuple(
            obligation
            if literal in relevant or isinstance(obligation, Verdict)
            else Verdict.UNDECIDED
            for literal, obligation in zip(self.owed, obligations, strict=True)
        )
        obligations = tuple(
            self._without_redundant(literal >> 1, obligation, known)
            for literal, obligation in zip(self.owed, obligations, strict=True)
        )
        return self._remembered(obligations, known, held)

    def _learnt(self, moved: Residual, held: list[bool], interval: Instants) -> list[Knowledge]:
        """Return what is known about each node, from those without parts upwards."""
        known: list[Knowledge] = []
        for number, node in self._nodes:
            if self._graph.temporal[number]:
                true, false = _consequences(node, known)
            else:
                true = interval if moved.held[number] else EMPTY
                true = either(true, _NOW if held[number] else EMPTY)
                false = without(either(interval, _NOW), true)
            known.append(moved.knowledge[number].joined(true, false))
        return known

    def _decided(
        self, number: int, obligation: _ObligationState, known: list[Knowledge]
    ) -> _ObligationState:
        """Return an obligation with the witnesses that are left, or what decides it."""
        node = self._graph.nodes[number]
        if isinstance(obligation, Verdict) or not isinstance(node, UntilNode):
            return obligation
        right = known[node.right >> 1].of(node.right)
        witnesses = without(obligation.witnesses, right.false)
        last_possible, left_from = FUTURE, FUTURE
        if node.left != TRUTH:
            left = known[node.left >> 1].of(node.left)
            left_from = run_end(left.true, obligation.left_from)
            last_possible = first_from(left.false, obligation.left_from)
        witnesses = both(witnesses, between(PAST, _next(last_possible)))
        if not witnesses:
            return Verdict.FALSE
        if both(both(right.true, witnesses), between(PAST, _next(left_from))):
            return Verdict.TRUE
        return Obligation(witnesses, 0 if node.left == TRUTH else left_from)

    def _value(self, literal: Literal, obligations: tuple[_ObligationState, ...]) -> Verdict:
        at = self._place.get(literal & ~1)
        if at is None:
            node = self._graph.nodes[literal >> 1]
            inner = node.literals if isinstance(node, All) else ()
            value = min((self._value(k, obligations) for k in inner), default=Verdict.TRUE)
        else:
            state = obligations[at]
            value = Verdict.UNDECIDED if isinstance(state, Obligation) else state
        return Verdict(-value) if literal & 1 else value

    def _relevant(
        self, literal: Literal, obligations: tuple[_ObligationState, ...]
    ) -> Iterator[Literal]:
        """Yield the obligations on which the verdict can still depend."""
        if self._value(literal, obligations) is not Verdict.UNDECIDED:
            return
        node = self._graph.nodes[literal >> 1]
        if literal & ~1 in self._place:
            yield literal & ~1
        elif isinstance(node, All):
            for inner in node.literals:
                yield from self._relevant(inner, obligations)

    def _without_redundant(
        self, number: int, obligation: _ObligationState, known: list[Knowledge]
    ) -> _ObligationState:
        """Drop past witnesses that cannot be better than others that stay."""
        node = self._graph.nodes[number]
        if not isinstance(obligation, Obligation) or not isinstance(node, UntilNode):
            return obligation
        past = both(obligation.witnesses, _PAST)
        if not past:
            return obligation
        needless = self._redundant(node, past, known)
        return Obligation(without(obligation.witnesses, needless), obligation.left_from)

    def _redundant(
        self, node: UntilNode, waiting: Instants, known: Sequence[Knowledge]
    ) -> Instants:
        """Return which witnesses of *node* among those *waiting* are not needed."""
        has_left = node.left != TRUTH
        return redundant(self._graph.nodes, node.right, waiting, known, keep_earlier=has_left)

    def undecided_part(
        self, literal: Literal, instants: Instants, known: Sequence[Knowledge]
    ) -> Literal:
        """Return what a conjunction comes down to at *instants* if only one part is open."""
        node = self._graph.nodes[literal >> 1]
        if not isinstance(node, All):
            return literal
        parts = [k for k in node.literals if without(instants, known[k >> 1].of(k).true)]
        if len(parts) != 1:
            return literal
        return self.undecided_part(parts[0], instants, known) ^ (literal & 1)

    def _remembered(
        self, obligations: tuple[_ObligationState, ...], known: list[Knowledge], held: list[bool]
    ) -> Residual:
        """Forget what no undecided operator asks for, from the top downwards."""
        asked = [EMPTY] * len(known)
        for literal, obligation in zip(self.owed, obligations, strict=True):
            node = self._graph.nodes[literal >> 1]
            if isinstance(obligation, Obligation) and isinstance(node, UntilNode):
                last = obligation.witnesses[-1]
                _ask(asked, node.right, obligation.witnesses)
                if node.left != TRUTH:
                    _ask(asked, node.left, between(obligation.left_from, _previous(last)))
        for number, node in reversed(self._nodes):
            known[number] = known[number].within(asked[number])
            if asked[number] and self._graph.temporal[number]:
                pending = _open(known[number], asked[number])
                self._give_up(number, pending, known)
                self._ask_parts(asked, node, pending)
        after = self._between or held
        still = [bool(value and a and a[-1] > 1) for value, a in zip(after, asked, strict=True)]
        return Residual(obligations, tuple(known), tuple(still))

    def _give_up(self, number: int, pending: Instants, known: list[Knowledge]) -> None:
        """Take the right side of an operator to be false at witnesses that are not needed.

        These are redundant past witnesses of all past instants at which the operator is pending.
        Nobody else may ask for the right side.
        """
        node = self._graph.nodes[number]
        past = both(pending, _PAST)
        if not past or not isinstance(node, UntilNode) or self._users[node.right >> 1] != 1:
            return
        first = past[-1] - 1 + node.least
        end = FUTURE if node.most == FUTURE else past[0] + node.most + 1
        right = known[node.right >> 1].of(node.right)
        shared = both(between(first, end), _PAST)
        needless = self._redundant(node, _open(right, shared), known)
        if needless:
            right = right.joined(EMPTY, needless)
            known[node.right >> 1] = right.of(node.right)

    def _ask_parts(self, asked: list[Instants], node: GraphNode, pending: Instants) -> None:
        match node:
            case All(literals):
                for literal in literals:
                    _ask(asked, literal, pending)
            case UntilNode(least, most, left, right):
                _ask(asked, right, after(pending, least, most))
                if left != TRUTH and most > 0:
                    _ask(asked, left, after(pending, 0, _previous(most)))
            case _:
                pass


def _count_users(graph: FormulaGraph) -> Counter[int]:
    """Return for each node how many nodes are made of it; the whole formula has one user more."""
    users = Counter([graph.root >> 1])
    for node in graph.nodes:
        match node:
            case All(literals):
                users.update(literal >> 1 for literal in literals)
            case UntilNode(_, _, left, right):
                users.update((left >> 1, right >> 1))
            case Proposition():
                pass
    return users


def _finite_bounds(node: GraphNode) -> int:
    """Return the longest finite duration that a node adds to an instant."""
    if not isinstance(node, UntilNode):
        return 0
    return node.least if node.most == FUTURE else node.most


def _mapped(instants: Instants, new: Callable[[int], int]) -> Instants:
    return tuple([_mapped_bound(bound, new) for bound in instants])


def _mapped_bound(bound: int, new: Callable[[int], int]) -> int:
    return bound if bound in (PAST, FUTURE) else new(bound)


def _next(instant: int) -> int:
    return instant if instant == FUTURE else instant + 1


def _previous(instant: int) -> int:
    return instant if instant == FUTURE else instant - 1


def _ask(asked: list[Instants], literal: Literal, instants: Instants) -> None:
    asked[literal >> 1] = either(asked[literal >> 1], instants)


def _open(known: Knowledge, asked: Instants) -> Instants:
    return without(without(asked, known.true), known.false)


def _consequences(node: GraphNode, known: list[Knowledge]) -> tuple[Instants, Instants]:
    """Return where a node is true and false, given what is known about its parts."""
    match node:
        case All(literals):
            parts = [known[k >> 1].of(k) for k in literals]
            true, false = parts[0].true, parts[0].false
            for part in parts[1:]:
                true, false = both(true, part.true), either(false, part.false)
            return true, false
        case UntilNode(least, most, left, right):
            goal = known[right >> 1].of(right)
            possible = complement(goal.false)
            if left == TRUTH:
                return before(goal.true, least, most), complement(before(possible, least, most))
            way = known[left >> 1].of(left)
            passable = complement(way.false)
            return (
                until(way.true, goal.true, least, most),
                complement(until(passable, possible, least, most)),
            )
        case _:
            return EMPTY, EMPTY

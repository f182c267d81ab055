"""A residual in the words of a formula.

The formula is about the time after the last state, the state itself having been looked at; an
interval is relative to that state. Where what is left depends on instants that have passed in a
way that no formula about the future says simply, an interval reaches back before 0.
"""

from dyknow.mtl import syntax
from dyknow.mtl.graph import FormulaGraph, conjunction, disjunction, negation
from dyknow.mtl.instants import FUTURE, pieces
from dyknow.mtl.nodes import TRUTH, All, Literal, UntilNode
from dyknow.mtl.residuals import Obligation, Progression, Residual
from dyknow.mtl.syntax import Formula, Interval
from dyknow.time import Duration

__all__ = ["formula_from_residual"]


def formula_from_residual(
    graph: FormulaGraph, progression: Progression, residual: Residual
) -> Formula:
    """Return *residual* as a formula."""
    return _Wording(graph, progression, residual).formula(graph.root)


class _Wording:
    """The parts of one residual as formulas."""

    def __init__(self, graph: FormulaGraph, progression: Progression, residual: Residual) -> None:
        self._graph = graph
        self._progression = progression
        self._states = dict(zip(progression.owed, residual.obligations, strict=True))
        self._knowledge = residual.knowledge

    def formula(self, literal: Literal) -> Formula:
        """Return what is left of a literal at the top level."""
        node = self._graph.nodes[literal >> 1]
        state = self._states.get(literal & ~1)
        if isinstance(state, Obligation) and isinstance(node, UntilNode):
            formula = self._anchor(node, state)
        elif state is not None:
            formula = syntax.TRUE if state == syntax.Verdict.TRUE else syntax.FALSE
        else:
            inner = node.literals if isinstance(node, All) else ()
            formula = conjunction([self.formula(k) for k in inner])
        return negation(formula) if literal & 1 else formula

    def _anchor(self, node: UntilNode, obligation: Obligation) -> Formula:
        right = self._graph.formula(node.right)
        options = pieces(obligation.witnesses)
        if node.left == TRUTH:
            return disjunction([f for p in options for f in self._eventually(node, right, *p)])
        left = self._graph.formula(node.left)
        until = [syntax.Until(_interval(*piece), left, right) for piece in options]
        if obligation.left_from >= 1 or obligation.witnesses[0] < 1:
            return disjunction([*until])
        so_far = syntax.Always(_interval(obligation.left_from, 1), left)
        return conjunction([so_far, disjunction([*until])])

    def _eventually(self, node: UntilNode, right: Formula, start: int, end: int) -> list[Formula]:
        """Return what it takes for the right side to hold from *start* up to before *end*."""
        simple = self._from_past(node.right, start, min(end, 1)) if start < 1 else None
        if simple is None:
            return [syntax.Eventually(_interval(start, end), right)]
        if end <= 1:
            return [simple]
        return [simple, syntax.Eventually(_interval(1, end), right)]

    def _from_past(self, literal: Literal, start: int, end: int) -> Formula | None:
        """Return what it takes for a literal to have held at some instant of the past.

        There is an answer for an operator over a state formula, alone among what is undecided.
        """
        literal = self._progression.undecided_part(literal, (start, end), self._knowledge)
        node = self._graph.nodes[literal >> 1]
        if not isinstance(node, UntilNode) or self._graph.temporal[node.right >> 1]:
            return None
        if node.left != TRUTH:
            return None
        most = FUTURE if node.most == FUTURE else node.most + 1
        if not literal & 1:
            last = most if most == FUTURE else end - 1 + most
            within = _interval(max(1, start + node.least), last)
            return syntax.Eventually(within, self._graph.formula(node.right))
        if end - 1 + node.least > 1:
            return None
        last = most if most == FUTURE else start + most
        return syntax.Always(_interval(1, last), self._graph.formula(node.right ^ 1))


def _interval(start: int, end: int) -> Interval:
    """Return an interval without its *end*; the instant after the state is called 0."""
    last = None if end == FUTURE else Duration(end - 1)
    return Interval(Duration(0 if start == 1 else start), last)

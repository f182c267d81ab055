"""Which literals of a formula graph hold wherever others do, as far as their form shows it.

One relation covers what progression needs to simplify: a conjunct that the others entail says
nothing, and conjuncts one of which entails the negation of another are never true together. It
sees that `eventually [0, 10] p` entails `eventually [0, 20] p`, `always p` entails `p`, `p until
q` entails `p or q`, and what follows from these. It does not look into numbers, and what two
operators say about an instant to come it does not put together: that `eventually [1, 10] p or
eventually [1, 10] not p` is true in any case is not seen.

Whenever one literal entails another by these rules, its value in Kleene's logic is never above the
other's, so that leaving out what is entailed changes no verdict.
"""

from collections.abc import Collection, Sequence

from dyknow.mtl.nodes import FALSITY, TRUTH, All, GraphNode, Literal, UntilNode

__all__ = ["Entailment"]

_DEEPEST = 24


class Entailment:
    """The relation on the literals of one graph, which may be growing.

    Attributes:
        nodes: The nodes of the graph.
    """

    def __init__(self, nodes: Sequence[GraphNode]) -> None:
        self.nodes = nodes
        self._known: dict[tuple[Literal, Literal], bool] = {}

    def follows(self, premises: Collection[Literal], conclusion: Literal) -> bool:
        """Return whether *conclusion* holds wherever all *premises* do."""
        return self._follows(premises, conclusion, _DEEPEST)

    def _follows(self, premises: Collection[Literal], conclusion: Literal, depth: int) -> bool:
        if any(self._entails(premise, conclusion, depth) for premise in premises):
            return True
        return depth > 0 and self._follows_together(premises, conclusion, depth - 1)

    def _follows_together(
        self, premises: Collection[Literal], conclusion: Literal, depth: int
    ) -> bool:
        """Return whether the parts of *conclusion* each follow, from one premise or another."""
        node, negated = self.nodes[conclusion >> 1], conclusion & 1
        match node:
            case All(literals) if negated:
                return any(self._follows(premises, k ^ 1, depth) for k in literals)
            case All(literals):
                return all(self._follows(premises, k, depth) for k in literals)
            case UntilNode(0, _, _, right) if not negated:
                return self._follows(premises, right, depth)
            case UntilNode(least, _, left, right) if negated:
                no_more = least > 0 or self._follows(premises, right ^ 1, depth)
                return no_more and self._follows(premises, left ^ 1, depth)
            case _:
                return False

    def _entails(self, one: Literal, other: Literal, depth: int) -> bool:
        if one in (other, FALSITY) or other == TRUTH:
            return True
        if one == TRUTH or other == FALSITY or not depth:
            return False
        known = self._known.get((one, other))
        if known is None:
            known = self._weakens(one, other, depth - 1) or self._weakens(
                other ^ 1, one ^ 1, depth - 1
            )
            known = known or self._contains(one, other, depth - 1)
            self._known[one, other] = known
        return known

    def _weakens(self, one: Literal, other: Literal, depth: int) -> bool:
        """Return whether something that *one* amounts to at least entails *other*."""
        node, negated = self.nodes[one >> 1], one & 1
        match node:
            case All(literals) if negated:
                return all(self._entails(k ^ 1, other, depth) for k in literals)
            case All(literals):
                return any(self._entails(k, other, depth) for k in literals)
            case UntilNode(0, _, _, right) if negated:
                return self._entails(right ^ 1, other, depth)
            case UntilNode(least, _, left, right) if not negated:
                at_once = least > 0 or self._entails(right, other, depth)
                return at_once and self._entails(left, other, depth)
            case _:
                return False

    def _contains(self, one: Literal, other: Literal, depth: int) -> bool:
        """Return whether both are operators, the one asking for more than the other."""
        if one & 1 and other & 1:
            one, other = other ^ 1, one ^ 1
        strong, weak = self.nodes[one >> 1], self.nodes[other >> 1]
        if (one | other) & 1 or not isinstance(strong, UntilNode):
            return False
        return (
            isinstance(weak, UntilNode)
            and weak.least <= strong.least
            and strong.most <= weak.most
            and self._entails(strong.left, weak.left, depth)
            and self._entails(strong.right, weak.right, depth)
        )

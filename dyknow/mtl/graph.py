"""A formula as a graph in which equal subformulas are one node.

Literals (`dyknow.mtl.nodes`) are simplified as they are made: constants disappear, `eventually
[a, b] eventually [c, d] f` is `eventually [a + c, b + d] f`, and in conjunctions, of not too many
parts, what others entail is left out and what others exclude is false (`dyknow.mtl.entailment`).

The graph is always about the time model `hold`. In the model `points` there is one more
proposition, *sampled*, which holds at the time-points of the states alone: operators speak of
`sampled and f` where they want a witness and of `sampled -> f` where they want all instants.
"""

from dyknow.mtl import syntax
from dyknow.mtl.entailment import Entailment
from dyknow.mtl.instants import FUTURE
from dyknow.mtl.nodes import (
    FALSITY,
    SAMPLED,
    TRUTH,
    All,
    GraphNode,
    Literal,
    Proposition,
    UntilNode,
)
from dyknow.mtl.syntax import Atom, Formula, Interval, TimeModel

__all__ = ["FormulaGraph", "conjunction", "disjunction", "negation"]

_MOST_COMPARED = 64


class FormulaGraph:
    """The nodes of one formula, each after those it is made of.

    Attributes:
        nodes: All nodes; node 0 is the constant true.
        temporal: Whether there is an `until` in the node.
        formulas: A formula that the node stands for.
        atoms: The atoms in order of their first occurrence.
        root: The literal of the whole formula.
        time_model: The time model.
    """

    def __init__(self, formula: Formula, time_model: TimeModel = TimeModel.HOLD) -> None:
        self.time_model = time_model
        self.nodes: list[GraphNode] = []
        self._entailment = Entailment(self.nodes)
        self.temporal: list[bool] = []
        self.formulas: list[Formula] = []
        self._number: dict[GraphNode, int] = {}
        self._number_by_atom: dict[Atom, int] = {}
        self._make(All(()), syntax.TRUE)
        self.root: Literal = self._literal(formula)

    @property
    def atoms(self) -> tuple[Atom, ...]:
        """The atoms, in the order of their numbers."""
        return tuple(self._number_by_atom)

    def formula(self, literal: Literal) -> Formula:
        """Return a formula that *literal* stands for."""
        formula = self.formulas[literal >> 1]
        return negation(formula) if literal & 1 else formula

    def plain_values(self, bits: int, *, sampled: bool = True) -> list[bool]:
        """Return the value of each node without an `until`; of the others, False.

        Args:
            bits: The truth of atom number i in bit i.
            sampled: Whether it is the time-point of a state.
        """
        values: list[bool] = []
        for node in self.nodes:
            match node:
                case Proposition(atom) if atom == SAMPLED:
                    values.append(sampled)
                case Proposition(atom):
                    values.append(bool(bits >> atom & 1))
                case All(literals):
                    values.append(all(values[k >> 1] != bool(k & 1) for k in literals))
                case UntilNode():
                    values.append(False)
        return values

    def _make(self, node: GraphNode, formula: Formula) -> Literal:
        number = self._number.setdefault(node, len(self.nodes))
        if number == len(self.nodes):
            self.nodes.append(node)
            self.formulas.append(formula)
            self.temporal.append(self._has_until(node))
        return 2 * number

    def _has_until(self, node: GraphNode) -> bool:
        match node:
            case Proposition():
                return False
            case All(literals):
                return any(self.temporal[literal >> 1] for literal in literals)
            case UntilNode():
                return True

    def _literal(self, formula: Formula) -> Literal:
        match formula:
            case syntax.Truth(value):
                return TRUTH if value else FALSITY
            case syntax.Feature() | syntax.Comparison():
                number = self._number_by_atom.setdefault(formula, len(self._number_by_atom))
                return self._make(Proposition(number), formula)
            case syntax.Always() | syntax.Eventually() | syntax.Until():
                return self._temporal_literal(formula)
            case syntax.ForAll() | syntax.Exists():
                raise ValueError("expected a formula without quantifiers: use expand first")
            case _:
                return self._boolean_literal(formula)

    def _boolean_literal(
        self,
        formula: syntax.Negation
        | syntax.Conjunction
        | syntax.Disjunction
        | syntax.Implication
        | syntax.Equivalence,
    ) -> Literal:
        match formula:
            case syntax.Negation(body):
                return self._literal(body) ^ 1
            case syntax.Conjunction(bodies):
                return self._all([self._literal(body) for body in bodies], formula)
            case syntax.Disjunction(bodies):
                parts = [self._literal(body) ^ 1 for body in bodies]
                return self._all(parts, negation(formula)) ^ 1
            case syntax.Implication(left, right):
                parts = [self._literal(left), self._literal(right) ^ 1]
                return self._all(parts, negation(formula)) ^ 1
            case syntax.Equivalence(left, right):
                return self._equivalence(self._literal(left), self._literal(right), formula)

    def _equivalence(self, left: Literal, right: Literal, formula: Formula) -> Literal:
        forwards = syntax.Implication(self.formula(left), self.formula(right))
        backwards = syntax.Implication(forwards.right, forwards.left)
        one = self._all([left, right ^ 1], syntax.Negation(forwards))
        other = self._all([left ^ 1, right], syntax.Negation(backwards))
        return self._all([one ^ 1, other ^ 1], formula)

    def _temporal_literal(
        self, formula: syntax.Always | syntax.Eventually | syntax.Until
    ) -> Literal:
        match formula:
            case syntax.Always(within, body):
                right = self._literal(body) ^ 1
                return self._until(within, TRUTH, right, negation(formula)) ^ 1
            case syntax.Eventually(within, body):
                return self._until(within, TRUTH, self._literal(body), formula)
            case syntax.Until(within, left, right_body):
                parts = self._literal(left), self._literal(right_body)
                return self._until(within, *parts, formula)

    def _all(self, literals: list[Literal], formula: Formula) -> Literal:
        flat: dict[Literal, None] = {}
        for literal in literals:
            node = self.nodes[literal >> 1]
            inner = node.literals if isinstance(node, All) and not literal & 1 else (literal,)
            flat.update(dict.fromkeys(inner))
        if any(literal ^ 1 in flat for literal in flat) or FALSITY in flat:
            return FALSITY
        kept = [literal for literal in flat if literal != TRUTH]
        if len(kept) <= _MOST_COMPARED:
            kept = self._independent(kept)
            if FALSITY in kept:
                return FALSITY
        if len(kept) <= 1:
            return kept[0] if kept else TRUTH
        if len(kept) < len(flat):
            formula = conjunction([self.formula(literal) for literal in kept])
        return self._make(All(tuple(sorted(kept))), formula)

    def _independent(self, literals: list[Literal]) -> list[Literal]:
        """Return what is left of a conjunction when no literal follows from the others."""
        kept = literals
        for literal in literals:
            others = [other for other in kept if other != literal]
            if self._entailment.follows(others, literal ^ 1):
                return [FALSITY]
            if self._entailment.follows(others, literal):
                kept = others
        return kept

    def _until(self, within: Interval, left: Literal, right: Literal, formula: Formula) -> Literal:
        least, most = int(within.start), FUTURE if within.end is None else int(within.end)
        if right == FALSITY or (left == FALSITY and least > 0):
            return FALSITY
        if left == FALSITY:
            return right
        if self.time_model is TimeModel.POINTS:
            left, right = self._sampled(left ^ 1) ^ 1, self._sampled(right)
        inner = self.nodes[right >> 1]
        nested = left == TRUTH and not right & 1 and isinstance(inner, UntilNode)
        if nested and isinstance(inner, UntilNode) and inner.left == TRUTH:
            most = FUTURE if FUTURE in {most, inner.most} else most + inner.most
            least, right = least + inner.least, inner.right
        return self._make(UntilNode(least, most, left, right), formula)

    def _sampled(self, literal: Literal) -> Literal:
        """Return what holds where *literal* does at the time-point of a state."""
        sampled = self._make(Proposition(SAMPLED), syntax.TRUE)
        return self._all([sampled, literal], self.formula(literal))


def negation(formula: Formula) -> Formula:  # noqa: PLR0911
    """Return the negation of *formula*, pushed inwards as far as it reads better."""
    match formula:
        case syntax.Truth(value):
            return syntax.FALSE if value else syntax.TRUE
        case syntax.Negation(body):
            return body
        case syntax.Always(within, body):
            return syntax.Eventually(within, negation(body))
        case syntax.Eventually(within, body):
            return syntax.Always(within, negation(body))
        case syntax.Conjunction(bodies):
            return disjunction([negation(body) for body in bodies])
        case syntax.Disjunction(bodies):
            return conjunction([negation(body) for body in bodies])
        case _:
            return syntax.Negation(formula)


def conjunction(formulas: list[Formula]) -> Formula:
    """Return the conjunction of *formulas*, without what changes nothing."""
    return _joined(formulas, syntax.Conjunction, neutral=syntax.TRUE, absorbing=syntax.FALSE)


def disjunction(formulas: list[Formula]) -> Formula:
    """Return the disjunction of *formulas*, without what changes nothing."""
    return _joined(formulas, syntax.Disjunction, neutral=syntax.FALSE, absorbing=syntax.TRUE)


def _joined(
    formulas: list[Formula],
    kind: type[syntax.Conjunction | syntax.Disjunction],
    *,
    neutral: Formula,
    absorbing: Formula,
) -> Formula:
    flat: list[Formula] = []
    for formula in formulas:
        flat.extend(formula.bodies if isinstance(formula, kind) else (formula,))
    kept = tuple(dict.fromkeys(f for f in flat if f != neutral))
    if absorbing in kept:
        return absorbing
    if len(kept) <= 1:
        return kept[0] if kept else neutral
    return kind(kept)

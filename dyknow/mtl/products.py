"""Formulas of many atoms that fall apart into parts, each of which is progressed by itself.

`always forall x in Car (...)` is a conjunction of one formula for each car, and so its residuals
are combinations of the residuals for the cars: far more than could be learnt one by one. Here each
part has its own residual, and parts that differ only in their atoms share one table.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

from dyknow.mtl import syntax
from dyknow.mtl.decisions import Rule, Times
from dyknow.mtl.graph import conjunction, disjunction, negation
from dyknow.mtl.progression import ProgressionTable
from dyknow.mtl.rules import NEVER, Shape
from dyknow.mtl.syntax import (
    Atom,
    Feature,
    Formula,
    Node,
    Verdict,
    operands,
    parts,
    with_operands,
)

__all__ = ["Product", "taken_apart"]

_FEW_ATOMS = 3


class _ProductShape(Shape):
    """The shapes and times of all parts.

    Attributes:
        states: A shape and its times for each part.
    """

    __slots__ = ("_product", "states")

    def __init__(
        self, product: "Product", states: Sequence[tuple[Shape, Times]], verdict: Verdict
    ) -> None:
        super().__init__(-1, None, (), verdict, 0)
        self._product = product
        self.states = states

    def __missing__(self, bits: int) -> Rule[Shape]:
        return lambda now, _: self._product.follow(self, bits, now)


class _Part:
    """One part of a formula, which has other atoms than the table that it is progressed by."""

    def __init__(
        self, table: ProgressionTable, own: Sequence[Atom], number_by_atom: Mapping[Atom, int]
    ) -> None:
        self.table = table
        self._atom_by_placeholder = dict(zip(table.atoms, own, strict=True))
        self._numbers = tuple(enumerate(number_by_atom[atom] for atom in own))

    def follow(self, shape: Shape, past: Times, bits: int, now: int) -> tuple[Shape, Times]:
        """Do what `RuleBook.follow` does, given the truth of the atoms of the whole formula."""
        own = 0
        for at, number in self._numbers:
            own |= (bits >> number & 1) << at
        return self.table.rules.follow(shape, past, own, now)

    def formula_left(self, shape: Shape, past: Times) -> Formula:
        """Return what is left of the part."""
        return _with_atoms(self.table.formula_left(shape, past), self._atom_by_placeholder)


class Product:
    """A formula as a conjunction or a disjunction of parts.

    Attributes:
        initial: What is left before the first state.
    """

    def __init__(
        self, table: ProgressionTable, formulas: Sequence[Formula], *, is_conjunction: bool
    ) -> None:
        """Make the parts.

        Args:
            table: The table of the whole formula.
            formulas: The parts, the atoms of which are among those of the table.
            is_conjunction: Whether all parts have to be true, and not just one of them.
        """
        self._formula = table.formula
        self._is_conjunction = is_conjunction
        tables: dict[Formula, ProgressionTable] = {}
        number_by_atom = {atom: number for number, atom in enumerate(table.atoms)}
        self._parts: list[_Part] = []
        for formula in formulas:
            own = _atoms(formula)
            abstract = _with_atoms(formula, {a: Feature(f"#{i}") for i, a in enumerate(own)})
            if abstract not in tables:
                tables[abstract] = ProgressionTable(abstract, table.limit, table.time_model)
            self._parts.append(_Part(tables[abstract], own, number_by_atom))
        start = [(part.table.rules.initial, (NEVER,)) for part in self._parts]
        self.initial = _ProductShape(self, start, Verdict.UNDECIDED)

    def follow(self, shape: _ProductShape, bits: int, now: int) -> tuple[Shape, Times]:
        """Return what is left after one more state, and the time of that state."""
        if shape.verdict is not Verdict.UNDECIDED:
            return shape, (now,)
        states = [
            part.follow(*state, bits, now) if state[0].verdict is Verdict.UNDECIDED else state
            for part, state in zip(self._parts, shape.states, strict=True)
        ]
        join = min if self._is_conjunction else max
        verdict = join(state[0].verdict for state in states)
        return _ProductShape(self, states, verdict), (now,)

    def formula_left(self, shape: Shape) -> Formula:
        """Return what is left as a formula."""
        if shape is self.initial or not isinstance(shape, _ProductShape):
            return self._formula
        pairs = zip(self._parts, shape.states, strict=True)
        left = [part.formula_left(*state) for part, state in pairs]
        return conjunction(left) if self._is_conjunction else disjunction(left)


def taken_apart(table: ProgressionTable) -> Product | None:
    """Return the parts of a formula, or None if it has few atoms or is in one piece."""
    if len(table.atoms) <= _FEW_ATOMS:
        return None
    conjuncts, disjuncts = _conjuncts(table.formula), _disjuncts(table.formula)
    if max(len(conjuncts), len(disjuncts)) == 1:
        return None
    if len(conjuncts) >= len(disjuncts):
        return Product(table, conjuncts, is_conjunction=True)
    return Product(table, disjuncts, is_conjunction=False)


def _conjuncts(formula: Formula) -> list[Formula]:
    """Return formulas that are all true exactly if *formula* is."""
    match formula:
        case syntax.Conjunction(bodies):
            return [part for body in bodies for part in _conjuncts(body)]
        case syntax.Always(_, body):
            return [replace(formula, body=part) for part in _conjuncts(body)]
        case syntax.Negation(body):
            return _each_or_whole(formula, _disjuncts(body), negation)
        case syntax.Implication(left, right):
            aims, cases = _conjuncts(right), _disjuncts(left)
            if len(aims) > 1:
                return [replace(formula, right=aim) for aim in aims]
            return [replace(formula, left=case) for case in cases]
        case _:
            return [formula]


def _disjuncts(formula: Formula) -> list[Formula]:
    """Return formulas at least one of which is true exactly if *formula* is."""
    match formula:
        case syntax.Disjunction(bodies):
            return [part for body in bodies for part in _disjuncts(body)]
        case syntax.Eventually(_, body):
            return [replace(formula, body=part) for part in _disjuncts(body)]
        case syntax.Negation(body):
            return _each_or_whole(formula, _conjuncts(body), negation)
        case syntax.Implication(left, right):
            return [*map(negation, _conjuncts(left)), *_disjuncts(right)]
        case _:
            return [formula]


def _each_or_whole(
    formula: Formula, found: list[Formula], change: Callable[[Formula], Formula]
) -> list[Formula]:
    return [change(part) for part in found] if len(found) > 1 else [formula]


def _atoms(node: Formula) -> tuple[Atom, ...]:
    """Return the atoms in reading order, each once."""
    found: dict[Atom, None] = {}
    waiting: list[Node] = [node]
    while waiting:
        part = waiting.pop()
        if isinstance(part, Feature | syntax.Comparison):
            found[part] = None
        else:
            waiting.extend(reversed(parts(part)))
    return tuple(found)


def _with_atoms(formula: Formula, new: Mapping[Atom, Atom]) -> Formula:
    """Return *formula* with other atoms."""
    if isinstance(formula, Feature | syntax.Comparison):
        return new[formula]
    return with_operands(formula, [_with_atoms(part, new) for part in operands(formula)])

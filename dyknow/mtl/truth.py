"""The truth of the atoms of a formula in one state, computed by a function made for them.

The function takes the usual way through one state: each feature is there and is a plain boolean,
number or text as its atoms need it. Whatever is not as usual, faults included, is left to
the general way (`dyknow.mtl.columns`), which says what is wrong.
"""

from collections.abc import Callable, Mapping, Sequence
from typing import Any

from dyknow.mtl import syntax
from dyknow.mtl.printer import text_from_formula
from dyknow.mtl.syntax import Atom, Comparison, Feature, Term

__all__ = ["OfState", "StateTruth"]

OfState = Callable[[Mapping[str, Any]], int]
"""From the features of a state to the truth of atom number i in bit i."""

_OPERATORS = {"=": "=="}
_BOOLEAN = "{0} is not True and {0} is not False"
_NUMBER = "type({0}) is not float and type({0}) is not int"
_TEXT = "type({0}) is not str"
_SAME = "type({0}) is not type({1}) or type({0}) not in plain"
_PLAIN = frozenset({bool, int, float, str})


class StateTruth:
    """The truth of some atoms in one state.

    Attributes:
        of: Returns the truth of atom number i in bit i, given the features of a state.
    """

    def __init__(self, atoms: Sequence[Atom], otherwise: OfState) -> None:
        """Make the function.

        Args:
            atoms: The atoms.
            otherwise: The general way to do the same.
        """
        function = _Function()
        for number, atom in enumerate(atoms):
            function.add(atom, number)
        self._name_by_term = function.name_by_term
        self._names: dict[str, Any] = {
            "otherwise": otherwise,
            "plain": _PLAIN,
            "usual": (KeyError, ZeroDivisionError, OverflowError),
            **function.constants,
        }
        self.spell({term: term for term in function.name_by_term})
        exec(function.source(), self._names)
        self.of: OfState = self._names["truth"]

    def spell(self, keys: Mapping[str, str]) -> None:
        """Look features up by other keys from now on, given by the printed terms."""
        for term, key in keys.items():
            self._names[f"key_{self._name_by_term[term]}"] = key


class _Function:
    """The source of a function, as it grows by a few lines for each atom.

    No expression has more than one operator, as Python does not compile what is nested too deep.
    """

    def __init__(self) -> None:
        self.name_by_term: dict[str, str] = {}
        self.constants: dict[str, Any] = {}
        self._lines: dict[str, None] = {}
        self._name_by_expression: dict[str, str] = {}

    def add(self, atom: Atom, number: int) -> None:
        """Compute an atom and set its bit."""
        if isinstance(atom, Feature):
            truth = self._checked(atom, _BOOLEAN)
        else:
            truth = self._comparison(atom)
        self._lines[f"bits |= ({truth}) << {number}" if number else f"bits = int({truth})"] = None

    def source(self) -> str:
        """Return the text of the function."""
        fetch = [f"{name} = state[key_{name}]" for name in self.name_by_term.values()]
        body = "\n        ".join([*fetch, "bits = 0", *self._lines, "return bits"])
        return (
            f"def truth(state):\n    try:\n        {body}\n"
            "    except usual:\n        return otherwise(state)\n"
        )

    def _comparison(self, atom: Comparison) -> str:
        operator = _OPERATORS.get(atom.operator, atom.operator)
        kind = _kind(atom.left) or _kind(atom.right)
        if atom.operator not in {"=", "!="}:
            kind = _NUMBER
        left, right = self._side(atom.left, kind), self._side(atom.right, kind)
        if not kind:
            self._check(_SAME.format(left, right))
        return f"{left} {operator} {right}"

    def _side(self, term: Term, kind: str) -> str:
        """Return a name for a side of a comparison, which must be of a kind and not NaN."""
        name = self._operand(term, kind)
        if not isinstance(term, syntax.Truth | syntax.Number | syntax.Text):
            self._check(f"{name} != {name}")
        return name

    def _operand(self, term: Term, kind: str) -> str:
        """Return a name for a term, which must be of a kind."""
        if isinstance(term, Feature):
            return self._checked(term, kind)
        if _kind(term) != kind:
            self._check("True")
        match term:
            case syntax.Minus(body):
                return self._named(f"-{self._operand(body, _NUMBER)}")
            case syntax.Arithmetic(left, operator, right):
                one, other = self._operand(left, _NUMBER), self._operand(right, _NUMBER)
                return self._named(f"{one} {operator} {other}")
            case _:
                name = f"constant{len(self.constants)}"
                self.constants[name] = term.value
                return name

    def _named(self, expression: str) -> str:
        """Return a name for the value of an expression."""
        name = self._name_by_expression.get(expression)
        if name is None:
            name = f"value{len(self._name_by_expression)}"
            self._name_by_expression[expression] = name
            self._lines[f"{name} = {expression}"] = None
        return name

    def _checked(self, feature: Feature, kind: str) -> str:
        """Return the name of a feature, which must be of a kind if one is given."""
        term = text_from_formula(feature)
        name = self.name_by_term.setdefault(term, f"feature{len(self.name_by_term)}")
        if kind:
            self._check(kind.format(name))
        return name

    def _check(self, fault: str) -> None:
        self._lines[f"if {fault}: return otherwise(state)"] = None


def _kind(term: Term) -> str:
    """Return the check of the kind that a term always has, or nothing if that is not known."""
    match term:
        case syntax.Truth():
            return _BOOLEAN
        case syntax.Text():
            return _TEXT
        case syntax.Feature():
            return ""
        case _:
            return _NUMBER

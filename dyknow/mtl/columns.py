"""The truth of a formula's atoms, for the states of many objects at once or for one state.

An atom is a boolean feature or a comparison. Features are given by their printed terms, such as
`on_road(from)` or `xydist(from, to)`; `speed[from]` is another way to write `speed(from)`.
Nothing is guessed: a missing feature, a value of the wrong kind, NaN on a side of a comparison,
and a division by zero are `FeatureError`s that name the feature or the term. Infinities compare
as usual. Rows that a caller masks are false and are not looked at.
"""

import operator
from collections.abc import Callable, Mapping, Sequence
from functools import cached_property
from typing import Any, Protocol

import numpy as np
import numpy.typing as npt

from dyknow.errors import FeatureError
from dyknow.mtl import syntax
from dyknow.mtl.printer import text_from_formula
from dyknow.mtl.syntax import Atom, Feature, Term, descendants
from dyknow.mtl.truth import OfState, StateTruth
from dyknow.source_text import did_you_mean, nearest_name

__all__ = ["AtomColumns", "Compiled", "evaluate_atoms"]

_Values = Mapping[str, Any]
_Evaluate = Callable[[_Values], Any]

_COMPARE: dict[str, Callable[[Any, Any], Any]] = {
    "<": operator.lt,
    "<=": operator.le,
    "=": operator.eq,
    "!=": operator.ne,
    ">=": operator.ge,
    ">": operator.gt,
}
_COMPUTE: dict[str, Callable[[Any, Any], Any]] = {
    "+": operator.add,
    "-": operator.sub,
    "*": operator.mul,
    "/": operator.truediv,
}
_KINDS_BY_TYPE = {bool: "boolean", int: "number", float: "number", str: "text"}
_KINDS = {"b": "boolean", "i": "number", "u": "number", "f": "number", "U": "text", "O": "text"}


class Compiled(Protocol):
    """Something that knows how to evaluate the atoms of a formula, such as a table."""

    @property
    def columns(self) -> "AtomColumns":
        """The atoms, compiled."""


def evaluate_atoms(
    table: Compiled,
    features: Mapping[str, npt.NDArray[Any]],
    n: int | None = None,
    mask: npt.NDArray[np.bool_] | None = None,
) -> npt.NDArray[np.bool_]:
    """Return the truth of the atoms of *table*'s formula for n objects or pairs.

    Args:
        table: The formula's `ProgressionTable`.
        features: Printed term to column, shape (n,); more than the formula needs may be given.
        n: The number of objects; may be left out if there is any feature.
        mask: shape (n,), the rows to look at; the atoms of all others are false.

    Returns:
        shape (n_atoms, n), for `ProgressionTable.progress` and `MonitorColumns.step`.

    Raises:
        FeatureError: A feature is missing, of the wrong kind, or NaN.
    """
    if n is None:
        if not features:
            raise ValueError("expected the number of objects, as there are no features")
        n = len(next(iter(features.values())))
    return table.columns.of_features(features, n, mask)


class AtomColumns:
    """The atoms of a formula, compiled once.

    Attributes:
        atoms: The atoms.
        features: The printed terms of the features in them, each once.
    """

    def __init__(self, atoms: Sequence[Atom]) -> None:
        self.atoms = tuple(atoms)
        terms = [node for atom in atoms for node, _ in descendants(atom)]
        found = {text_from_formula(t): None for t in terms if isinstance(t, Feature)}
        self.features = tuple(found)
        self._evaluate = [_compiled_atom(atom) for atom in self.atoms]
        self._bracketed = {term: _bracketed(term) for term in self.features}

    def of_features(
        self,
        features: Mapping[str, npt.NDArray[Any]],
        n: int,
        mask: npt.NDArray[np.bool_] | None = None,
    ) -> npt.NDArray[np.bool_]:
        """Return the truth of each atom for n objects; see `evaluate_atoms`."""
        columns = {term: self._value(term, features) for term in self.features}
        for term, column in columns.items():
            if np.shape(column) != (n,):
                raise FeatureError(term, f"a column of {n} values", f"shape {np.shape(column)}")
        truth = np.zeros((len(self.atoms), n), dtype=np.bool_)
        rows = slice(None) if mask is None else mask
        if mask is not None:
            columns = {term: column[mask] for term, column in columns.items()}
        for at, evaluate in enumerate(self._evaluate):
            truth[at, rows] = evaluate(columns)
        return truth

    @cached_property
    def of_state(self) -> OfState:
        """A function from one state of plain values to the truth of atom number i in bit i.

        It raises what `evaluate_atoms` raises.
        """
        return self._state_truth.of

    @cached_property
    def _state_truth(self) -> StateTruth:
        return StateTruth(self.atoms, self._of_unusual_state)

    def _of_unusual_state(self, state: Mapping[str, Any]) -> int:
        values = {term: self._value(term, state) for term in self.features}
        keys = {term: self._key(term, state) for term in self.features}
        self._state_truth.spell(keys)
        return sum(bool(evaluate(values)) << at for at, evaluate in enumerate(self._evaluate))

    def _value(self, term: str, features: Mapping[str, Any]) -> Any:
        return features[self._key(term, features)]

    def _key(self, term: str, features: Mapping[str, Any]) -> str:
        for key in (term, self._bracketed[term]):
            if key in features:
                return key
        hint = did_you_mean(nearest_name(term, features))
        raise FeatureError(term, "a value in the state", f"none{hint}")


def _bracketed(term: str) -> str:
    """Return a feature in the other notation, `speed[uav1]`."""
    name, opening, arguments = term.partition("(")
    return f"{name}[{arguments[:-1]}]" if opening else term


def _compiled_atom(atom: Atom) -> _Evaluate:
    if isinstance(atom, Feature):
        term = text_from_formula(atom)
        return lambda values: _of_kind("boolean", values[term], term)
    return _compiled_comparison(atom)


def _compiled_comparison(atom: syntax.Comparison) -> _Evaluate:
    compare = _COMPARE[atom.operator]
    left, right = _compiled_term(atom.left), _compiled_term(atom.right)
    left_text, right_text = text_from_formula(atom.left), text_from_formula(atom.right)

    def evaluate(values: _Values) -> Any:
        one, other = left(values), right(values)
        kind = _kind(one, left_text)
        if atom.operator not in {"=", "!="}:
            _of_kind("number", one, left_text)
        _of_kind(kind, other, right_text)
        if kind == "number":
            _forbid_nan(one, left_text)
            _forbid_nan(other, right_text)
        return compare(one, other)

    return evaluate


def _compiled_term(term: Term) -> _Evaluate:
    match term:
        case syntax.Truth(value) | syntax.Number(value) | syntax.Text(value):
            constant: Any = value
            return lambda _: constant
        case syntax.Feature():
            key = text_from_formula(term)
            return lambda values: values[key]
        case syntax.Minus(body):
            inner, text = _compiled_term(body), text_from_formula(body)
            return lambda values: -_of_kind("number", inner(values), text)
        case syntax.Arithmetic():
            return _compiled_arithmetic(term)


def _compiled_arithmetic(term: syntax.Arithmetic) -> _Evaluate:
    compute = _COMPUTE[term.operator]
    left, right = _compiled_term(term.left), _compiled_term(term.right)
    left_text, right_text = text_from_formula(term.left), text_from_formula(term.right)
    text = text_from_formula(term)

    def evaluate(values: _Values) -> Any:
        one = _of_kind("number", left(values), left_text)
        other = _of_kind("number", right(values), right_text)
        if term.operator == "/" and np.any(np.equal(other, 0)):
            raise FeatureError(right_text, "a divisor other than 0", "0")
        try:
            return compute(one, other)
        except OverflowError:
            expected = "a number of a size that can be computed with"
            raise FeatureError(text, expected, "a larger one") from None

    return evaluate


def _kind(value: Any, text: str) -> str:
    """Return whether a value or a column is boolean, a number or a text."""
    kind = _KINDS_BY_TYPE.get(type(value))
    if kind is None and isinstance(value, np.ndarray | np.generic):
        kind = _KINDS.get(value.dtype.kind)
    if kind is None:
        raise FeatureError(text, "a boolean, a number or a text", _described(value))
    return kind


def _of_kind(kind: str, value: Any, text: str) -> Any:
    found = _kind(value, text)
    if found != kind:
        raise FeatureError(text, f"a {kind}", _described(value))
    return value


def _forbid_nan(value: Any, text: str) -> None:
    if np.isnan(value).any() if isinstance(value, np.ndarray) else value != value:  # noqa: PLR0124
        raise FeatureError(text, "a number", "NaN")


def _described(value: Any) -> str:
    if isinstance(value, np.ndarray):
        return f"a column of {value.dtype}"
    return f"{value!r} ({type(value).__name__})"

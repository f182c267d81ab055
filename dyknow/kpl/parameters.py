"""Putting values in the places of names: parameters, and the members of sets.

A name may stand for an object symbol, a time in a policy, or a value of a setting or a condition.
"""

from collections.abc import Mapping
from dataclasses import is_dataclass, replace
from typing import Any, TypeVar

from dyknow.errors import SortMismatchError, SpecificationError, UnknownNameError
from dyknow.kpl.names import parts_of
from dyknow.kpl.syntax import (
    Condition,
    Constraint,
    Label,
    Name,
    Number,
    ParameterDeclaration,
    Setting,
    Specification,
    Text,
    Time,
    Truth,
    Value,
    Values,
)
from dyknow.mtl.syntax import Formula
from dyknow.source_text import Span, nearest_name
from dyknow.time import milliseconds

__all__ = ["bind_label", "bind_members", "bind_parameters", "kind_of"]

Node = TypeVar("Node")


def bind_parameters(
    specification: Specification, values: Mapping[str, Value]
) -> tuple[Specification, list[SpecificationError]]:
    """Return the specification with every use of a parameter replaced by its value.

    *values* take the place of the declared defaults. Uses that are at fault stay as they are.
    """
    parameters = [d for d in specification.declarations if isinstance(d, ParameterDeclaration)]
    binder = _Binder({d.name.text: values.get(d.name.text, d.default) for d in parameters})
    return binder.bound(specification), binder.faults


def bind_members(node: Node, members: Mapping[str, str]) -> Node:
    """Return a piece of a specification with the objects that names of members stand for."""
    bound: Node = _Binder({name: Name(member) for name, member in members.items()}).bound(node)
    return bound


def bind_label(node: Node, member: str, label: Label) -> Node:
    """Return a piece of a specification with *label* for each label that is *member* alone."""
    bound: Node = _Binder({}, {member: label}).bound(node)
    return bound


def kind_of(value: Value) -> str:
    """Return what people call a value of this kind."""
    match value:
        case Number():
            return "number"
        case Time():
            return "time"
        case Text() | Name():
            return "name"
        case Truth():
            return "truth value"
        case Values():
            return "list"


class _Binder:
    """Replaces names, and collects the uses that are at fault."""

    def __init__(
        self, values: Mapping[str, Value], labels: Mapping[str, Label] | None = None
    ) -> None:
        self._values = values
        self._labels = labels or {}
        self.faults: list[SpecificationError] = []

    def bound(self, node: Any) -> Any:
        """Return *node* with the values of names in their places."""
        new: Any = node
        match node:
            case tuple():
                parts = tuple(map(self.bound, node))
                is_same = all(a is b for a, b in zip(parts, node, strict=True))
                new = node if is_same else parts
            case ParameterDeclaration(name):
                new = replace(node, default=self._values.get(name.text, node.default))
            case Label():
                new = self._label(node)
            case Setting() | Condition():
                new = replace(node, value=self._value(node.value))
            case _ if isinstance(node, Constraint):
                new = self._constraint(node)
            case _ if is_dataclass(node) and not isinstance(node, Formula | Span):
                new = self._parts(node, self.bound)
            case _:
                pass
        return new

    def _parts(self, node: Any, bound: Any) -> Any:
        """Return *node* with each of its parts replaced, if there is anything to replace."""
        parts = parts_of(node)
        new = {name: bound(part) for name, part in parts.items()}
        changed = {name: part for name, part in new.items() if part is not parts[name]}
        return replace(node, **changed) if changed else node

    def _label(self, node: Label) -> Label:
        if node.text in self._labels:
            return replace(self._labels[node.text], span=node.span)
        return replace(node, objects=tuple(map(self._object, node.objects)))

    def _object(self, node: Name) -> Name:
        match self._values.get(node.text):
            case None:
                return node
            case Name(text) | Text(text):
                return replace(node, text=text)
            case value:
                self._report_sort(node, "an object", kind_of(value))
                return node

    def _value(self, node: Value) -> Value:
        match node:
            case Name(name) if name in self._values:
                return replace(self._values[name], span=node.span)
            case Values(values):
                return replace(node, values=tuple(self._value(each) for each in values))
            case _:
                return node

    def _constraint(self, node: Constraint) -> Constraint:
        """Return a constraint without names: those it has all stand for times."""
        bound: Constraint = self._parts(
            node, lambda part: self._time(part) if isinstance(part, Name) else part
        )
        return bound

    def _time(self, node: Name) -> Time | Name:
        match self._values.get(node.text):
            case None:
                nearest = nearest_name(node.text, self._values)
                self.faults.append(UnknownNameError("parameter", node.text, node.span, nearest))
                return node
            case Time(time):
                return Time(time, span=node.span)
            case Number(number):
                return Time(milliseconds(number), span=node.span)
            case value:
                self._report_sort(node, "time", kind_of(value))
                return node

    def _report_sort(self, node: Name, expected: str, found: str) -> None:
        what = f"the parameter '{node.text}'"
        self.faults.append(SortMismatchError(what, expected, found, node.span))

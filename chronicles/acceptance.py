"""Which events are as chronicle files declare them, and what is wrong with the others."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from enum import StrEnum

from chronicles.conditions import tester_of, variables_in
from chronicles.declared import Declared
from chronicles.event_types import event_type_of
from chronicles.events import Event
from chronicles.printer import text_of
from chronicles.syntax import (
    VALUE_VARIABLE,
    AttributeDeclaration,
    Chronicle,
    ChronicleFile,
    Condition,
    MessageDeclaration,
)
from dyknow.source_text import did_you_mean, nearest_name

__all__ = ["Acceptance", "Refusal", "RefusalKind"]

_MOST_KEPT = 1024
_Row = Sequence[str | None]


class RefusalKind(StrEnum):
    """Why an event is not as declared."""

    UNKNOWN = "unknown"
    KIND = "wrong kind"
    ARITY = "wrong number of arguments"
    DOMAIN = "outside its domain"


@dataclass(frozen=True, slots=True)
class Refusal:
    """What is wrong with an event.

    Attributes:
        kind: What kind of fault.
        message: What was expected, and what was found.
    """

    kind: RefusalKind
    message: str


@dataclass(frozen=True, slots=True)
class _Restriction:
    """A condition on the arguments of an event and on one of its values, behind them."""

    condition: Condition
    names: frozenset[str]
    allows: Callable[[_Row], bool]

    def holds(self, event: Event) -> bool:
        if VALUE_VARIABLE not in self.names:
            return self.allows((*event.arguments, None))
        values = (event.from_value, event.to_value)
        return all(self.allows((*event.arguments, v)) for v in values if v is not None)


@dataclass(frozen=True, slots=True)
class _Shape:
    """One way in which events of one name can be."""

    is_message: bool
    n_arguments: int
    restrictions: tuple[_Restriction, ...] = ()

    @property
    def asks_values_only(self) -> bool:
        """Whether events with the same values and as many arguments are all like this or not."""
        return all(each.names <= {VALUE_VARIABLE} for each in self.restrictions)

    def refusal(self, event: Event) -> Refusal | None:
        name, n_found = event.attribute, len(event.arguments)
        is_message = event.from_value is None and event.to_value is None
        if is_message != self.is_message:
            kinds = ("a message", "an attribute")
            expected, found = kinds if self.is_message else reversed(kinds)
            message = f"expected {expected} as '{name}', found the event of {found}"
            return Refusal(RefusalKind.KIND, message)
        if n_found != self.n_arguments:
            s = "" if self.n_arguments == 1 else "s"
            message = f"expected {self.n_arguments} argument{s} of '{name}', found {n_found}"
            return Refusal(RefusalKind.ARITY, message)
        for restriction in self.restrictions:
            if not restriction.holds(event):
                message = f"expected {text_of(restriction.condition)} of '{name}', found "
                return Refusal(RefusalKind.DOMAIN, message + _text_of_event(event))
        return None


class Acceptance:
    """Tells whether events are as any of some chronicle files declares them.

    A file that declares neither attributes nor messages knows those that its chronicles use.
    What a chronicle recognises is known as well.
    """

    def __init__(self, files: Iterable[ChronicleFile]) -> None:
        self._shapes: dict[str, list[_Shape]] = {}
        self._refusals: dict[str, Refusal] = {}
        for file in files:
            for name, shape in _shapes_of(file):
                shapes = self._shapes.setdefault(name, [])
                if shape not in shapes:
                    shapes.append(shape)
        self._accepted: dict[tuple[str, str | None, str | None], int] = {}

    def refusal(self, event: Event) -> Refusal | None:
        """Return what is wrong with *event*; None if nothing is."""
        like = (event.attribute, event.from_value, event.to_value)
        if self._accepted.get(like) == len(event.arguments):
            return None
        shapes = self._shapes.get(event.attribute)
        if shapes is None:
            return self._unknown(event.attribute)
        first = None
        for shape in shapes:
            refusal = shape.refusal(event)
            if refusal is None:
                if shape.asks_values_only and len(self._accepted) < _MOST_KEPT:
                    self._accepted[like] = shape.n_arguments
                return None
            first = first or refusal
        return first

    def _unknown(self, name: str) -> Refusal:
        refusal = self._refusals.get(name)
        if refusal is None:
            hint = did_you_mean(nearest_name(name, self._shapes))
            refusal = Refusal(RefusalKind.UNKNOWN, f"no chronicle knows '{name}'{hint}")
            if len(self._refusals) < _MOST_KEPT:
                self._refusals[name] = refusal
        return refusal


def _shapes_of(file: ChronicleFile) -> Iterable[tuple[str, _Shape]]:
    declared = Declared.of(file)
    for signal in file.signals:
        yield signal.name, _declared_shape(signal, declared)
    for chronicle in file.chronicles:
        yield chronicle.name, _Shape(is_message=False, n_arguments=len(chronicle.parameters))
        if not file.signals:
            yield from _used_shapes(chronicle, declared)


def _used_shapes(chronicle: Chronicle, declared: Declared) -> Iterable[tuple[str, _Shape]]:
    for statement in chronicle.plain:
        used = event_type_of(statement)
        if used is not None and used.name not in declared.chronicles:
            yield used.name, _Shape(used.change is None, len(used.arguments))


def _declared_shape(
    signal: AttributeDeclaration | MessageDeclaration, declared: Declared
) -> _Shape:
    names = [*(parameter.name for parameter in signal.parameters), VALUE_VARIABLE]
    restrictions = tuple(
        _Restriction(
            condition,
            frozenset(variable.name for variable in variables_in(condition)),
            tester_of(condition, names, declared.domains),
        )
        for condition in signal.conditions
    )
    return _Shape(isinstance(signal, MessageDeclaration), len(signal.parameters), restrictions)


def _text_of_event(event: Event) -> str:
    arguments = f"[{', '.join(event.arguments)}]" if event.arguments else ""
    if event.from_value is None and event.to_value is None:
        return f"{event.attribute}{arguments}"
    before, after = ("?" if v is None else v for v in (event.from_value, event.to_value))
    return f"{event.attribute}{arguments}:({before}, {after})"

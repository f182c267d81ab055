"""What the attributes of chronicles stand for: streams, found by their names.

The vocabulary is that of formulas over streams (`dyknow.monitoring.interpretation`); what differs
is that an attribute of a chronicle is about any objects, `speed_class[?car]`.
"""

from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from difflib import get_close_matches
from typing import Any

from chronicles.errors import UngroundedAttributeError
from chronicles.models import Model
from chronicles.syntax import EventType
from dyknow.errors import SpecificationErrors
from dyknow.kpl.names import OUTSIDE, Declarations, Placed
from dyknow.kpl.syntax import Label
from dyknow.monitoring.interpretation import check_targets, label_and_field
from dyknow.streams.selecting import FieldPath

__all__ = [
    "RECOGNITIONS",
    "AttributeInterpretation",
    "AttributeOrigin",
    "Naming",
    "attributes_of",
    "origins_of_attributes",
]

RECOGNITIONS = "recognitions"
"""The feature in the labels of streams of what is recognised."""

Naming = Callable[[Any], str | None]
"""What a value of an attribute is called in chronicles; None if it is not known."""

_MOST_NEAREST = 3


@dataclass(frozen=True, slots=True)
class AttributeInterpretation:
    """What attributes of chronicles stand for, where their name does not say.

    An attribute `speed_class[?car]` stands for all stream generators `speed_class[X]`, one for
    each object; `cars.link[?car]` for the column `link` of the tables of `cars`, or for the field
    `link` of the values of all `cars[X]` if these are generators. The name of a chronicle that
    is recognised stands for its recognitions. What *features* says comes before.

    Attributes:
        features: Attribute to label and field, as for formulas: `{"link": "cars.link"}`. A label
            alone whose values are events, or recognitions, gives those of the attribute's name.
        objects: How the arguments of attributes are called in a row of a table, by the label of
            the stream; between percent signs stands a column. Of
            `{"car_pairs": ["car%first%", "car%second%"]}` a row with 3 and 7 in these columns is
            about `car3` and `car7`. Without that a row is about its own object alone.
        values: What values are called in chronicles, by attribute. Without that true is `true`,
            numbers are their digits, texts are themselves, and NaN is not known.

    Raises:
        ValueError: A label is none, or objects are no sequence of names.
    """

    features: Mapping[str, str] = field(default_factory=dict)
    objects: Mapping[str, Sequence[str]] = field(default_factory=dict)
    values: Mapping[str, Naming] = field(default_factory=dict)

    def __post_init__(self) -> None:
        check_targets(self.features)
        for stream, names in self.objects.items():
            if isinstance(names, str) or not all(name.count("%") % 2 == 0 for name in names):
                raise ValueError(
                    f"expected names of objects such as ['car%first%'] for '{stream}', "
                    f"found {names!r}"
                )

    def joined(self, other: "AttributeInterpretation") -> "AttributeInterpretation":
        """Return what is here and in *other*, which counts where something is in both."""
        return AttributeInterpretation(
            {**self.features, **other.features},
            {**self.objects, **other.objects},
            {**self.values, **other.values},
        )


@dataclass(frozen=True, slots=True)
class AttributeOrigin:
    """A stream from which changes of an attribute come.

    Attributes:
        attribute: Its name in chronicles.
        stream: The label of the stream generator.
        path: The way to the field of its values that is meant; empty for the whole value.
        objects: What the values of the stream are about; None if its rows, or events, say that.
        rows: How the objects of a row are called; None for the row's own symbol.
        naming: What values are called; None for the usual.
        is_message: Whether each sample is an event, whatever its value.
    """

    attribute: str
    stream: str
    path: FieldPath = ()
    objects: tuple[str, ...] | None = None
    rows: tuple[str, ...] | None = None
    naming: Naming | None = None
    is_message: bool = False


def attributes_of(model: Model) -> list[EventType]:
    """Return an event type for each attribute or message of a chronicle, by name and arity."""
    patterns = [slot.pattern for slot in model.slots] + [one.pattern for one in model.counters]
    found = [pattern.event_type for pattern in patterns]
    return list({(each.name, len(each.arguments)): each for each in reversed(found)}.values())


def origins_of_attributes(
    model: Model,
    interpretation: AttributeInterpretation,
    declared: Declarations,
    known: Collection[str] = (),
    messages: Collection[str] = (),
) -> tuple[AttributeOrigin, ...]:
    """Return where the changes of the attributes of a chronicle come from.

    Args:
        model: The chronicle.
        interpretation: What attributes stand for.
        declared: Among which streams are looked for.
        known: The names of the chronicles that are recognised.
        messages: The names of messages: of these each sample is an event.

    Raises:
        SpecificationErrors: For some attributes there is no stream; one for each place.
    """
    finder = _Finder(interpretation, declared, known, messages)
    wanted = sorted(attributes_of(model), key=lambda each: each.span.start)
    found = [finder.origins(each) for each in wanted]
    faults = [each for each in found if isinstance(each, UngroundedAttributeError)]
    if faults:
        what = f"{len(faults)} fault(s) in chronicle '{model.name}'"
        raise SpecificationErrors(what, faults)
    return tuple(
        origin
        for each in found
        if not isinstance(each, UngroundedAttributeError)
        for origin in each
    )


class _Finder:
    """Finds streams by the names of attributes."""

    def __init__(
        self,
        interpretation: AttributeInterpretation,
        declared: Declarations,
        known: Collection[str],
        messages: Collection[str],
    ) -> None:
        self._interpretation = interpretation
        self._declared = declared
        self._known = known
        self._messages = messages

    def origins(self, wanted: EventType) -> list[AttributeOrigin] | UngroundedAttributeError:
        """Return the streams of one attribute, or what is wrong with it."""
        name, arity = wanted.name, len(wanted.arguments)
        if name not in self._interpretation.features and name in self._known:
            return [self._origin(name, f"{RECOGNITIONS}[{name}]", ())]
        target = label_and_field(self._interpretation.features.get(name, name), ())
        if target is None:
            expected = "a label for it in the interpretation, since it cannot be one itself"
            return UngroundedAttributeError(name, expected, (), wanted.span)
        label, path = target
        if label.objects:
            return self._of_one(wanted, label, path)
        generators = self._generators(label, arity)
        if generators:
            return [
                self._origin(name, each.label.text, path, _objects(each.label))
                for each in generators
            ]
        return self._of_rows(wanted, label, path)

    def _of_one(
        self, wanted: EventType, label: Label, path: FieldPath
    ) -> list[AttributeOrigin] | UngroundedAttributeError:
        """Return the stream of an attribute that stands for one generator with objects."""
        if len(label.objects) != len(wanted.arguments):
            expected = f"a label with {len(wanted.arguments)} objects, found '{label.text}'"
            return UngroundedAttributeError(wanted.name, expected, (), wanted.span)
        if not self._declared.meaning(label, OUTSIDE).generators:
            return self._missing(wanted, label)
        return [self._origin(wanted.name, label.text, path, _objects(label))]

    def _of_rows(
        self, wanted: EventType, label: Label, path: FieldPath
    ) -> list[AttributeOrigin] | UngroundedAttributeError:
        """Return the stream of an attribute whose rows, or events, say what they are about."""
        if not self._generators(label, 0):
            return self._missing(wanted, label)
        name, is_message = wanted.name, wanted.name in self._messages
        rows = self._interpretation.objects.get(label.text)
        if not path:
            if name in self._interpretation.features:
                return [self._origin(name, label.text, ())]
            expected = f"a column of the tables of '{label.text}', as in '{label.text}.COLUMN'"
            return UngroundedAttributeError(name, expected, (), wanted.span)
        if is_message:
            expected = "a stream of its own, since each sample is one of a message"
            return UngroundedAttributeError(name, expected, (), wanted.span)
        n_objects = 1 if rows is None else len(rows)
        if n_objects != len(wanted.arguments):
            expected = (
                f"how {len(wanted.arguments)} objects are called in the rows of '{label.text}', "
                f"found {n_objects}"
            )
            return UngroundedAttributeError(name, expected, (), wanted.span)
        return [self._origin(name, label.text, path, rows=rows)]

    def _origin(
        self,
        name: str,
        stream: str,
        path: FieldPath,
        objects: tuple[str, ...] | None = None,
        rows: Sequence[str] | None = None,
    ) -> AttributeOrigin:
        naming = self._interpretation.values.get(name)
        named = None if rows is None else tuple(rows)
        is_message = name in self._messages
        return AttributeOrigin(name, stream, path, objects, named, naming, is_message)

    def _generators(self, label: Label, arity: int) -> list[Placed]:
        """Return the generators of a feature with some number of objects that are always there."""
        return [
            each
            for each in self._declared.placed
            if each.label.feature.text == label.feature.text
            and len(each.label.objects) == arity
            and not each.scope.blocks
        ]

    def _missing(self, wanted: EventType, label: Label) -> UngroundedAttributeError:
        arity = len(wanted.arguments)
        called = f"'{label.text}'" if label.objects or not arity else f"'{label.text}[...]'"
        expected = f"a stream generator called {called}"
        if any(each.label.feature.text == label.feature.text for each in self._in_blocks()):
            expected += " that is always there, not only for the members of a set"
        features: Iterable[str] = {each.label.feature.text for each in self._declared.placed}
        nearest = get_close_matches(label.feature.text, list(features), n=_MOST_NEAREST)
        others = [each for each in nearest if each != label.feature.text]
        return UngroundedAttributeError(wanted.name, expected, others, wanted.span)

    def _in_blocks(self) -> list[Placed]:
        return [each for each in self._declared.placed if each.scope.blocks]


def _objects(label: Label) -> tuple[str, ...]:
    return tuple(each.text for each in label.objects)

"""What the symbols of formulas stand for: objects, constants, and the streams of features.

Features are mapped to streams by name (syntactic grounding; Heintz, 'Semantically grounded stream
reasoning integrated with ROS', section V).
"""

import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from difflib import get_close_matches

from dyknow.errors import SpecificationErrors
from dyknow.kpl.names import OUTSIDE, Declarations
from dyknow.kpl.printer import text_from
from dyknow.kpl.syntax import Label, Name
from dyknow.monitoring.errors import UngroundedFeatureError
from dyknow.mtl import syntax
from dyknow.mtl.printer import text_from_formula
from dyknow.mtl.syntax import Feature
from dyknow.streams.selecting import FieldPath
from dyknow.time import TimePoint

__all__ = [
    "Constant",
    "Fluent",
    "Interpretation",
    "Origin",
    "check_targets",
    "label_and_field",
    "origins_of",
]

Constant = bool | float | str

Fluent = Callable[[TimePoint], Constant]
"""What holds at a valid time, as far as the program itself knows it."""

_TARGET = re.compile(r"([A-Za-z_]\w*)(?:\[([^\[\].]*)\])?((?:\.[A-Za-z_]\w*)*)")
_OBJECT = re.compile(r"[A-Za-z_]\w*")
_MOST_NEAREST = 3


@dataclass(frozen=True, slots=True)
class Interpretation:
    """What symbols of formulas stand for, where the symbol itself does not say.

    A feature with its objects, `speed[uav1]` or `speed(uav1)`, stands for the stream generator of
    that label. What *features* says comes before: by the name of a feature or by a feature with
    its objects, the label it stands for, and behind a point the field of its values that is meant:
    `{"speed": "cars.speed"}` makes `speed[car3]` the column `speed` of the row of `car3` in the
    tables of `cars`, or the field `speed` of the values of `cars[car3]` if that is a generator.
    Objects are added to a label that is written without. A formula may as well name the field
    itself, as in `cars.speed[car3]`.

    Attributes:
        features: Feature to label and field.
        constants: What a name without objects stands for, such as a limit.
        domains: The objects that quantifiers range over. A name of one of them, wherever it
            stands alone, is the object.
        known: Features with their objects, as they are printed, that come from no stream because
            the program knows them itself, such as what it is doing.

    Raises:
        ValueError: A label is none, or a domain is no sequence of names.
    """

    features: Mapping[str, str] = field(default_factory=dict)
    constants: Mapping[str, Constant] = field(default_factory=dict)
    domains: Mapping[str, Sequence[str]] = field(default_factory=dict)
    known: Mapping[str, Fluent] = field(default_factory=dict)

    def __post_init__(self) -> None:
        check_targets(self.features)
        for domain, objects in self.domains.items():
            if isinstance(objects, str) or not all(isinstance(each, str) for each in objects):
                raise ValueError(f"expected names of objects for '{domain}', found {objects!r}")

    def joined(self, other: "Interpretation") -> "Interpretation":
        """Return what is here and in *other*, which counts where a symbol is in both."""
        return Interpretation(
            {**self.features, **other.features},
            {**self.constants, **other.constants},
            {**self.domains, **other.domains},
            {**self.known, **other.known},
        )

    def constant(self, name: str) -> Constant | None:
        """Return what a name without objects stands for, if it is not a feature."""
        if name in self.constants:
            return self.constants[name]
        return name if any(name in objects for objects in self.domains.values()) else None

    def needs_stream(self, feature: Feature) -> bool:
        """Return whether a stream has to give the values of a feature."""
        if text_from_formula(feature) in self.known:
            return False
        return bool(feature.arguments) or self.constant(feature.name) is None


@dataclass(frozen=True, slots=True)
class Origin:
    """Where the values of a feature come from.

    Attributes:
        feature: The feature with its objects, as it is printed.
        stream: The label of the stream generator.
        path: The way to the field of its values that is meant; empty for the whole value.
        symbol: The object whose row in a table is meant; None if the values are no tables.
    """

    feature: str
    stream: str
    path: FieldPath = ()
    symbol: str | None = None


def origins_of(
    features: Iterable[Feature], interpretation: Interpretation, declared: Declarations
) -> tuple[Origin, ...]:
    """Return where the values of *features* come from, among what is declared.

    Raises:
        SpecificationErrors: For some of them there is no stream; one for each place.
    """
    found = [_origin(each, interpretation, declared) for each in features]
    faults = {each.span.start: each for each in reversed(found) if not isinstance(each, Origin)}
    if faults:
        ordered = [faults[start] for start in sorted(faults)]
        raise SpecificationErrors(f"{len(ordered)} fault(s) in a formula", ordered)
    return tuple(each for each in found if isinstance(each, Origin))


def _origin(
    feature: Feature, interpretation: Interpretation, declared: Declarations
) -> Origin | UngroundedFeatureError:
    term = text_from_formula(feature)
    target = _target(feature, interpretation)
    if target is None:
        expected = "a label for it in the interpretation, since it cannot be one itself"
        return UngroundedFeatureError(term, expected, (), feature.span)
    label, path = target
    meaning = declared.meaning(label, OUTSIDE)
    if meaning.generators:
        return Origin(term, label.text, path)
    if meaning.table is None:
        expected = f"a stream generator called '{label.text}'"
        if meaning.elsewhere:
            block = meaning.elsewhere[0].scope.blocks[-1]
            member, members = block.member.text, text_from(block.members)
            expected += f" that is always there, not for each '{member}' in '{members}' alone"
        nearest = _nearest(label.text, declared.generators)
        return UngroundedFeatureError(term, expected, nearest, feature.span)
    table = meaning.table.label.text
    if not path:
        expected = f"a column of the table stream '{table}', as in '{table}.COLUMN'"
        return UngroundedFeatureError(term, expected, (), feature.span)
    return Origin(term, table, path, label.objects[0].text)


def _target(feature: Feature, interpretation: Interpretation) -> tuple[Label, FieldPath] | None:
    """Return the label and the field that a feature stands for, if it can stand for any."""
    objects = _objects(feature)
    for key in _ways_to_write(feature):
        if key in interpretation.features:
            return label_and_field(interpretation.features[key], ())
    if objects is None:
        return None
    return label_and_field(interpretation.features.get(feature.name, feature.name), objects)


def check_targets(features: Mapping[str, str]) -> None:
    """Raise an error if what a feature is to stand for is no label and no field.

    Raises:
        ValueError: It is none.
    """
    for feature, target in features.items():
        if _TARGET.fullmatch(target) is None:
            raise ValueError(
                f"expected a label such as 'speed[uav1]', or a field such as 'cars.speed', "
                f"for the feature '{feature}', found '{target}'"
            )


def _ways_to_write(feature: Feature) -> Iterator[str]:
    """Yield a feature with its objects in both notations, if it has any."""
    if feature.arguments:
        term = text_from_formula(feature)
        yield term
        yield f"{feature.name}[{term[len(feature.name) + 1 : -1]}]"


def _objects(feature: Feature) -> tuple[str, ...] | None:
    """Return the names of the objects of a feature, unless one is no name."""
    names = [_name(each) for each in feature.arguments]
    if not all(map(_OBJECT.fullmatch, names)):
        return None
    return tuple(names)


def _name(argument: syntax.Argument) -> str:
    match argument:
        case syntax.Name(name):
            return name
        case syntax.Text(text):
            return text
        case syntax.Number():
            return ""


def label_and_field(target: str, objects: tuple[str, ...]) -> tuple[Label, FieldPath] | None:
    """Return the label and the field that *target* means; it has *objects* if none are written."""
    match = _TARGET.fullmatch(target)
    if match is None:
        return None
    feature, written, path = match.groups()
    if written is not None:
        objects = tuple(each.strip() for each in written.split(","))
    label = Label(Name(feature), tuple(map(Name, objects)))
    return label, tuple(path.split(".")[1:])


def _nearest(name: str, known: Iterable[str]) -> list[str]:
    return get_close_matches(name, list(known), n=_MOST_NEAREST)

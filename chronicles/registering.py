"""Chronicles that a network recognises, and what has to be declared for them."""

from collections.abc import Iterable
from dataclasses import dataclass

from chronicles.attributes import RECOGNITIONS, AttributeOrigin
from chronicles.models import Model
from chronicles.observing import AttributeChanges
from chronicles.processes import ChronicleRecogniser
from dyknow.errors import ServiceError
from dyknow.kpl.build import application, stream, strmgen, term
from dyknow.kpl.build import label as label_of
from dyknow.kpl.syntax import (
    Constraint,
    Declaration,
    MaxDelay,
    MonotoneOrder,
    Setting,
    StreamTerm,
    Text,
    Time,
)
from dyknow.source_text import did_you_mean
from dyknow.time import Duration

__all__ = [
    "FIND_CHANGES",
    "RECOGNISE",
    "ChronicleAlreadyRegisteredError",
    "NoSuchChronicleError",
    "RecognitionSettings",
    "Registration",
    "StreamChanges",
    "constraints_of",
    "declaration_of_changes",
    "declarations_of_recognitions",
]

FIND_CHANGES = "AttributeChanges"
"""The symbol of the unit that finds the changes in a stream."""

RECOGNISE = "RecogniseChronicle"
"""The symbol of the unit that recognises a chronicle."""


class ChronicleAlreadyRegisteredError(ServiceError):
    """A chronicle of this name is recognised already."""

    def __init__(self, name: str) -> None:
        super().__init__(f"chronicle '{name}' is recognised already")


class NoSuchChronicleError(ServiceError):
    """No chronicle of this name is recognised."""

    def __init__(self, name: str, nearest: str | None) -> None:
        hint = did_you_mean(nearest)
        super().__init__(f"no chronicle called '{name}' is recognised{hint}")


@dataclass(frozen=True, slots=True)
class RecognitionSettings:
    """How chronicles are recognised.

    Attributes:
        max_delay: How long after its valid time a sample of any stream may arrive; later ones
            are left out, and published as violations. None to go by what the streams promise.
        limit: How many partial instances of each chronicle are kept; None for any number.
    """

    max_delay: Duration | None = None
    limit: int | None = None


class Registration:
    """A chronicle that a network recognises.

    Attributes:
        name: The name of the chronicle.
        label: The label of the stream generator of its recognitions.
        origins: Where the changes of its attributes come from.
        unit: The process that recognises it.
        max_delay: How long after its valid time a recognition is known at the latest, as far as
            the streams promise it.
    """

    def __init__(
        self, model: Model, origins: Iterable[AttributeOrigin], settings: RecognitionSettings
    ) -> None:
        self.name = model.name
        self.label = f"{RECOGNITIONS}[{model.name}]"
        self.origins = tuple(origins)
        self.unit = ChronicleRecogniser([model], limit=settings.limit)
        self.max_delay: Duration | None = None
        self.settings = settings
        self.changes: list[StreamChanges] = []

    @property
    def streams(self) -> tuple[str, ...]:
        """The labels of the streams that its attributes name."""
        return tuple(dict.fromkeys(origin.stream for origin in self.origins))

    def open_inputs(self) -> None:
        """Tell the process what is known of its inputs, and know the largest delay."""
        delays = [each.max_delay for each in self.changes]
        for at, delay in enumerate(delays):
            self.unit.order.open(at, max_delay=delay, is_ordered=True)
        known = [each for each in delays if each is not None]
        self.max_delay = max(known) if known and len(known) == len(delays) else None

    def origins_in(self, stream: str) -> list[AttributeOrigin]:
        """Return the attributes whose changes come from a stream."""
        return [origin for origin in self.origins if origin.stream == stream]


@dataclass(eq=False)
class StreamChanges:
    """The changes in one stream under one policy, and how many chronicles need them.

    Attributes:
        label: The label of the stream generator of the changes.
        term: The stream itself.
        stream: Its label.
        unit: The process that finds the changes.
        max_delay: The largest delay of its samples, if one is promised.
        n_users: How many chronicles need them.
    """

    label: str
    term: StreamTerm
    stream: str
    unit: AttributeChanges
    max_delay: Duration | None
    n_users: int = 0


def constraints_of(settings: RecognitionSettings) -> tuple[Constraint, ...]:
    """Return the policy under which the streams of attributes are taken."""
    if settings.max_delay is None:
        return (MonotoneOrder(),)
    return (MonotoneOrder(), MaxDelay(Time(settings.max_delay)))


def declaration_of_changes(changes: StreamChanges) -> Declaration:
    """Declare the stream of changes in a stream."""
    unit = application(FIND_CHANGES, [changes.term], [Setting("name", Text(changes.label))])
    return strmgen(label_of(changes.label), unit)


def declarations_of_recognitions(registration: Registration) -> list[Declaration]:
    """Declare the stream of recognitions of a chronicle, and an output without which it is not."""
    inputs = [term(label_of(each.label)) for each in registration.changes]
    settings = [Setting("name", Text(registration.name))]
    recognitions = label_of(RECOGNITIONS, registration.name)
    unit = application(RECOGNISE, inputs, settings)
    return [strmgen(recognitions, unit), stream(recognitions, term(recognitions))]

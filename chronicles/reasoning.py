"""Chronicles over the streams of a network that may be running.

A `ChronicleReasoner` does for chronicles what a `dyknow.monitoring` `StreamReasoner` does for
formulas, and what Heintz (2009) describes in section 8.7.3: it goes through the attributes of a
chronicle that is registered, finds their streams, has changes of their values made into events,
and takes away what has been made when the chronicle is withdrawn.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from itertools import count

from chronicles.attributes import (
    RECOGNITIONS,
    AttributeInterpretation,
    attributes_of,
    origins_of_attributes,
)
from chronicles.models import Model, models_from_chronicles
from chronicles.observing import AttributeChanges
from chronicles.parameters import Given
from chronicles.parser import parse_chronicles, with_values
from chronicles.processes import ChronicleRecogniser
from chronicles.registering import (
    FIND_CHANGES,
    RECOGNISE,
    ChronicleAlreadyRegisteredError,
    NoSuchChronicleError,
    RecognitionSettings,
    Registration,
    StreamChanges,
    constraints_of,
    declaration_of_changes,
    declarations_of_recognitions,
)
from chronicles.syntax import ChronicleFile, MessageDeclaration
from dyknow.errors import PrototypeAlreadyExistsError
from dyknow.kpl.build import compunit, specification
from dyknow.kpl.implementations import Implementations
from dyknow.kpl.members import is_object, label_from
from dyknow.kpl.names import Declarations
from dyknow.kpl.network import Network
from dyknow.kpl.promises import policy_of_input
from dyknow.kpl.syntax import ANY_SORT, Declaration, StreamTerm
from dyknow.runtime.generators import Label, Receive
from dyknow.runtime.subscriptions import StreamProxy
from dyknow.source_text import nearest_name
from dyknow.time import Duration

__all__ = ["ChronicleReasoner", "Chronicles"]

_EVENTS_SORT = "events"

Chronicles = str | ChronicleFile | Sequence[Model]
"""A text of chronicles, what has been read from one, or what has been made of it."""


class ChronicleReasoner:
    """Recognises chronicles over the streams of a network, which may be running.

    Each chronicle is a process of the network; its samples are tuples of recognitions. Chronicles
    over one stream share the changes that are found in it.

    Attributes:
        network: The network.
        interpretation: What attributes stand for in all chronicles.
        settings: How chronicles are recognised, where nothing else is said.
    """

    def __init__(
        self,
        network: Network,
        interpretation: AttributeInterpretation | None = None,
        settings: RecognitionSettings | None = None,
    ) -> None:
        """Recognise chronicles over the streams of *network*; one reasoner for each network.

        Raises:
            PrototypeAlreadyExistsError: The network has the units of a reasoner already.
        """
        for unit in (FIND_CHANGES, RECOGNISE):
            if unit in network.declarations.units:
                raise PrototypeAlreadyExistsError(unit)
        self.network = network
        self.interpretation = interpretation or AttributeInterpretation()
        self.settings = settings or RecognitionSettings()
        self._registered: dict[str, Registration] = {}
        self._changes: list[StreamChanges] = []
        self._units: dict[str, ChronicleRecogniser | AttributeChanges] = {}
        network.provide(Implementations(units={FIND_CHANGES: self._finder, RECOGNISE: self._unit}))

    @property
    def chronicles(self) -> Mapping[str, Registration]:
        """What is recognised, by the names of the chronicles."""
        return dict(self._registered)

    def register(
        self,
        chronicles: Chronicles,
        interpretation: AttributeInterpretation | None = None,
        *,
        settings: RecognitionSettings | None = None,
        values: Mapping[str, Given] | None = None,
    ) -> tuple[str, ...]:
        """Recognise chronicles in what their streams say from now on; return their names.

        The recognitions of each are the samples of the stream generator `recognitions[NAME]`, and
        an output of this name. The values that attributes have now are changes from unknown, at
        the times of the newest samples of their streams. All chronicles are registered, or none.

        Args:
            chronicles: The chronicles; they may speak of each other, and of registered ones.
            interpretation: What attributes stand for, beside what they stand for in all.
            settings: How these are recognised, if not as all others.
            values: Of the parameters of a text or file, in place of those that it declares.

        Raises:
            ChronicleAlreadyRegisteredError: A chronicle of this name is recognised.
            ChronicleSyntaxError: A text does not follow the grammar.
            SpecificationErrors: There is no stream for some attributes, or another fault.
            ValueError: The name of a chronicle cannot stand in a label, or values are given to
                chronicles that have been prepared already.
        """
        models, messages = _models(chronicles, values or {})
        self._check_names([model.name for model in models])
        meaning = self.interpretation.joined(interpretation or AttributeInterpretation())
        known = {*self._registered, *(model.name for model in models)}
        declared = self.network.declarations
        settings = settings or self.settings
        added = [
            Registration(
                model,
                origins_of_attributes(model, meaning, declared, known - {model.name}, messages),
                settings,
            )
            for model in _ordered(models)
        ]
        self._add(added, declared)
        return tuple(model.name for model in models)

    def withdraw(self, name: str) -> Registration:
        """Recognise a chronicle no more, and take away what was made for it alone.

        Raises:
            LabelInUseError: Others use its recognitions, or changes that no chronicle needs any
                more.
            NoSuchChronicleError: No chronicle of this name is recognised.
        """
        registration = self._registration(name)
        alone = [each for each in registration.changes if each.n_users == 1]
        removed = [f"stream {registration.label}", f"strmgen {registration.label}"]
        removed += [f"strmgen {each.label}" for each in alone]
        if len(self._registered) == 1:
            removed += [f"compunit {FIND_CHANGES}", f"compunit {RECOGNISE}"]
        self.network.remove(removed)
        for each in registration.changes:
            each.n_users -= 1
            each.unit.leave(registration.origins_in(each.stream))
        self._changes = [each for each in self._changes if each.n_users]
        return self._registered.pop(name)

    def subscribe(self, name: str, receive: Receive) -> StreamProxy:
        """Hand the recognitions of a chronicle to *receive*, as samples.

        Raises:
            NoSuchChronicleError: No chronicle of this name is recognised.
        """
        return self.network.subscribe(self._registration(name).label, receive)

    def _registration(self, name: str) -> Registration:
        if name not in self._registered:
            raise NoSuchChronicleError(name, nearest_name(name, self._registered))
        return self._registered[name]

    def _check_names(self, names: Sequence[str]) -> None:
        if not names:
            raise ValueError("expected at least one chronicle")
        for at, name in enumerate(names):
            if name in self._registered or name in names[:at]:
                raise ChronicleAlreadyRegisteredError(name)
            if not is_object(name) or name in self.network.declarations.parameters:
                raise ValueError(f"expected a name that can stand in a label, found '{name}'")

    def _add(self, added: Sequence[Registration], declared: Declarations) -> None:
        """Declare what new chronicles need, have it built, and tell it what holds now."""
        declarations: list[Declaration] = []
        if not self._registered:
            declarations.append(compunit(_EVENTS_SORT, FIND_CHANGES, ANY_SORT))
            recognise = compunit(RECOGNITIONS, RECOGNISE, _EVENTS_SORT)
            declarations.append(replace(recognise, takes_more=True))
        new: list[StreamChanges] = []
        delays = {each.name: each.max_delay for each in self._registered.values()}
        for registration in added:
            for label in registration.streams:
                changes = self._found(label, registration.settings, new)
                if changes is None:
                    changes = self._made(label, registration.settings, declared, delays, new)
                    declarations.append(declaration_of_changes(changes))
                registration.changes.append(changes)
            registration.open_inputs()
            delays[registration.name] = registration.max_delay
            declarations += declarations_of_recognitions(registration)
        self._build(added, new, declarations)

    def _build(
        self,
        added: Sequence[Registration],
        new: Sequence[StreamChanges],
        declarations: Sequence[Declaration],
    ) -> None:
        units: dict[str, ChronicleRecogniser | AttributeChanges] = {}
        units.update((each.label, each.unit) for each in added)
        units.update((each.label, each.unit) for each in new)
        self._units = units
        try:
            self.network.add(specification(*declarations))
        finally:
            self._units = {}
        self._changes += new
        for registration in added:
            self._registered[registration.name] = registration
            for each in registration.changes:
                each.n_users += 1
                each.unit.watch(registration.origins_in(each.stream))
        self.network.kernel.change(lambda: self._begin(added, new))

    def _begin(self, added: Iterable[Registration], new: Iterable[StreamChanges]) -> None:
        """Let new processes know the values that there are by now."""
        for each in new:
            last = self.network.kernel.generator(Label(each.stream)).last
            if last is not None:
                each.unit.begin(last)
        for registration in added:
            for at, each in enumerate(registration.changes):
                present = each.unit.present(registration.origins_in(each.stream))
                if present is not None:
                    registration.unit.begin(at, present)

    def _found(
        self, stream_label: str, settings: RecognitionSettings, new: Iterable[StreamChanges]
    ) -> StreamChanges | None:
        """Return the changes in a stream under the policy of some settings, if they are found."""
        wanted = StreamTerm(label_from(stream_label), constraints_of(settings))
        return next((each for each in (*self._changes, *new) if each.term == wanted), None)

    def _made(
        self,
        stream_label: str,
        settings: RecognitionSettings,
        declared: Declarations,
        delays: Mapping[str, Duration | None],
        new: list[StreamChanges],
    ) -> StreamChanges:
        wanted = StreamTerm(label_from(stream_label), constraints_of(settings))
        generator = declared.generators.get(stream_label)
        max_delay = policy_of_input(wanted, [] if generator is None else [generator]).max_delay
        of_chronicle = label_from(stream_label)
        if of_chronicle.feature.text == RECOGNITIONS and of_chronicle.objects:
            max_delay = delays.get(of_chronicle.objects[0].text, max_delay)
        taken = {each.label for each in (*self._changes, *new)} | set(declared.arities)
        labels = (f"changes_{number}" for number in count(1))
        label = next(each for each in labels if each not in taken)
        unit = AttributeChanges(stream_label)
        changes = StreamChanges(label, wanted, stream_label, unit, max_delay)
        new.append(changes)
        return changes

    def _finder(self, name: str) -> AttributeChanges:
        """Return the process that finds changes and is being added under a label."""
        unit = self._units[name]
        assert isinstance(unit, AttributeChanges)
        return unit

    def _unit(self, name: str) -> ChronicleRecogniser:
        """Return the process that recognises a chronicle that is being registered."""
        unit = self._units[f"{RECOGNITIONS}[{name}]"]
        assert isinstance(unit, ChronicleRecogniser)
        return unit


def _models(
    chronicles: Chronicles, values: Mapping[str, Given]
) -> tuple[tuple[Model, ...], frozenset[str]]:
    """Return chronicles ready to be recognised, and the names of the messages they declare."""
    if isinstance(chronicles, str):
        chronicles = parse_chronicles(chronicles, values=values)
    elif isinstance(chronicles, ChronicleFile) and values:
        chronicles = with_values(chronicles, values)
    if not isinstance(chronicles, ChronicleFile):
        if values:
            raise ValueError("expected a text or a file of chronicles to give values to")
        return tuple(chronicles), frozenset()
    messages = [each.name for each in chronicles.signals if isinstance(each, MessageDeclaration)]
    return models_from_chronicles(chronicles), frozenset(messages)


def _ordered(models: Sequence[Model]) -> list[Model]:
    """Return chronicles behind those that they speak of; circles are a fault that others find."""
    left, done = list(models), list[Model]()
    names = {model.name for model in models}
    used = {model.name: {each.name for each in attributes_of(model)} & names for model in models}
    while left:
        known = {model.name for model in done}
        ready = [model for model in left if used[model.name] <= known] or left
        done += ready
        left = [model for model in left if model not in ready]
    return done

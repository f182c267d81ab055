"""Adding processes to a kernel, each thing once, and taking them out again.

A generator that is declared outside of configuration blocks stays until somebody removes it.
What comes and goes with the members of sets, and processes without a label, go when nothing
uses them any more.
"""

from collections.abc import Collection, Iterable, Iterator
from dataclasses import dataclass

from dyknow.kpl.check import raise_faults
from dyknow.kpl.description import NetworkChange
from dyknow.kpl.implementations import Implementations, Maker
from dyknow.kpl.members import Mediator
from dyknow.kpl.names import streams_of
from dyknow.kpl.policies import policy_from_constraints
from dyknow.kpl.printer import text_from
from dyknow.kpl.promises import policy_of_input, promise_of
from dyknow.kpl.states import SelectOfStates, field_names_of_states, synchroniser
from dyknow.kpl.syntax import (
    Constraint,
    GeneratorDeclaration,
    Label,
    Mediation,
    Process,
    Provider,
    Selection,
    SourceInstance,
    StreamTerm,
    Synchronisation,
)
from dyknow.runtime import generators
from dyknow.runtime.failures import OnFailure
from dyknow.runtime.kernel import Kernel
from dyknow.runtime.subscriptions import StreamProxy
from dyknow.streams.policy import Policy
from dyknow.streams.process import ComputationalUnit, Source
from dyknow.streams.viewing import View

__all__ = ["Assembly", "Part", "name_of", "policy_of"]


@dataclass
class Part:
    """A process of the network.

    Attributes:
        label: Of its generator; of a process without a label, its text.
        process: What it is made of; the label itself for a view of a table; None for a label
            that nothing declares.
        constraints: Of the output, or of the states of a synchronisation.
        inputs: The streams that it always has.
        declaration: The declaration of the generator, if it has one.
        is_kept: Whether it stays when nothing uses it.
        n_users: How many others use it: inputs, outputs, blocks and mediations.
        source: What has been made of it, if it is a source.
        unit: What has been made of it, if it is a unit.
    """

    label: generators.Label
    process: Process | Label | None
    constraints: tuple[Constraint, ...]
    inputs: tuple[StreamTerm, ...]
    declaration: GeneratorDeclaration | None = None
    is_kept: bool = False
    n_users: int = 0
    source: Source | None = None
    unit: ComputationalUnit | None = None


class Assembly:
    """The processes of a network, and the declarations that more can be made from.

    Attributes:
        kernel: Runs them.
        implementations: What the symbols stand for in what is built from now on.
        known: The declarations of all generators that there can be now, by label.
        lasting: The labels of those that are declared outside of blocks.
        parts: What has been built, by label, in the order of building.
        journal: What has changed since somebody last looked.
    """

    def __init__(self, kernel: Kernel, implementations: Implementations) -> None:
        self.kernel = kernel
        self.implementations = implementations
        self.known: dict[str, GeneratorDeclaration] = {}
        self.lasting: set[str] = set()
        self.parts: dict[str, Part] = {}
        self.journal = NetworkChange()

    def missing(self, terms: Iterable[StreamTerm]) -> list[str]:
        """Return the labels without which streams cannot be built."""
        return [part.label for part in self._needed(terms) if part.process is None]

    def build(self, terms: Iterable[StreamTerm]) -> list[Part]:
        """Build what streams need and is not there yet, all or nothing, and return it.

        Raises:
            SpecificationErrors: Something cannot be made.
        """
        maker = Maker(self.implementations)
        needed = list(self._needed(terms))
        for part in needed:
            self._make(part, maker)
        raise_faults(sorted(maker.faults, key=lambda fault: fault.span.start))
        for part in needed:
            self._add(part)
        return needed

    def hold(self, term: StreamTerm) -> generators.Label:
        """Count one more user of what provides a stream, and return its label."""
        part = self.parts[name_of(term)]
        part.n_users += 1
        return part.label

    def release(self, name: str) -> list[Part]:
        """Count one user less; take out what nothing uses any more, and return it."""
        self.parts[name].n_users -= 1
        return self.sweep(name)

    def sweep(self, name: str, *, anyway: bool = False) -> list[Part]:
        """Take out a part, and what it alone has used, unless something uses it.

        With *anyway*, it is taken out even if it was to be kept.

        Raises:
            LabelInUseError: Somebody has subscribed to it without the knowledge of the network.
        """
        gone: list[Part] = []
        ahead = [self.parts[name]]
        while ahead:
            part = ahead.pop()
            if part.n_users or (part.is_kept and not (anyway and part.label == name)):
                continue
            self.kernel.remove(part.label)
            del self.parts[part.label]
            self.journal.removed.append(part.label)
            gone.append(part)
            for stream in part.inputs:
                provider = self.parts[name_of(stream)]
                provider.n_users -= 1
                if not provider.n_users:
                    ahead.append(provider)
        return gone

    def users_of(
        self, names: Collection[str], staying: Iterable[StreamTerm], own: Collection[StreamProxy]
    ) -> dict[str, list[str]]:
        """Return by whom some parts are used, if all but them and what they alone use goes on.

        Args:
            names: The labels of the parts.
            staying: Outputs and streams of sets that go on, whoever provides them.
            own: The streams that the network has subscribed to itself.
        """
        ahead = [name for name, part in self.parts.items() if part.is_kept and name not in names]
        ahead.extend(map(name_of, staying))
        found: dict[str, list[str]] = {}
        seen = set(ahead)
        while ahead:
            part = self.parts[ahead.pop()]
            for below in map(name_of, part.inputs):
                if below in names:
                    found.setdefault(below, []).append(part.label)
                if below not in seen:
                    seen.add(below)
                    ahead.append(below)
        for proxy in self.kernel.streams:
            if proxy.provider in names and proxy.number == 0 and proxy not in own:
                found.setdefault(proxy.provider, []).append(proxy.receiver)
        return found

    def redeclare(self, name: str, declaration: GeneratorDeclaration) -> None:
        """Let the inputs of a generator have the policies of another declaration of it."""
        self.known[name] = declaration
        part = self.parts.get(name)
        if part is None:
            return
        inputs = _inputs_of(declaration.process)
        for number, (old, new) in enumerate(zip(part.inputs, inputs, strict=True), start=1):
            if old.constraints != new.constraints:
                self._replace(name, number, policy_of(new))
        part.declaration, part.process, part.inputs = declaration, declaration.process, inputs

    def _replace(self, name: str, number: int, policy: Policy) -> None:
        for proxy in self.kernel.streams:
            if proxy.receiver == name and proxy.number == number:
                proxy.replace_policy(policy)

    def _needed(self, terms: Iterable[StreamTerm]) -> Iterator[Part]:
        """Yield what streams need and is not there, inputs first.

        The way down is kept in a list: recursion would end at some hundred processes in a row.
        """
        seen: set[str] = set()
        path: list[tuple[Part | None, Iterator[StreamTerm]]] = [(None, iter(list(terms)))]
        while path:
            part, ahead = path[-1]
            term = next(ahead, None)
            if term is not None:
                name = name_of(term)
                if name not in self.parts and name not in seen:
                    seen.add(name)
                    below = self._part(name, term)
                    path.append((below, iter(below.inputs)))
                continue
            path.pop()
            if part is not None:
                yield part

    def _part(self, name: str, term: StreamTerm) -> Part:
        label, provider = generators.Label(name), term.provider
        if not isinstance(provider, Label):
            of_states = term.constraints if isinstance(provider, Synchronisation) else ()
            return Part(label, provider, of_states, _inputs_of(provider))
        if name in self.known:
            declaration = self.known[name]
            process, is_kept = declaration.process, name in self.lasting
            inputs = _inputs_of(process)
            return Part(label, process, declaration.constraints, inputs, declaration, is_kept)
        if len(provider.objects) == 1 and provider.feature.text in self.known:
            table = StreamTerm(Label(provider.feature, span=provider.span), span=provider.span)
            return Part(label, provider, (), (table,))
        return Part(label, None, (), ())

    def _make(self, part: Part, maker: Maker) -> None:
        match part.process:
            case SourceInstance(name):
                part.source = maker.source(name)
            case Synchronisation(streams):
                inputs = [policy_of_input(each, self._providers(each)) for each in streams]
                names = [text_from(each) for each in streams]
                part.unit = synchroniser(names, part.constraints, inputs)
            case Mediation():
                part.unit = Mediator()
            case Label(_, objects):
                part.unit = View(objects[0].text)
            case Selection(_, selected):
                select = maker.select(part.process)
                fields = self._fields_of_states(selected)
                part.unit = select if fields is None else SelectOfStates(fields, select)
            case None:
                raise AssertionError(part)  # the caller has asked what is missing
            case process:
                part.unit = maker.unit(process)

    def _fields_of_states(self, selected: Provider) -> tuple[str, ...] | None:
        """Return the names of the fields of the states that are selected from, if they are."""
        if isinstance(selected, Label) and selected.text in self.known:
            process: Process | Provider = self.known[selected.text].process
        else:
            process = selected
        if not isinstance(process, Synchronisation):
            return None
        return field_names_of_states(process.streams)

    def _providers(self, term: StreamTerm) -> list[GeneratorDeclaration]:
        name = name_of(term)
        return [self.known[name]] if name in self.known else []

    def _add(self, part: Part) -> None:
        promise = Policy() if part.declaration is None else promise_of(part.declaration)
        on_failure = OnFailure.STOP if part.declaration is None else part.declaration.on_failure
        if part.source is not None:
            self.kernel.add_source(part.label, part.source, promise, on_failure)
        elif part.unit is not None:
            inputs = [(self.hold(each), policy_of(each)) for each in part.inputs]
            self.kernel.add_unit(part.label, part.unit, inputs, promise, on_failure)
        self.parts[part.label] = part
        self.journal.built.append(part.label)


def name_of(term: StreamTerm) -> str:
    """Return the label of what provides a stream; of a process without a label, its text."""
    if isinstance(term.provider, Label):
        return term.provider.text
    return text_from(term if isinstance(term.provider, Synchronisation) else term.provider)


def policy_of(term: StreamTerm) -> Policy:
    """Return what the receiver of a stream requires; of states made for it alone, nothing."""
    if isinstance(term.provider, Synchronisation):
        return Policy()
    return policy_from_constraints(term.constraints)


def _inputs_of(process: Process) -> tuple[StreamTerm, ...]:
    return (process.members,) if isinstance(process, Mediation) else streams_of(process)

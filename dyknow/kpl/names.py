"""What a specification declares, by name, and what refers to it."""

from collections.abc import Iterable, Iterator
from dataclasses import fields, is_dataclass
from typing import Any

from dyknow.errors import DuplicateNameError
from dyknow.kpl.printer import text_from
from dyknow.kpl.syntax import (
    STATE_SORT,
    Declaration,
    GeneratorDeclaration,
    Label,
    Link,
    ParameterDeclaration,
    Process,
    Sort,
    SourceDeclaration,
    SourceInstance,
    Specification,
    StreamDeclaration,
    StreamTerm,
    Synchronisation,
    UnitDeclaration,
    UnitInstance,
)
from dyknow.source_text import Span

__all__ = ["Declarations", "descendants", "labels_in", "streams_of"]


class Declarations:
    """The declarations of a specification, by name; of two with one name, the first.

    Attributes:
        sources: By symbol.
        units: By symbol.
        generators: By the text of the label.
        streams: By symbol.
        parameters: By symbol.
        arities: The number of objects of each feature.
    """

    def __init__(self, specification: Specification) -> None:
        self.all = specification.declarations
        self.sources: dict[str, SourceDeclaration] = {}
        self.units: dict[str, UnitDeclaration] = {}
        self.generators: dict[str, GeneratorDeclaration] = {}
        self.streams: dict[str, StreamDeclaration] = {}
        self.parameters: dict[str, ParameterDeclaration] = {}
        self.arities: dict[str, int] = {}
        for declaration in self.all:
            self._add(declaration)

    def duplicates(self) -> Iterator[DuplicateNameError]:
        """Yield a fault for each declaration of a name that is taken."""
        first: dict[tuple[str, str], Span] = {}
        for declaration in self.all:
            kind, name, span = _identity(declaration)
            space = "process" if kind in ("source", "computational unit") else kind
            if (space, name) in first:
                yield DuplicateNameError(kind, name, span, first[space, name])
            first.setdefault((space, name), span)

    def sort_of(self, provider: Label | Synchronisation) -> Sort | None:
        """Return the sort of what a generator or a synchronisation gives, if it is known."""
        if isinstance(provider, Synchronisation):
            return self._sort_of_state(provider)
        generator = self.generators.get(text_from(provider))
        return None if generator is None else self._sort_of_process(generator.process)

    def _add(self, declaration: Declaration) -> None:
        match declaration:
            case SourceDeclaration(_, name):
                self.sources.setdefault(name.text, declaration)
            case UnitDeclaration(_, name):
                self.units.setdefault(name.text, declaration)
            case GeneratorDeclaration(label):
                self.generators.setdefault(text_from(label), declaration)
                self.arities.setdefault(label.feature.text, len(label.objects))
            case StreamDeclaration(name):
                self.streams.setdefault(name.text, declaration)
            case ParameterDeclaration(name):
                self.parameters.setdefault(name.text, declaration)

    def _sort_of_process(self, process: Process) -> Sort | None:
        match process:
            case SourceInstance(name):
                source = self.sources.get(name.text)
                return None if source is None else source.sort
            case UnitInstance(name) | Link(_, name):
                unit = self.units.get(name.text)
                return None if unit is None else unit.sort
            case Synchronisation():
                return self._sort_of_state(process)

    def _sort_of_state(self, synchronisation: Synchronisation) -> Sort:
        """Return the sort of states; where a part is not known, it is `any`."""
        sorts = (self.sort_of(stream.provider) for stream in synchronisation.streams)
        return Sort(STATE_SORT, tuple(Sort("any") if sort is None else sort for sort in sorts))


def streams_of(process: Process) -> tuple[StreamTerm, ...]:
    """Return the input streams of a process."""
    match process:
        case SourceInstance():
            return ()
        case UnitInstance(_, streams) | Synchronisation(streams):
            return streams
        case Link(stream):
            return (stream,)


def labels_in(streams: Iterable[StreamTerm]) -> Iterator[Label]:
    """Yield the labels that *streams* are made from, also through synchronisations."""
    for stream in streams:
        if isinstance(stream.provider, Label):
            yield stream.provider
        else:
            yield from labels_in(stream.provider.streams)


def descendants(node: Any) -> Iterator[Any]:
    """Yield a piece of a specification and all it is made of."""
    if isinstance(node, tuple):
        for part in node:
            yield from descendants(part)
    elif is_dataclass(node) and not isinstance(node, Span):
        yield node
        for each in fields(node):
            yield from descendants(getattr(node, each.name))


def _identity(declaration: Declaration) -> tuple[str, str, Span]:
    match declaration:
        case SourceDeclaration(_, name):
            return "source", name.text, name.span
        case UnitDeclaration(_, name):
            return "computational unit", name.text, name.span
        case GeneratorDeclaration(label):
            return "stream generator", text_from(label), label.span
        case StreamDeclaration(name):
            return "stream", name.text, name.span
        case ParameterDeclaration(name):
            return "parameter", name.text, name.span

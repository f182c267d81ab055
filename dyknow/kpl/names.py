"""What a specification declares, by name, and what a label means at a place of the text.

What is declared in a configuration block is known in that block and in the blocks inside it.
From elsewhere it can be merged: whether it exists depends on the members of a stream.
"""

from collections.abc import Collection, Iterable, Iterator
from dataclasses import dataclass, fields, is_dataclass
from functools import cache
from typing import Any

from dyknow.kpl.syntax import (
    Configuration,
    Declaration,
    GeneratorDeclaration,
    Label,
    Link,
    Mediation,
    Merging,
    ParameterDeclaration,
    Process,
    Provider,
    Selection,
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

__all__ = [
    "EVERYWHERE",
    "OUTSIDE",
    "Declarations",
    "Meaning",
    "Placed",
    "Scope",
    "descendants",
    "labels_of",
    "may_be_one",
    "parts_of",
    "streams_of",
]


@dataclass(frozen=True)
class Scope:
    """Where something is written: the blocks around it, and the members it may speak of.

    Attributes:
        blocks: The configuration blocks, from the outermost to the innermost.
        merged: The members of the mediations around it.
    """

    blocks: tuple[Configuration, ...] = ()
    merged: tuple[str, ...] = ()

    @property
    def members(self) -> tuple[str, ...]:
        """The names that stand for members of sets here."""
        return (*(block.member.text for block in self.blocks), *self.merged)

    def inside(self, block: Configuration) -> "Scope":
        """Return the scope of what is declared in *block*."""
        return Scope((*self.blocks, block), self.merged)

    def merging(self, mediation: Mediation) -> "Scope":
        """Return the scope of the stream that a mediation merges for each member."""
        return Scope(self.blocks, (*self.merged, mediation.member.text))

    def is_merged(self, label: Label) -> bool:
        """Return whether *label* is a member of a stream of labels, and so may be any."""
        return not label.objects and label.feature.text in self.merged

    def knows(self, other: "Scope") -> bool:
        """Return whether what is declared in *other* is known here."""
        return self.blocks[: len(other.blocks)] == other.blocks


OUTSIDE = Scope()
"""Outside all blocks."""

EVERYWHERE = Scope(merged=("",))
"""From where the generators of all blocks are known."""


@dataclass(frozen=True)
class Placed:
    """The declaration of a stream generator and where it stands."""

    declaration: GeneratorDeclaration
    scope: Scope

    @property
    def label(self) -> Label:
        """The label of the generator."""
        return self.declaration.label


@dataclass(frozen=True)
class Meaning:
    """What a label can mean at the place where it is used.

    Attributes:
        generators: Which generators it can be; several if members of sets stand in it.
        table: The stream of tables that it is a view of, if it is one.
        elsewhere: Generators that it would be, were they not declared in another block.
    """

    generators: tuple[Placed, ...] = ()
    table: Placed | None = None
    elsewhere: tuple[Placed, ...] = ()

    @property
    def all(self) -> tuple[Placed, ...]:
        """The generators whose samples a stream of the label would have."""
        return self.generators if self.table is None else (self.table,)


class Declarations:
    """The declarations of a specification, by name; of two with one name, the first.

    Attributes:
        all: As they are written, blocks as a whole.
        sources: By symbol.
        units: By symbol.
        parameters: By symbol.
        generators: Those outside of blocks, by the text of the label.
        streams: Those outside of blocks, by name.
        placed: All generators, also those in blocks.
        arities: The number of objects of each feature.
    """

    def __init__(self, specification: Specification, wild: Collection[str] = ()) -> None:
        """Look up *specification*; an object that is called as one of *wild* may be any."""
        self.all = specification.declarations
        self.sources: dict[str, SourceDeclaration] = {}
        self.units: dict[str, UnitDeclaration] = {}
        self.parameters: dict[str, ParameterDeclaration] = {}
        self.generators: dict[str, GeneratorDeclaration] = {}
        self.streams: dict[str, StreamDeclaration] = {}
        self.placed: list[Placed] = []
        self.arities: dict[str, int] = {}
        self._wild = tuple(wild)
        self._outside: dict[str, Placed] = {}
        self._by_feature: dict[str, list[Placed]] = {}
        for declaration, scope in self.scoped():
            self._add(declaration, scope)

    def scoped(self) -> Iterator[tuple[Declaration, Scope]]:
        """Yield every declaration with its scope; a block comes before what it holds."""
        return _scoped(self.all, OUTSIDE)

    def meaning(self, label: Label, scope: Scope) -> Meaning:
        """Return what *label* can mean in *scope*."""
        if scope.is_merged(label):
            return Meaning(tuple(self.placed))
        fitting = self._fitting(label, scope)
        if fitting:
            known = fitting if scope.merged else [e for e in fitting if scope.knows(e.scope)]
            return Meaning(tuple(known), elsewhere=() if known else tuple(fitting))
        if len(label.objects) == 1 and self.arities.get(label.feature.text) == 0:
            return Meaning(table=self._outside.get(label.feature.text))
        return Meaning()

    def _fitting(self, label: Label, scope: Scope) -> list[Placed]:
        is_plain = not any(each.text in (*scope.members, *self._wild) for each in label.objects)
        if is_plain and not self._wild and label.text in self._outside:
            return [self._outside[label.text]]
        alike = self._by_feature.get(label.feature.text, ())
        return [each for each in alike if self._may_mean(label, scope, each)]

    def _may_mean(self, label: Label, scope: Scope, placed: Placed) -> bool:
        """Return whether a label can mean a generator; members of shared blocks are the same."""
        shared = {
            block.member.text
            for block in placed.scope.blocks
            if any(block is around for around in scope.blocks)
        }
        own = [*self._wild, *(name for name in scope.members if name not in shared)]
        other = [*self._wild, *(name for name in placed.scope.members if name not in shared)]
        return may_be_one(label, own, placed.label, other)

    def _add(self, declaration: Declaration, scope: Scope) -> None:
        match declaration:
            case SourceDeclaration(_, name):
                self.sources.setdefault(name.text, declaration)
            case UnitDeclaration(_, name):
                self.units.setdefault(name.text, declaration)
            case ParameterDeclaration(name):
                self.parameters.setdefault(name.text, declaration)
            case GeneratorDeclaration():
                self._add_generator(Placed(declaration, scope))
            case StreamDeclaration(name) if not scope.blocks:
                self.streams.setdefault(name.text, declaration)
            case StreamDeclaration() | Configuration():
                pass

    def _add_generator(self, placed: Placed) -> None:
        label = placed.label
        self.placed.append(placed)
        self.arities.setdefault(label.feature.text, len(label.objects))
        self._by_feature.setdefault(label.feature.text, []).append(placed)
        if not placed.scope.blocks:
            self.generators.setdefault(label.text, placed.declaration)
            self._outside.setdefault(label.text, placed)


def may_be_one(one: Label, its_wild: Collection[str], other: Label, wild: Collection[str]) -> bool:
    """Return whether two labels can be the same when some of their objects may be any."""
    if one.feature.text != other.feature.text or len(one.objects) != len(other.objects):
        return False
    return all(
        a.text == b.text or a.text in its_wild or b.text in wild
        for a, b in zip(one.objects, other.objects, strict=True)
    )


def streams_of(node: Process | Provider) -> tuple[StreamTerm, ...]:
    """Return the streams that a process takes or may take."""
    match node:
        case SourceInstance() | Label():
            return ()
        case UnitInstance(_, streams) | Synchronisation(streams) | Merging(streams):
            return streams
        case Link(stream):
            return (stream,)
        case Mediation(stream, _, members):
            return stream, members
        case Selection(_, provider):
            return (StreamTerm(provider, span=provider.span),)


def labels_of(node: Process | Provider, scope: Scope) -> Iterator[tuple[Label, Scope]]:
    """Yield the labels that a process or a provider is made from, with their scopes."""
    match node:
        case Label():
            yield node, scope
        case Mediation(stream, _, members):
            yield from labels_of(stream.provider, scope.merging(node))
            yield from labels_of(members.provider, scope)
        case _:
            for stream in streams_of(node):
                yield from labels_of(stream.provider, scope)


def descendants(node: Any) -> Iterator[Any]:
    """Yield a piece of a specification and all it is made of."""
    if isinstance(node, tuple):
        for part in node:
            yield from descendants(part)
    elif is_dataclass(node) and not isinstance(node, Span):
        yield node
        for part in parts_of(node).values():
            yield from descendants(part)


def parts_of(node: Any) -> dict[str, Any]:
    """Return what a piece of a specification is made of, by name."""
    names = _names_of_parts(type(node))  # type: ignore[arg-type]  # classes can be hashed
    return {name: getattr(node, name) for name in names}


@cache
def _names_of_parts(kind: Any) -> tuple[str, ...]:
    return tuple(each.name for each in fields(kind))


def _scoped(
    declarations: Iterable[Declaration], scope: Scope
) -> Iterator[tuple[Declaration, Scope]]:
    for declaration in declarations:
        yield declaration, scope
        if isinstance(declaration, Configuration):
            yield from _scoped(declaration.declarations, scope.inside(declaration))

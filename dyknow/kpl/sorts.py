"""Of which sort the samples of a stream are."""

from collections.abc import Iterable

from dyknow.kpl.names import Declarations, Placed, Scope, labels_of
from dyknow.kpl.syntax import (
    ANY_SORT,
    OBJECT_SORT,
    STATE_SORT,
    Label,
    Link,
    Mediation,
    Merging,
    Process,
    Provider,
    Selection,
    Sort,
    SourceInstance,
    StreamTerm,
    Synchronisation,
    UnitInstance,
)

__all__ = ["Sorts", "accepts"]

ANY = Sort(ANY_SORT)


def accepts(expected: Sort, found: Sort) -> bool:
    """Return whether a stream of sort *found* may stand where *expected* is."""
    if ANY_SORT in (expected.name, found.name):
        return True
    if expected.name != found.name:
        return False
    if not expected.parts or not found.parts:
        return True
    return len(expected.parts) == len(found.parts) and all(
        map(accepts, expected.parts, found.parts)
    )


class Sorts:
    """Finds the sorts of streams; one that cannot be known is `any`."""

    def __init__(self, declared: Declarations) -> None:
        self._declared = declared
        self._known: dict[int, Sort] = {}

    def of(self, provider: Process | Provider, scope: Scope) -> Sort:
        """Return the sort of what a process or a provider gives; *scope* is where it stands."""
        match provider:
            case Label():
                return self._of_label(provider, scope)
            case SourceInstance() | UnitInstance() | Link():
                return self._of_prototype(provider)
            case Synchronisation(streams):
                return Sort(STATE_SORT, tuple(self._of_streams(streams, scope)))
            case Merging(streams):
                return _common(self._of_streams(streams, scope))
            case Mediation(stream):
                return self.of(stream.provider, scope.merging(provider))
            case Selection(_, selected):
                return self.of(selected, scope)

    def _of_prototype(self, process: SourceInstance | UnitInstance | Link) -> Sort:
        if isinstance(process, SourceInstance):
            source = self._declared.sources.get(process.source.text)
            return ANY if source is None else source.sort
        unit = self._declared.units.get(process.unit.text)
        return ANY if unit is None else unit.sort

    def _of_streams(self, streams: Iterable[StreamTerm], scope: Scope) -> list[Sort]:
        return [self.of(stream.provider, scope) for stream in streams]

    def _of_label(self, label: Label, scope: Scope) -> Sort:
        if scope.is_merged(label):
            return ANY
        meaning = self._declared.meaning(label, scope)
        if meaning.table is not None:
            return Sort(OBJECT_SORT, (self._of_placed(meaning.table),))
        return _common([self._of_placed(each) for each in meaning.generators])

    def _of_placed(self, placed: Placed) -> Sort:
        """Return the sort of a generator, having found those of all that it is made from.

        Not by recursion, since the way may be long.
        """
        ahead, begun = [placed], set[int]()
        while ahead:
            key = id(ahead[-1].declaration)
            new = [] if key in self._known or key in begun else self._unknown_inputs(ahead[-1])
            begun.add(key)
            if new:
                ahead.extend(new)
                continue
            last = ahead.pop()
            if key not in self._known:
                self._known[key] = ANY  # for a generator that is defined in terms of itself
                self._known[key] = self.of(last.declaration.process, last.scope)
        return self._known[id(placed.declaration)]

    def _unknown_inputs(self, placed: Placed) -> list[Placed]:
        process = placed.declaration.process
        if isinstance(process, SourceInstance | UnitInstance | Link):
            return []
        return [
            each
            for label, scope in labels_of(process, placed.scope)
            if not scope.is_merged(label)
            for each in self._declared.meaning(label, scope).all
            if id(each.declaration) not in self._known
        ]


def _common(sorts: Iterable[Sort]) -> Sort:
    """Return the one sort of all, if they have one."""
    found = [sort for sort in sorts if sort != ANY]
    return found[0] if found and all(sort == found[0] for sort in found) else ANY

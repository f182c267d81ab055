"""What the symbols of a specification stand for, and the processes made of them."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, Protocol, TypeVar

from dyknow.errors import SpecificationError, SpecificationErrors, UnknownNameError
from dyknow.kpl.settings import arguments_from, plain_value
from dyknow.kpl.syntax import (
    Link,
    Merging,
    Name,
    SelectedField,
    Selection,
    UnitInstance,
)
from dyknow.mtl.syntax import Formula
from dyknow.source_text import Span, nearest_name
from dyknow.streams.merging import Merge
from dyknow.streams.process import ComputationalUnit, Source
from dyknow.streams.selecting import Condition, Field, FieldPath, Select

__all__ = ["Implementations", "LinkFactory", "Maker"]

T = TypeVar("T")


class LinkFactory(Protocol):
    """Makes the process that a `link(...)` generator declares."""

    def __call__(
        self,
        unit: str,
        establish: Formula,
        reestablish: Formula,
        maintain: Formula,
        settings: Mapping[str, Any],
    ) -> ComputationalUnit:
        """Return a link process with one input, the objects to be linked.

        *unit* is the symbol of the computational unit that computes the upper objects;
        *settings* has what the declaration sets by name. Times with a unit are nanoseconds
        there, and numbers are as written. A ValueError is reported with the declaration's place.
        """


@dataclass(frozen=True)
class Implementations:
    """What the symbols of a specification stand for (Heintz 2009, definition 4.5.2).

    Attributes:
        sources: Source symbol to a function without arguments that makes the source.
        units: Computational unit symbol to a function that takes the settings as keyword
            arguments and makes the unit. Settings are checked against its signature. A setting
            annotated `Duration` may be written as a bare number of milliseconds. A ValueError
            is reported with the place of the symbol, SpecificationErrors as they are.
        link: Makes link processes, if the specification has any.
    """

    sources: Mapping[str, Callable[[], Source]] = field(default_factory=dict)
    units: Mapping[str, Callable[..., ComputationalUnit]] = field(default_factory=dict)
    link: LinkFactory | None = None

    def joined(self, others: "Implementations") -> "Implementations":
        """Return what is here and in *others*, which count where a symbol is in both."""
        sources, units = {**self.sources, **others.sources}, {**self.units, **others.units}
        return Implementations(sources, units, others.link or self.link)


class Maker:
    """Makes sources and units, and collects what is at fault.

    Attributes:
        faults: What could not be made, and why.
    """

    def __init__(self, implementations: Implementations) -> None:
        self.faults: list[SpecificationError] = []
        self._implementations = implementations

    def source(self, name: Name) -> Source | None:
        """Return a new source, or None if it cannot be made."""
        make = self._find("source", name, self._implementations.sources)
        return None if make is None else self._made(name.span, make)

    def unit(self, process: UnitInstance | Link | Merging) -> ComputationalUnit | None:
        """Return a new unit, or None if it cannot be made."""
        match process:
            case UnitInstance(unit, _, settings):
                make = self._find("computational unit", unit, self._implementations.units)
                if make is None:
                    return None
                arguments = arguments_from(settings, make)
                return self._made(unit.span, lambda: make(**arguments))
            case Link():
                return self._link(process)
            case Merging(streams):
                return Merge(len(streams))

    def select(self, selection: Selection) -> Select:
        """Return the unit of a selection."""
        conditions = [Condition(_path(c.path), plain_value(c.value)) for c in selection.conditions]
        return Select([_field(each) for each in selection.fields], conditions)

    def _link(self, link: Link) -> ComputationalUnit | None:
        make = self._implementations.link
        if make is None:
            message = "nothing is there to make link processes"
            self.faults.append(SpecificationError(message, link.span))
            return None
        settings = {each.name: plain_value(each.value) for each in link.settings}
        conditions = link.establish, link.reestablish, link.maintain
        return self._made(link.unit.span, lambda: make(link.unit.text, *conditions, settings))

    def _find(self, kind: str, name: Name, known: Mapping[str, T]) -> T | None:
        if name.text not in known:
            nearest = nearest_name(name.text, known)
            what = f"implementation of a {kind}"
            self.faults.append(UnknownNameError(what, name.text, name.span, nearest))
        return known.get(name.text)

    def _made(self, span: Span, make: Callable[[], T]) -> T | None:
        try:
            return make()
        except ValueError as fault:
            self.faults.append(SpecificationError(str(fault), span))
        except SpecificationErrors as errors:
            self.faults += (e for e in errors.exceptions if isinstance(e, SpecificationError))
        return None


def _field(selected: SelectedField) -> Field:
    if selected.pattern is None:
        return Field(_path(selected.path))
    parts = selected.pattern.split("%")  # every second part is a field
    name = [part if at % 2 == 0 else _path(part) for at, part in enumerate(parts)]
    return Field(_path(selected.path), tuple(part for part in name if part))


def _path(written: str) -> FieldPath:
    return tuple(written.split("."))

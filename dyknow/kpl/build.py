"""Specifications made in Python, for tests and for what is computed rather than written.

One function for each declaration; the parts are those of `dyknow.kpl.syntax`.
"""

from collections.abc import Sequence

from dyknow.kpl.syntax import (
    Constraint,
    Declaration,
    GeneratorDeclaration,
    Label,
    Name,
    ParameterDeclaration,
    Process,
    Setting,
    Sort,
    SourceDeclaration,
    Specification,
    StreamDeclaration,
    StreamTerm,
    Synchronisation,
    UnitDeclaration,
    UnitInstance,
    Value,
)

__all__ = [
    "application",
    "compunit",
    "label",
    "parameter",
    "source",
    "specification",
    "stream",
    "strmgen",
    "term",
]


def specification(*declarations: Declaration) -> Specification:
    """Return a specification of *declarations*."""
    return Specification(declarations)


def source(sort: str, name: str) -> SourceDeclaration:
    """Return `source SORT NAME`."""
    return SourceDeclaration(Sort(sort), Name(name))


def compunit(sort: str, name: str, *inputs: str) -> UnitDeclaration:
    """Return `compunit SORT NAME(INPUTS)`."""
    return UnitDeclaration(Sort(sort), Name(name), tuple(map(Sort, inputs)))


def strmgen(name: Label, process: Process) -> GeneratorDeclaration:
    """Return `strmgen NAME = PROCESS`."""
    return GeneratorDeclaration(name, process)


def stream(name: str, what: StreamTerm) -> StreamDeclaration:
    """Return `stream NAME = TERM`."""
    return StreamDeclaration(label(name), what)


def parameter(name: str, default: Value) -> ParameterDeclaration:
    """Return `parameter NAME = VALUE`."""
    return ParameterDeclaration(Name(name), default)


def label(feature: str, *objects: str) -> Label:
    """Return `FEATURE[OBJECTS]`."""
    return Label(Name(feature), tuple(map(Name, objects)))


def term(provider: Label | Synchronisation, *constraints: Constraint) -> StreamTerm:
    """Return `PROVIDER with CONSTRAINTS`."""
    return StreamTerm(provider, constraints)


def application(
    unit: str, streams: Sequence[StreamTerm], settings: Sequence[Setting] = ()
) -> UnitInstance:
    """Return `UNIT(STREAMS, SETTINGS)`."""
    return UnitInstance(Name(unit), tuple(streams), tuple(settings))

"""Specifications made in Python, for tests and for what is computed rather than written.

One function for each declaration; the parts are those of `dyknow.kpl.syntax`.
"""

from collections.abc import Sequence

from dyknow.kpl.syntax import (
    Configuration,
    Constraint,
    Declaration,
    GeneratorDeclaration,
    Label,
    Name,
    ParameterDeclaration,
    Process,
    Provider,
    Setting,
    Sort,
    SourceDeclaration,
    Specification,
    StreamDeclaration,
    StreamTerm,
    UnitDeclaration,
    UnitInstance,
    Value,
)
from dyknow.runtime.failures import OnFailure

__all__ = [
    "application",
    "compunit",
    "for_each",
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


def strmgen(
    name: Label,
    process: Process,
    *constraints: Constraint,
    on_failure: OnFailure = OnFailure.STOP,
) -> GeneratorDeclaration:
    """Return `strmgen NAME = PROCESS with CONSTRAINTS on failure ...`."""
    return GeneratorDeclaration(name, process, constraints, on_failure)


def stream(name: str | Label, what: StreamTerm) -> StreamDeclaration:
    """Return `stream NAME = TERM`."""
    return StreamDeclaration(label(name) if isinstance(name, str) else name, what)


def for_each(
    member: str,
    members: StreamTerm,
    *declarations: GeneratorDeclaration | StreamDeclaration | Configuration,
) -> Configuration:
    """Return `for each MEMBER in TERM { DECLARATIONS }`."""
    return Configuration(Name(member), members, declarations)


def parameter(name: str, default: Value) -> ParameterDeclaration:
    """Return `parameter NAME = VALUE`."""
    return ParameterDeclaration(Name(name), default)


def label(feature: str, *objects: str) -> Label:
    """Return `FEATURE[OBJECTS]`."""
    return Label(Name(feature), tuple(map(Name, objects)))


def term(provider: Provider, *constraints: Constraint) -> StreamTerm:
    """Return `PROVIDER with CONSTRAINTS`."""
    return StreamTerm(provider, constraints)


def application(
    unit: str, streams: Sequence[StreamTerm], settings: Sequence[Setting] = ()
) -> UnitInstance:
    """Return `UNIT(STREAMS, SETTINGS)`."""
    return UnitInstance(Name(unit), tuple(streams), tuple(settings))

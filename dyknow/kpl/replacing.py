"""Another policy for a stream of a specification."""

from collections.abc import Sequence
from dataclasses import replace
from typing import TypeVar

from dyknow.errors import NoSuchLabelError, ServiceError
from dyknow.kpl.names import Declarations
from dyknow.kpl.syntax import (
    Configuration,
    Constraint,
    Declaration,
    GeneratorDeclaration,
    Link,
    Mediation,
    Merging,
    Process,
    Specification,
    StreamDeclaration,
    StreamTerm,
    Synchronisation,
    UnitInstance,
)
from dyknow.source_text import did_you_mean, nearest_name

__all__ = ["Target", "replace_constraints"]

Target = str | tuple[str, int]
"""A stream: the name of an output, or the label of a process and the number of its input."""

Constraints = tuple[Constraint, ...]
Written = TypeVar("Written", bound=Declaration)


def replace_constraints(
    specification: Specification, target: Target, constraints: Constraints
) -> Specification:
    """Return a specification in which one stream has another policy.

    The inputs of a mediation are number 1, the stream of sets, and number 2, which stands for all
    streams that it merges. What a configuration block declares is named as it is written there.

    Raises:
        ServiceError: There is no such stream, or it has no policy of its own.
    """
    found = Declarations(specification).scoped()
    outputs = [each.name.text for each, _ in found if isinstance(each, StreamDeclaration)]
    labels = [placed.label.text for placed in Declarations(specification).placed]
    if isinstance(target, str) and target not in outputs:
        hint = did_you_mean(nearest_name(target, outputs))
        raise ServiceError(f"no output stream called '{target}'{hint}")
    if not isinstance(target, str) and target[0] not in labels:
        raise NoSuchLabelError(target[0], nearest_name(target[0], labels))
    declarations = tuple(
        _changed(each, target, constraints) for each in specification.declarations
    )
    return replace(specification, declarations=declarations)


def _changed(declaration: Written, target: Target, constraints: Constraints) -> Written:
    match declaration:
        case StreamDeclaration(name, stream) if name.text == target:
            return replace(declaration, stream=_with(stream, constraints))
        case GeneratorDeclaration(label, process) if (
            not isinstance(target, str) and label.text == target[0]
        ):
            return replace(declaration, process=_process(process, *target, constraints))
        case Configuration(_, _, inner):
            changed = tuple(_changed(each, target, constraints) for each in inner)
            return replace(declaration, declarations=changed)
        case _:
            return declaration


def _process(process: Process, label: str, number: int, constraints: Constraints) -> Process:
    match process:
        case UnitInstance(_, streams) | Merging(streams) | Synchronisation(streams):
            changed = _at(streams, label, number, constraints)
            return replace(process, streams=changed)
        case Link(stream):
            (changed_one,) = _at((stream,), label, number, constraints)
            return replace(process, stream=changed_one)
        case Mediation(stream, _, members):
            members, stream = _at((members, stream), label, number, constraints)
            return replace(process, stream=stream, members=members)
        case _:
            raise ServiceError(f"'{label}' has no input with a policy of its own")


def _at(
    streams: Sequence[StreamTerm], label: str, number: int, constraints: Constraints
) -> tuple[StreamTerm, ...]:
    if not 1 <= number <= len(streams):
        raise ServiceError(f"'{label}' has inputs 1 to {len(streams)}, found {number}")
    changed = list(streams)
    changed[number - 1] = _with(streams[number - 1], constraints)
    return tuple(changed)


def _with(stream: StreamTerm, constraints: Constraints) -> StreamTerm:
    if isinstance(stream.provider, Synchronisation):
        raise ServiceError(
            "a synchronisation without a label has a state policy, which cannot be replaced"
        )
    return replace(stream, constraints=constraints)

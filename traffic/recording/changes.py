"""What is not as it was when a run was recorded, and how that shows."""

import textwrap
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path

from dyknow.errors import ValueNotAvailableError
from dyknow.kpl.printer import text_from
from dyknow.kpl.syntax import (
    Declaration,
    GeneratorDeclaration,
    ParameterDeclaration,
    SourceDeclaration,
    Specification,
    StreamDeclaration,
    UnitDeclaration,
)
from dyknow.recordings.comparing import Difference
from dyknow.recordings.errors import MissingStreamError
from dyknow.recordings.recording import Recording
from dyknow.streams.table import Table
from dyknow.streams.values import are_equal
from traffic.origin import digest_of, system_name, versions
from traffic.recording.describing import RunDescription

__all__ = ["changes_since", "detail_of"]

_LONGEST_VALUE = 120

_MOST_NAMES = 5


def changes_since(
    recorded: RunDescription, specification: Specification, files: Iterable[Path]
) -> Iterator[str]:
    """Yield what may make a replay come out otherwise, a line each.

    Args:
        recorded: What the recording says of its run.
        specification: What is replayed.
        files: What the units of the replay have read.
    """
    if names := list(_changed_declarations(recorded.specification, specification)):
        more = f" and {len(names) - _MOST_NAMES} more" if len(names) > _MOST_NAMES else ""
        yield f"the specification, in {', '.join(names[:_MOST_NAMES])}{more}"
    yield from _changed_files(recorded.origin.files_sha256, files)
    now = versions()
    for name, then in recorded.origin.versions.items():
        if now.get(name) != then:
            yield f"{name}: {then} is now {now.get(name, 'not there')}"
    if recorded.origin.system != system_name():
        yield f"the system: {recorded.origin.system} is now {system_name()}"


def detail_of(difference: Difference, recorded: Recording, computed: Recording) -> str:
    """Return, as the end of a message, how the values differ where two streams do."""
    topic, time = difference.topic, difference.time
    try:
        one, other = recorded.value(topic, time), computed.value(topic, time)
    except (ValueNotAvailableError, MissingStreamError):
        return ""
    if are_equal(one, other):
        return ""
    if not (isinstance(one, Table) and isinstance(other, Table)):
        return f": {_short(one)}, and {_short(other)}"
    columns = [
        name
        for name in {**one.columns, **other.columns}
        if not (name in one and name in other and are_equal(one[name], other[name]))
    ]
    if not are_equal(one.ids, other.ids):
        columns.insert(0, "id")
    return f", in {', '.join(columns)}"


def _short(value: object) -> str:
    return textwrap.shorten(repr(value), _LONGEST_VALUE, placeholder=" …")


def _changed_declarations(old: Specification, new: Specification) -> Iterator[str]:
    """Yield the names of the declarations that only one of the two has."""
    one, other = set(old.declarations), set(new.declarations)
    changed = [each for each in old.declarations if each not in other]
    added = [each for each in new.declarations if each not in one]
    yield from dict.fromkeys(map(_name, [*changed, *added]))


def _name(declaration: Declaration) -> str:
    match declaration:
        case GeneratorDeclaration(label):
            return f"'{text_from(label)}'"
        case (
            SourceDeclaration() | UnitDeclaration() | StreamDeclaration() | ParameterDeclaration()
        ):
            return f"'{declaration.name.text}'"
        case _:
            return f"'{text_from(declaration).splitlines()[0]}'"


def _changed_files(recorded: Mapping[str, str], files: Iterable[Path]) -> Iterator[str]:
    digests = {Path(path).name: digest for path, digest in recorded.items()}
    for path in files:
        if path.name not in digests:
            yield f"the file '{path.name}' is read now and was not"
        elif digest_of(path) != digests[path.name]:
            yield f"the file '{path.name}'"

"""The chronicles that come with the program, and what there is to know about each."""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from chronicles.comments import comment_of, heading_of, remark_on
from chronicles.event_types import event_type_of
from chronicles.expansion import expand
from chronicles.parameters import parameters_behind
from chronicles.parser import read_chronicles
from chronicles.syntax import Chronicle, ChronicleFile, EventType, ParameterDeclaration
from dyknow.source_text import nearest_name
from traffic.bundled import data_folder
from traffic.errors import RequestError

__all__ = [
    "ENDING",
    "Entry",
    "Family",
    "FileParameter",
    "Needed",
    "bundled_families",
    "document_of",
    "find_entries",
    "path_of",
]

ENDING = ".chronicle"


@dataclass(frozen=True, slots=True)
class Needed:
    """A kind of event that a chronicle looks at.

    Attributes:
        name: Of the attribute, the message, or another chronicle.
        kind: `attribute`, `message` or `chronicle`.
        n_arguments: How many arguments it has.
    """

    name: str
    kind: str
    n_arguments: int


@dataclass(frozen=True, slots=True)
class FileParameter:
    """A value in a chronicle file that whoever uses the file may replace.

    Attributes:
        name: Its name.
        value: As it is written.
        meaning: The comment behind it, or before it.
    """

    name: str
    value: str
    meaning: str


@dataclass(frozen=True, slots=True)
class Entry:
    """A chronicle.

    Attributes:
        family: The name of the file that it stands in, without its ending.
        name: What its recognitions are called.
        parameters: What a recognition tells, without marks.
        meaning: The comment before it, or else the comment at the top of its file.
        needs: The events that it looks at, in the order of the text.
        settings: The parameters of its file on which it depends.
        text: How it is written.
    """

    family: str
    name: str
    parameters: tuple[str, ...]
    meaning: str
    needs: tuple[Needed, ...]
    settings: tuple[FileParameter, ...]
    text: str

    @property
    def signature(self) -> str:
        """Name and parameters."""
        return f"{self.name}[{', '.join(self.parameters)}]" if self.parameters else self.name

    @property
    def summary(self) -> str:
        """The first sentence of the meaning."""
        paragraph = " ".join(self.meaning.partition("\n\n")[0].split())
        sentence, stop, _ = paragraph.partition(". ")
        return sentence + stop.strip()


@dataclass(frozen=True, slots=True)
class Family:
    """The chronicles of one file.

    Attributes:
        name: The name of the file, without its ending.
        path: The file.
        meaning: The comment at its top.
        entries: Its chronicles.
    """

    name: str
    path: Path
    meaning: str
    entries: tuple[Entry, ...]


def bundled_families() -> tuple[Family, ...]:
    """Return the families that come with the program, in order of name.

    Raises:
        SpecificationErrors: One does not follow the grammar.
    """
    return tuple(_family(path) for path in _bundled_paths().values())


def find_entries(name: str) -> tuple[Family, tuple[Entry, ...]]:
    """Return the chronicles of a family, or of a file, or the one chronicle of that name.

    Raises:
        OSError: The file cannot be read.
        RequestError: There is none of that name.
        SpecificationErrors: The file does not follow the grammar.
    """
    paths = _bundled_paths()
    if name in paths or _is_path(name):
        family = _family(paths.get(name, Path(name)))
        return family, family.entries
    families = bundled_families()
    for family in families:
        found = tuple(entry for entry in family.entries if entry.name == name)
        if found:
            return family, found
    known = [*paths, *(entry.name for family in families for entry in family.entries)]
    raise _unknown("NAME", "a family, a chronicle or a file", name, nearest_name(name, known))


def path_of(name: str) -> Path:
    """Return the file of the family of that name, or the name itself if it is that of a file.

    Raises:
        RequestError: There is neither.
    """
    paths = _bundled_paths()
    if name in paths:
        return paths[name]
    if _is_path(name):
        return Path(name)
    what = "a file or the name of a family of the library"
    raise _unknown("CHRONICLES", what, name, nearest_name(name, paths))


def document_of(entry: Entry) -> dict[str, Any]:
    """Return an entry as plain data."""
    return {
        "family": entry.family,
        "chronicle": entry.name,
        "parameters": list(entry.parameters),
        "meaning": entry.meaning,
        "needs": [
            {"name": each.name, "kind": each.kind, "arguments": each.n_arguments}
            for each in entry.needs
        ],
        "settings": [
            {"name": each.name, "value": each.value, "meaning": each.meaning}
            for each in entry.settings
        ],
        "text": entry.text,
    }


def _bundled_paths() -> dict[str, Path]:
    folder = data_folder() / "chronicles"
    return {path.stem: path for path in sorted(folder.glob(f"*{ENDING}"))}


def _is_path(name: str) -> bool:
    return name.endswith(ENDING) or Path(name).exists() or len(Path(name).parts) > 1


def _unknown(what: str, expected: str, name: str, nearest: str | None) -> RequestError:
    hint = f" (did you mean '{nearest}'?)" if nearest else ""
    return RequestError(what, expected + hint, name)


def _family(path: Path) -> Family:
    file = read_chronicles(path)
    heading = heading_of(file)
    entries = tuple(_entry(chronicle, file, path.stem, heading) for chronicle in file.chronicles)
    return Family(path.stem, path, heading, entries)


def _entry(chronicle: Chronicle, file: ChronicleFile, family: str, heading: str) -> Entry:
    span = chronicle.span
    return Entry(
        family=family,
        name=chronicle.name,
        parameters=tuple(p.name.removeprefix("?") for p in chronicle.parameters),
        meaning=comment_of(chronicle) or heading,
        needs=tuple(dict.fromkeys(_needs(chronicle, file))),
        settings=tuple(map(_file_parameter, parameters_behind(chronicle, file))),
        text=span.source.text[span.start : span.end],
    )


def _file_parameter(parameter: ParameterDeclaration) -> FileParameter:
    written = parameter.value.span
    value = written.source.text[written.start : written.end]
    return FileParameter(parameter.name, value, remark_on(parameter))


def _needs(chronicle: Chronicle, file: ChronicleFile) -> Iterator[Needed]:
    signals = {signal.name for signal in file.signals}
    others = {other.name for other in file.chronicles} - signals
    for statement in expand(chronicle, file).statements:
        event_type = event_type_of(statement)
        if event_type is not None:
            kind = "chronicle" if event_type.name in others else _kind_of(event_type)
            yield Needed(event_type.name, kind, len(event_type.arguments))


def _kind_of(event_type: EventType) -> str:
    return "message" if event_type.change is None else "attribute"

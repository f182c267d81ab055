"""Which chronicles are asked for."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from chronicles.acceptance import Acceptance
from chronicles.boundedness import UnlimitedEvent, warnings
from chronicles.models import Model, models_from_chronicles
from chronicles.parameters import Given, amount_from
from chronicles.parser import read_chronicles, with_values
from chronicles.recognition import Recogniser
from chronicles.syntax import Amount, ChronicleFile
from dyknow.errors import SpecificationError, SpecificationErrors
from dyknow.source_text import SourceText, Span, nearest_name
from traffic.errors import RequestError
from traffic.recognising.library import path_of
from traffic.settings import change_from_text

__all__ = ["Question", "read_question", "value_from_text"]

_OPTION = "--set"


@dataclass(frozen=True, slots=True)
class Question:
    """Chronicles that are to be recognised.

    Attributes:
        models: The chronicles.
        acceptance: Which events are as their files declare them.
        warnings: The events that an instance may await without end.
    """

    models: tuple[Model, ...]
    acceptance: Acceptance
    warnings: tuple[UnlimitedEvent, ...]


def read_question(names: Sequence[str], values: Mapping[str, Given] | None = None) -> Question:
    """Read chronicle files.

    Args:
        names: Paths of files, or names of families that come with the program.
        values: Of the parameters of the files; `longest` is that of all files which have one, and
            `overtakes.longest` that of the file of this name, without its ending.

    Raises:
        OSError: A file cannot be read.
        RequestError: There is no such family, no chronicle at all, or two of one name; or no
            file has a parameter that is given a value.
        SpecificationErrors: A file has faults, or a value is none that a parameter can have.
    """
    files = _with_values([path_of(name) for name in names], values or {})
    models = tuple(model for file in files for model in models_from_chronicles(file))
    if not models:
        raise RequestError("CHRONICLES", "at least one chronicle", ", ".join(names))
    try:
        Recogniser(models)
    except ValueError as error:
        raise RequestError("CHRONICLES", "chronicles that fit together", error) from error
    found = tuple(warning for file in files for warning in warnings(file))
    return Question(models, Acceptance(files), found)


def value_from_text(text: str) -> tuple[str, Amount]:
    """Return the name and the value of a parameter that a user wrote as NAME=VALUE.

    Raises:
        RequestError: It is not written like that.
        SpecificationErrors: The value is neither a length of time nor a number.
    """
    name, _ = change_from_text(text)
    value = text.partition("=")[2].strip()
    try:
        return name, amount_from(value, Span(SourceText(_OPTION, text), 0, len(text)))
    except SpecificationError as error:
        raise SpecificationErrors("1 fault(s)", [error]) from error


def _with_values(paths: Sequence[Path], values: Mapping[str, Given]) -> list[ChronicleFile]:
    """Return files that have been read, with values for their parameters."""
    files = [read_chronicles(path) for path in paths]
    unknown = dict(values)
    for at, (path, file) in enumerate(zip(paths, files, strict=True)):
        own = {each.name: f"{path.stem}.{each.name}" for each in file.parameters}
        used = {n: n for n in own if n in values} | {n: m for n, m in own.items() if m in values}
        if used:
            files[at] = with_values(file, {name: values[key] for name, key in used.items()})
        for name, alone in own.items():
            unknown.pop(name, None)
            unknown.pop(alone, None)
    if unknown:
        name = next(iter(unknown))
        known = [each.name for file in files for each in file.parameters]
        nearest = nearest_name(name.rpartition(".")[2], known)
        hint = f" (did you mean '{nearest}'?)" if nearest else ""
        there = f"one of the parameters {', '.join(dict.fromkeys(known))}" if known else "none"
        raise RequestError(_OPTION, f"{there}{hint}", name)
    return files

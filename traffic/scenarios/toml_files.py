"""TOML files that people write: read, and complained about with the place of each fault."""

import re
import tomllib
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import Any

from pydantic import ValidationError
from pydantic_core import ErrorDetails

from dyknow.source_text import SourceText, did_you_mean, nearest_name
from traffic.errors import TrafficError
from traffic.scenarios.places import KeyPath, places_of_keys, span_of

__all__ = ["details_of", "faults_of", "message_of", "read_toml"]

_EXPECTED = {
    "dict_type": "a table",
    "model_type": "a table",
    "path_type": "a text",
    "string_pattern_mismatch": "a name of letters, digits and '_'",
    "string_type": "a text",
    "tuple_type": "an array",
}

Error = Callable[[str], TrafficError]


def read_toml(path: Path, error: Error) -> tuple[SourceText, dict[str, Any]]:
    """Return the text of a file and the values in it.

    Raises:
        TrafficError: As *error* makes it: the file cannot be read, or is not TOML.
    """
    try:
        source = SourceText(str(path), path.read_text(encoding="utf-8"))
    except OSError as fault:
        raise error(f"cannot read '{path}': {fault.strerror}") from fault
    except UnicodeDecodeError as fault:
        raise error(f"'{path}' is not a text in UTF-8") from fault
    try:
        return source, tomllib.loads(source.text)
    except tomllib.TOMLDecodeError as fault:
        raise error(_syntax_fault(str(fault), source)) from fault


def faults_of(found: Iterable[tuple[str, KeyPath]], source: SourceText) -> list[str]:
    """Return messages with their places and the lines in question, in reading order."""
    if not (found := list(found)):
        return []
    places = places_of_keys(source)
    spans = [(span_of(path, places, source), message) for message, path in found]
    return [
        f"{span.place}: {message}\n{span.excerpt()}"
        for span, message in sorted(spans, key=lambda pair: pair[0].start)
    ]


def details_of(error: ValidationError) -> list[ErrorDetails]:
    """Return what a model says of a file, without lists that are too short for their faults."""
    details = error.errors()
    return [
        each
        for each in details
        if each["type"] != "too_short"
        or not any(
            other["loc"][: len(each["loc"])] == each["loc"] for other in details if other != each
        )
    ]


def message_of(detail: ErrorDetails, known_keys: Callable[[KeyPath], Sequence[str]]) -> str:
    """Return what to say about a value that a model refuses.

    Args:
        detail: What the model says.
        known_keys: Tells which keys may stand where the last of a path stands.
    """
    name = str(detail["loc"][-1]) if detail["loc"] else ""
    match detail["type"]:
        case "extra_forbidden":
            hint = did_you_mean(nearest_name(name, known_keys(detail["loc"])))
            return f"no key called '{name}' here{hint}"
        case "too_short":
            return f"expected at least one item for '{name}', found none"
        case "missing":
            return f"the key '{name}' is missing"
        case "value_error":
            return detail["msg"].removeprefix("Value error, ")
        case _:
            said = detail["msg"].removeprefix("Input should be ").split(", unable")[0]
            expected = _EXPECTED.get(detail["type"], said)
            return f"expected {expected}, found {detail['input']!r}"


def _syntax_fault(text: str, source: SourceText) -> str:
    at = re.search(r" \(at (?:line (\d+), column (\d+)|end of document)\)$", text)
    end = source.place(len(source.text))
    line, column = (int(at[1]), int(at[2])) if at and at[1] else end
    fault = text[: at.start()] if at else text
    place = f"{source.name}:{line}:{column}"
    excerpt = f"{source.line(line)}\n{' ' * (column - 1)}^"
    return f"{place}: {fault[0].lower()}{fault[1:]}\n{excerpt}"

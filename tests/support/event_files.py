"""Events in memory, read as from a file that comes in pieces."""

import json
from collections.abc import Iterable, Sequence
from functools import cache

from chronicles.acceptance import Acceptance
from chronicles.boundedness import warnings
from chronicles.events import Event, Recognition, json_from_event
from chronicles.models import models_from_chronicles
from chronicles.parser import parse_chronicles
from tests.support.state_files import Pieces
from traffic.recognising.following import Outcome, Settings, recognise
from traffic.recognising.opening import EventReader, read_events
from traffic.recognising.questions import Question
from traffic.recognising.screening import Remark

__all__ = ["asked", "events_in", "lines_from", "reader_of", "recognised"]


@cache
def asked(*texts: str) -> Question:
    """Return the question for chronicles in some texts."""
    files = [parse_chronicles(text) for text in texts]
    models = tuple(model for file in files for model in models_from_chronicles(file))
    found = tuple(warning for file in files for warning in warnings(file))
    return Question(models, Acceptance(files), found)


def reader_of(text: str | bytes, ending: str = "", size: int = 1 << 20) -> EventReader:
    """Return a reader of the events in a text."""
    content = text.encode() if isinstance(text, str) else text
    return read_events(Pieces(content, size), "events", ending)


def events_in(text: str | bytes, ending: str = "", size: int = 1 << 20) -> list[Event]:
    """Return all events in a text."""
    return list(reader_of(text, ending, size))


def lines_from(events: Iterable[Event]) -> str:
    """Return the lines of JSON for some events."""
    return "".join(json.dumps(json_from_event(event)) + "\n" for event in events)


def recognised(
    chronicles: str | Sequence[str], text: str, settings: Settings | None = None
) -> tuple[list[Recognition], list[Remark], Outcome]:
    """Return recognitions and remarks in the order in which they were told, and the outcome."""
    texts = [chronicles] if isinstance(chronicles, str) else chronicles
    found: list[Recognition] = []
    remarks: list[Remark] = []
    outcome = recognise(
        asked(*texts), reader_of(text), settings or Settings(), found.append, remarks.append
    )
    return found, remarks, outcome

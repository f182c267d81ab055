"""Explanations as a page has them: said in words where words are what is shown."""

from collections.abc import Callable, Iterator, Mapping
from functools import partial
from typing import Any

from traffic.errors import ExplanationError
from traffic.explaining.explanation import (
    Change,
    EventExplanation,
    Frame,
    LinkStep,
    ObjectExplanation,
    RecognitionExplanation,
    State,
)
from traffic.explaining.story import story_of
from traffic.explaining.walking import Walker
from traffic.explaining.wording import (
    constraint_text,
    counted_text,
    end_text,
    event_text,
    length_text,
    time_text,
)
from traffic.reporting.bands import band_of
from traffic.reporting.misses import believed_of
from traffic.watching import OnProgress

__all__ = ["conditions_of", "processes_of", "reasons_of"]

_MADE = {"establish": "established", "reestablish": "re-established"}
_PLACES = ("crossing", "link", "lane")
_UNTOLD = frozenset({"x", "y", "length", "width", "temperature"})


def reasons_of(walker: Walker, on_progress: OnProgress) -> dict[str, Any]:
    """Return what explains each recognition and each miss of a run, by the id of its item.

    What cannot be explained says why.
    """
    result = walker.run.result
    total = len(result.recognitions) + len(result.missed)
    found: dict[str, Any] = {}
    for number in range(1, len(result.recognitions) + 1):
        found[f"recognition={number}"] = _or_fault(partial(_recognised, walker, number))
        on_progress(len(found), total)
    for number, missed in enumerate(result.missed, start=1):
        found[f"missed={number}"] = _or_fault(partial(believed_of, walker, missed))
        on_progress(len(found), total)
    return found


def processes_of(walker: Walker) -> dict[str, str]:
    """Return what makes each stream of a run, as the specification writes it."""
    return {label: walker.run.process_of(label) for label in walker.run.roles.generators}


def conditions_of(walker: Walker) -> Mapping[str, Mapping[str, str]]:
    """Return the conditions of each link process, as the specification writes them."""
    return walker.run.conditions


def _or_fault(explain: Callable[[], dict[str, Any]]) -> dict[str, Any]:
    try:
        return explain()
    except ExplanationError as error:
        return {"fault": str(error)}


def _recognised(walker: Walker, number: int) -> dict[str, Any]:
    told = walker.explanation(number).recognition
    story = story_of(walker, told)
    return {
        "span": [story.begin, story.end],
        "marks": [[time, " = ".join(names)] for time, names in story.instants.items()],
        "bands": [band_of(band, story.begin, story.end) for band in story.bands],
        "constants": list(story.constants),
        **_told(told),
    }


def _told(told: RecognitionExplanation) -> dict[str, Any]:
    sample = told.sample
    vehicles = told.truth or {}
    symbol_of = told.values
    return {
        "number": told.number,
        "chronicle": told.chronicle,
        "file": told.file,
        "values": told.values,
        "certain": told.recognised_at,
        "stream": None if sample is None else sample.stream,
        "told": None if sample is None else sample.available_time,
        "events": [_event(each) for each in told.events],
        "constraints": [
            {"text": constraint_text(each), "written": each.text, "holds": each.holds}
            for each in told.constraints
        ],
        "counted": [
            {
                "text": counted_text(each),
                "holds": each.holds,
                "events": [[event.time, event_text(event)] for event in each.events],
            }
            for each in told.counted
        ],
        "objects": [
            _object(
                each, [v for name, v in vehicles.items() if symbol_of.get(name) == each.symbol]
            )
            for each in told.objects
        ],
        "frames": [_frame(each) for each in told.frames],
    }


def _event(told: EventExplanation) -> dict[str, Any]:
    sample = told.sample
    return {
        "at": told.event.time,
        "instants": " = ".join(told.instants),
        "text": event_text(told.event),
        "meets": told.predicates,
        "stream": None if sample is None else sample.stream,
        "told": None if sample is None else sample.available_time,
        "change": [] if told.change is None else list(_change(told.change)),
        "near": [
            f"{time_text(each.time)} {each.before or 'unknown'} → {each.after or 'unknown'}"
            for each in told.near
        ],
        "below": None if told.recognition is None else _told(told.recognition),
    }


def _change(change: Change) -> Iterator[dict[str, Any]]:
    filtered, raw = change.filtered, change.raw
    at = time_text(filtered.available_time)
    if raw is None:
        yield {"text": f"column {filtered.column}, at {at}", "stream": filtered.stream}
        return
    held = length_text(change.held_ms)
    yield {"text": f"let through at {at}, held for {held}", "stream": filtered.stream}
    numbers = [f"{k} {v:.2f}" for k, v in raw.quantities.items() if k not in _UNTOLD]
    measured = f"; {', '.join(numbers)}" if numbers else ""
    text = (
        f"before the filter, at {time_text(raw.valid_time)}: {raw.column} "
        f"{raw.before or 'unknown'} → {raw.after or 'unknown'}{measured}"
    )
    yield {"text": text, "stream": raw.stream}


def _object(told: ObjectExplanation, vehicles: list[str]) -> dict[str, Any]:
    return {
        "symbol": told.symbol,
        "variables": told.variables,
        "vehicle": vehicles[0] if vehicles else None,
        "since": told.first_seen,
        "links": [_link(each) for each in told.links],
        "states": [_state(each) for each in told.states],
        "gaps": [[gap.begin, gap.end] for gap in told.gaps],
    }


def _link(link: LinkStep) -> dict[str, Any]:
    return {
        "stream": link.stream,
        "begin": link.begin,
        "upper": link.upper,
        "lower": link.lower,
        "made": _MADE[link.made_by],
        "by": link.made_by,
        "end": link.end,
        "why": None if link.end is None else end_text(link),
    }


def _state(state: State) -> dict[str, Any]:
    where = [str(state.place[name]) for name in _PLACES if name in state.place]
    return {
        "at": state.time,
        "instants": " = ".join(state.instants),
        "position": [round(each, 2) for each in state.position],
        "speed": None if state.speed is None else round(state.speed, 1),
        "heading": None if state.heading is None else round(state.heading),
        "where": ", ".join(where) or "off the road",
        "rests": state.structure[1:],
        "observed": state.observed,
    }


def _frame(frame: Frame) -> dict[str, Any]:
    return {
        "at": frame.time,
        "instants": " = ".join(frame.instants),
        "percepts": frame.percepts,
        "images": [f"{label} {number}" for label, number in frame.images.items()],
        "seen": [
            {
                "symbol": each.symbol,
                "percept": each.percept,
                "place": [round(p, 1) for p in (each.pixel or each.position)],
                "is_pixel": each.pixel is not None,
                "in_view": each.in_view,
            }
            for each in frame.seen
        ],
    }

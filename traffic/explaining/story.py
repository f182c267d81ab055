"""What a picture of an explanation shows: which time, which moments, which attributes."""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

from dyknow.time import MILLISECOND, SECOND
from traffic.explaining.attributes import Steps
from traffic.explaining.explanation import (
    Counted,
    EventExplanation,
    Frame,
    RecognitionExplanation,
)
from traffic.explaining.walking import Walker

__all__ = ["Band", "Story", "story_of"]

_LEAST_MARGIN = 1_500.0
_SHARE = 0.25
_REACH = 8_000.0
_MOST_FRAMES = 5
_FEWEST_FRAMES = 4
_APART = 300.0
_MOST_BANDS = 12
_MOST_ROWS_COUNTED = 3


@dataclass(frozen=True, slots=True)
class Band:
    """One row of the time line: an attribute of some objects.

    Attributes:
        steps: Its values over time; of a recognised chronicle its recognitions.
        raw: The same before it was filtered; None if there was no filter.
        events: Those that met an `event` predicate.
        counted: The intervals in which its events were counted.
        is_chronicle: Whether it is a chronicle; its values are then beginnings and ends.
    """

    steps: Steps
    raw: Steps | None
    events: tuple[EventExplanation, ...]
    counted: tuple[Counted, ...]
    is_chronicle: bool

    @property
    def name(self) -> str:
        """The attribute with its arguments."""
        listed = ", ".join(self.steps.arguments)
        return f"{self.steps.attribute}[{listed}]" if listed else self.steps.attribute


@dataclass(frozen=True, slots=True)
class Story:
    """What a picture shows.

    Attributes:
        begin: Of the time line, milliseconds.
        end: Of it.
        instants: The instants in it, by time; those at one time together.
        earlier: The instants before it.
        frames: The frames of the strip, in order of time.
        bands: The rows of the time line.
        constants: The attributes that did not change in this time, with their values.
    """

    begin: float
    end: float
    instants: dict[float, list[str]]
    earlier: dict[float, list[str]]
    frames: tuple[Frame, ...]
    bands: tuple[Band, ...]
    constants: tuple[str, ...]


def story_of(walker: Walker, told: RecognitionExplanation) -> Story:
    """Return what a picture of an explained recognition shows."""
    margin = max(_LEAST_MARGIN, _SHARE * (told.end - told.begin))
    reach = told.begin - max(_REACH, told.end - told.begin)
    changed = [each for each in told.events if each.objects or each.event.before is not None]
    times = [each.event.time for each in changed]
    below = [each.recognition for each in told.events if each.recognition is not None]
    near = [time for time in (*times, *(each.begin for each in below)) if time >= reach]
    begin = max(min([told.begin, *near]) - margin, 0.0)
    end = max([told.end, told.recognised_at, *near]) + margin
    instants: dict[float, list[str]] = {}
    earlier: dict[float, list[str]] = {}
    for name, time in sorted(told.instants.items(), key=lambda item: (item[1], item[0])):
        shown = instants if time >= begin and time >= reach else earlier
        shown.setdefault(time, []).append(name)
    bands = list(_bands(walker, told))
    moving = [band for band in bands if _is_telling(band, begin, end)]
    return Story(
        begin=begin,
        end=end,
        instants=instants,
        earlier=earlier,
        frames=tuple(_frames(walker, told, begin)),
        bands=tuple(moving[:_MOST_BANDS]),
        constants=tuple(_constant(band, end) for band in bands if band not in moving),
    )


def _frames(walker: Walker, told: RecognitionExplanation, begin: float) -> list[Frame]:
    """Return frames at the events, no more than fit, with some between if they are few."""
    every = {frame.time: frame for frame in _frames_below(told)}
    frames = [frame for time, frame in sorted(every.items()) if time >= begin and frame.seen]
    while len(frames) > _MOST_FRAMES:
        between = range(1, len(frames) - 1)
        least = min(between, key=lambda at: frames[at + 1].time - frames[at - 1].time)
        del frames[least]
    symbols = [each.symbol for each in told.objects]
    while 1 < len(frames) < _FEWEST_FRAMES:
        gaps = [later.time - earlier.time for earlier, later in pairwise(frames)]
        widest = max(gaps)
        if widest < 2 * _APART:
            break
        at = gaps.index(widest)
        middle = round((frames[at].time + widest / 2) * MILLISECOND)
        frames[at + 1 : at + 1] = walker.frames.frames({middle: []}, symbols)
    return frames


def _frames_below(told: RecognitionExplanation) -> Iterator[Frame]:
    """Yield the frames of the recognitions that made one, and its own."""
    for event in told.events:
        if event.recognition is not None:
            yield from _frames_below(event.recognition)
    yield from told.frames


def _bands(walker: Walker, told: RecognitionExplanation) -> Iterator[Band]:
    """Yield the attributes that the chronicle speaks of, each once."""
    streams = walker.streams_to(told.sample)
    wanted: dict[tuple[str, tuple[str, ...]], None] = {}
    for each in told.events:
        wanted[each.event.attribute, tuple(each.event.arguments)] = None
    for counted in told.counted:
        for key in _keys_counted(counted):
            wanted[key] = None
    for attribute, arguments in wanted:
        events = tuple(
            each
            for each in told.events
            if (each.event.attribute, tuple(each.event.arguments)) == (attribute, arguments)
        )
        counted_here = tuple(c for c in told.counted if (attribute, arguments) in _keys_counted(c))
        yield Band(
            steps=walker.attributes.steps(attribute, arguments, streams),
            raw=walker.attributes.raw_steps(attribute, arguments, streams),
            events=events,
            counted=counted_here,
            is_chronicle=walker.is_chronicle(attribute),
        )


def _keys_counted(counted: Counted) -> list[tuple[str, tuple[str, ...]]]:
    """Return the attributes and arguments that a predicate counts events of."""
    if counted.arguments is not None:
        return [(counted.attribute, tuple(counted.arguments))]
    met = dict.fromkeys((each.attribute, tuple(each.arguments)) for each in counted.events)
    return list(met)[:_MOST_ROWS_COUNTED]


def _is_telling(band: Band, begin: float, end: float) -> bool:
    """Return whether an attribute changed between two times; a fact said at 0 is no change."""
    if band.is_chronicle:
        return bool(band.events)
    times = (time / MILLISECOND for time in band.steps.times if time > 0)
    return any(begin <= time <= end for time in times)


def _constant(band: Band, end: float) -> str:
    value, since = None, None
    for time, each in zip(band.steps.times, band.steps.values, strict=True):
        if time / MILLISECOND <= end:
            value, since = each, time
    if since is None:
        return f"{band.name} never changed"
    return f"{band.name} = {value or 'unknown'} since {since / SECOND:.1f} s"

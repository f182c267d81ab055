"""Attributes over time, as a page draws them below what was recognised or missed."""

from collections.abc import Iterator, Sequence
from typing import Any

from dyknow.time import MILLISECOND
from traffic.explaining.attributes import Steps
from traffic.explaining.kept import records_of
from traffic.explaining.story import Band
from traffic.explaining.symbols import sort_of_symbol
from traffic.explaining.walking import Walker

__all__ = ["band_of", "bands_about"]

_MOST = 14
_BEFORE_MS = 4_000.0


def band_of(band: Band, begin: float, end: float) -> dict[str, Any]:
    """Return a band of an explanation between two times, milliseconds."""
    return {
        "name": band.name,
        "objects": list(band.steps.arguments),
        "spans": [] if band.is_chronicle else list(_spans(band.steps, begin, end)),
        "raw": None if band.raw is None else list(_spans(band.raw, begin, end)),
        "events": [each.event.time for each in band.events],
        "counted": [
            [max(each.begin, begin), min(each.end, end), each.most == 0] for each in band.counted
        ],
        "recognised": _recognised(band) if band.is_chronicle else [],
    }


def bands_about(
    walker: Walker, symbols: Sequence[str], begin: float, end: float
) -> dict[str, Any]:
    """Return every attribute of some objects that changed between two times, milliseconds.

    Those in which other objects take part are left out.
    """
    since, until = max(begin - _BEFORE_MS, 0.0), end + _BEFORE_MS
    wanted, sorts = set(symbols), set(walker.run.description.sorts.values())
    events = walker.run.events
    times = events["time"] / MILLISECOND
    keys: dict[tuple[str, tuple[str, ...]], None] = {}
    for row in records_of(events[(times >= since) & (times <= until)]):
        arguments = tuple(map(str, row["arguments"]))
        objects = {each for each in arguments if sort_of_symbol(each) in sorts}
        if objects and objects <= wanted:
            keys[str(row["attribute"]), arguments] = None
    bands = [
        {
            "name": f"{attribute}[{', '.join(arguments)}]",
            "objects": list(arguments),
            "spans": list(_spans(walker.attributes.steps(attribute, arguments), since, until)),
            "raw": None,
            "events": [],
            "counted": [],
            "recognised": [],
        }
        for attribute, arguments in list(keys)[:_MOST]
    ]
    return {"span": [since, until], "bands": bands}


def _spans(steps: Steps, begin: float, end: float) -> Iterator[tuple[float, float, str | None]]:
    """Yield from when to when each value held, between two times."""
    times = [time / MILLISECOND for time in steps.times]
    for since, until, value in zip(times, [*times[1:], end], steps.values, strict=True):
        first, last = max(since, begin), min(until, end)
        if first < last:
            yield first, last, value


def _recognised(band: Band) -> list[list[float]]:
    """Return from when to when each recognition of a chronicle went on."""
    told = (each.event for each in band.events)
    return [[float(each.before or each.time), float(each.after or each.time)] for each in told]

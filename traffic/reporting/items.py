"""What a page of a run lists: everything that was recognised, and everything that was missed."""

from collections.abc import Iterator, Mapping
from enum import StrEnum
from typing import Any

from traffic.results import Manoeuvre, RecognitionResult, RunResult, Score, car_names

__all__ = ["Verdict", "items_of", "symbols_of"]

_MARGIN_MS = 3_000.0
"""A recognition so long before or after a manoeuvre that was missed may have been meant for it."""


class Verdict(StrEnum):
    """What the truth says of an item."""

    HIT = "hit"
    FALSE = "false"
    MISSED = "missed"
    OUTSIDE = "outside"
    UNJUDGED = "unjudged"


def items_of(result: RunResult) -> list[dict[str, Any]]:
    """Return all recognitions, numbered as `traffic report` lists them, and then all misses."""
    recognised = [
        _recognised(number, each, result.score)
        for number, each in enumerate(result.recognitions, start=1)
    ]
    missed = [_missed(number, each, result) for number, each in enumerate(result.missed, start=1)]
    return [*recognised, *missed]


def symbols_of(result: RunResult, vehicles: list[str]) -> list[str]:
    """Return under which symbols some vehicles were known, as far as recognitions tell."""
    return list(dict.fromkeys(s for v, s in _symbols(result) if v in vehicles))


def _symbols(result: RunResult) -> Iterator[tuple[str, str]]:
    """Yield vehicles of the simulator, and symbols that they had."""
    for each in result.recognitions:
        for name, vehicle in (each.truth or {}).items():
            if name in each.arguments:
                yield vehicle, each.arguments[name]


def _recognised(
    number: int, recognition: RecognitionResult, score: Mapping[str, Score]
) -> dict[str, Any]:
    arguments, truth = recognition.arguments, recognition.truth or {}
    names = car_names(arguments)
    return {
        "id": f"recognition={number}",
        "number": number,
        "kind": recognition.chronicle,
        "verdict": _verdict(recognition, score),
        "begin": recognition.begin,
        "end": recognition.end,
        "at": recognition.recognised_at,
        "cars": [arguments[name] for name in names],
        "vehicles": [truth.get(name) for name in names],
        "where": [value for name, value in arguments.items() if name not in names],
    }


def _verdict(recognition: RecognitionResult, score: Mapping[str, Score]) -> Verdict:
    if recognition.agrees is not None:
        return Verdict.HIT if recognition.agrees else Verdict.FALSE
    return Verdict.OUTSIDE if recognition.kind in score else Verdict.UNJUDGED


def _missed(number: int, manoeuvre: Manoeuvre, result: RunResult) -> dict[str, Any]:
    return {
        "id": f"missed={number}",
        "number": None,
        "kind": manoeuvre.kind,
        "verdict": Verdict.MISSED,
        "begin": manoeuvre.begin,
        "end": manoeuvre.end,
        "at": manoeuvre.end,
        "cars": symbols_of(result, manoeuvre.vehicles),
        "vehicles": manoeuvre.vehicles,
        "where": manoeuvre.place,
        "instead": list(_instead(manoeuvre, result)),
    }


def _instead(manoeuvre: Manoeuvre, result: RunResult) -> Iterator[int]:
    """Yield the numbers of recognitions of the same vehicles at about the same time."""
    begin, end = manoeuvre.begin - _MARGIN_MS, manoeuvre.end + _MARGIN_MS
    for number, each in enumerate(result.recognitions, start=1):
        is_near = each.begin <= end and each.end >= begin
        if is_near and set((each.truth or {}).values()) & set(manoeuvre.vehicles):
            yield number

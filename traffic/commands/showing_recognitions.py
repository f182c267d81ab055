"""Recognitions as they become certain, remarks about events, and what is left at the end."""

import sys
import time
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import Any

from pydantic_core import to_json

from chronicles.events import Recognition, json_from_recognition
from chronicles.prospects import Awaited, PartialInstance
from traffic.reading.times import text_from_time
from traffic.recognising.documents import document_of_end, document_of_instance
from traffic.recognising.following import Outcome, Settings, recognise
from traffic.recognising.opening import EventReader
from traffic.recognising.questions import Question
from traffic.recognising.screening import Remark, RemarkKind

__all__ = ["recognitions_shown"]

_MOST_OF_A_KIND = 10


def recognitions_shown(
    question: Question,
    events: EventReader,
    settings: Settings,
    *,
    partial: bool,
    live: bool,
    json: bool,
) -> None:
    """Recognise chronicles and print what is found, each recognition as soon as it is certain.

    With *live*, for events that are still to happen, standard output never waits to be full.
    """
    for warning in question.warnings:
        sys.stderr.write(f"{warning.span.place}: warning: {warning.message}\n")
    began = time.perf_counter()
    show = _show_in_json if json else _show_in_text
    remarks = _Remarks()
    outcome = show(question, events, settings, remarks.tell, partial=partial, live=live)
    elapsed = time.perf_counter() - began
    for line in (*remarks.rest(), *_counted(outcome, elapsed)):
        sys.stderr.write(line + "\n")


class _Remarks:
    """Tells the first few remarks of each kind, and at the end how many more there were."""

    def __init__(self) -> None:
        self._n_told: Counter[RemarkKind] = Counter()
        self._n_more: Counter[RemarkKind] = Counter()

    def tell(self, remark: Remark) -> None:
        kind = remark.kind
        if self._n_told[kind] == _MOST_OF_A_KIND:
            self._n_more[kind] += 1
            return
        self._n_told[kind] += 1
        what = "left out: " if remark.is_left_out else ""
        sys.stderr.write(f"{remark.place}: warning: {what}{remark.message}\n")

    def rest(self) -> Iterator[str]:
        for kind, n in self._n_more.items():
            yield f"and {n} more warnings: {kind.value}"


def _show_in_text(
    question: Question,
    events: EventReader,
    settings: Settings,
    on_remark: Callable[[Remark], None],
    *,
    partial: bool,
    live: bool,
) -> Outcome:
    def show(recognition: Recognition) -> None:
        sys.stdout.write(_recognition(recognition) + "\n")
        if live:
            sys.stdout.flush()

    outcome = recognise(question, events, settings, show, on_remark)
    for line in _instances("pending", outcome.pending):
        sys.stdout.write(line + "\n")
    if partial:
        for line in _instances("possible", outcome.partial):
            sys.stdout.write(line + "\n")
    return outcome


def _show_in_json(
    question: Question,
    events: EventReader,
    settings: Settings,
    on_remark: Callable[[Remark], None],
    *,
    partial: bool,
    live: bool,
) -> Outcome:
    """Print one document that grows by a line for each recognition."""
    separator = '{"recognitions":['

    def show(recognition: Recognition) -> None:
        nonlocal separator
        sys.stdout.write(f"{separator}\n{_json(json_from_recognition(recognition))}")
        if live:
            sys.stdout.flush()
        separator = ","

    outcome = recognise(question, events, settings, show, on_remark)
    sys.stdout.write(separator if separator != "," else "\n")
    sys.stdout.write("]")
    instances = {"pending": outcome.pending, **({"partial": outcome.partial} if partial else {})}
    for name, found in instances.items():
        sys.stdout.write(f',\n"{name}":[')
        for i, instance in enumerate(found):
            sys.stdout.write(f"{',' if i else ''}\n{_json(document_of_instance(instance))}")
        sys.stdout.write("\n]" if found else "]")
    for name, value in document_of_end(outcome).items():
        sys.stdout.write(f',\n"{name}":{_json(value)}')
    sys.stdout.write("}\n")
    return outcome


def _json(document: Any) -> str:
    return to_json(document).decode()


def _recognition(recognition: Recognition) -> str:
    arguments = _bracketed(recognition.arguments)
    recognised_at = text_from_time(recognition.recognised_at)
    return (
        f"{recognised_at} ms: {recognition.chronicle}{arguments}"
        f" from {text_from_time(recognition.begin)} to {text_from_time(recognition.end)} ms"
    )


def _instances(what: str, instances: Iterable[PartialInstance]) -> Iterator[str]:
    for instance in instances:
        seen = ", ".join(f"{n} = {text_from_time(t)}" for n, t in instance.instants.items())
        yield f"{what}: {instance.chronicle}{_bracketed(instance.values)}, {seen}"
        for awaited in instance.awaited:
            yield f"  awaits {awaited.predicate} {_stretch(awaited)}"


def _stretch(awaited: Awaited) -> str:
    earliest = text_from_time(awaited.earliest)
    if awaited.latest is None:
        return f"from {earliest} ms on"
    return f"from {earliest} to {text_from_time(awaited.latest)} ms"


def _bracketed(values: Mapping[str, str]) -> str:
    listed = ", ".join(f"{name} = {value}" for name, value in values.items())
    return f"[{listed}]" if listed else ""


def _counted(outcome: Outcome, elapsed: float) -> Iterator[str]:
    """Yield what is told on standard error at the end."""
    for name, n in outcome.given_up.items():
        yield f"chronicle '{name}': {_number(n, 'partial instance')} given up because of the limit"
    listed = [f"{n} {kind.value}" for kind, n in outcome.remarks.items()]
    if listed:
        n_remarks = sum(outcome.remarks.values())
        yield f"{_number(n_remarks, 'remark')} about events: {', '.join(listed)}"
    n_events, n_found = outcome.n_events, outcome.n_recognitions
    rate = f", {n_events / elapsed:.0f} a second" if n_events and elapsed > 0 else ""
    yield (
        f"{_number(n_found, 'recognition')} in {_number(n_events, 'event')}, {elapsed:.3g} s{rate}"
    )
    waiting: Sequence[PartialInstance] = outcome.pending
    if waiting:
        yield f"{_number(len(waiting), 'instance')} pending; --close decides them"


def _number(n: int, what: str) -> str:
    return f"{n} {what}{'' if n == 1 else 's'}"

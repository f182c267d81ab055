"""Verdicts on formulas, what is left of them state by state, and reasons, as text and as JSON."""

import json
import shutil
import sys
import tempfile
import time
from collections.abc import Iterator
from typing import IO, Any

from pydantic_core import to_json

from dyknow.mtl.syntax import TimeModel
from traffic.monitoring.following import (
    Answer,
    Step,
    document_from,
    follow,
    milliseconds_of,
)
from traffic.monitoring.questions import Question
from traffic.monitoring.reasons import Reason
from traffic.monitoring.states import StateReader
from traffic.reading.times import described, text_from_time

__all__ = ["answer_shown"]

_KEPT_IN_MEMORY = 1 << 20


def answer_shown(
    question: Question,
    states: StateReader,
    time_model: TimeModel,
    *,
    explain: bool,
    json: bool,
) -> None:
    """Follow the formula and print the answer; with *explain* also what each state does."""
    began = time.perf_counter()
    if json and explain:
        answer = _explained_in_json(question, states, time_model)
    elif json:
        answer = follow(question, states, time_model)
        sys.stdout.write(to_json(document_from(answer)).decode() + "\n")
    else:
        answer = follow(question, states, time_model, _show_step if explain else None)
        for line in _answered(answer, is_explained=explain):
            sys.stdout.write(line + "\n")
    elapsed = time.perf_counter() - began
    rate = answer.n_states / elapsed
    counted = f"{answer.n_states} state{'s' if answer.n_states > 1 else ''}"
    sys.stderr.write(f"{counted} in {elapsed:.3g} s, {rate:.0f} a second\n")


def _show_step(step: Step) -> None:
    sys.stdout.write(f"{_time(step.time)}: {_literals(step)}: {step.residual}\n")
    sys.stdout.flush()


def _literals(step: Step) -> str:
    literals = [atom if value else _negated(atom) for atom, value in step.changes.items()]
    return ", ".join(literals) or "as before"


def _negated(atom: str) -> str:
    return f"not {atom}" if " " not in atom else f"not ({atom})"


def _time(time: int) -> str:
    return f"{text_from_time(time)} ms"


def _answered(answer: Answer, *, is_explained: bool) -> Iterator[str]:
    if answer.decided_at is None:
        yield f"undecided after the last state, at {_time(answer.last)}"
        if not is_explained:
            yield f"what is left: {answer.residual}"
        return
    yield f"{answer.verdict.name.lower()}, decided at {_time(answer.decided_at)}"
    if not is_explained:
        return
    if answer.reasons is None:
        yield "why: not to be said by a few observations, or they are too long ago"
        return
    yield "why, whatever else was the case:"
    for reason in answer.reasons:
        yield f"  {_stretch(reason)}: {_observed(reason)}"
    if not answer.reasons:
        yield "  nothing but that there was a state"


def _stretch(reason: Reason) -> str:
    if reason.n_states == 1:
        return f"at {_time(reason.begin)}"
    return f"from {_time(reason.begin)} to {_time(reason.end)} ({reason.n_states} states)"


def _observed(reason: Reason) -> str:
    literal = reason.atom if reason.value else _negated(reason.atom)
    values = ", ".join(f"{term} = {described(value)}" for term, value in reason.values.items())
    if not values:
        return literal
    return f"{literal}; {values}" if reason.n_states == 1 else f"{literal}; at first {values}"


def _explained_in_json(question: Question, states: StateReader, time_model: TimeModel) -> Answer:
    """Print one document; what each state does waits in a file until the verdict is known."""
    with tempfile.SpooledTemporaryFile(_KEPT_IN_MEMORY, "w+", encoding="utf-8") as steps:
        first = True

        def on_step(step: Step) -> None:
            nonlocal first
            steps.write(("" if first else ",") + "\n" + _plain_step(step))
            first = False

        answer = follow(question, states, time_model, on_step)
        document = {**document_from(answer), "reasons": _plain_reasons(answer)}
        steps.seek(0)
        _write_document(document, steps)
    return answer


def _write_document(document: dict[str, Any], steps: IO[str]) -> None:
    sys.stdout.write(to_json(document).decode()[:-1] + ',"steps":[')
    shutil.copyfileobj(steps, sys.stdout)
    sys.stdout.write("]}\n")


def _plain_step(step: Step) -> str:
    plain = {
        "t": milliseconds_of(step.time),
        "changes": dict(step.changes),
        "residual": step.residual,
    }
    return json.dumps(plain, ensure_ascii=False)


def _plain_reasons(answer: Answer) -> list[dict[str, Any]] | None:
    if answer.reasons is None:
        return None
    return [
        {
            "atom": reason.atom,
            "value": reason.value,
            "from": milliseconds_of(reason.begin),
            "to": milliseconds_of(reason.end),
            "states": reason.n_states,
            "values": dict(reason.values),
        }
        for reason in answer.reasons
    ]

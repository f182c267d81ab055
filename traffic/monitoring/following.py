"""Following a formula along states, up to the first state that decides it."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from dyknow.errors import FeatureError
from dyknow.mtl.check import BOOLEAN, NUMBER, TEXT
from dyknow.mtl.monitors import Monitor
from dyknow.mtl.printer import text_from_formula
from dyknow.mtl.syntax import TimeModel, Verdict
from dyknow.time import MILLISECOND, TimePoint
from traffic.errors import LineError
from traffic.monitoring.past import Past
from traffic.monitoring.questions import Question, forbid_missing
from traffic.monitoring.reasons import Reason, reasons_of
from traffic.monitoring.states import StateReader
from traffic.reading.times import described

__all__ = ["Answer", "OnStep", "Step", "document_from", "follow", "milliseconds_of"]


@dataclass(frozen=True, slots=True)
class Step:
    """What one state did to the formula.

    Attributes:
        time: Of the state.
        changes: Each atom whose truth is not what it was in the state before, and its truth; in
            the first state, all atoms.
        residual: What must hold from now on.
    """

    time: TimePoint
    changes: Mapping[str, bool]
    residual: str


@dataclass(frozen=True, slots=True)
class Answer:
    """What states say about a formula.

    Attributes:
        verdict: The verdict.
        decided_at: The time of the state that decided it, or None.
        residual: What is left of the formula.
        n_states: How many states were looked at.
        last: The time of the last of them.
        reasons: The observations that bring the verdict about, if they were asked for and there
            is a verdict; None if they reach too far back.
    """

    verdict: Verdict
    decided_at: TimePoint | None
    residual: str
    n_states: int
    last: TimePoint
    reasons: tuple[Reason, ...] | None = ()


OnStep = Callable[[Step], None]


def follow(
    question: Question,
    states: StateReader,
    time_model: TimeModel = TimeModel.HOLD,
    on_step: OnStep | None = None,
) -> Answer:
    """Follow a formula until it is decided, or until there are no more states.

    Args:
        question: The formula.
        states: The states, which are read only as far as they are needed.
        time_model: At which time-points there is a state.
        on_step: Told about each state. With it, reasons are given for the verdict.

    Raises:
        LineError: Something is wrong with the states.
        SpecificationErrors: The first state does not have all features of the formula.
    """
    monitor = Monitor(question.formula, time_model)
    if on_step is None:
        n_states, now = _steps(question, states, monitor.step)
        past = None
    else:
        past = Past(monitor)
        explained = _Explained(monitor, past, on_step)
        n_states, now = _steps(question, states, explained.step)
    is_decided = monitor.verdict is not Verdict.UNDECIDED
    return Answer(
        verdict=monitor.verdict,
        decided_at=now if is_decided else None,
        residual=text_from_formula(monitor.residual),
        n_states=n_states,
        last=now,
        reasons=() if past is None or not is_decided else reasons_of(past),
    )


def document_from(answer: Answer) -> dict[str, Any]:
    """Return the answer as plain data; times are milliseconds."""
    decided_at = answer.decided_at
    return {
        "verdict": answer.verdict.name.lower(),
        "decided_at": None if decided_at is None else milliseconds_of(decided_at),
        "residual": answer.residual,
    }


def milliseconds_of(time: int) -> int | float:
    """Return a time in milliseconds, as a whole number if it is one."""
    whole, rest = divmod(time, MILLISECOND)
    return time / MILLISECOND if rest else whole


def _steps(
    question: Question,
    states: StateReader,
    step: Callable[[TimePoint, Mapping[str, Any]], Verdict],
) -> tuple[int, TimePoint]:
    """Take in states until there is a verdict; return their number and the time of the last."""
    undecided = Verdict.UNDECIDED
    n_states, now = 0, TimePoint(0)
    for now, values in _complete(question, states):
        n_states += 1
        try:
            verdict = step(now, values)
        except FeatureError as error:
            raise _located(error, question, states, values) from None
        if verdict is not undecided:
            break
    return n_states, now


def _complete(
    question: Question, states: StateReader
) -> Iterator[tuple[TimePoint, Mapping[str, Any]]]:
    """Yield the states, the first of which has every feature of the formula."""
    following = iter(states)
    for now, values in following:
        forbid_missing(question, states.terms(), states.place())
        yield now, values
        break
    yield from following


def _located(
    error: FeatureError, question: Question, states: StateReader, values: Mapping[str, Any]
) -> LineError:
    """Return a fault of a value, with its place and as it stands in the state.

    A feature of another sort than the formula needs is at fault, whatever it is compared with.
    """
    for term, sort in question.sorts.items():
        found = _SORTS.get(type(values.get(term)))
        if sort is not None and found is not None and sort != found:
            expected = f"a {sort} as '{term}'"
            return LineError(states.place(term), expected, f"{described(values[term])}, a {found}")
    place = states.place(error.feature)
    return LineError(place, f"{error.expected} as '{error.feature}'", error.found)


_SORTS = {bool: BOOLEAN, int: NUMBER, float: NUMBER, str: TEXT}


class _Explained:
    """Takes in states and tells what each of them does."""

    def __init__(self, monitor: Monitor, past: Past, on_step: OnStep) -> None:
        self._monitor = monitor
        self._past = past
        self._on_step = on_step
        self._atoms = [text_from_formula(atom) for atom in monitor.table.atoms]
        self._bits: int | None = None

    def step(self, now: TimePoint, values: Mapping[str, Any]) -> Verdict:
        """Take in a state and return the verdict."""
        bits = self._monitor.table.columns.of_state(values)
        verdict = self._monitor.step_bits(now, bits)
        residual = self._monitor.residual
        self._past.add(now, bits, values, residual)
        self._on_step(Step(now, self._changes(bits), text_from_formula(residual)))
        return verdict

    def _changes(self, bits: int) -> dict[str, bool]:
        changed = -1 if self._bits is None else bits ^ self._bits
        self._bits = bits
        return {
            atom: bool(bits >> number & 1)
            for number, atom in enumerate(self._atoms)
            if changed >> number & 1
        }

"""Chronicles recognised in events as these are read, in bounded memory."""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass

from chronicles.constraints import floor_to_instant
from chronicles.events import Event, Recognition
from chronicles.prospects import PartialInstance
from chronicles.recognition import Recogniser
from dyknow.time import Duration, TimePoint, duration_from_text
from traffic.errors import RequestError
from traffic.reading.times import LATEST, text_from_time
from traffic.recognising.opening import EventReader
from traffic.recognising.ordering import Ordering
from traffic.recognising.questions import Question
from traffic.recognising.screening import OnRemark, RemarkKind, Screening

__all__ = ["OnRecognition", "Outcome", "Settings", "delay_from", "recognise"]

_NO_DELAY = Duration(0)

OnRecognition = Callable[[Recognition], None]


@dataclass(frozen=True, slots=True)
class Settings:
    """How events are taken in.

    Attributes:
        max_delay: How much later than the latest event one may come and still be put in order.
        closes: Whether what is open at the end of the input ends then, with nothing to follow.
        limit: How many partial instances of one chronicle are kept; None for any number.
    """

    max_delay: Duration = _NO_DELAY
    closes: bool = False
    limit: int | None = None


@dataclass(frozen=True, slots=True)
class Outcome:
    """What is to be said at the end of the events, apart from the recognitions.

    Attributes:
        n_events: How many events were read.
        n_recognitions: How many recognitions there were.
        clock: The time before which everything is known, or None if there were no events.
        remarks: How often there was something to remark about an event, by kind.
        given_up: How many partial instances were given up because of the limit, by chronicle.
        pending: Instances all of whose events have come, and that something may still end.
        partial: The other partial instances.
    """

    n_events: int
    n_recognitions: int
    clock: TimePoint | None
    remarks: Mapping[RemarkKind, int]
    given_up: Mapping[str, int]
    pending: tuple[PartialInstance, ...]
    partial: tuple[PartialInstance, ...]


def recognise(
    question: Question,
    events: EventReader,
    settings: Settings,
    on_recognition: OnRecognition,
    on_remark: OnRemark,
) -> Outcome:
    """Recognise chronicles in events, and tell each recognition as soon as it is certain.

    Args:
        question: The chronicles.
        events: The events.
        settings: How they are taken in.
        on_recognition: Told about each recognition.
        on_remark: Told about each event that is left out or doubtful.

    Raises:
        LineError: An event cannot be read.
    """
    return _Following(question, settings, on_recognition, on_remark).follow(events)


class _Following:
    """One stretch of events."""

    def __init__(
        self,
        question: Question,
        settings: Settings,
        on_recognition: OnRecognition,
        on_remark: OnRemark,
    ) -> None:
        self._settings = settings
        self._on_recognition = on_recognition
        self._recogniser = Recogniser(question.models, limit=settings.limit)
        self._n_slots = {model.name: len(model.slots) for model in question.models}
        self._screening = Screening(question.acceptance, on_remark)
        self._is_fit = self._screening.is_fit
        self._is_change = self._screening.is_change
        self._push = self._recogniser.push
        self._n_recognitions = 0

    def follow(self, events: EventReader) -> Outcome:
        if self._settings.max_delay:
            n_events = self._put_in_order(events)
        else:
            n_events = self._take_as_they_come(events)
        clock = self._recogniser.clock
        if self._settings.closes:
            self._tell(self._recogniser.advance(TimePoint(LATEST)))
        pending: list[PartialInstance] = []
        partial: list[PartialInstance] = []
        for instance in self._recogniser.partial_instances():
            is_pending = len(instance.events) == self._n_slots[instance.chronicle]
            (pending if is_pending else partial).append(instance)
        return Outcome(
            n_events=n_events,
            n_recognitions=self._n_recognitions,
            clock=clock,
            remarks=self._screening.counts,
            given_up=self._recogniser.n_given_up,
            pending=tuple(pending),
            partial=tuple(partial),
        )

    def _take_as_they_come(self, events: EventReader) -> int:
        n_events, clock, place = 0, -LATEST, events.place
        for event in events:
            n_events += 1
            if event.time >= clock:
                clock = floor_to_instant(event.time)
                self._take(event, place)
            else:
                self._leave_out_late(event, clock, place())
        return n_events

    def _put_in_order(self, events: EventReader) -> int:
        n_events, ordering = 0, Ordering(self._settings.max_delay)
        for event in events:
            n_events += 1
            clock = ordering.clock
            if clock is not None and event.time < clock:
                self._leave_out_late(event, clock, events.place())
                continue
            for due, where in ordering.put(event, events.place()):
                self._take(due, where.__str__)
        for due, where in ordering.rest():
            self._take(due, where.__str__)
        return n_events

    def _take(self, event: Event, place: Callable[[], str]) -> None:
        """Take in an event that is not late; what is left out still tells how late it is."""
        if self._is_fit(event, place) and self._is_change(event, place):
            found = self._push(event.time, (event,))
        else:
            found = self._push(event.time, ())
        if found:
            self._tell(found)

    def _tell(self, recognitions: Iterable[Recognition]) -> None:
        for recognition in recognitions:
            self._n_recognitions += 1
            self._on_recognition(recognition)

    def _leave_out_late(self, event: Event, clock: int, place: str) -> None:
        expected = f"expected events in order of time, after {text_from_time(clock)} ms"
        message = f"{expected}, found one at {text_from_time(event.time)} ms"
        self._screening.remark(RemarkKind.LATE, message, place)


def delay_from(text: str) -> Duration:
    """Read the delay that is allowed to events.

    Raises:
        RequestError: It is no length of time, or less than none.
    """
    try:
        delay = duration_from_text(text)
    except ValueError:
        delay = None
    if delay is None or delay < 0:
        raise RequestError("--max-delay", "a length of time such as '200' or '1.5 s'", text)
    return delay

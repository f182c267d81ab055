"""What one process recognises, as events for the chronicles of another."""

from typing import Any

from chronicles.events import Event, event_from_recognition
from dyknow.streams.process import Reactive
from dyknow.streams.sample import Heartbeat, Sample
from dyknow.time import TimePoint

__all__ = ["RecognitionEvents"]


class RecognitionEvents(Reactive):
    """Turns a stream of recognitions into a stream of events, sample by sample.

    The event of a recognition is the same that it is for the other chronicles of its own file: it
    is named after the chronicle, has its arguments, and has its beginning and its end, in
    milliseconds, as the values before and after. It happens **when the recognition became
    certain** (`recognised_at`), not when what was recognised happened: an event of an earlier
    time would come after others have been taken in. The same file would recognise the same.

    The samples come as late after their valid time as those of the recogniser, so that the second
    recogniser needs at least the `max_delay` of the first. Heartbeats are passed on.
    """

    def push(
        self, now: TimePoint, inputs: tuple[Sample[Any], ...]
    ) -> list[Sample[tuple[Event, ...]]]:
        """Emit the events of the new recognitions."""
        (sample,) = inputs
        events = tuple(event_from_recognition(each) for each in sample.value)
        return [Sample(events, sample.valid_time, now)]

    def beat(self, now: TimePoint, at: int, heartbeat: Heartbeat) -> list[Heartbeat]:  # noqa: ARG002, the protocol's
        """Pass on how far the recognitions are complete."""
        return [Heartbeat(heartbeat.until, now)]

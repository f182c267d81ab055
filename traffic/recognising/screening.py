"""What is left out of a stream of events, and what is doubtful in it."""

from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass
from enum import StrEnum

from chronicles.acceptance import Acceptance, RefusalKind
from chronicles.events import Event

__all__ = ["OnRemark", "Remark", "RemarkKind", "Screening"]

_KEPT = 1 << 16


class RemarkKind(StrEnum):
    """What a remark is about."""

    LATE = "late"
    UNKNOWN = "unknown"
    KIND = "wrong kind"
    ARITY = "wrong number of arguments"
    DOMAIN = "outside its domain"
    UNCHANGED = "unchanged"
    CONTRADICTION = "contradicts the last value"


@dataclass(frozen=True, slots=True)
class Remark:
    """Something that is doubtful about an event.

    Attributes:
        place: Of the event.
        kind: What kind of doubt.
        message: What was expected, and what was found.
        is_left_out: Whether the event is left out for it.
    """

    place: str
    kind: RemarkKind
    message: str
    is_left_out: bool


OnRemark = Callable[[Remark], None]

_KIND_OF = {kind: RemarkKind(kind.value) for kind in RefusalKind}


class Screening:
    """Tells which events are fit to be taken in, and remarks on the others.

    Attributes:
        counts: How often there was something to remark, by kind.
    """

    def __init__(self, acceptance: Acceptance, on_remark: OnRemark) -> None:
        self.counts: Counter[RemarkKind] = Counter()
        self._acceptance = acceptance
        self._on_remark = on_remark
        self._unknown: set[str] = set()
        self._last: dict[tuple[str, tuple[str, ...]], str | None] = {}

    def is_fit(self, event: Event, place: Callable[[], str]) -> bool:
        """Return whether *event* is as declared.

        That a name is unknown is told once.
        """
        if event.attribute in self._unknown:
            self.counts[RemarkKind.UNKNOWN] += 1
            return False
        refusal = self._acceptance.refusal(event)
        if refusal is None:
            return True
        kind = _KIND_OF[refusal.kind]
        if kind is RemarkKind.UNKNOWN and len(self._unknown) < _KEPT:
            self._unknown.add(event.attribute)
        self.remark(kind, refusal.message, place())
        return False

    def is_change(self, event: Event, place: Callable[[], str]) -> bool:
        """Return whether *event*, the next in order, changes something; it may be a message.

        What an event says of the value before is believed even if it contradicts the event
        before, as one that was lost in between would explain it.
        """
        before, after = event.from_value, event.to_value
        if before == after:
            if before is None:
                return True
            self.counts[RemarkKind.UNCHANGED] += 1
            return False
        key = (event.attribute, event.arguments)
        last = self._last.pop(key, None)
        if before is not None and last is not None and before != last:
            message = f"expected a change from '{last}', the last value, found one from '{before}'"
            self.remark(RemarkKind.CONTRADICTION, message, place(), is_left_out=False)
        self._last[key] = after
        if len(self._last) > _KEPT:
            del self._last[next(iter(self._last))]
        return True

    def remark(
        self, kind: RemarkKind, message: str, place: str, *, is_left_out: bool = True
    ) -> None:
        """Count a doubt and tell it."""
        self.counts[kind] += 1
        self._on_remark(Remark(place, kind, message, is_left_out))

"""What is to happen when: the queue of the kernel.

An entry is keyed by (time, priority, sequence number). Priority is the depth of the participant
in the network, so that within one instant everything that feeds a process has had its turn
before the process has; the sequence number is the order of declaration.
"""

from heapq import heappop, heappush
from typing import Protocol

from dyknow.time import TimePoint

__all__ = ["Agenda", "Participant", "Ticket"]


class Participant(Protocol):
    """Something that is given turns."""

    def turn(self, now: TimePoint) -> None:
        """Do what is due at *now*."""


class Ticket:
    """The place of one participant in the agenda.

    Attributes:
        priority: Who comes first within an instant: the lower one.
        number: Unique, in the order in which participants joined.
        wake_at: When the next turn is, if one is planned.
    """

    __slots__ = ("number", "participant", "priority", "wake_at")

    def __init__(self, participant: Participant, priority: int, number: int) -> None:
        self.participant = participant
        self.priority = priority
        self.number = number
        self.wake_at: TimePoint | None = None


class Agenda:
    """The turns to come, in order."""

    def __init__(self) -> None:
        self._entries: list[tuple[TimePoint, int, int]] = []
        self._tickets: list[Ticket] = []

    def join(self, participant: Participant, priority: int) -> Ticket:
        """Let a participant in and return its ticket."""
        ticket = Ticket(participant, priority, len(self._tickets))
        self._tickets.append(ticket)
        return ticket

    def wake(self, ticket: Ticket, time: TimePoint) -> None:
        """Plan a turn at *time*, or leave an earlier one that is planned already."""
        if ticket.wake_at is None or time < ticket.wake_at:
            ticket.wake_at = time
            heappush(self._entries, (time, ticket.priority, ticket.number))

    def next_time(self) -> TimePoint | None:
        """Return the time of the next turn, if there is one."""
        entries = self._entries
        while entries:
            time, _, number = entries[0]
            if self._tickets[number].wake_at == time:
                return time
            heappop(entries)
        return None

    def hold_instant(self, now: TimePoint) -> None:
        """Give all turns of the instant *now*, also those that are planned meanwhile."""
        entries = self._entries
        while entries and entries[0][0] == now:
            _, _, number = heappop(entries)
            ticket = self._tickets[number]
            if ticket.wake_at == now:
                ticket.wake_at = None
                ticket.participant.turn(now)

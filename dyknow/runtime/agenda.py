"""What is to happen when: the queue of the kernel.

An entry is keyed by (time, priority, sequence number). Priority is the depth of the participant
in the network, so that within one instant everything that feeds a process has had its turn
before the process has; the sequence number is the order in which participants joined.
"""

from heapq import heapify, heappop, heappush
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
    """The turns to come, in order.

    Attributes:
        pending: How many sources have not ended, and how many samples are on their way that
            will be available later. While there are any, a run without an end goes on.
        horizon: Up to when the current run works; None without an end, and between runs.
    """

    def __init__(self) -> None:
        self.pending = 0
        self.horizon: TimePoint | None = None
        self._entries: list[tuple[TimePoint, int, int]] = []
        self._tickets: dict[int, Ticket] = {}
        self._n_joined = 0
        self._n_void = 0

    @property
    def size(self) -> int:
        """How many participants there are."""
        return len(self._tickets)

    @property
    def n_entries(self) -> int:
        """How many entries the queue holds, void ones included."""
        return len(self._entries)

    def join(self, participant: Participant, priority: int) -> Ticket:
        """Let a participant in and return its ticket."""
        ticket = Ticket(participant, priority, self._n_joined)
        self._tickets[self._n_joined] = ticket
        self._n_joined += 1
        return ticket

    def leave(self, ticket: Ticket) -> None:
        """Give the participant no more turns and forget it."""
        del self._tickets[ticket.number]
        if ticket.wake_at is not None:
            ticket.wake_at = None
            self._void_one()

    def move(self, ticket: Ticket, priority: int) -> None:
        """Give the participant another priority."""
        ticket.priority = priority
        if ticket.wake_at is not None:
            heappush(self._entries, (ticket.wake_at, priority, ticket.number))
            self._void_one()

    def wake(self, ticket: Ticket, time: TimePoint) -> None:
        """Plan a turn at *time*, or leave an earlier one that is planned already."""
        planned = ticket.wake_at
        if planned is None or time < planned:
            ticket.wake_at = time
            heappush(self._entries, (time, ticket.priority, ticket.number))
            if planned is not None:
                self._void_one()

    def extend(self, wanted: TimePoint, given: TimePoint) -> None:
        """Let the current run work until *given*, if *wanted* belongs to it.

        That is for samples which would be available at the last instant of a run and were
        given a later nanosecond because available times are unique.
        """
        if self.horizon is not None and wanted <= self.horizon < given:
            self.horizon = given

    def next_time(self) -> TimePoint | None:
        """Return the time of the next turn, if there is one."""
        self._tidy()
        entries = self._entries
        while entries:
            if self._is_planned(entries[0]):
                return entries[0][0]
            heappop(entries)
            self._n_void -= 1
        return None

    def hold_instant(self, now: TimePoint) -> None:
        """Give all turns of the instant *now*, also those that are planned meanwhile."""
        entries = self._entries
        tickets = self._tickets
        while entries and entries[0][0] == now:
            _, priority, number = heappop(entries)
            ticket = tickets.get(number)
            if ticket is not None and ticket.wake_at == now and ticket.priority == priority:
                ticket.wake_at = None
                ticket.participant.turn(now)
            else:
                self._n_void -= 1

    def _void_one(self) -> None:
        self._n_void += 1
        self._tidy()

    def _tidy(self) -> None:
        """Throw the void entries out when they are more than the others."""
        if 2 * self._n_void > len(self._entries):
            # As a set, since a turn may have been planned again for the time of a void entry.
            planned = {entry for entry in self._entries if self._is_planned(entry)}
            self._entries[:] = planned
            heapify(self._entries)
            self._n_void = 0

    def _is_planned(self, entry: tuple[TimePoint, int, int]) -> bool:
        time, priority, number = entry
        ticket = self._tickets.get(number)
        return ticket is not None and ticket.wake_at == time and ticket.priority == priority

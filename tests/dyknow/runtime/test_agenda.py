"""The queue of turns, against a list that is searched."""

from hypothesis import given, settings
from hypothesis import strategies as st

from dyknow.runtime.agenda import Agenda


class Logging:
    """Notes its turns."""

    def __init__(self, name, log):
        self.name = name
        self.log = log

    def turn(self, now):
        """Note the turn."""
        self.log.append((now, self.name))


steps = st.lists(
    st.one_of(
        st.tuples(st.just("wake"), st.integers(0, 4), st.integers(0, 30)),
        st.tuples(st.just("leave"), st.integers(0, 4), st.just(0)),
        st.tuples(st.just("move"), st.integers(0, 4), st.integers(0, 9)),
        st.tuples(st.just("hold"), st.just(0), st.just(0)),
    ),
    max_size=60,
)


@settings(derandomize=True, deadline=None, max_examples=300)
@given(steps)
def test_turns_come_by_time_priority_and_order_of_joining(todo):
    """Each participant has the earliest turn that it asked for, at its place, and no other."""
    agenda, log, expected = Agenda(), [], []
    tickets = {name: agenda.join(Logging(name, log), name) for name in range(5)}
    planned = {}
    for what, name, number in todo:
        ticket = tickets.get(name)
        if what == "hold":
            now = agenda.next_time()
            assert now == min(planned.values(), default=None)
            if now is not None:
                agenda.hold_instant(now)
                due = [other for other, time in planned.items() if time == now]
                due.sort(key=lambda other: (tickets[other].priority, tickets[other].number))
                expected += [(now, other) for other in due]
                planned = {other: time for other, time in planned.items() if time != now}
        elif ticket is None:
            tickets[name] = agenda.join(Logging(name, log), name)
        elif what == "wake":
            agenda.wake(ticket, number)
            planned[name] = min(number, planned.get(name, number))
        elif what == "move":
            agenda.move(ticket, number)
        else:
            agenda.leave(tickets.pop(name))
            planned.pop(name, None)
        assert agenda.size == len(tickets)
        assert agenda.next_time() == min(planned.values(), default=None)
        assert agenda.n_entries <= 2 * len(planned)

    assert log == expected


def test_turns_that_are_planned_meanwhile_belong_to_the_instant():
    """A participant may plan another turn for the instant that is being held."""
    agenda, log = Agenda(), []
    later = agenda.join(Logging("later", log), 5)

    class Waking(Logging):
        def turn(self, now):
            super().turn(now)
            agenda.wake(later, now)

    agenda.wake(agenda.join(Waking("first", log), 1), 3)
    agenda.hold_instant(3)

    assert log == [(3, "first"), (3, "later")]

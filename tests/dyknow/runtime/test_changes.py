"""A network that is changed while it runs, against receivers that are alone in the world."""

import gc
from collections import Counter

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from dyknow.errors import LabelAlreadyExistsError, LabelInUseError, NoSuchLabelError
from dyknow.runtime.adaptation import AdaptedStream, PlainStream
from dyknow.runtime.agenda import Ticket
from dyknow.runtime.generators import Label
from dyknow.runtime.kernel import Kernel
from dyknow.runtime.processes import RunningProcess
from dyknow.runtime.subscriptions import StreamProxy
from dyknow.streams.adapter import adapter_for
from dyknow.streams.policy import Approximation, Order, Policy, SampleEvery
from dyknow.streams.sample import Sample
from tests.support.policies import streams
from tests.support.streams import GivenSource, ms, text

A, B, C, TICKS = Label("a"), Label("b"), Label("c"), Label("ticks")
END = 260
POLICIES = [
    Policy(),
    Policy(order=Order.STRICT),
    Policy(change=SampleEvery(ms(10))),
    Policy(change=SampleEvery(ms(20)), max_delay=ms(30)),
    Policy(
        change=SampleEvery(ms(10)),
        approximation=Approximation.MOST_RECENT,
        max_delay=ms(20),
        start=ms(0),
    ),
    Policy(change=SampleEvery(ms(10), longest=ms(40))),
]


class Repeating:
    """Repeats its first input, and rings a while later."""

    def __init__(self, after=7):
        self.after = ms(after)
        self.at = None

    def push(self, now, inputs):
        """Repeat."""
        self.at = now + self.after
        return [Sample(inputs[0].value, inputs[0].valid_time, now)]

    def advance(self, now):
        """Ring."""
        at, self.at = self.at, None
        return [Sample("!", at, now)]

    def due(self):
        """Return when it rings."""
        return self.at


class Client:
    """Asks a kernel for one stream, changes it, and remembers what it received."""

    def __init__(self, kernel, label):
        self.kernel = kernel
        self.label = label
        self.proxy = None
        self.received = []
        self.violations = []

    def do(self, what, policy):
        """Make one change, if it makes sense."""
        if what == "subscribe" and self.proxy is None:
            self.proxy = self.kernel.subscribe(self.label, self.received.append, policy)
            self.proxy.subscribe_violations(lambda each: self.violations.append(each.violation))
        elif self.proxy is None or self.proxy.has_ended:
            return
        elif what == "replace":
            self.proxy.replace_policy(policy)
        elif what == "lengthen" and self.proxy.policy == POLICIES[-1] == policy:
            self.proxy.set_period(ms(30))
        elif what == "end":
            self.proxy.end()

    @property
    def outcome(self):
        """What was received and what was violated."""
        figures = self.proxy and self.proxy.statistics
        return repr(self.received), repr(self.violations), figures and figures.samples


def values(samples):
    """Return the values of samples as numbers."""
    return [int(sample.value) for sample in samples]


actions = st.lists(
    st.tuples(
        st.integers(0, 12).map(lambda n: 20 * n),
        st.integers(0, 3),
        st.sampled_from(["subscribe", "subscribe", "replace", "lengthen", "end"]),
        st.sampled_from(POLICIES),
    ),
    max_size=10,
).map(lambda drawn: sorted(drawn, key=lambda each: each[0]))


def served(samples, todo, only=None, *, within=True):
    """Return the clients of a run in which *todo* is done, by all of them or by *only* one.

    Changes are asked for within an instant, by a receiver, or between two runs.
    """
    kernel = Kernel()
    kernel.add_source(A, GivenSource(samples))
    kernel.add_unit(B, Repeating(), [(A, Policy())])
    clients = [Client(kernel, label) for label in (A, A, B, B)]

    def act(now):
        for time, client, what, policy in todo:
            if ms(time) == now and only in (None, client):
                clients[client].do(what, policy)

    if within:
        kernel.add_source(TICKS, GivenSource(" ".join(f"{n}:x" for n in range(0, END, 20))))
        kernel.subscribe(TICKS, lambda sample: act(sample.valid_time))
        kernel.run(ms(END))
        return clients
    for time in range(0, END, 20):
        kernel.run(ms(time))
        act(ms(time))
    kernel.run(ms(END))
    return clients


@settings(derandomize=True, deadline=None, max_examples=120)
@given(streams(), actions)
def test_each_receiver_gets_what_it_would_get_alone(samples, todo):
    """Others that come, change and go, and share a stream or not, make no difference."""
    together = served(samples, todo)

    for at, client in enumerate(together):
        assert client.outcome == served(samples, todo, only=at)[at].outcome


@settings(derandomize=True, deadline=None, max_examples=120)
@given(streams(), actions)
def test_a_change_within_an_instant_is_one_made_after_it(samples, todo):
    """Asked for by a receiver or between two runs: it takes effect when the instant is done."""
    within = served(samples, todo, within=True)
    between = served(samples, todo, within=False)

    assert [client.outcome for client in within] == [client.outcome for client in between]


def naively(samples, policy, begin, end):
    """Return what an adapter makes of the samples from *begin* on, handed on up to *end*."""
    adapter = adapter_for(policy, begin)
    if adapter is None:
        return [sample for sample in samples if begin <= sample.available_time <= end]
    made = []
    arrivals = [sample for sample in samples if begin <= sample.available_time <= end]
    while True:
        due = adapter.due()
        if arrivals and (due is None or arrivals[0].available_time <= due):
            made += adapter.push(arrivals.pop(0))
        elif due is not None and due <= end:
            made += adapter.advance(due)
        else:
            return [sample for sample in made if sample.available_time <= end]


@settings(derandomize=True, deadline=None, max_examples=200)
@given(streams(), st.sampled_from(POLICIES[:4]), st.integers(0, 24), st.integers(1, 24))
def test_a_stream_is_what_its_adapter_makes_of_the_samples_of_its_time(
    samples, policy, begin, length
):
    """It begins a nanosecond after the subscription and has its last sample where it is ended."""
    kernel, received = Kernel(), []
    kernel.add_source(A, GivenSource(samples))
    begin, end = ms(10 * begin), ms(10 * (begin + length))

    kernel.run(begin)
    proxy = kernel.subscribe(A, received.append, policy)
    kernel.run(end)
    proxy.end()
    kernel.run(ms(600))

    assert text(received) == text(naively(samples, policy, begin + 1, end))


MACHINERY = (AdaptedStream, PlainStream, RunningProcess, StreamProxy, Ticket)


def census():
    """Return how many objects of each kind there are."""
    gc.collect()
    counts = Counter(map(type, gc.get_objects()))
    return {
        kind: sum(counts[each] for each in counts if issubclass(each, kind)) for kind in MACHINERY
    }


@settings(derandomize=True, deadline=None, max_examples=5)
@given(streams(), actions)
def test_what_has_gone_leaves_nothing_behind(samples, todo):
    """After all streams have ended and all processes have been removed, none is kept."""
    kernel = Kernel()
    before = census()
    kernel.add_source(A, GivenSource(samples))
    for at, label in enumerate((B, C)):
        kernel.add_unit(label, Repeating(9999), [(A, POLICIES[3]), (A, POLICIES[at])])
    clients = [Client(kernel, label) for label in (A, A, B, C)]
    for time in range(0, END, 20):
        kernel.run(ms(time))
        for at, client, what, policy in todo:
            if at == time:
                clients[client].do(what, policy)

    for client in clients:
        client.do("end", None)
    clients.clear()
    client = None
    for label in (C, B, A):
        kernel.remove(label)
    kernel.run()

    assert census() == before
    assert (kernel.labels, kernel.streams) == ((), ())


def test_processes_can_be_added_and_removed_while_the_network_runs():
    """A new process begins when the instant is done; a removed one finishes the instant."""
    kernel, received, closed = Kernel(), [], []

    class Closing(GivenSource):
        def samples(self):
            try:
                yield from super().samples()
            finally:
                closed.append(kernel.now)

    def act(sample):
        if sample.value == "add":
            kernel.add_source(B, Closing("0:early 25:x 30:y 45:z"))
            kernel.add_unit(C, Repeating(), [(B, Policy())])
            kernel.subscribe(C, received.append)
        if sample.value == "remove":
            for proxy in kernel.streams:
                if proxy.provider == C:
                    proxy.end()
            kernel.remove(C)
            kernel.remove(B)
            assert kernel.labels == (A,)
            kernel.add_source(B, GivenSource("50:other"))
            kernel.subscribe(B, received.append)

    kernel.add_source(A, GivenSource("10:x 20:add 30:remove 40:x 60:x"))
    kernel.subscribe(A, act)
    kernel.run()

    assert text(received) == "0:early@20+1 25:x 30:y 50:other"
    assert closed == [ms(30)]


def test_the_run_does_not_wait_for_what_was_removed():
    """An endless source that is removed does not keep a run without an end going."""
    kernel, counted = Kernel(), []

    class Endless:
        def samples(self):
            at = 0
            while True:
                yield Sample(at, ms(at), ms(at))
                at += 1

    def count(sample):
        counted.append(sample)
        if len(counted) == 5:
            proxy.end()
            kernel.remove(A)

    kernel.add_source(A, Endless())
    proxy = kernel.subscribe(A, count)
    kernel.run()

    assert kernel.now == ms(4)
    assert kernel.labels == ()


def test_a_process_in_use_is_not_removed():
    """The error names those who receive its samples; unknown labels have a hint."""
    kernel = Kernel()
    kernel.add_source(A, GivenSource("0:a"))
    kernel.add_unit(B, Repeating(), [(A, Policy())])
    proxy = kernel.subscribe(A, print, name=Label("screen"))

    with pytest.raises(LabelInUseError, match="'a' is in use by 'b', 'screen'"):
        kernel.remove(A)
    with pytest.raises(NoSuchLabelError, match="did you mean 'b'"):
        kernel.remove(Label("bb"))
    with pytest.raises(LabelAlreadyExistsError, match="called 'b' already"):
        kernel.add_unit(B, Repeating(), [])
    proxy.end()
    kernel.remove(B)
    kernel.remove(A)

    assert kernel.labels == ()


def test_an_input_ends_with_its_process_alone():
    """Nobody can take an input away from a unit; to end a subscription twice is nothing."""
    kernel = Kernel()
    kernel.add_source(A, GivenSource("0:a"))
    kernel.add_unit(B, Repeating(), [(A, Policy())])
    proxy = kernel.subscribe(A, print)
    (given_input,) = (each for each in kernel.streams if each.number)

    with pytest.raises(ValueError, match="is an input and ends with its process"):
        given_input.end()
    proxy.end()
    proxy.end()
    with pytest.raises(ValueError, match="has ended"):
        proxy.replace_policy(Policy(end=ms(5)))

    assert kernel.streams == (given_input,)


def test_a_change_is_made_between_instants():
    """Within an instant a change waits for the end of the work; between runs it does not."""
    kernel, log = Kernel(), []
    kernel.add_source(A, GivenSource("0:a 10:b"))
    kernel.add_unit(B, Repeating(), [(A, Policy())])
    kernel.subscribe(A, lambda sample: kernel.change(lambda: log.append(f"{sample.value} done")))
    kernel.subscribe(B, lambda sample: log.append(sample.value))

    kernel.run()
    kernel.change(lambda: log.append("at once"))

    assert log == ["a", "a done", "!", "b", "b done", "at once"]


def test_the_period_of_one_receiver_can_be_lengthened():
    """Under load one of two equal streams is sampled less often, and the other goes on."""
    kernel, one, other, third = Kernel(), [], [], []
    kernel.add_source(A, GivenSource(" ".join(f"{10 * n}:{n}" for n in range(14))))
    proxies = [
        kernel.subscribe(A, received.append, POLICIES[-1]) for received in (one, other, third)
    ]

    kernel.run(ms(25))
    proxies[0].set_period(ms(30))
    proxies[1].set_period(ms(30))
    assert [proxy.period for proxy in proxies] == [ms(30), ms(30), ms(10)]
    kernel.run(ms(95))
    proxies[0].set_period(ms(10))
    kernel.run()

    assert values(one) == [0, 1, 2, 5, 8, 10, 11, 12, 13]
    assert values(other) == [0, 1, 2, 5, 8, 11]
    assert values(third) == list(range(14))
    assert [proxy.statistics.samples for proxy in proxies] == [9, 6, 14]
    with pytest.raises(ValueError, match="may not be sampled every 50"):
        proxies[2].set_period(ms(50))

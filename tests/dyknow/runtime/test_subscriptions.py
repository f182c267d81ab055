"""What is known about streams, and the violations of each of them."""

from dyknow.runtime.generators import Label
from dyknow.runtime.kernel import Kernel
from dyknow.runtime.statistics import Statistics
from dyknow.streams.policy import Approximation, Constraint, Order, Policy, SampleEvery
from dyknow.streams.sample import Heartbeat
from dyknow.time import seconds
from tests.support.streams import GivenSource, ms, stream, text

A, B = Label("a"), Label("b")


class Idle:
    """Takes in everything and says nothing."""

    def push(self, now, inputs):
        """Emit nothing."""
        return ()

    def advance(self, now):
        """Emit nothing."""
        return ()

    def due(self):
        """Wait for nothing."""


def test_the_streams_of_a_network_are_listed():
    """Each stream knows its provider, its receiver, which input it is, and its policy."""
    kernel = Kernel()
    kernel.add_source(A, GivenSource("0:a"))
    strict = Policy(order=Order.STRICT)
    kernel.add_unit(B, Idle(), [(A, Policy()), (A, strict)])
    proxy = kernel.subscribe(B, print, name=Label("screen"))

    assert [(s.provider, s.receiver, s.number, s.policy) for s in kernel.streams] == [
        ("a", "b", 1, Policy()),
        ("a", "b", 2, strict),
        ("b", "screen", 0, Policy()),
    ]
    assert repr(kernel.streams[1]) == "StreamProxy(a -> b/2)"
    assert repr(proxy) == "StreamProxy(b -> screen)"


def test_a_stream_has_statistics():
    """Samples, rate over valid time, delays, violations, late samples and heartbeats."""
    kernel = Kernel()
    given = [*stream("0:a 100:b@110 50:c@120 200:d@230 300:e@400"), Heartbeat(ms(300), ms(400))]
    kernel.add_source(A, GivenSource(given))
    plain = kernel.subscribe(A, lambda sample: None)
    strict = kernel.subscribe(A, lambda sample: None, Policy(order=Order.STRICT, max_delay=ms(50)))

    kernel.run()

    assert strict.statistics == Statistics(
        samples=3,
        rate=10.0,
        mean_delay=round((ms(10) + ms(30)) / 3),
        delay_99=strict.statistics.delay_99,
        largest_delay=strict.statistics.largest_delay,
        violations=2,
        late=2,
        heartbeats=1,
    )
    assert ms(30) <= strict.statistics.delay_99 <= strict.statistics.largest_delay <= ms(33.4)
    assert plain.statistics == kernel.generator(A).statistics
    assert (plain.statistics.samples, plain.statistics.largest_delay) == (5, ms(100))


def test_the_statistics_of_an_ended_stream_stay():
    """What others receive afterwards does not count."""
    kernel = Kernel()
    kernel.add_source(A, GivenSource("0:a 10:b 20:c"))
    proxies = [kernel.subscribe(A, lambda sample: None) for _ in range(2)]

    assert proxies[0].statistics == Statistics()
    kernel.run(ms(15))
    proxies[0].end()
    kernel.run()

    assert [proxy.statistics.samples for proxy in proxies] == [2, 3]


def test_a_stream_that_begins_late_counts_from_its_beginning():
    """Neither samples nor delays of the time before are its own."""
    kernel = Kernel()
    kernel.add_source(A, GivenSource("0:a@80 90:b 100:c@101 110:d@111"))
    kernel.run(ms(85))
    proxy = kernel.subscribe(A, lambda sample: None)
    sampled = kernel.subscribe(A, lambda sample: None, Policy(change=SampleEvery(ms(20))))

    kernel.run()

    assert (proxy.statistics.samples, proxy.statistics.rate) == (3, 100.0)
    assert proxy.statistics.mean_delay == round(2 * ms(1) / 3)
    assert ms(1) <= proxy.statistics.largest_delay < ms(3)
    assert (sampled.statistics.samples, sampled.statistics.rate) == (2, 50.0)


def test_each_stream_has_a_stream_of_violations():
    """Subscribers to one stream hear of no other; both kinds of subscription can be ended."""
    kernel = Kernel()
    kernel.add_source(A, GivenSource("10:a 5:b@20 4:c@30 3:d@40"))
    strict, prompt = Policy(order=Order.STRICT), Policy(max_delay=ms(20))
    kernel.add_unit(B, Idle(), [(A, Policy()), (A, strict)])
    proxy = kernel.subscribe(A, lambda sample: None, prompt)
    of_all, of_input, of_subscription = [], [], []
    end = kernel.subscribe_violations(of_all.append)
    kernel.streams[1].subscribe_violations(of_input.append)
    end_own = proxy.subscribe_violations(of_subscription.append)

    kernel.run(ms(30))
    end()
    end_own()
    kernel.run()

    assert [(each.receiver, each.number) for each in of_input] == [("b", 2)] * 3
    assert [each.violation.sample.value for each in of_input] == ["b", "c", "d"]
    assert [(each.provider, each.receiver, each.number) for each in of_subscription] == [
        ("a", "output", 0)
    ]
    assert of_subscription[0].violation.constraint is Constraint.DELAY
    assert len(of_all) == 3
    assert kernel.accounts[B].violations == 3


def test_a_receiver_may_be_shown_to_others():
    """Who taps a stream sees what its receiver gets, also under another policy."""
    kernel, received, shown = Kernel(), [], []
    kernel.add_source(A, GivenSource("0:a 10:b 20:c 30:d"))
    proxy = kernel.subscribe(A, received.append)
    end = proxy.tap(shown.append, lambda heartbeat: None)

    kernel.run(ms(10))
    proxy.replace_policy(Policy(change=SampleEvery(ms(20))))
    kernel.run(ms(30))
    end()
    kernel.run()

    assert text(received) == text(shown) == "0:a 10:b 30:d"


def test_many_streams_of_equal_policies_are_adapted_once():
    """Ten thousand equal subscriptions receive the very same samples, those made up included."""
    policy = Policy(
        approximation=Approximation.MOST_RECENT,
        change=SampleEvery(seconds(1)),
        max_delay=seconds(0),
        start=seconds(0),
    )
    kernel, received = Kernel(), []
    kernel.add_source(A, GivenSource("0:a 2000:b"))
    for _ in range(10_000):
        kernel.subscribe(A, received.append, policy)

    kernel.run(seconds(4))

    assert len(received) == 50_000
    assert len({id(sample) for sample in received}) == 5

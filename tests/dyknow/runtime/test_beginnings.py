"""Streams that begin in the past or take the place of another one."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from dyknow.errors import PolicyNotSupportedError
from dyknow.runtime.generators import Label
from dyknow.runtime.kernel import Kernel
from dyknow.streams.policy import ANY_CHANGE, Approximation, Order, Policy, SampleEvery
from dyknow.streams.sample import END_OF_TIME, Heartbeat, Sample
from dyknow.streams.stream import is_fluent_stream
from tests.support.policies import streams
from tests.support.streams import GivenSource, ms, stream, text

A = Label("a")
MOST_RECENT = Approximation.MOST_RECENT


def every(period, **rest):
    """Return a policy of regular sampling."""
    return Policy(change=SampleEvery(ms(period)), **rest)


def recent(period, delay, start=0):
    """Return a policy of regular sampling with approximation."""
    return every(period, approximation=MOST_RECENT, max_delay=ms(delay), start=ms(start))


def running(samples, until, capacity=8):
    """Return a kernel with one source that has run for a while."""
    kernel = Kernel()
    kernel.add_source(A, GivenSource(samples))
    kernel.generator(A).capacity = capacity
    kernel.run(ms(until))
    return kernel


def told(kernel):
    """Return a list to which the kernel's violations are added."""
    violations = []
    kernel.subscribe_violations(lambda each: violations.append(each.violation.reason))
    return violations


def values(samples):
    """Return valid times in milliseconds and values."""
    return " ".join(f"{sample.valid_time // ms(1)}:{sample.value}" for sample in samples)


def test_a_stream_that_begins_in_the_past_is_served_from_the_cache():
    """What is held comes first, a nanosecond apart, then what arrives."""
    kernel, received = running("0:a 10:b 20:c 30:d 40:e", 25), []

    kernel.subscribe(A, received.append, Policy(start=ms(10)))
    kernel.run()

    assert text(received) == "10:b@25+1 20:c@25+2 30:d 40:e"


def test_samples_that_are_not_held_any_more_are_refused():
    """A stream that would lack its beginning is not made."""
    kernel = running("0:a 10:b 20:c 30:d 40:e", 45, capacity=3)

    with pytest.raises(PolicyNotSupportedError, match=r"begin at 10, .* only the last 3 are held"):
        kernel.subscribe(A, print, Policy(start=ms(10)))

    assert kernel.streams == ()
    kernel.subscribe(A, print, Policy(start=ms(11)))


def test_what_would_come_too_late_is_not_asked_for():
    """A stream of a maximal delay begins with what can still be in time."""
    kernel, received = running("0:a 10:b 20:c 30:d", 25, capacity=1), []
    violations = told(kernel)

    kernel.subscribe(A, received.append, Policy(start=ms(0), max_delay=ms(9)))
    kernel.run()

    assert text(received) == "20:c@25+1 30:d"
    assert violations == []


def test_an_approximated_stream_that_begins_late_knows_the_value_of_the_past():
    """The most recent value is known although it became available before the subscription."""
    kernel, received = running("0:a 7:b 90:c", 45, capacity=1), []
    violations = told(kernel)

    kernel.subscribe(A, received.append, recent(20, 10))
    kernel.run(ms(80))

    assert text(received) == "40:b@50 60:b@70"
    assert violations == []


def test_a_generator_without_a_past_can_be_subscribed_to_at_any_time():
    """What has never had a sample has lost none."""
    kernel, received = running("0:a", 45), []
    kernel.add_source(Label("b"), GivenSource("0:x 50:y"))

    kernel.subscribe(Label("b"), received.append, Policy(start=ms(0)))
    kernel.run()

    assert text(received) == "0:x@45+1 50:y"


def test_a_past_that_is_asked_for_within_an_instant_has_no_gap():
    """The sample that arrives in the same instant is part of the stream."""
    kernel, received = Kernel(), []
    kernel.add_source(A, GivenSource("0:a 10:b 20:c"))

    def subscribe(sample):
        if sample.value == "b":
            kernel.subscribe(Label("b"), received.append, Policy(start=ms(0)))

    class Repeating:
        def push(self, now, inputs):
            return [Sample(inputs[0].value, now, now)]

        def advance(self, now):
            return ()

        def due(self):
            return None

    kernel.subscribe(A, subscribe)
    kernel.add_unit(Label("b"), Repeating(), [(A, Policy())])
    kernel.run()

    assert text(received) == "0:a@10+1 10:b@10+2 20:c"


def test_live_samples_wait_for_those_of_the_past():
    """What arrives while older samples are handed on comes after them."""
    samples = [Sample(n, ms(10) * n, ms(10) * n) for n in range(5)]
    samples.append(Sample(5, ms(50), ms(40) + 2))
    samples.append(Sample(6, ms(60), ms(40) + 9))
    kernel, received = running(samples, 40), []

    kernel.subscribe(A, received.append, Policy(start=ms(0)))
    kernel.run()

    assert [sample.value for sample in received] == [0, 1, 2, 3, 4, 5, 6]
    assert [sample.available_time - ms(40) for sample in received] == [1, 2, 3, 4, 5, 6, 9]


@settings(derandomize=True, deadline=None, max_examples=150)
@given(streams(), st.integers(0, 210), st.sampled_from(Order), st.booleans())
def test_a_stream_with_its_past_has_the_samples_of_one_that_was_there(
    samples, begin, order, wants_change
):
    """Served from the cache or received when they came: the same samples in the same order."""
    changes = {"change": ANY_CHANGE} if wants_change else {}
    policy = Policy(start=ms(20), order=order, **changes)
    kernel, early, late = Kernel(), [], []
    kernel.add_source(A, GivenSource(samples))
    kernel.subscribe(A, early.append, policy)

    kernel.run(ms(begin))
    kernel.subscribe(A, late.append, policy)
    kernel.run()

    assert values(late) == values(early)
    assert is_fluent_stream(late)


def test_a_replaced_policy_goes_on_where_the_old_one_ends():
    """The grid of a sampled stream goes on from the last sample; the statistics do so too."""
    kernel, received = Kernel(), []
    kernel.add_source(A, GivenSource(" ".join(f"{10 * n}:{n}" for n in range(13))))
    violations = told(kernel)
    proxy = kernel.subscribe(A, received.append, every(10))

    kernel.run(ms(30))
    proxy.replace_policy(every(20))
    assert proxy.policy == every(20)
    kernel.run(ms(75))
    proxy.replace_policy(every(30))
    kernel.run()

    assert values(received) == "0:0 10:1 20:2 30:3 50:5 70:7 100:10"
    assert proxy.statistics.samples == len(received)
    assert violations == []


def test_a_stream_that_is_sampled_more_often_does_not_miss_what_was_left_out():
    """What the old policy has left out is over, and its absence no violation."""
    kernel, received = Kernel(), []
    kernel.add_source(A, GivenSource(" ".join(f"{10 * n}:{n}" for n in range(10))))
    violations = told(kernel)
    proxy = kernel.subscribe(A, received.append, every(40))

    kernel.run(ms(65))
    proxy.replace_policy(every(10))
    kernel.run()

    assert values(received) == "0:0 40:4 70:7 80:8 90:9"
    assert violations == []


def test_the_order_of_valid_times_goes_on():
    """After the change, too, no sample is older than the last one received."""
    kernel, received = Kernel(), []
    kernel.add_source(A, GivenSource("0:a 30:b 20:c@40 30:b@50 60:d"))
    proxy = kernel.subscribe(A, received.append, Policy(order=Order.MONOTONE))

    kernel.run(ms(35))
    proxy.replace_policy(Policy(order=Order.STRICT))
    kernel.run()

    assert values(received) == "0:a 30:b 60:d"
    assert (proxy.statistics.late, proxy.statistics.violations) == (2, 2)


def test_what_the_old_policy_has_held_back_is_not_lost():
    """A sample that waits for an earlier one is handed on under the new policy."""
    kernel, received = Kernel(), []
    kernel.add_source(A, GivenSource("0:a 20:c 40:e@60"))
    proxy = kernel.subscribe(A, received.append, every(10, max_delay=ms(25)))

    kernel.run(ms(22))
    assert values(received) == "0:a"
    proxy.replace_policy(every(20, max_delay=ms(25)))
    kernel.run()

    assert text(received) == "0:a 20:c@22+1 40:e@60"


def test_an_approximated_stream_can_be_sampled_differently():
    """No time is filled twice, and the value that held before the change is known."""
    kernel, received = Kernel(), []
    kernel.add_source(A, GivenSource("0:a 15:b 200:z"))
    violations = told(kernel)
    proxy = kernel.subscribe(A, received.append, recent(10, 0))

    kernel.run(ms(45))
    proxy.replace_policy(recent(20, 20))
    kernel.run(ms(110))
    proxy.replace_policy(Policy(order=Order.STRICT))
    kernel.run()

    assert text(received) == "0:a 10:a 20:b 30:b 40:b 60:b@80 80:b@100 200:z"
    assert violations == []


def test_a_stream_becomes_an_approximated_one():
    """What has become known before the change is what is approximated with."""
    kernel, received = Kernel(), []
    kernel.add_source(A, GivenSource("0:a 15:b 31:c 200:z"))
    proxy = kernel.subscribe(A, received.append)

    kernel.run(ms(32))
    proxy.replace_policy(recent(10, 5))
    kernel.run(ms(60))

    assert text(received) == "0:a 15:b 31:c 40:c@45 50:c@55"


def test_a_policy_is_replaced_when_the_instant_is_done():
    """Within an instant, the old policy is in force to the end."""
    kernel, received = Kernel(), []
    kernel.add_source(A, GivenSource("0:a 10:b 20:c"))

    def receive(sample):
        received.append(sample)
        proxy.replace_policy(Policy(end=ms(10)))
        proxy.replace_policy(Policy(end=ms(15)))

    proxy = kernel.subscribe(A, receive)
    kernel.run()

    assert text(received) == "0:a 10:b"
    assert proxy.policy == Policy(end=ms(15))


def test_a_policy_that_the_process_does_not_promise_is_refused():
    """Neither a new stream nor a replaced policy may ask for more than there is."""
    kernel = Kernel()
    kernel.add_source(A, GivenSource("0:a"), output_policy=every(100))
    proxy = kernel.subscribe(A, print, every(200))

    for ask in (
        lambda: kernel.subscribe(A, print, every(50)),
        lambda: proxy.replace_policy(every(50)),
        lambda: kernel.add_unit(Label("b"), object(), [(A, every(50))]),
    ):
        with pytest.raises(PolicyNotSupportedError, match="'a' does not support the policy"):
            ask()

    assert kernel.labels == (A,)
    assert [each.policy for each in kernel.streams] == [every(200)]


def test_a_unit_whose_past_is_lost_is_not_added():
    """A unit is added with all its inputs or not at all."""
    kernel = running("0:a 10:b 20:c", 30, capacity=1)

    class Idle:
        def due(self):
            return None

    with pytest.raises(PolicyNotSupportedError):
        kernel.add_unit(Label("b"), Idle(), [(A, Policy()), (A, Policy(start=ms(0)))])

    assert kernel.labels == (A,)
    assert kernel.streams == ()


def test_a_late_receiver_hears_the_last_heartbeat():
    """What a generator has promised holds for those who come later."""
    kernel, heard = Kernel(), []
    source = [*stream("0:a"), Heartbeat(ms(7), ms(5)), *stream("20:b")]
    kernel.add_source(A, GivenSource([*source, Heartbeat(END_OF_TIME, ms(20))]))

    kernel.run(ms(10))
    kernel.subscribe(A, lambda sample: None, beat=heard.append)
    kernel.run()

    assert heard == [Heartbeat(ms(7), ms(10) + 1), Heartbeat(END_OF_TIME, ms(20))]


@settings(derandomize=True, deadline=None, max_examples=200)
@given(
    streams(),
    st.lists(
        st.tuples(
            st.integers(1, 220),
            st.sampled_from(
                [
                    Policy(order=Order.STRICT),
                    Policy(order=Order.STRICT, max_delay=ms(50)),
                    every(10),
                    every(20, max_delay=ms(50)),
                    recent(10, 30),
                    recent(20, 0, start=10),
                ]
            ),
        ),
        max_size=5,
    ),
)
def test_through_all_changes_a_stream_of_strict_order_stays_one(samples, changes):
    """Whatever policies follow each other: available times are unique, valid times in order."""
    kernel, received = Kernel(), []
    kernel.add_source(A, GivenSource(samples))
    proxy = kernel.subscribe(A, received.append, Policy(order=Order.STRICT))

    for time, policy in sorted(changes, key=lambda change: change[0]):
        kernel.run(ms(time))
        proxy.replace_policy(policy)
    kernel.run(ms(300))

    assert is_fluent_stream(received)
    times = [sample.valid_time for sample in received]
    assert times == sorted(set(times))
    assert proxy.statistics.samples == len(received)
    assert proxy.statistics.mean_delay == (
        round(sum(sample.delay for sample in received) / len(received)) if received else 0
    )

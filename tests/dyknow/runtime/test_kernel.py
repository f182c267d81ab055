"""The kernel gives every process its turn, in a defined order."""

from itertools import pairwise, permutations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from dyknow.errors import ProcessError
from dyknow.runtime.generators import Label
from dyknow.runtime.kernel import Kernel
from dyknow.streams.policy import Approximation, Order, Policy, SampleEvery
from dyknow.streams.sample import Heartbeat, Sample
from dyknow.streams.stream import is_fluent_stream, join
from dyknow.streams.synchronisation import Synchronisation
from tests.support.policies import streams
from tests.support.streams import GivenSource, ms, stream, text

ANYTHING = Policy()


class Joining:
    """Emits the values of its inputs as one word, with a delay."""

    def __init__(self, delay=0):
        self.delay = delay
        self.calls = []

    def push(self, now, inputs):
        """Emit one sample."""
        self.calls.append(now)
        word = "".join(str(sample.value or "-") for sample in inputs)
        yield Sample(word, now, now + self.delay)

    def advance(self, now):
        """Emit nothing."""
        return ()

    def due(self):
        """Return no deadline."""


class Alarm:
    """Emits `!` a while after the last input."""

    def __init__(self, after):
        self.after = after
        self.at = None

    def push(self, now, inputs):
        """Set the alarm."""
        self.at = now + self.after
        return ()

    def advance(self, now):
        """Ring."""
        if self.at is not None and self.at <= now:
            yield Sample("!", self.at, now)
            self.at = None

    def due(self):
        """Return when the alarm rings."""
        return self.at


def network(*, sources=None, units=None):
    """Return a kernel and a dictionary that collects the samples of every generator."""
    kernel = Kernel()
    collected = {}
    for label, given_stream in (sources or {}).items():
        kernel.add_source(Label(label), GivenSource(given_stream))
    for label, (unit, *inputs) in (units or {}).items():
        named = [(i, ANYTHING) if isinstance(i, str) else i for i in inputs]
        kernel.add_unit(Label(label), unit, named)
    for label in kernel.labels:
        kernel.subscribe(label, collected.setdefault(label, []).append)
    return kernel, collected


def test_a_unit_is_called_once_per_instant_with_all_that_is_new():
    """Two inputs that change at once are one call; an input without a sample is NO_SAMPLE."""
    kernel, collected = network(
        sources={"a": "0:a 10:b", "b": "10:x 20:y"}, units={"ab": (Joining(), "a", "b")}
    )

    kernel.run()

    assert text(collected["ab"]) == "0:a- 10:bx 20:by"


@settings(derandomize=True, deadline=None, max_examples=100)
@given(streams(), streams())
def test_a_unit_sees_the_join_of_its_inputs(one, other):
    """What a unit is called with is definition 4.3.16, whatever the streams are."""
    kernel, collected = network(
        sources={"a": one, "b": other}, units={"ab": (Joining(), "a", "b")}
    )

    kernel.run()

    expected = [
        "".join(str(getattr(s, "value", s) or "-") for s in joined.value)
        for joined in join(one, other)
    ]
    assert [sample.value for sample in collected["ab"]] == expected


def test_a_diamond_is_joined_at_its_lower_end():
    """A process has its turn after everything that feeds it, however long the ways are."""
    units = {
        "left": (Joining(), "a"),
        "longer": (Joining(), "left"),
        "both": (Joining(), "longer", "a"),
    }
    kernel, collected = network(sources={"a": "0:a 10:b"}, units=units)

    kernel.run()

    assert text(collected["both"]) == "0:aa 10:bb"


@settings(derandomize=True, deadline=None, max_examples=60)
@given(streams(), streams(), streams())
def test_the_order_of_declaration_changes_nothing(one, two, three):
    """Whatever the order in which sources are added, every stream is the same."""
    given_streams = {"a": one, "b": two, "c": three}
    results = []
    for order in permutations(given_streams):
        units = {
            "ab": (Joining(), "a", "b"),
            "all": (Joining(delay=ms(5)), "ab", "c", ("a", Policy(order=Order.STRICT))),
            "late": (Alarm(ms(25)), "all"),
            "states": (Synchronisation("ac"), "a", "c"),
        }
        kernel, collected = network(
            sources={name: given_streams[name] for name in order}, units=units
        )
        kernel.run(until=ms(500))
        results.append({label: repr(samples) for label, samples in collected.items()})

    assert all(result == results[0] for result in results)


@settings(derandomize=True, deadline=None, max_examples=60)
@given(streams(), st.integers(0, 3))
def test_every_stream_is_a_fluent_stream(one, delay):
    """Available times are unique and in order, whatever a unit answers."""
    kernel, collected = network(
        sources={"a": one}, units={"b": (Joining(ms(delay)), "a"), "c": (Joining(), "b", "a")}
    )

    kernel.run()

    assert all(is_fluent_stream(samples) for samples in collected.values())


def test_the_later_of_two_samples_at_one_instant_gets_the_next_nanosecond():
    """No stream has two samples with one available time."""

    class Twice(Joining):
        def push(self, now, inputs):
            return [Sample(1, now, now), Sample(2, now, now)]

    kernel, collected = network(
        sources={"a": "0:a"}, units={"b": (Twice(), "a"), "c": (Joining(), "b")}
    )

    kernel.run()

    assert text(collected["b"]) == "0:1 0:2@0+1"
    assert [sample.value for sample in collected["c"]] == ["1", "2"]


def test_a_sample_that_needs_time_is_delivered_when_it_is_available():
    """A unit may say that its answer takes a while; receivers see it then."""
    kernel, collected = network(
        sources={"a": "0:a 10:b"}, units={"b": (Joining(ms(7)), "a"), "c": (Joining(), "b")}
    )

    kernel.run()

    assert text(collected["b"]) == "0:a@7 10:b@17"
    assert text(collected["c"]) == "7:a 17:b"


def test_alarms_ring_when_they_are_due_and_after_arrivals():
    """A sample at the deadline postpones the alarm's effect; one later does not."""
    policy = Policy(
        approximation=Approximation.MOST_RECENT,
        change=SampleEvery(ms(10)),
        max_delay=ms(0),
        start=ms(0),
    )
    kernel, collected = network(
        sources={"a": "0:a 8:b 10:c 15:d"},
        units={"rings": (Alarm(ms(6)), "a"), "sampled": (Joining(), ("a", policy))},
    )

    kernel.run(until=ms(30))

    assert text(collected["sampled"]) == "0:a 10:c 20:d 30:d"
    assert text(collected["rings"]) == "6:! 21:!"
    assert kernel.now == ms(30)


def test_without_an_end_the_run_ends_with_the_sources():
    """Alarms after the last sample would go on for ever, and do not ring."""
    kernel, collected = network(sources={"a": "0:a 5:b"}, units={"r": (Alarm(ms(3)), "a")})

    kernel.run()

    assert text(collected["r"]) == "3:!"
    assert kernel.now == ms(5)


def test_a_run_can_be_continued_and_stopped():
    """Two runs one after the other are one run; `stop` ends after the current instant."""
    kernel, collected = network(sources={"a": "0:a 5:b 9:c"}, units={"j": (Joining(), "a")})

    kernel.run(until=ms(5))
    assert text(collected["j"]) == "0:a 5:b"
    kernel.run()
    assert text(collected["j"]) == "0:a 5:b 9:c"

    kernel, collected = network(sources={"a": "0:a 5:b 9:c"}, units={"j": (Joining(), "a")})
    kernel.subscribe(Label("a"), lambda sample: kernel.stop() if sample.value == "b" else None)
    kernel.run(until=ms(100))
    assert text(collected["j"]) == "0:a 5:b"
    assert kernel.now == ms(5)


def test_progress_is_told_instant_by_instant():
    """The callback sees each instant once, in order, before its work begins."""
    kernel, collected = network(sources={"a": "0:a 5:b", "b": "5:c"})
    seen = []

    kernel.run(on_time=lambda now: seen.append((now, len(collected["a"]))))

    assert seen == [(ms(0), 0), (ms(5), 1)]


def test_sources_are_read_lazily():
    """A source is asked for its next sample when all that follows from the last is done."""
    log = []

    class Asked:
        def samples(self):
            for at in (0, 5):
                log.append(f"asked for {at}")
                yield Sample(at, ms(at), ms(at))

    class Logging(Joining):
        def push(self, now, inputs):
            log.append(f"worked at {now // ms(1)}")
            return ()

    kernel = Kernel()
    kernel.add_source(Label("a"), Asked())
    kernel.add_unit(Label("b"), Logging(), [(Label("a"), ANYTHING)])

    kernel.run()

    assert log == ["asked for 0", "worked at 0", "asked for 5", "worked at 5"]


def test_a_failing_process_is_named():
    """The error says which process failed and when, with the cause attached."""

    class Failing(Joining):
        def push(self, now, inputs):
            if now:
                raise ZeroDivisionError
            return ()

    kernel, _ = network(sources={"a": "0:a 5:b"}, units={"bad": (Failing(), "a")})

    with pytest.raises(ProcessError, match="process 'bad' failed at 5 ms") as caught:
        kernel.run()

    assert isinstance(caught.value.__cause__, ZeroDivisionError)
    assert (caught.value.label, caught.value.time) == ("bad", ms(5))


def test_a_source_that_goes_back_in_time_is_an_error():
    """Samples of a source come in order of available time."""
    kernel, _ = network(sources={"a": stream("5:a 3:b")})

    with pytest.raises(ProcessError) as caught:
        kernel.run()

    assert str(caught.value.__cause__) == "the source went back in time, from 5 to 3 ms"


def test_a_unit_whose_alarm_never_stops_is_an_error():
    """After `advance` a unit must not be due at the same time again."""

    class Stuck(Joining):
        def due(self):
            return ms(5)

    kernel, _ = network(sources={"a": "9:a"}, units={"stuck": (Stuck(), "a")})

    with pytest.raises(ProcessError, match="'stuck' failed at 5 ms"):
        kernel.run()


def test_accounts_count_calls_samples_time_and_violations():
    """Each process has an account; what time means is up to the meter."""
    ticks = iter(range(1000))
    kernel = Kernel(meter=lambda: float(next(ticks)))
    kernel.add_source(Label("a"), GivenSource("0:a 5:b 3:c@6"))
    kernel.add_unit(Label("b"), Joining(), [(Label("a"), Policy(order=Order.STRICT))])

    kernel.run()

    accounts = kernel.accounts
    assert (accounts["a"].calls, accounts["a"].samples) == (4, 3)
    assert (accounts["b"].calls, accounts["b"].samples) == (2, 2)
    assert accounts["a"].seconds == 4
    assert accounts["b"].seconds == 2
    assert accounts["b"].violations == 1


def test_violations_are_published_with_the_stream_they_happened_in():
    """Whoever asks is told, of input streams, of outputs, and of units that report themselves."""
    kernel = Kernel()
    kernel.add_source(Label("a"), GivenSource("5:a 3:b@6"))
    kernel.add_source(Label("b"), GivenSource("5:a 9:b"))
    kernel.add_unit(Label("j"), Joining(), [(Label("a"), Policy(order=Order.STRICT))])
    ab = [(Label("a"), ANYTHING), (Label("b"), ANYTHING)]
    kernel.add_unit(Label("sync"), Synchronisation("ab"), ab)
    kernel.subscribe(Label("a"), lambda sample: None, Policy(max_delay=ms(1)))
    told = []
    kernel.subscribe_violations(told.append)

    kernel.run()

    assert {(each.provider, each.receiver) for each in told} == {
        ("a", "j"),
        ("a", "output"),
        ("sync", "sync"),
    }


def test_a_subscription_can_be_ended():
    """After the end nothing more is received, and others are not affected."""
    kernel, collected = network(sources={"a": "0:a 5:b"})
    received = []
    end = kernel.subscribe(Label("a"), received.append)

    kernel.run(until=ms(1))
    end.end()
    kernel.run()

    assert text(received) == "0:a"
    assert text(collected["a"]) == "0:a 5:b"


def test_the_alarms_of_an_ended_subscription_are_silent():
    """A sampled stream without a receiver makes and publishes nothing more."""
    policy = Policy(
        approximation=Approximation.MOST_RECENT,
        change=SampleEvery(ms(10)),
        max_delay=ms(0),
        start=ms(0),
    )
    kernel, _ = network(sources={"a": "0:a"})
    received = []
    end = kernel.subscribe(Label("a"), received.append, policy)

    kernel.run(until=ms(15))
    end.end()
    kernel.run(until=ms(50))

    assert text(received) == "0:a 10:a"


def test_what_a_policy_has_held_back_is_delivered_at_the_end():
    """Samples that wait for the next nanosecond are not lost when the sources end."""
    policy = Policy(change=SampleEvery(ms(100)), max_delay=ms(150), end=ms(200))
    kernel, _ = network(sources={"a": "0:a 200:c 100:b@240"})
    received = []
    kernel.subscribe(Label("a"), received.append, policy)

    kernel.run()

    assert text(received) == "0:a 100:b@240 200:c@240+1"


def test_a_run_delivers_what_its_last_instant_has_produced():
    """A sample that gets a later nanosecond only because it is the second one is not left over."""

    class Thrice(Joining):
        def push(self, now, inputs):
            return [Sample(n, now, now) for n in range(3)]

    kernel, collected = network(
        sources={"a": "0:a 10:b 10:c 20:d"},
        units={"b": (Thrice(), "a"), "c": (Joining(delay=1), "b"), "d": (Joining(), "b")},
    )

    kernel.run(until=ms(10))

    assert text(collected["a"]) == "0:a 10:b 10:c@10+1"
    assert len(collected["b"]) == len(collected["d"]) == 9
    assert len(collected["c"]) == 8
    assert kernel.now == ms(10) + 5
    kernel.run(until=ms(11))
    assert len(collected["c"]) == 9
    assert kernel.now == ms(11)


def test_heartbeats_reach_those_who_listen():
    """Ordinary units never see one; what they hold up comes after the samples before it."""

    class Hearing(Joining):
        def __init__(self):
            super().__init__()
            self.heard = []

        def beat(self, now, at, heartbeat):
            self.heard.append((now, at, heartbeat.until))
            return [Heartbeat(heartbeat.until, now)]

    hearing, joining, heard = Hearing(), Joining(), []
    source = [*stream("0:a"), Heartbeat(ms(4), ms(5)), *stream("10:b"), Heartbeat(ms(20), ms(10))]
    kernel = Kernel()
    kernel.add_source(Label("a"), GivenSource(source))
    kernel.add_source(Label("b"), GivenSource("10:x"))
    inputs = [(Label("b"), ANYTHING), (Label("a"), Policy(order=Order.STRICT))]
    kernel.add_unit(Label("hearing"), hearing, inputs)
    kernel.add_unit(Label("joining"), joining, [(Label("hearing"), ANYTHING)])
    kernel.subscribe(Label("hearing"), lambda sample: None, beat=heard.append)

    kernel.run()

    assert hearing.heard == [(ms(5), 1, ms(4)), (ms(10), 1, ms(20))]
    assert hearing.calls == joining.calls == [ms(0), ms(10)]
    assert heard == [Heartbeat(ms(4), ms(5)), Heartbeat(ms(20), ms(10))]
    assert kernel.generator(Label("a")).statistics.heartbeats == 2


def test_an_input_that_is_added_later_makes_its_unit_deeper():
    """The unit, and all after it, are still called once per instant, with all that is new."""
    units = {"far": (Joining(), "a"), "farther": (Joining(), "far"), "near": (Joining(), "a")}
    kernel, collected = network(
        sources={"a": "0:a 10:b 20:c"}, units=units | {"last": (Joining(), "near")}
    )

    kernel.run(until=ms(5))
    given = kernel.add_input(Label("near"), Label("farther"))
    kernel.run(until=ms(15))
    kernel.remove_input(given)
    kernel.run()

    assert text(collected["near"]) == "0:a 10:bb 20:c-"
    assert text(collected["last"]) == "0:a 10:bb 20:c-"
    assert [kernel.processes[label].depth for label in kernel.labels] == [0, 1, 2, 3, 4]
    kernel.add_input(Label("near"), Label("far"))
    with pytest.raises(ValueError, match="'last' depends on 'far'"):
        kernel.add_input(Label("far"), Label("last"))


def test_labels_must_be_known_and_new():
    """A generator is added once, after those that feed it."""
    kernel, _ = network(sources={"a": "0:a"})

    with pytest.raises(ValueError, match="called 'a' already"):
        kernel.add_source(Label("a"), GivenSource(""))
    with pytest.raises(ValueError, match="no stream generator called 'x'"):
        kernel.add_unit(Label("b"), Joining(), [(Label("x"), ANYTHING)])
    with pytest.raises(ValueError, match="no stream generator called 'x'"):
        kernel.subscribe(Label("x"), print)


@settings(derandomize=True, deadline=None, max_examples=60)
@given(streams(), st.integers(1, 40))
def test_stopping_and_going_on_changes_nothing(one, step):
    """A run in pieces gives the same streams as a run in one piece."""
    units = {"j": (Joining(ms(3)), "a"), "r": (Alarm(ms(25)), "j")}
    whole, of_whole = network(sources={"a": one}, units=units)
    whole.run(until=ms(300))

    units = {"j": (Joining(ms(3)), "a"), "r": (Alarm(ms(25)), "j")}
    pieces, of_pieces = network(sources={"a": one}, units=units)
    for begin, _ in pairwise(range(0, 301 + step, step)):
        pieces.run(until=ms(min(begin, 300)))
    pieces.run(until=ms(300))

    assert repr(of_whole) == repr(of_pieces)

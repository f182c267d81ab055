"""A process that fails stops the network or ends, and everybody is told."""

import traceback

import pytest

from dyknow.errors import ProcessError
from dyknow.runtime.failures import OnFailure
from dyknow.runtime.generators import Label
from dyknow.runtime.kernel import Kernel
from dyknow.streams.policy import Approximation, Policy, SampleEvery
from dyknow.streams.sample import END_OF_TIME, Heartbeat, Sample
from tests.support.streams import GivenSource, ms, text

A, B, C = Label("a"), Label("b"), Label("c")
ANYTHING = Policy()


class FailingAt:
    """Repeats its input until a time, at which it fails."""

    def __init__(self, time):
        self.time = time

    def push(self, now, inputs):
        """Repeat or fail."""
        if now == self.time:
            raise ZeroDivisionError("division by zero")
        return [Sample(inputs[0].value, now, now)]

    def advance(self, now):
        """Say nothing."""
        return ()

    def due(self):
        """Wait for nothing."""


class Repeating(FailingAt):
    """Repeats its input."""

    def __init__(self):
        super().__init__(None)


def failing_network(on_failure, *, hears=()):
    """Return a kernel with a unit that fails at 10 ms, and what its neighbours receive."""
    kernel, received = Kernel(), {label: [] for label in (A, B, C)}
    kernel.add_source(A, GivenSource("0:a 10:b 20:c"))
    kernel.add_source(Label("x"), GivenSource("5:x"))
    inputs = [(A, ANYTHING), (Label("x"), ANYTHING)]
    kernel.add_unit(B, FailingAt(ms(10)), inputs, on_failure=on_failure)
    kernel.add_unit(C, Repeating(), [(A, ANYTHING)])
    for label, collected in received.items():
        beat = collected.append if label in hears else None
        kernel.subscribe(label, collected.append, beat=beat)
    return kernel, received


def test_a_failure_names_the_process_the_instant_and_the_samples():
    """The error says what went wrong, where and with what, and keeps the traceback."""
    kernel, _ = failing_network(OnFailure.STOP)

    with pytest.raises(ProcessError) as caught:
        kernel.run()

    error = caught.value
    assert str(error) == (
        "process 'b' failed at 10 ms: ZeroDivisionError: division by zero, "
        "given 'a' valid at 10, available at 10, 'x' valid at 5, available at 5"
    )
    assert (error.label, error.time) == (B, ms(10))
    assert [(label, sample.value) for label, sample in error.inputs] == [("a", "b"), ("x", "x")]
    assert "in push" in "".join(traceback.format_tb(error.__cause__.__traceback__))


def test_a_process_may_end_and_the_rest_goes_on():
    """The failed process gives nothing more, its inputs end, and the others are not affected."""
    kernel, received = failing_network(OnFailure.END, hears=[B])
    failures = []
    kernel.subscribe_failures(failures.append)

    kernel.run()

    assert text(received[A]) == "0:a 10:b 20:c"
    assert text(received[C]) == "0:a 10:b 20:c"
    assert text(received[B][:-1]) == "0:a 5:a"
    assert received[B][-1] == Heartbeat(END_OF_TIME, ms(10))
    (failure,) = failures
    assert (failure.label, failure.time) == (B, ms(10))
    assert isinstance(failure.error, ZeroDivisionError)
    process = kernel.processes[B]
    assert process.has_ended
    assert process.failure is failure
    assert process.account.failures == 1
    assert [proxy.receiver for proxy in kernel.streams if proxy.number] == [C]


def test_a_failure_is_told_before_the_network_stops():
    """Who has subscribed to failures learns of those that stop the network as well."""
    kernel, _ = failing_network(OnFailure.STOP)
    told = []
    end = kernel.subscribe_failures(told.append)
    end()
    kernel.subscribe_failures(lambda failure: told.append(failure.label))

    with pytest.raises(ProcessError):
        kernel.run()

    assert told == [B]


def test_a_source_that_fails_can_end():
    """What it has produced is delivered, and a run without an end does not wait for it."""

    class Breaking:
        def samples(self):
            yield Sample("a", ms(0), ms(0))
            yield Sample("b", ms(0), ms(0))
            raise OSError("the wire is cut")

    kernel, received, failures = Kernel(), [], []
    kernel.add_source(A, Breaking(), on_failure=OnFailure.END)
    kernel.subscribe(A, received.append)
    kernel.subscribe_failures(failures.append)

    kernel.run()

    assert text(received) == "0:a 0:b@0+1"
    assert [failure.text for failure in failures] == ["OSError: the wire is cut"]
    assert kernel.processes[A].has_ended


def test_a_source_that_goes_back_in_time_can_end():
    """The samples before are kept; the one from the past is not delivered."""
    kernel, received = Kernel(), []
    kernel.add_source(A, GivenSource("5:a 3:b 9:c"), on_failure=OnFailure.END)
    kernel.subscribe(A, received.append)

    kernel.run(ms(20))

    assert text(received) == "5:a"
    assert "back in time, from 5 to 3 ms" in kernel.processes[A].failure.text


@pytest.mark.parametrize(
    ("produced", "reason"),
    [
        ([None], "expected a sample or a heartbeat, found None"),
        (
            [Heartbeat(ms(7), ms(5)), Sample("late", ms(7), ms(5))],
            "a sample valid at 7 after the promise of none up to 7",
        ),
        (3, "'int' object is not iterable"),
    ],
)
def test_what_a_process_may_not_produce_is_its_failure(produced, reason):
    """Something that is no sample, and a sample against a promise, are told where they arise."""

    class Producing(Repeating):
        def push(self, now, inputs):
            return produced

    kernel = Kernel()
    kernel.add_source(A, GivenSource("5:a"))
    kernel.add_unit(B, Producing(), [(A, ANYTHING)])

    with pytest.raises(ProcessError, match="process 'b' failed at 5 ms") as caught:
        kernel.run()

    assert reason in str(caught.value)


def test_a_run_can_go_on_after_a_failure():
    """The rest of the instant is worked on by the next run, and nothing is done twice."""
    kernel, received = failing_network(OnFailure.STOP)

    with pytest.raises(ProcessError):
        kernel.run()
    kernel.run()

    assert text(received[A]) == "0:a 10:b 20:c"
    assert text(received[C]) == "0:a 10:b 20:c"
    assert text(received[B]) == "0:a 5:a 20:c"


def test_a_source_that_has_stopped_the_network_is_not_waited_for():
    """Alarms that would ring for ever do not keep a later run without an end going."""
    kernel = Kernel()
    kernel.add_source(A, GivenSource("5:a 3:b"))
    policy = Policy(
        approximation=Approximation.MOST_RECENT,
        change=SampleEvery(ms(10)),
        max_delay=ms(0),
        start=ms(0),
    )
    kernel.subscribe(A, lambda sample: None, policy)

    with pytest.raises(ProcessError, match="back in time"):
        kernel.run()
    kernel.run()

    assert kernel.now == ms(5)
    assert kernel.processes[A].has_ended

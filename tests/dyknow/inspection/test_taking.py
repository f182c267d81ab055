"""A snapshot says of a network what the network says of itself, also while it runs."""

from itertools import pairwise

from hypothesis import given, settings
from hypothesis import strategies as st

from dyknow.inspection.snapshot import Kind, Snapshot
from dyknow.inspection.taking import snapshot
from dyknow.kpl.parser import parse_specification
from dyknow.kpl.plan import Implementations, Network, build_network
from dyknow.runtime.failures import OnFailure
from dyknow.runtime.generators import Label
from dyknow.runtime.kernel import Kernel
from dyknow.streams.policy import Order, Policy
from dyknow.streams.process import Reactive
from dyknow.streams.sample import Sample
from dyknow.time import SECOND, Duration, TimePoint
from tests.support.policies import streams
from tests.support.streams import GivenSource, ms

TEXT = """
source int src
compunit int Copy(int)
strmgen numbers = src
strmgen copies = Copy(numbers with strict order)
stream copies = copies
stream ordered = numbers with max delay 100, monotone order
"""


class Copy(Reactive):
    """Emits its input again, and fails at the value `x`."""

    def push(self, now, inputs):
        """Emit the input."""
        if inputs[0].value == "x":
            raise ValueError("x")
        return [Sample(inputs[0].value, inputs[0].valid_time, now)]


def network(samples: str) -> Network:
    """Return a network of a source, a copy of it, and two outputs."""
    implementations = Implementations(
        sources={"src": lambda: GivenSource(samples)}, units={"Copy": Copy}
    )
    return build_network(parse_specification(TEXT), implementations)


def test_a_network_that_has_not_run_has_no_figures():
    """Before a run, processes and their inputs are there, and nothing is counted."""
    taken = snapshot(network("0:a"))

    assert [(p.label, p.kind, p.depth) for p in taken.processes] == [
        ("numbers", Kind.SOURCE, 0),
        ("copies", Kind.UNIT, 1),
    ]
    assert [p.text for p in taken.processes] == ["src", "Copy(numbers with strict order)"]
    [stream] = taken.streams
    assert (stream.provider, stream.receiver, stream.number) == ("numbers", "copies", 1)
    assert stream.policy == "strict order"
    assert (stream.samples, stream.rate, stream.mean_delay) == (0, None, None)
    assert taken.outputs == ("copies", "ordered")


def test_a_network_that_has_run_tells_what_happened():
    """After a run, samples, rates, delays, violations and caches are those of the run."""
    running = network("0:a 100:b@150 50:c@300 400:d")
    running.subscribe("ordered", lambda sample: None)

    running.kernel.run()
    taken = snapshot(running)

    [copies] = taken.inputs_of("copies")
    assert (copies.samples, copies.violations, copies.late) == (3, 1, 1)
    assert copies.rate == 5.0
    assert copies.mean_delay == round(ms(50) / 3)
    [ordered] = [stream for stream in taken.streams if stream.is_output]
    assert (ordered.name, ordered.policy) == ("output/ordered", "max delay 100, monotone order")
    assert (ordered.samples, ordered.violations) == (3, 1)
    numbers, copy = taken.processes
    assert (numbers.samples, copy.samples, copy.calls) == (4, 3, 3)
    assert (numbers.cached, copy.cached) == (4, 3)
    assert numbers.cache_limit is not None
    assert copy.violations == 1
    assert taken.now == ms(400)


def test_a_failure_is_counted():
    """A process that was allowed to end is shown with its failure."""
    kernel = Kernel()
    kernel.add_source(Label("a"), GivenSource("0:x 100:y"))
    kernel.add_unit(Label("b"), Copy(), [(Label("a"), Policy())], on_failure=OnFailure.END)

    kernel.run()

    failed = snapshot(kernel).processes[1]
    assert (failed.failures, failed.on_failure) == (1, "end")


def test_a_running_network_can_be_watched():
    """Taken at each instant of a run, snapshots add up to the whole."""
    running = network("0:a 1000:b 2000:c 3000:d")
    looks: list[Snapshot] = []

    def look(now: TimePoint) -> None:
        if now % SECOND == 0:
            looks.append(snapshot(running))

    running.kernel.run(on_time=look)
    looks.append(snapshot(running))

    assert [look.now for look in looks] == [ms(1000 * n) for n in (0, 1, 2, 3, 3)]
    between = [later.since(earlier) for earlier, later in pairwise(looks)]
    assert [part.processes[0].samples for part in between] == [1, 1, 1, 1]
    assert between[1].inputs_of("copies")[0].rate == 1.0


@settings(derandomize=True, deadline=None, max_examples=40)
@given(streams(), st.sampled_from(Order))
def test_figures_are_those_of_the_samples(samples, order):
    """Number, rate, mean delay and 99 % are what the samples that were handed on say."""
    kernel = Kernel()
    kernel.add_source(Label("a"), GivenSource(list(samples)))
    received: list[Sample] = []
    kernel.subscribe(Label("a"), received.append, Policy(order=order))

    kernel.run()

    [figures] = snapshot(kernel).streams
    delays = sorted(sample.delay for sample in received)
    assert figures.samples == len(received)
    assert figures.samples + figures.violations == len(samples)
    if received:
        assert figures.mean_delay == Duration(round(sum(delays) / len(delays)))
        least = delays[min(len(delays) - 1, round(0.99 * len(delays)))]
        assert figures.delay_99 >= min(least, delays[-1]) - 1


def test_what_kpl_knows_has_a_name():
    """Kinds of processes, and all outputs, are called as in the description of the network."""
    text = """
    source int src
    strmgen one = src
    strmgen two = src
    strmgen both = merge(one, two)
    stream both = both
    stream states = sync(one, two)
    stream again = both
    """
    sources = {"src": lambda: GivenSource("0:a")}

    built = build_network(parse_specification(text), Implementations(sources=sources))
    for output in built.outputs:
        built.subscribe(output, lambda sample: None)

    taken = snapshot(built)

    kinds = {process.label: process.kind for process in taken.processes}
    assert kinds["both"] is Kind.MERGING
    assert kinds["sync(one, two)"] is Kind.SYNCHRONISATION
    names = [stream.receiver for stream in taken.streams if stream.is_output]
    assert sorted(names) == ["again", "both", "states"]

"""Judging executions of small networks."""

from dataclasses import replace
from typing import Any

from hypothesis import assume, given, settings
from hypothesis import strategies as st

from dyknow.judging.judge import judge
from dyknow.judging.judgement import Basis
from dyknow.judging.terms import may_vary
from dyknow.streams.merging import Merge
from dyknow.streams.policy import Policy, SampleEvery
from dyknow.streams.sample import Heartbeat, Sample
from dyknow.time import Duration, TimePoint
from tests.dyknow.judging.units import Counting, Hearing, Late, Pairs, Ticking
from tests.support.laws import same_streams
from tests.support.mutations import MUTATIONS, Mutation
from tests.support.policies import approximating_policies, heartbeats, policies, streams
from tests.support.small_networks import SmallNetwork
from tests.support.streams import ms, stream

_UNITS = {
    "pairs": (Pairs, 2),
    "counting": (Counting, 2),
    "hearing": (Hearing, 2),
    "late": (Late, 1),
    "ticking": (Ticking, 1),
    "merge": (lambda: Merge(2), 2),
}


@st.composite
def sources_of(
    draw: st.DrawFn, streams: st.SearchStrategy[list[Sample[Any]]]
) -> list[Sample[Any] | Heartbeat]:
    """Draw streams with heartbeats between the samples."""
    samples = draw(streams)
    return sorted([*samples, *draw(heartbeats(samples))], key=_moment)


def _moment(element: Sample[Any] | Heartbeat) -> tuple[TimePoint, bool]:
    return element.available_time, isinstance(element, Heartbeat)


@st.composite
def networks(draw: st.DrawFn) -> SmallNetwork:
    """Draw networks of small units with random policies."""
    sources = {f"source{n}": draw(sources_of(streams())) for n in range(draw(st.integers(1, 2)))}
    labels = list(sources)
    units = {}
    for at in range(draw(st.integers(1, 4))):
        kind = draw(st.sampled_from(sorted(_UNITS)))
        make, n_inputs = _UNITS[kind]
        terms = [
            (draw(st.sampled_from(labels)), draw(policies() | approximating_policies()))
            for _ in range(n_inputs)
        ]
        units[f"{kind}{at}"] = (make, terms)
        labels.append(f"{kind}{at}")
    policy = draw(policies() | approximating_policies() | st.just(Policy()))
    outputs = {"all": (labels[-1], policy)}
    return SmallNetwork(sources, units, outputs)


@settings(derandomize=True, deadline=None, max_examples=80)
@given(networks(), st.integers(0, 25))
def test_what_the_kernel_does_is_correct(network: SmallNetwork, end: int) -> None:
    """Whatever network the kernel runs, the execution satisfies what was declared."""
    judgement = judge(network.declared(), network.run(ms(10 * end)))

    assert judgement.breaches == ()


@settings(derandomize=True, deadline=None, max_examples=150)
@given(networks(), st.sampled_from(MUTATIONS), st.data())
def test_whatever_happens_to_a_stream_is_found(
    network: SmallNetwork, mutation: Mutation, data: st.DataObject
) -> None:
    """A stream of a unit, an adapted stream, or an output that was altered is named.

    Of a stream whose period may be longer under load, samples may be missing.
    """
    execution = network.run(ms(300))
    declared = network.declared()
    inputs = [each for process in declared.processes.values() for each in process.inputs]
    lenient = {each.topic for each in (*inputs, *declared.outputs) if may_vary(each.policy)}
    samples = {
        topic: [each for each in elements if isinstance(each, Sample)]
        for topic, elements in execution.streams.items()
        if topic not in network.sources and topic not in lenient
    }
    topic = data.draw(st.sampled_from(sorted(samples)))
    place = data.draw(st.integers(0, max(0, len(samples[topic]) - 1)))
    altered = mutation(samples[topic], place) if samples[topic] else []
    assume(not same_streams(altered, samples[topic]))
    spoilt = replace(execution, streams={**execution.streams, topic: altered})

    judgement = judge(declared, spoilt)

    assert topic in {breach.stream for breach in judgement.breaches}


def simple(*units: str) -> SmallNetwork:
    """Return a chain of units that count, on a source of a sample every 100 ms."""
    source = stream(" ".join(f"{at}:{at}" for at in range(0, 1000, 100)))
    providers = ["source", *units]
    return SmallNetwork(
        {"source": source},
        {unit: (Counting, [(providers[at], Policy())]) for at, unit in enumerate(units)},
        {"out": (providers[-1], Policy(change=SampleEvery(Duration(ms(200)))))},
    )


def test_a_wrong_stream_alone_is_to_blame() -> None:
    """What follows from what a stream should have been is no breach of what follows it."""
    network = simple("first", "second")
    execution = network.run(ms(1000))
    wrong = list(execution.streams["first"])
    wrong[3] = replace(wrong[3], value="wrong")
    streams = {**execution.streams, "first": wrong, "second/1": wrong}

    judgement = judge(network.declared(), replace(execution, streams=streams))

    assert [breach.stream for breach in judgement.breaches] == ["first"]
    second = next(each for each in judgement.findings if each.stream == "second")
    assert second.basis is Basis.CORRECTED


def test_what_was_not_recorded_is_computed() -> None:
    """A unit whose inputs were not recorded is computed from what was recorded before them."""
    network = simple("first", "second")
    execution = network.run(ms(1000))
    kept = {topic: execution.streams[topic] for topic in ("source", "second", "output/out")}

    judgement = judge(network.declared(), replace(execution, streams=kept))

    assert judgement.is_satisfied
    by_stream = {finding.stream: finding for finding in judgement.findings}
    assert by_stream["second"].basis is Basis.COMPUTED
    assert by_stream["first"].unjudged == ("not recorded",)


def test_without_its_source_a_unit_is_left_open() -> None:
    """What cannot be computed for want of a source is not judged, and it is said why."""
    network = simple("first")
    execution = network.run(ms(1000))
    kept = {topic: execution.streams[topic] for topic in ("first", "output/out")}

    judgement = judge(network.declared(), replace(execution, streams=kept))

    first = next(each for each in judgement.findings if each.stream == "first")
    assert first.unjudged == ("it cannot be computed again without 'source'",)
    assert judgement.is_satisfied


def test_a_unit_that_fails_on_recorded_inputs_is_a_breach() -> None:
    """Where a unit raises an error that it had not raised, the stream is not what it computes."""

    class Failing(Counting):
        def push(self, now: TimePoint, inputs: tuple[Sample[Any], ...]) -> Any:
            if now >= ms(500):
                raise ZeroDivisionError("no")
            return super().push(now, inputs)

    network = simple("first")
    execution = network.run(ms(1000))
    network.units = {"first": (Failing, [("source", Policy())])}

    found = judge(network.declared(), execution).breaches

    assert any("a failure: ZeroDivisionError: no" in each.found for each in found)


def test_of_many_breaches_the_first_are_kept_and_all_are_counted() -> None:
    """A stream that is wrong throughout does not fill the judgement."""
    network = simple("first")
    execution = network.run(ms(1000))
    wrong = [replace(each, value=0) for each in execution.streams["first"]]
    streams = {**execution.streams, "first": wrong}

    judgement = judge(network.declared(), replace(execution, streams=streams), keep=3)

    first = next(each for each in judgement.findings if each.stream == "first")
    assert len(first.breaches) == 3
    assert first.breach_count == 10
    assert first.breaches[0].available_time == 0


def test_unpublished_violations_are_breaches() -> None:
    """A sample that is missing under `sample every` is a breach unless it was published."""
    network = SmallNetwork(
        {"source": stream("0:a 100:b 300:d")},
        {"first": (Counting, [("source", Policy(change=SampleEvery(Duration(ms(100)))))])},
    )
    execution = network.run(ms(1000))

    assert judge(network.declared(), execution).is_satisfied
    hushed = judge(network.declared(), replace(execution, published=()))
    assert [(each.stream, each.definition) for each in hushed.breaches] == [
        ("first/1", "4.5.11"),
        ("violations of 'source' to 'first'", "4.5.11"),
    ]

"""A snapshot is plain data: it can be written, read again, and taken from a later one."""

import json
from dataclasses import replace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from dyknow.inspection.snapshot import Kind, ProcessFigures, Snapshot, StreamFigures
from dyknow.time import Duration, TimePoint
from tests.support.snapshots import small_network, snapshots

SECOND = 1_000_000_000
HEADER = '{"format": "dyknow-network", "version": 1'


@settings(derandomize=True, deadline=None, max_examples=25)
@given(snapshots())
def test_reading_is_the_inverse_of_writing(snapshot):
    """What has been written as JSON is read as the same snapshot."""
    assert Snapshot.from_json(snapshot.to_json()) == snapshot


def test_the_document_says_what_it_is():
    """The document names its format and version, and has the figures by their names."""
    document = json.loads(small_network().to_json())

    assert document["format"] == "dyknow-network"
    assert document["version"] == 1
    assert document["network"]["processes"][1]["label"] == "percepts[vision]"
    assert document["network"]["streams"][1]["mean_delay"] == 40_000_000


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "not a snapshot of a network: Invalid JSON"),
        ("{}", "not a snapshot of a network: format: Field required"),
        (f"{HEADER}}}", "network: Field required"),
        (f'{HEADER}, "network": {{"processes": 1}}}}', "network.processes: Input should be"),
        ('{"format": "x", "version": 1}', "expected 'dyknow-network' version 1, found 'x'"),
        ('{"format": "dyknow-network", "version": 2}', "found 'dyknow-network' version 2"),
    ],
)
def test_other_documents_are_refused(text, message):
    """A document of another kind or version is refused with what was expected and found."""
    with pytest.raises(ValueError, match=r".*") as refusal:
        Snapshot.from_json(text)

    assert message in str(refusal.value)


def test_a_difference_counts_what_came_between():
    """Counts are those of the time between, and the rate is that of the samples in it."""
    earlier = small_network()
    process, stream = earlier.processes[1], earlier.streams[1]
    later = replace(
        earlier,
        now=TimePoint(4 * SECOND),
        processes=(replace(process, samples=90, calls=100, seconds=3.5),),
        streams=(
            replace(stream, samples=60, violations=5, late=1, mean_delay=Duration(60_000_000)),
        ),
    )

    between = later.since(earlier)

    assert between.begin == 2 * SECOND
    assert between.span == 2 * SECOND
    assert [(p.samples, p.calls, p.seconds) for p in between.processes] == [(40, 50, 0.5)]
    [figures] = between.streams
    assert (figures.samples, figures.rate) == (40, 20.0)
    assert (figures.violations, figures.late) == (3, 0)
    assert figures.mean_delay == 70_000_000


def test_new_processes_count_from_their_beginning():
    """What was not there before counts as a whole; what is gone is left out."""
    earlier = Snapshot(processes=(ProcessFigures(label="old", kind=Kind.UNIT, samples=1),))
    later = Snapshot(
        now=TimePoint(SECOND),
        processes=(ProcessFigures(label="new", kind=Kind.UNIT, samples=7),),
        streams=(StreamFigures(provider="new", receiver="out", is_output=True, samples=7),),
    )

    between = later.since(earlier)

    assert [(p.label, p.samples) for p in between.processes] == [("new", 7)]
    assert [stream.samples for stream in between.streams] == [7]


@settings(derandomize=True, deadline=None, max_examples=30)
@given(snapshots())
def test_nothing_happens_between_a_snapshot_and_itself(snapshot):
    """The difference of a snapshot with itself counts nothing."""
    between = snapshot.since(snapshot)

    assert not any(process.samples or process.calls for process in between.processes)
    assert not any(stream.samples or stream.violations for stream in between.streams)


@given(st.integers(min_value=1, max_value=10))
@settings(derandomize=True, deadline=None, max_examples=5)
def test_the_earlier_snapshot_is_earlier(later):
    """A difference is taken from the later snapshot."""
    with pytest.raises(ValueError, match="the earlier snapshot"):
        Snapshot().since(Snapshot(now=TimePoint(later)))


def test_streams_are_found_from_both_ends():
    """A snapshot knows what feeds a process, and what a generator feeds."""
    network = small_network()

    assert [s.name for s in network.inputs_of("cars")] == ["cars/1"]
    assert [s.name for s in network.streams_of("cars")] == ["output/cars"]
    assert network.inputs_of("images") == ()

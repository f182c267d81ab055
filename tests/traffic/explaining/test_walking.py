"""Every step of an explanation leads to something that really was there."""

import math

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from chronicles.events import json_from_event
from dyknow.time import MILLISECOND
from traffic.errors import ExplanationError

pytestmark = pytest.mark.sumo

NEAR = 1e-3
STRATEGY = st.integers(0, 10_000)
QUICK = settings(
    derandomize=True,
    deadline=None,
    max_examples=25,
    suppress_health_check=[HealthCheck.function_scoped_fixture],
)


def told(explained_run, draw):
    """Return the explanation of some recognition of the run."""
    found = explained_run.walker.run.result.recognitions
    return explained_run.walker.explanation(1 + draw % len(found)).recognition


def sample_of(recording, provenance):
    """Return the recorded sample that a provenance names."""
    (sample,) = (
        sample
        for sample in recording.samples(provenance.stream)
        if sample.available_time == round(provenance.available_time * MILLISECOND)
    )
    assert sample.valid_time == round(provenance.valid_time * MILLISECOND)
    return sample


def table_at(recording, label, time):
    """Return the recorded table of a stream that is valid at a time in milliseconds."""
    for sample in recording.samples(label):
        if sample.valid_time == round(time * MILLISECOND):
            return sample.value
    raise AssertionError(f"'{label}' has no sample valid at {time} ms")


@given(STRATEGY)
@QUICK
def test_every_event_is_in_the_stream_that_is_named(explained_run, draw):
    """The sample of an event holds it, and the sample of a recognition holds that."""
    found = told(explained_run, draw)

    recognised = sample_of(explained_run.recording, found.sample).value
    assert found.chronicle in {each.chronicle for each in recognised}
    for event in found.events:
        documents = [
            json_from_event(each)
            for each in sample_of(explained_run.recording, event.sample).value
        ]
        assert {
            "t": event.event.time,
            "attribute": event.event.attribute,
            "arguments": event.event.arguments,
            "from": event.event.before,
            "to": event.event.after,
        } in documents


@given(STRATEGY)
@QUICK
def test_values_changed_where_it_is_said(explained_run, draw):
    """Before and after a change the recorded tables hold the values that are told."""
    walker, recording = explained_run
    for event in told(explained_run, draw).events:
        for change in [] if event.change is None else [event.change.filtered, event.change.raw]:
            assert change is not None
            samples = list(recording.samples(change.stream))
            times = [sample.valid_time for sample in samples]
            at = times.index(round(change.valid_time * MILLISECOND))
            (symbol,) = event.event.arguments
            for sample, value in ((samples[at], change.after), (samples[at - 1], change.before)):
                row = sample.value.row(int(symbol.removeprefix("car")))
                code = -2 if row is None or at == 0 else int(row[change.column])
                assert walker.run.value_of(change.column, code) == value


@given(STRATEGY)
@QUICK
def test_every_link_stood_when_it_is_named(explained_run, draw):
    """The objects below an object at a time were linked to one another then, and were there."""
    for each in told(explained_run, draw).objects:
        for state in each.states:
            for upper, lower in zip(state.structure, state.structure[1:], strict=False):
                assert any(
                    (link.upper, link.lower) == (upper, lower)
                    and link.begin <= state.time
                    and (link.end is None or state.time < link.end)
                    for link in each.links
                )
            if state.observed:
                percept = state.structure[-1]
                percepts = table_at(explained_run.recording, "percepts[truth]", state.time)
                assert int(percept.removeprefix("percept")) in percepts.ids


@given(STRATEGY)
@QUICK
def test_states_and_percepts_are_those_of_the_streams(explained_run, draw):
    """Positions, speeds and headings are those of the recorded tables of cars and percepts."""
    recording = explained_run.recording
    found = told(explained_run, draw)

    for each in found.objects:
        for state in each.states:
            row = table_at(recording, "cars", state.time).row(int(each.symbol[3:]))
            assert np.allclose(row["position"], state.position, atol=NEAR)
            assert math.isclose(row["speed"], state.speed, abs_tol=NEAR)
            assert bool(row["observed"]) == state.observed
    for frame in found.frames:
        assert frame.images == {}
        for seen in frame.seen:
            if seen.percept is not None:
                percepts = table_at(recording, "percepts[truth]", frame.time)
                row = percepts.row(int(seen.percept.removeprefix("percept")))
                assert np.allclose(row["position"], seen.position, atol=NEAR)


@given(STRATEGY)
@QUICK
def test_what_is_asked_for_was_given(explained_run, draw):
    """All constraints hold, what is counted is as much as was asked for, and all of it is told."""
    found = told(explained_run, draw)

    assert all(constraint.holds for constraint in found.constraints)
    for counted in found.counted:
        streams = explained_run.walker.streams_to(found.sample)
        events = {
            (event.time, event.arguments, event.from_value, event.to_value)
            for label in streams
            for sample in explained_run.recording.samples(label)
            for event in sample.value
            if event.attribute == counted.attribute
            and (counted.arguments is None or list(event.arguments) == counted.arguments)
            and counted.begin <= event.time / MILLISECOND < counted.end
        }
        assert counted.holds
        assert counted.count == len(counted.events) <= len(events)
        for event in counted.events:
            time = round(event.time * MILLISECOND)
            assert (time, tuple(event.arguments), event.before, event.after) in events


@pytest.mark.parametrize("number", [0, 999])
def test_a_number_that_is_not_there_is_refused(explained_run, number):
    """The message says which ones there are."""
    n = len(explained_run.walker.run.result.recognitions)

    with pytest.raises(ExplanationError, match=rf"no recognition {number}; it has 1 to {n}"):
        explained_run.walker.explanation(number)

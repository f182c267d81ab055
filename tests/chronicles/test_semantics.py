"""The recogniser finds what the meaning of chronicles says, at the time that it says."""

from itertools import groupby

import pytest
from hypothesis import HealthCheck, assume, event, given, settings
from hypothesis import strategies as st

from chronicles.check import faults
from chronicles.events import Event, Recognition
from chronicles.expansion import expand
from chronicles.models import models_from_chronicles
from chronicles.parser import parse_chronicles
from chronicles.prospects import PartialInstance
from chronicles.recognition import Recogniser
from chronicles.semantics import Match, matches
from chronicles.syntax import Chronicle, ChronicleFile, NoEvent, Occurs
from dyknow.time import MILLISECOND, TimePoint
from tests.support.random_chronicles import chronicle_texts, streams

MS = int(MILLISECOND)
ALL = list(HealthCheck)


def chronicle_called(name: str, file: ChronicleFile) -> Chronicle:
    """Return a chronicle of a file by its name."""
    (found,) = [chronicle for chronicle in file.chronicles if chronicle.name == name]
    return found


def flat(recognition: Recognition, names: set[str]) -> Match:
    """Return a recognition in the form of the meaning."""
    values = {f"?{name}": value for name, value in recognition.arguments.items()}
    times = {name: time for name, time in recognition.instants.items() if name in names}
    return Match(
        recognition.recognised_at, tuple(sorted(times.items())), tuple(sorted(values.items()))
    )


def events_of_sub(file: ChronicleFile, events: list[Event], end: int) -> list[Event]:
    """Return the events that the recognitions of the chronicle `sub` are."""
    found = []
    for match in matches(chronicle_called("sub", file), file, events, end):
        time = dict(match.times)["t"] // MS
        arguments = (dict(match.values)["?k"],)
        moment = TimePoint(match.recognised_at)
        found.append(Event("sub", arguments, str(time), str(time), moment))
    return found


def finer(one: Event, by: int) -> Event:
    """Return an event some nanoseconds later, at the same instant."""
    later = TimePoint(one.time + by)
    return Event(one.attribute, one.arguments, one.from_value, one.to_value, later)


def recognised(
    recogniser: Recogniser, events: list[Event], end: int, data: st.DataObject
) -> list[Recognition]:
    """Push events one by one or by instants, with or without moving the clock before."""
    found = []
    clock = None
    together = data.draw(st.booleans())
    for time, group in groupby(events, key=lambda one: one.time):
        at_instant = list(group)
        for pushed in [at_instant] if together else [[one] for one in at_instant]:
            if data.draw(st.booleans()):
                found += recogniser.advance(time)
            by = data.draw(st.sampled_from([0, 0, 999_999]))
            new = recogniser.push(TimePoint(time + by), [finer(one, by) for one in pushed])
            assert all(clock is None or clock <= one.recognised_at for one in new)
            assert all(one.recognised_at <= time for one in new)
            found += new
            assert all(is_possible(one, time) for one in recogniser.partial_instances())
        clock = time
    return found + recogniser.advance(TimePoint(end))


def is_possible(instance: PartialInstance, clock: int) -> bool:
    """Return whether everything that a partial instance waits for can still come."""
    return bool(instance.awaited) and all(
        awaited.latest is None or max(clock, awaited.earliest) <= awaited.latest
        for awaited in instance.awaited
    )


def check_agreement(text: str, data: st.DataObject) -> None:
    """Hold the recogniser to the meaning of a chronicle called c for a stream of events."""
    file = parse_chronicles(text)
    assume(not faults(file))
    expansion = expand(chronicle_called("c", file), file)
    asked = [each.event_type for each in expansion.events]
    counted = [s.event_type for s in expansion.statements if isinstance(s, NoEvent | Occurs)]
    events = data.draw(streams([*asked, *asked, *counted]))
    wait = data.draw(st.integers(0, 8))
    options = data.draw(st.sampled_from([{}, {"limit": 10**6}, {"on_end": lambda _: None}]))
    recogniser = Recogniser(models_from_chronicles(file), **options)
    end = (events[-1].time if events else 0) + wait * MS

    found = recognised(recogniser, events, end, data)

    names = {each.instant for each in expansion.events}
    expected = matches(
        chronicle_called("c", file), file, [*events, *events_of_sub(file, events, end)], end
    )
    event(f"matches: {min(len(expected), 3)}")
    told = [flat(one, names) for one in found if one.chronicle == "c"]
    assert sorted(told) == expected


@settings(derandomize=True, deadline=None, max_examples=200, suppress_health_check=ALL)
@given(chronicle_texts(), st.data())
def test_recogniser_agrees_with_the_meaning(text: str, data: st.DataObject) -> None:
    """The recogniser finds the matches that the meaning says, once each and at their time."""
    check_agreement(text, data)


@pytest.mark.exhaustive
@settings(derandomize=True, deadline=None, max_examples=6_000, suppress_health_check=ALL)
@given(chronicle_texts(), st.data())
def test_six_thousand_random_chronicles(text: str, data: st.DataObject) -> None:
    """The same for thousands of chronicles, each with a stream of its own."""
    check_agreement(text, data)

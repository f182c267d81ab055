"""Recognitions as events of other chronicles."""

from hypothesis import given, settings
from hypothesis import strategies as st

from chronicles.events import Event, Recognition
from chronicles.models import models_from_chronicles
from chronicles.parser import parse_chronicles
from chronicles.processes import ChronicleRecogniser
from chronicles.recognised import RecognitionEvents
from dyknow.streams.sample import Heartbeat, Sample
from dyknow.time import Duration, TimePoint
from tests.support.streams import ms, run_unit

_DELAY = Duration(ms(40))
_SIMPLE = """
chronicle pair[?x] { event(a[?x], t1) event(b[?x], t2) noevent(d[?x], (t1 + 1, t2)) t1 < t2 }
chronicle quiet[?x] { event(a[?x], t1) noevent(d[?x], (t1 + 1, t1 + 30)) }
"""
_COMPOUND = """
chronicle twice[?x] {
    event(pair[?x]:(?begin, ?end), t1)
    event(quiet[?x]:(?, ?), t2)
    event(d[?x], t3)
    t1 <= t2 <= t3 <= t1 + 60
}
"""


def _samples(
    text: str, *inputs: list[Sample[tuple[Event, ...]]], until: TimePoint
) -> list[Sample[tuple[Recognition, ...]]]:
    """Return what is recognised of the chronicles of a text."""
    models = models_from_chronicles(parse_chronicles(text))
    produced = run_unit(ChronicleRecogniser(models, max_delay=_DELAY), *inputs, until=until)
    return [each for each in produced if isinstance(each, Sample)]


def _sample(valid: int, available: int, *names: str) -> Sample[tuple[Event, ...]]:
    events = tuple(Event(name, ("x",), None, None, ms(valid)) for name in names)
    return Sample(events, ms(valid), ms(available))


def test_a_recognition_is_an_event_at_the_time_when_it_became_certain():
    """Its valid time is that of recognition; when it began and ended are its values."""
    messages = [_sample(0, 0, "a"), _sample(20, 20), _sample(50, 50)]
    recognitions = _samples(_SIMPLE, messages, until=ms(200))

    (sample,) = run_unit(RecognitionEvents(), recognitions, until=ms(200))

    assert sample.value == (Event("quiet", ("x",), "0", "0", ms(30)),)
    assert (sample.valid_time, sample.available_time) == (ms(30), ms(70))


def test_heartbeats_are_passed_on():
    """Where recognitions are complete, their events are."""
    said = RecognitionEvents().beat(ms(50), 0, Heartbeat(ms(30), ms(50)))

    assert said == [Heartbeat(ms(30), ms(50))]


@settings(derandomize=True, deadline=None, max_examples=60)
@given(
    st.lists(
        st.tuples(st.integers(0, 90), st.integers(0, 40), st.sampled_from("abd")), max_size=12
    )
)
def test_two_recognisers_find_what_one_finds(drawn: list[tuple[int, int, str]]) -> None:
    """Chronicles of chronicles are the same in one file as across two processes."""
    arrivals = {valid + delay: (valid, name) for valid, delay, name in drawn}
    messages = [_sample(valid, at, name) for at, (valid, name) in sorted(arrivals.items())]
    until = ms(400)

    together = _samples(_SIMPLE + _COMPOUND, messages, until=until)
    simple = _samples(_SIMPLE, messages, until=until)
    events = run_unit(RecognitionEvents(), simple, until=until)
    apart = _samples(_COMPOUND, messages, events, until=until)

    found = [each for sample in together for each in sample.value if each.chronicle == "twice"]
    assert [each for sample in apart for each in sample.value] == found

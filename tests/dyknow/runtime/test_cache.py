"""The queries of thesis section 5.3.2, against looking at every sample."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from dyknow.errors import ValueNotAvailableError
from dyknow.runtime.generators import Label
from dyknow.runtime.kernel import Kernel
from tests.support.policies import streams
from tests.support.streams import GivenSource, ms, stream, text


def generator_of(samples, capacity=8):
    """Return a generator through which *samples* have gone."""
    kernel = Kernel()
    kernel.add_source(Label("a"), GivenSource(samples))
    generator = kernel.generator(Label("a"))
    generator.capacity = capacity
    kernel.run()
    return generator


def test_the_queries_of_the_stream_generator_interface():
    """Latest by available time, latest and closest by valid time, slices and ranges."""
    generator = generator_of("0:a 20:b 10:c@25 20:d@30")

    assert generator.size == 4
    assert text([generator.latest()]) == "20:d@30"
    assert text([generator.nth_latest(0), generator.nth_latest(2)]) == "20:d@30 20:b"
    assert text(generator.slice(1, 2)) == "20:b 10:c@25"
    assert text([generator.latest_valid()]) == "20:d@30"
    assert text([generator.closest_at_or_before(ms(19))]) == "10:c@25"
    assert text(generator.between(ms(10), ms(20))) == "20:b 10:c@25 20:d@30"
    assert text(generator.between(ms(1), ms(9))) == ""


def test_what_is_not_held_is_not_available():
    """Every query for one sample says so if there is none, with the label."""
    generator = generator_of("10:a 20:b 30:c", capacity=2)

    assert text(generator.samples) == "20:b 30:c"
    for query in (
        lambda: generator.nth_latest(2),
        lambda: generator.nth_latest(-1),
        lambda: generator.slice(0, 2),
        lambda: generator.closest_at_or_before(ms(19)),
    ):
        with pytest.raises(ValueNotAvailableError, match="'a' holds no"):
            query()
    generator.reset()
    for query in (generator.latest, generator.latest_valid):
        with pytest.raises(ValueNotAvailableError, match="'a' holds no"):
            query()
    assert generator.size == 0


def test_the_capacity_can_be_changed():
    """A smaller cache forgets the oldest; a larger one holds more from then on."""
    generator = generator_of("10:a 20:b 30:c")

    generator.capacity = 2
    assert text(generator.samples) == "20:b 30:c"
    generator.capacity = 100
    assert (generator.size, generator.capacity) == (2, 100)
    with pytest.raises(ValueError, match="at least one sample, found a capacity of 0"):
        generator.capacity = 0


@settings(derandomize=True, deadline=None, max_examples=100)
@given(streams(), st.integers(1, 12), st.integers(0, 250), st.integers(0, 250))
def test_queries_are_what_the_definitions_say(samples, capacity, one, other):
    """Each query is the sample that a search of the last samples finds."""
    generator = generator_of(samples, capacity)

    held = stream(text(samples))[-capacity:] if samples else []
    assert text(generator.samples) == text(held)
    first, last = sorted([ms(one), ms(other)])
    within = [sample for sample in held if first <= sample.valid_time <= last]
    assert text(generator.between(first, last)) == text(within)
    before = [sample for sample in held if sample.valid_time <= first]
    if before:
        best = max(before, key=lambda sample: (sample.valid_time, sample.available_time))
        assert text([generator.closest_at_or_before(first)]) == text([best])
    else:
        assert generator.find_at_or_before(first) is None

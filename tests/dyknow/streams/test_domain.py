"""What counts as a value, a sample, a stream: the examples of Heintz (2009), section 4.3."""

import numpy as np
import pytest

from dyknow.streams.domain import TIME, Domain, computed_stream, source_stream
from dyknow.streams.sample import NO_SAMPLE, NO_VALUE, Sample
from dyknow.streams.table import Table
from dyknow.time import TimePoint
from tests.support.streams import ms, stream, text

OBJECTS = frozenset(f"o{number}" for number in range(1, 11))
PRIMITIVES = frozenset(f"{kind}{number}" for kind in "ps" for number in range(1, 11))
DOMAIN = Domain(OBJECTS, PRIMITIVES)
"""The domain of example 4.3.1."""


def test_example_4_3_1_a_domain():
    """Objects, time-points and primitive values are the simple values of a domain."""
    assert all(map(DOMAIN.is_simple_value, ["o1", "o10", 0, 10**18, "p1", "s10"]))
    assert not any(map(DOMAIN.is_simple_value, ["o11", -1, 1.5, True, "q1", None, ["o1"]]))
    assert 0 in TIME


def test_a_domain_does_not_contain_no_value():
    """The absence of a value is no object, time-point or primitive value."""
    with pytest.raises(ValueError, match="no value of a domain may be NO_VALUE"):
        Domain(OBJECTS, {NO_VALUE})


def test_example_4_3_2_values():
    """Simple values, no value, and tuples of values are values."""
    assert all(map(DOMAIN.is_simple_value, ["p4", "o3", "s9"]))
    assert DOMAIN.is_value((NO_VALUE, ("o10",)))
    assert not DOMAIN.is_simple_value((NO_VALUE, ("o10",)))
    assert not DOMAIN.is_simple_value(NO_VALUE)
    assert DOMAIN.is_value(())
    assert not DOMAIN.is_value((NO_VALUE, ("o11",)))


def test_tables_and_mappings_are_values_if_what_they_hold_is():
    """A table is the tuple of the states of its objects, whose symbols are objects."""
    good = Table("o", [3, 4], {"place": np.array(["p1", "p2"])})

    assert DOMAIN.is_value(good)
    assert DOMAIN.is_value({"place": "p1", "speed": NO_VALUE})
    assert not DOMAIN.is_value(Table("o", [3, 11], {"place": np.array(["p1", "p2"])}))
    assert not DOMAIN.is_value(Table("o", [3, 4], {"place": np.array(["p1", "p11"])}))
    assert not DOMAIN.is_value({"place": "p11"})


def test_example_4_3_3_the_valid_time_of_a_picture_stays():
    """A blob is valid when its picture was taken and available when it has been extracted."""
    picture = Sample("picture", ms(100), ms(140))
    blob = Sample("blob", picture.valid_time, ms(165))

    assert (picture.delay, blob.delay) == (ms(40), ms(65))
    assert blob.valid_time == picture.valid_time


def test_example_4_3_4_a_sample_is_later_when_it_has_been_processed():
    """Three time units of processing and two of communication after 11 it is 16."""
    s1 = Sample("s1", TimePoint(10), TimePoint(11))
    s2 = Sample("s2", s1.valid_time, TimePoint(s1.available_time + 3 + 2))

    assert (s2.available_time, s2.valid_time) == (16, 10)
    assert DOMAIN.is_sample(s1)
    assert DOMAIN.is_sample(s2)
    assert DOMAIN.is_sample(NO_SAMPLE)
    assert not DOMAIN.is_sample(Sample("s1", TimePoint(-5), TimePoint(11)))


def test_example_4_3_5_fluent_streams_of_a_domain():
    """Samples of the domain with available times of their own are a fluent stream of it."""
    assert DOMAIN.is_fluent_stream(stream("1:p1 2:p2@3 5:p3@4"))
    assert DOMAIN.is_fluent_stream(stream("1:p4@2 1:p5@4 1:p6@5"))
    assert not DOMAIN.is_fluent_stream(stream("1:p1@4 2:p2@4"))
    assert not DOMAIN.is_fluent_stream(stream("1:p1 2:p11@3"))
    assert not DOMAIN.is_fluent_stream([NO_SAMPLE])


def test_example_4_3_9_a_source_speaks_when_it_has_something_to_say():
    """A user who counts cars now and then is a function with gaps."""
    observations = {ms(20): Sample(3, ms(10), ms(20)), ms(50): Sample(4, ms(50), ms(50))}

    said = source_stream(lambda time: observations.get(time, NO_SAMPLE), map(ms, range(60)))

    assert text(said) == "10:3@20 50:4"


def test_example_4_3_10_addition_is_a_computational_unit():
    """It takes no notice of the time and the state, and adds what is there of both inputs."""

    def add(time, inputs, state):
        if NO_SAMPLE in inputs:
            return NO_SAMPLE, state
        left, right = inputs
        total = left.value + right.value
        return Sample(total, max(left.valid_time, right.valid_time), time), state

    left = [Sample(1, ms(0), ms(0)), Sample(2, ms(10), ms(15))]
    right = [Sample(10, ms(0), ms(5)), Sample(20, ms(10), ms(12))]

    assert text(computed_stream(add, left, right)) == "0:11@5 10:21@12 10:22@15"


def test_a_unit_begins_with_no_value_as_its_state():
    """What a unit remembers is handed from one application to the next."""

    def count(time, inputs, state):
        number = 1 if state is NO_VALUE else state + 1
        return Sample(number, time, time), number

    assert text(computed_stream(count, stream("0:a 10:b 20:c"))) == "0:1 10:2 20:3"

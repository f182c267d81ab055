"""Comparing two recordings byte by byte."""

import tempfile
from pathlib import Path

from hypothesis import given, settings
from hypothesis import strategies as st
from mcap.writer import Writer

from traffic.recording.comparing import compare

TOPICS = ("a", "b", "c")
MESSAGES = st.lists(
    st.tuples(st.sampled_from(TOPICS), st.integers(0, 2), st.sampled_from([b"x", b"yz"])),
    max_size=12,
)


def write(path, messages, schema_of_a=b"s"):
    """Write messages: topic, valid time, bytes; their available times are their places."""
    with path.open("wb") as file:
        writer = Writer(file, chunk_size=64)
        writer.start()
        channels = {}
        for topic in TOPICS:
            data = schema_of_a if topic == "a" else b"s"
            schema = writer.register_schema(topic, "protobuf", data)
            channels[topic] = writer.register_channel(topic, "protobuf", schema)
        for at, (topic, valid_time, data) in enumerate(messages):
            writer.add_message(channels[topic], at, data, valid_time)
        writer.finish()


def oracle(recorded, computed, topics):
    """Return, for each topic that differs, the number of equal samples before that."""
    found = {}
    for topic in topics:
        one, other = (
            [(at, *item[1:]) for at, item in enumerate(items) if item[0] == topic]
            for items in (recorded, computed)
        )
        if one != other:
            pairs = zip(one, other, strict=False)
            same = next((n for n, (a, b) in enumerate(pairs) if a != b), None)
            found[topic] = min(len(one), len(other)) if same is None else same
    return found


@settings(derandomize=True, deadline=None, max_examples=100)
@given(MESSAGES, MESSAGES, st.integers(0, 12), st.sets(st.sampled_from(TOPICS)))
def test_the_first_difference_of_each_stream_is_found(messages, others, common, topics):
    """As the definition says, whatever lies between the samples of a stream."""
    computed = messages[:common] + others
    with tempfile.TemporaryDirectory() as folder:
        one, other = Path(folder) / "a.mcap", Path(folder) / "b.mcap"
        write(one, messages)
        write(other, computed)
        comparison = compare(one, other, topics)

    expected = oracle(messages, computed, topics)
    assert {each.topic: each.number for each in comparison.differences} == expected
    assert comparison.identical == len(topics) - len(expected)
    assert [each.at for each in comparison.differences] == sorted(
        each.at for each in comparison.differences
    )


def test_the_same_bytes_under_another_schema_differ(tmp_path):
    """What bytes mean is a part of them."""
    messages = [("a", 0, b"x"), ("b", 0, b"x")]
    write(tmp_path / "a.mcap", messages)
    write(tmp_path / "b.mcap", messages, b"other")

    comparison = compare(tmp_path / "a.mcap", tmp_path / "b.mcap", TOPICS)

    assert [each.topic for each in comparison.differences] == ["a"]


def test_what_was_recorded_and_what_came_stand_in_the_difference(tmp_path):
    """Available time, valid time and size of each, or None where a stream has ended."""
    write(tmp_path / "a.mcap", [("a", 5, b"x"), ("a", 6, b"x")])
    write(tmp_path / "b.mcap", [("a", 5, b"x")])

    (difference,) = compare(tmp_path / "a.mcap", tmp_path / "b.mcap", TOPICS).differences

    assert (difference.recorded, difference.computed) == ((1, 6, 1), None)
    assert difference.at == 1

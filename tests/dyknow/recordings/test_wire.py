"""The wire format agrees with the library of protocol buffers."""

import pytest
from google.protobuf.wrappers_pb2 import BytesValue, UInt64Value
from hypothesis import given, settings
from hypothesis import strategies as st

from dyknow.recordings.wire import VARINT, delimited, parts, tag, varint, varints


@settings(derandomize=True, deadline=None, max_examples=100)
@given(st.integers(0, (1 << 64) - 1))
def test_numbers_in_groups_of_seven_bits(number: int) -> None:
    """The library reads our number, and we read the library's."""
    data = tag(1, VARINT) + varint(number)

    assert UInt64Value.FromString(data).value == number
    assert list(varints(varint(number) * 2, 0, 2 * len(varint(number)))) == [number, number]


@settings(derandomize=True, deadline=None, max_examples=50)
@given(st.binary(min_size=1, max_size=300))
def test_fields_with_a_length(content: bytes) -> None:
    """The library writes the same bytes, and we find the content in them."""
    data = BytesValue(value=content).SerializeToString()

    assert delimited(1, content) == data
    ((number, begin, end),) = parts(data, 0, len(data))
    assert (number, data[begin:end]) == (1, content)


@pytest.mark.parametrize("data", [b"\x80", b"\x0a\x05ab", b"\x0b", b"\x09\0\0"])
def test_what_is_no_message_is_refused(data: bytes) -> None:
    """Bytes that end too early, or with fields of no known kind, are a ValueError."""
    with pytest.raises(ValueError, match=r"message|wire type"):
        list(parts(data, 0, len(data)))

"""Files of which parts were lost, doubled or written over."""

from hypothesis import strategies as st

_PIECES = st.one_of(
    st.binary(max_size=4),
    st.sampled_from([b"{", b"}", b'"', b",", b":", b"\n", b"null", b"NaN", b"1e999", b"-1", b"["]),
    st.sampled_from([b"\\", b"\r", b"t", b"9" * 400, b"\xff", b"\xe2\x82", b"\\ud800", b"\0"]),
)


@st.composite
def damaged(draw: st.DrawFn, content: bytes) -> bytes:
    """Return bytes of which stretches were lost, doubled or written over."""
    for _ in range(draw(st.integers(1, 4))):
        start = draw(st.integers(0, len(content)))
        end = min(len(content), start + draw(st.integers(0, 12)))
        middle = draw(st.one_of(st.just(b""), st.just(content[start:end] * 2), _PIECES))
        content = content[:start] + middle + content[end:]
    return content[: draw(st.one_of(st.just(len(content)), st.integers(0, len(content))))]

"""Two recordings are compared byte by byte."""

from pathlib import Path
from typing import Any

import pytest

from dyknow.recordings.comparing import compare
from dyknow.recordings.recorder import Recorder
from dyknow.recordings.recording import open_recording
from tests.support.recorded import sample

MS = 1_000_000


def differences(folder: Path, one: Any, other: Any) -> list[str]:
    """Return how recordings of two sets of streams differ."""
    paths = []
    for name, streams in (("one", one), ("other", other)):
        paths.append(folder / f"{name}.mcap")
        with Recorder(paths[-1], metadata={"name": name}, chunk_size=50) as recorder:
            for topic, samples in streams.items():
                tap = recorder.generator(topic)
                for each in samples:
                    tap(each)
    with open_recording(paths[0]) as left, open_recording(paths[1]) as right:
        return [str(difference) for difference in compare(left, right)]


SAME = [sample(float(n), n * MS) for n in range(5)]


@pytest.mark.parametrize(
    ("other", "expected"),
    [
        (SAME, None),
        (SAME[:3], "message 4, at 3 ms: only the first recording has it"),
        ([*SAME, sample(9.0, 9 * MS)], "message 6, at 9 ms: only the second recording has it"),
        ([*SAME[:2], *SAME[3:]], "message 3, at 2 ms: it became available at 2 and 3"),
        (
            [*SAME[:2], sample(2.0, MS, 2 * MS), *SAME[3:]],
            "message 3, at 2 ms: its valid time is 2 and 1",
        ),
        ([*SAME[:2], sample(-0.0, 2 * MS), *SAME[3:]], "message 3, at 2 ms: it has another value"),
        ([sample(0, 0), *SAME[1:]], "message 1, at 0 ms: it has another value"),
    ],
)
def test_first_difference_is_named(tmp_path: Path, other: Any, expected: str | None) -> None:
    """The stream, the place in it and what differs are named; equal streams have nothing."""
    found = differences(tmp_path, {"x": SAME, "y": SAME}, {"x": other, "y": SAME})

    assert found == ([] if expected is None else [f"stream 'x', {expected}"])


def test_streams_of_one_recording_alone_are_named(tmp_path: Path) -> None:
    """A stream that only one recording has is a difference."""
    found = differences(tmp_path, {"x": SAME, "a": SAME}, {"x": SAME, "b": []})

    assert found == [
        "stream 'a': only the first recording has it",
        "stream 'b': only the second recording has it",
    ]


def test_order_between_streams_does_not_matter(tmp_path: Path) -> None:
    """Only what each stream says counts, not how they were written beside each other."""
    assert differences(tmp_path, {"x": SAME, "y": SAME}, {"y": SAME, "x": SAME}) == []

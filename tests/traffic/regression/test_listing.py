"""What a suite says that it has."""

from pathlib import Path

import pytest

from tests.support.regression import entry_of
from traffic.regression.listing import Listed, listed
from traffic.regression.manifest import Making
from traffic.regression.suite import Entry


@pytest.mark.sumo
@pytest.mark.slow
def test_a_recording_is_described_by_itself_and_by_the_suite(
    recording: Path, tmp_path: Path
) -> None:
    """Its run, length and size, what it is for, and what is expected, counted."""
    entry = entry_of(recording, tmp_path)
    making = Making.model_validate(
        {"name": "rural", "shows": "Trucks.", "scenario": "rural", "from": "1 s", "to": "16 s"}
    )

    found = listed(entry, making)

    size = entry.recording.stat().st_size
    assert found.expected.startswith("true: overtake ")
    assert found == Listed(
        entry, "Trucks.", "rural, seed 1, 1 s to 16 s", "truth, 1 m", 15, size, found.expected
    )
    assert listed(entry, None).made == "rural, seed 1"


def test_one_that_cannot_be_read_is_listed_too(tmp_path: Path) -> None:
    """With what is wrong."""
    entry = Entry(tmp_path, "x")
    assert "there is no" in listed(entry, None).fault
    entry.recording.write_text("no recording")
    assert "expected a recording in MCAP" in listed(entry, None).fault

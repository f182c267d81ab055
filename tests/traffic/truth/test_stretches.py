"""Stretches of frames in which something is the case."""

from hypothesis import given, settings
from hypothesis import strategies as st

from dyknow.time import TimePoint
from traffic.truth.stretches import Stretches


@given(st.lists(st.sets(st.sampled_from("abc")), min_size=1, max_size=10))
@settings(derandomize=True, deadline=None, max_examples=200)
def test_stretches_are_runs_of_frames(frames: list[set[str]]) -> None:
    """Each longest run of frames that hold something is found, once, as it ends."""
    stretches: Stretches[str] = Stretches()
    found = [
        each
        for time, held in enumerate(frames)
        for each in stretches.observe(TimePoint(time), held)
    ]
    found += stretches.finish()

    runs = []
    for key in "abc":
        text = "".join("x" if key in held else " " for held in frames)
        at = 0
        for run in text.split(" "):
            if run:
                runs.append((key, at, at + len(run) - 1))
            at += len(run) + 1
    assert sorted(found) == sorted(runs)
    assert all((key in stretches) == (key in frames[-1]) for key in "abc")

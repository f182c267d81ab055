"""Every recording of a run is judged."""

from pathlib import Path

from traffic.judging import judge_recording

__all__ = ["assert_judged_correct"]


def assert_judged_correct(recording: Path, specification: Path | None = None) -> None:
    """Check that a recorded run satisfies the specification that stands in it, or another one."""
    judgement = judge_recording(recording, specification).judgement

    assert judgement.is_satisfied, "\n".join(map(str, judgement.breaches))

"""What stood back under load in a run stands back in its replay."""

import pytest

from dyknow.service.governor import PeriodChange
from dyknow.time import MILLISECOND, SECOND
from tests.support.judging import assert_judged_correct
from traffic.recording.periods import changes_from_text, text_from_changes
from traffic.recording.rebuilding import describe, open_run
from traffic.replaying import ReplayRequest, replay
from traffic.request import RunRequest
from traffic.running import run_scenario

SPECIFICATION = """
parameter view = truth
parameter sample_period = 100
source vehicles vehicles
compunit percepts NoisyPositions(vehicles)
strmgen vehicles = vehicles
strmgen percepts = NoisyPositions(
    vehicles with sample every 100 up to 400 under load, error = 0)
stream percepts = percepts
"""


def test_changes_come_back_from_their_text():
    """With every time, label and period."""
    changes = (
        PeriodChange(SECOND, "a", "b[c]", 2, 40 * MILLISECOND, 80 * MILLISECOND),
        PeriodChange(2 * SECOND, "a", "output", 0, 80 * MILLISECOND, 40 * MILLISECOND),
    )

    assert changes_from_text(text_from_changes(changes)) == changes


@pytest.mark.sumo
def test_a_replay_repeats_the_changes_of_periods(tmp_path, monkeypatch):
    """A run that was always late is judged right, and comes out the same, late or not."""
    always_late = property(lambda _: SECOND, lambda *_: None)
    monkeypatch.setattr("dyknow.runtime.clock.WallClock.last_lateness", always_late, raising=False)
    (tmp_path / "late.kpl").write_text(SPECIFICATION)
    request = RunRequest.from_texts(
        scenario="crossing",
        view="truth",
        duration="2 s",
        real_time=True,
        specification=tmp_path / "late.kpl",
        record=tmp_path / "x.mcap",
        out=tmp_path / "run",
    )

    result, _ = run_scenario(request, lambda *_: None)
    replayed = replay(
        ReplayRequest.from_texts(path=tmp_path / "x.mcap", record=tmp_path / "again.mcap"),
        lambda *_: None,
    )

    assert result.timing.lateness is not None
    assert result.timing.lateness.period_changes == 2
    for path in (tmp_path / "x.mcap", tmp_path / "again.mcap"):
        assert_judged_correct(path)
        with open_run(path) as recording:
            (first, second) = describe(recording).period_changes
            n_percepts = recording.streams["percepts"].count
        assert (first.before, second.after) == (100 * MILLISECOND, 400 * MILLISECOND)
        assert n_percepts < 19
    assert replayed.replay is not None
    assert replayed.replay.compared == replayed.replay.identical > 3

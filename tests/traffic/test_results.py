"""Folders of runs."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from traffic.errors import ResultError
from traffic.results import (
    Manoeuvre,
    RecognitionResult,
    RunResult,
    Score,
    Timing,
    read_result,
    run_folder,
    write_result,
)

TEXT = st.text(max_size=8)
NUMBER = st.floats(0, 1e6)
RESULTS = st.builds(
    RunResult,
    scenario=TEXT,
    settings=st.dictionaries(TEXT, st.one_of(st.none(), TEXT, st.integers(), NUMBER), max_size=3),
    recognitions=st.lists(
        st.builds(
            RecognitionResult,
            chronicle=TEXT,
            arguments=st.dictionaries(TEXT, TEXT, max_size=2),
            times=st.dictionaries(TEXT, NUMBER, max_size=2),
            begin=NUMBER,
            end=NUMBER,
            recognised_at=NUMBER,
            events=st.just([]),
            truth=st.one_of(st.none(), st.dictionaries(TEXT, TEXT, max_size=2)),
            agrees=st.one_of(st.none(), st.booleans()),
        ),
        max_size=3,
    ),
    missed=st.lists(
        st.builds(
            Manoeuvre,
            kind=TEXT,
            vehicles=st.lists(TEXT, max_size=2),
            place=st.lists(TEXT, max_size=3),
            begin=NUMBER,
            end=NUMBER,
        ),
        max_size=2,
    ),
    score=st.dictionaries(
        TEXT,
        st.builds(
            Score,
            truth=st.integers(0, 99),
            recognised=st.integers(0, 99),
            correct=st.integers(0, 99),
            precision=st.one_of(st.none(), st.floats(0, 1)),
            recall=st.one_of(st.none(), st.floats(0, 1)),
            left_out=st.integers(0, 9),
        ),
        max_size=2,
    ),
    timing=st.builds(
        Timing,
        simulated_s=NUMBER,
        wall_s=NUMBER,
        real_time_factor=NUMBER,
        stages=st.dictionaries(TEXT, NUMBER, max_size=3),
    ),
)


@settings(derandomize=True, deadline=None, max_examples=50)
@given(RESULTS)
def test_what_was_written_is_read_again(tmp_path_factory, result):
    """Writing then reading gives the same result."""
    folder = tmp_path_factory.mktemp("run")
    write_result(result, folder)

    assert read_result(folder) == result


@settings(derandomize=True, deadline=None, max_examples=60)
@given(RESULTS, st.data())
def test_a_result_that_was_cut_off_is_refused(tmp_path_factory, result, data):
    """A file cut off anywhere is an error with a message, never half a result."""
    folder = tmp_path_factory.mktemp("run")
    write_result(result, folder)
    path = folder / "result.json"
    whole = path.read_bytes()
    path.write_bytes(whole[: data.draw(st.integers(0, len(whole) - 3))])

    with pytest.raises(ResultError, match="is not the result of a run"):
        read_result(folder)


def test_a_folder_without_a_run_is_refused(tmp_path):
    """A folder that holds something else is named."""
    with pytest.raises(ResultError, match="holds no finished run"):
        read_result(tmp_path)


def test_a_run_that_fails_leaves_nothing_behind(tmp_path):
    """Neither the folder nor its partial form remains after an error."""

    def fail_half_way() -> None:
        with run_folder(tmp_path / "run") as folder:
            (folder / "half").write_text("half")
            raise RuntimeError

    with pytest.raises(RuntimeError):
        fail_half_way()
    assert list(tmp_path.iterdir()) == []


def test_a_folder_that_exists_is_never_touched(tmp_path):
    """An existing folder is refused and keeps what it holds."""
    (tmp_path / "kept").write_text("kept")

    with pytest.raises(ResultError, match="exists already"), run_folder(tmp_path):
        pytest.fail("the block must not be entered")
    assert (tmp_path / "kept").read_text() == "kept"


def test_a_place_that_cannot_be_written_is_named(tmp_path):
    """A file where a folder is needed is an error of the user's."""
    (tmp_path / "file").write_text("")

    with (
        pytest.raises(ResultError, match="cannot write to"),
        run_folder(tmp_path / "file" / "run"),
    ):
        pytest.fail("the block must not be entered")

"""The journal: what was appended is there, wherever it was cut off."""

import resource
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from traffic.errors import ExperimentError
from traffic.experiments.journal import Journal, read_lines

values = st.dictionaries(
    st.text(max_size=5), st.one_of(st.none(), st.integers(), st.text(max_size=8)), max_size=4
)


@settings(
    derandomize=True,
    deadline=None,
    max_examples=60,
    suppress_health_check=[HealthCheck.function_scoped_fixture],
)
@given(st.lists(values, min_size=1, max_size=5), st.data())
def test_whole_lines_survive_a_cut_at_any_byte(
    tmp_path: Path, lines: list[dict[str, object]], data: st.DataObject
) -> None:
    """A file that was cut off has the lines before, and takes new ones behind them."""
    path = tmp_path / "runs.jsonl"
    path.unlink(missing_ok=True)
    with Journal(path) as journal:
        for line in lines:
            journal.append(line)
    content = path.read_bytes()
    path.write_bytes(content[: data.draw(st.integers(0, len(content)))])

    kept = list(read_lines(path))
    with Journal(path) as journal:
        journal.append({"new": 1})

    assert kept == lines[: len(kept)]
    assert list(read_lines(path)) == [*kept, {"new": 1}]


@pytest.mark.parametrize("text", ["{\n", "3\n", '{"a": 1}\nnonsense\n', "\xff\n"])
def test_a_damaged_line_is_named(tmp_path: Path, text: str) -> None:
    """A whole line that is no JSON object is a fault with its number, and nothing is cut off."""
    path = tmp_path / "runs.jsonl"
    path.write_bytes(text.encode("latin-1"))

    with pytest.raises(ExperimentError, match=rf"{path}:\d+: expected a JSON object"):
        Journal(path)
    assert path.read_bytes() == text.encode("latin-1")


def test_what_cannot_be_written_is_told(tmp_path: Path) -> None:
    """A file that may not grow, as on a full disk, is an error; the lines before stay."""
    path = tmp_path / "runs.jsonl"
    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    with Journal(path) as journal:
        journal.append({"a": 1})
        resource.setrlimit(resource.RLIMIT_FSIZE, (20, limits[1]))
        try:
            with pytest.raises(ExperimentError, match="the runs before are safe"):
                journal.append({"long": "x" * 100})
        finally:
            resource.setrlimit(resource.RLIMIT_FSIZE, limits)

    assert list(read_lines(path)) == [{"a": 1}]

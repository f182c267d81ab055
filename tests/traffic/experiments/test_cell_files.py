"""Tables of results in files: what an experiment writes is read the same, faults have places."""

from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from traffic.errors import ExperimentError
from traffic.experiments.cell_files import bundled_cell_files, find_cell_file, read_cell_file
from traffic.experiments.levels import key_of
from traffic.experiments.measures import Share
from traffic.experiments.tables import CellMeasures, cell_table

MEASURES = ("overtake.detection", "turn.recall", "overtake.false_alarms")

numbers = st.one_of(st.integers(-(10**9), 10**9), st.floats(-1e6, 1e6).map(lambda f: f + 0.0))
texts = st.from_regex(r"[a-zA-Z_/.,\"' -]{1,8}", fullmatch=True).map(str.strip).filter(bool)
shares = st.integers(0, 300).flatmap(
    lambda trials: st.integers(0, trials).map(lambda successes: Share(successes, trials))
)


@st.composite
def tables(draw: st.DrawFn) -> list[CellMeasures]:
    """Return cells of two settings, the one with numbers, the other one with texts or numbers."""
    kinds = [numbers, draw(st.sampled_from([numbers, texts, st.booleans()]))]
    keys = draw(
        st.lists(
            st.tuples(*kinds),
            min_size=1,
            max_size=6,
            unique_by=lambda pair: tuple(map(key_of, pair)),
        )
    )
    return [
        CellMeasures(
            {"position_noise": one, "scenario.acts.overtake.speed": other},
            draw(st.integers(300, 400)),
            draw(st.integers(0, 5)),
            {measure: draw(shares) for measure in MEASURES},
        )
        for one, other in keys
    ]


def written(tmp_path: Path, text: str) -> Path:
    """Return the path of a file with that text."""
    path = tmp_path / "cells.csv"
    path.write_text(text, encoding="utf-8", newline="")
    return path


@settings(
    derandomize=True,
    deadline=None,
    max_examples=150,
    suppress_health_check=[HealthCheck.function_scoped_fixture],
)
@given(cells=tables())
def test_what_an_experiment_writes_is_read_the_same(
    tmp_path: Path, cells: list[CellMeasures]
) -> None:
    """Counts and levels come back, and writing what was read gives the same bytes."""
    text = cell_table(MEASURES, cells).to_csv(index=False)

    found = read_cell_file(written(tmp_path, text))

    assert found.measures == MEASURES
    assert found.varying == ("position_noise", "scenario.acts.overtake.speed")
    assert [(c.runs, c.failed, c.shares) for c in found.cells] == [
        (c.runs, c.failed, c.shares) for c in cells
    ]
    assert [c.cell["position_noise"] for c in found.cells] == pytest.approx(
        [c.cell["position_noise"] for c in cells]
    )
    assert cell_table(found.measures, found.cells).to_csv(index=False) == text


@pytest.mark.parametrize(
    ("row", "expected"),
    [
        ("0,10,0.7", Share(7, 10)),
        ("0,10,70 %", Share(7, 10)),
        ("0,10,70%", Share(7, 10)),
        ("0,3,0.67", Share(2, 3)),
        ("0,3,66.7 %", Share(2, 3)),
        (" 0 , 1e1 , 1. ", Share(10, 10)),
        ("0,10,", Share(0, 0)),
    ],
)
def test_a_share_and_the_number_of_runs_are_enough(
    tmp_path: Path, row: str, expected: Share
) -> None:
    """Shares with the digits that were published become counts; an empty one is not measured."""
    text = f"# From a paper,\n# its table 2.\nnoise,runs,overtake.detection\n{row}\n"

    found = read_cell_file(written(tmp_path, text))

    assert found.description == "From a paper, its table 2."
    assert found.cells[0].shares == {"overtake.detection": expected}


def test_failed_runs_are_no_trials(tmp_path: Path) -> None:
    """A share is one of the runs that did not fail; counts of it win."""
    text = "n,runs,failed,a.detection,b.false_alarms.successes\n1,10,2,0.5,3\n"

    (cell,) = read_cell_file(written(tmp_path, text)).cells

    assert cell.shares == {"a.detection": Share(4, 8), "b.false_alarms": Share(3, 8)}


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "1: expected a measure such as 'overtake.detection', found nothing"),
        ("a,runs\n1,2\n", "1: expected a measure such as 'overtake.detection', found a, runs"),
        (
            "a.detecton,runs\n",
            "1: column 'a.detecton': expected a measure, found 'a.detecton'; did",
        ),
        ("n,a.detection\n1,1\n", "1: expected the column 'runs', found n, a.detection"),
        ("runs,a.recall\n1,1\n", "column 'a.recall': expected the column 'a.recall.trials', bec"),
        ("runs,a.detection.low\n1,1\n", "expected 'a.detection' or 'a.detection.successes' as"),
        ("n,n,runs,a.detection\n", "1: column 'n': expected each column once, found it again"),
        ("n,,runs,a.detection\n", "1: expected a name for column 2, found none"),
        ("n,runs,a.detection\n", "1: expected a row for each cell below the header, found none"),
        ("n,runs,a.detection\n1,10\n", "2: expected 3 values, found 2"),
        ("n,runs,a.detection\n\n1,x,1\n", "3: column 'runs': expected a count, found 'x'"),
        ("n,runs,a.detection\n1,-1,1\n", "2: column 'runs': expected a count, found '-1'"),
        ("n,runs,a.detection\n1,2.5,1\n", "2: column 'runs': expected a count, found '2.5'"),
        ("n,runs,a.detection\n1,10,60\n", "2: column 'a.detection': expected a share from 0 to 1"),
        ("n,runs,a.detection\n1,10,0.65\n", "expected a share of 10 trials, such as 0.6, found"),
        ("n,runs,a.detection\n,10,0.6\n", "2: column 'n': expected a level, found nothing"),
        ("n,runs,failed,a.detection\n1,2,3,0\n", "'failed': expected at most 2 runs, found 3"),
        (
            "# x\nn,runs,a.detection.successes,a.detection.trials\n1,9,8,7\n",
            "3: column 'a.detection.successes': expected a count, at most 7, found '8'",
        ),
        (
            "n,runs,a.detection\n1,10,1\n2,10,1\n1.0,10,0\n",
            "4: expected each cell once, found that of line 2 again",
        ),
        ('n,runs,a.detection\n"1,10,1\n', "expected a table as CSV: unexpected end of data"),
    ],
)
def test_faults_have_their_place(tmp_path: Path, text: str, said: str) -> None:
    """Line, column, what was expected and what was found."""
    with pytest.raises(ExperimentError) as raised:
        read_cell_file(written(tmp_path, text))

    assert said in str(raised.value)
    assert str(raised.value).startswith(str(tmp_path / "cells.csv"))


def test_all_faults_are_told_up_to_twenty(tmp_path: Path) -> None:
    """One line for each; how many more there are is told as well."""
    text = "n,runs,a.detection\n" + "".join(f"{i},x,y\n" for i in range(30))

    with pytest.raises(ExperimentError) as raised:
        read_cell_file(written(tmp_path, text))

    assert len(raised.value.faults) == 21
    assert raised.value.faults[-1].startswith("and ")


@settings(
    derandomize=True,
    deadline=None,
    max_examples=300,
    suppress_health_check=[HealthCheck.function_scoped_fixture],
)
@given(st.data())
def test_damaged_tables_are_read_or_refused(tmp_path: Path, data: st.DataObject) -> None:
    """Whatever is written over a part of a table: it is read, or an error says why not."""
    whole = bundled_cell_files()["table-8.2-published"].read_text(encoding="utf-8")
    begin = data.draw(st.integers(0, len(whole)))
    end = data.draw(st.integers(begin, min(len(whole), begin + 60)))
    piece = data.draw(st.text(alphabet='0123456789.,-+%e"\n\r#ax\x00é ', max_size=8))

    try:
        found = read_cell_file(written(tmp_path, whole[:begin] + piece + whole[end:]))
    except ExperimentError:
        return

    assert found.cells
    assert all(0 <= s <= t for c in found.cells for s, t in c.shares.values())


def test_what_is_no_text_is_refused(tmp_path: Path) -> None:
    """Bytes that are no UTF-8, a folder, and nothing at all."""
    binary = tmp_path / "binary.csv"
    binary.write_bytes(b"\xff\xfe\x00")

    for path, said in ((binary, "UTF-8"), (tmp_path / "no.csv", "No such file")):
        with pytest.raises(ExperimentError, match=said):
            read_cell_file(path)


def test_the_published_table_comes_with_the_program() -> None:
    """Table 8.2 of Heintz (2009): 36 cells of ten runs, 228 of 360 recognised."""
    path = find_cell_file(Path("table-8.2-published"))

    assert path is not None
    found = read_cell_file(path)

    shares = [cell.shares["overtake.detection"] for cell in found.cells]
    assert len(shares) == 36
    assert {share.trials for share in shares} == {10}
    assert sum(share.successes for share in shares) == 228
    assert found.description.startswith("Heintz (2009)")

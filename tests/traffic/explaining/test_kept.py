"""What cannot be explained is refused with a message that says why."""

import json
import shutil

import pytest

from dyknow.time import SECOND
from traffic.errors import ExplanationError, ResultError
from traffic.explaining.kept import open_kept_run
from traffic.explaining.walking import Walker

pytestmark = pytest.mark.sumo


@pytest.fixture
def folder(recorded_run, tmp_path):
    """Return a copy of a run, to be damaged."""
    return shutil.copytree(recorded_run.folder, tmp_path / "run")


def test_a_run_that_does_not_exist_is_refused(tmp_path):
    """So is a folder that is none."""
    with pytest.raises(ExplanationError, match="does not exist; expected the folder of a run"):
        open_kept_run(tmp_path / "nothing")
    with pytest.raises(ResultError, match="holds no finished run"):
        open_kept_run(tmp_path)


def test_a_recording_is_not_a_run(recorded_run):
    """The message says how it becomes one."""
    with pytest.raises(ExplanationError, match=r"'traffic replay .*run\.mcap --out FOLDER'"):
        open_kept_run(recorded_run.path)


def test_a_run_of_an_older_version_is_refused(folder):
    """It keeps nothing to be explained by."""
    shutil.rmtree(folder / "explanations")

    with pytest.raises(ExplanationError, match="an older version of this program has made it"):
        open_kept_run(folder)


def test_a_run_of_another_version_is_refused(folder):
    """The message says which one was expected."""
    path = folder / "explanations" / "description.json"
    document = json.loads(path.read_text())
    path.write_text(json.dumps({**document, "version": 9}))

    with pytest.raises(
        ExplanationError, match=r"version 1, found 'traffic explanations', version 9"
    ):
        open_kept_run(folder)


@pytest.mark.parametrize("name", ["events", "changes", "states", "percepts", "links"])
@pytest.mark.parametrize("damage", ["cut", "missing", "other"])
def test_a_damaged_file_is_named(folder, name, damage):
    """A file that is cut off, missing, or another one, is refused by its name."""
    path = folder / "explanations" / f"{name}.parquet"
    match damage:
        case "cut":
            path.write_bytes(path.read_bytes()[:-200])
        case "missing":
            path.unlink()
        case _:
            shutil.copyfile(folder / "explanations" / "images.parquet", path)

    with pytest.raises(ExplanationError, match=rf"{name}\.parquet"):
        Walker(open_kept_run(folder)).explanation(1)


def test_a_damaged_description_is_refused(folder):
    """The message names the place."""
    (folder / "explanations" / "description.json").write_text('{"network": {}}')

    with pytest.raises(ExplanationError, match=r"description\.json' is damaged: sorts"):
        open_kept_run(folder)


def test_a_changed_chronicle_is_noticed(folder):
    """A recognition is never explained by a chronicle that it does not fit."""
    for path in (folder / "specification").glob("*.chronicle"):
        text = path.read_text()
        path.write_text(text.replace("event(cars.link[?c]:(?l1, ?), t1)", ""))

    with pytest.raises((ExplanationError, Exception), match="chronicle"):
        Walker(open_kept_run(folder)).explanation(1)


def test_chronicles_say_what_they_said_in_the_run(folder):
    """With the values that the specification gave to the parameters of their files."""
    path = folder / "explanations" / "description.json"
    text = path.read_text()
    assert text.count("file = turns, ") == 1
    path.write_text(text.replace("file = turns, ", "file = turns, in_crossing = 100 s, "))
    walker = Walker(open_kept_run(folder))
    found = [walker.explanation(number).recognition for number in (1, 2)]
    chronicles = {each.chronicle.name: each for each in walker.run.chronicles}

    assert chronicles["turn_left"].stream == "turns"
    assert chronicles["overtake"].file.parameters[0].value.duration == 60 * SECOND
    assert all("t2 - t1 in [0, 100000]" in [c.text for c in each.constraints] for each in found)

"""A user asks by number or by name, for text, JSON, and a picture."""

import json

import pytest
from typer.testing import CliRunner

from traffic.__main__ import app
from traffic.errors import ExplanationError, RequestError, ResultError
from traffic.explaining.asking import ExplanationRequest, explain_run, number_of, recognitions_of
from traffic.explaining.explanation import Explanation

pytestmark = pytest.mark.sumo


def asked(run, recognition, **options):
    """Return an explanation that was asked for."""
    request = ExplanationRequest.from_texts(run=run, recognition=recognition, **options)
    return explain_run(request, lambda _: "text", lambda *_: None)


def test_recognitions_are_listed_as_the_result_has_them(recorded_run):
    """The numbers begin with 1."""
    listed = recognitions_of(recorded_run.folder)

    assert [each.number for each in listed] == [*range(1, len(listed) + 1)]
    names = [each.chronicle for each in recorded_run.result.recognitions]
    assert [each.chronicle for each in listed] == names


def test_a_recognition_is_asked_for_by_number_or_name(explained_run):
    """A name that is not unique, or unknown, is refused with what would do."""
    run = explained_run.walker.run
    names = [each.chronicle for each in run.result.recognitions]
    repeated = next(name for name in names if names.count(name) > 1)

    assert number_of(run, "2") == 2
    with pytest.raises(ExplanationError, match="recognised more than once"):
        number_of(run, repeated)
    with pytest.raises(ExplanationError, match=f"did you mean '{repeated}'"):
        number_of(run, f"{repeated}x")


def test_a_folder_holds_text_json_and_picture(recorded_run, tmp_path):
    """Nothing is written over."""
    told = asked(recorded_run.folder, "1", out=tmp_path / "x", picture=tmp_path / "p.png")

    document = (tmp_path / "x" / "explanation.json").read_text()
    assert Explanation.model_validate_json(document) == told
    assert (tmp_path / "x" / "explanation.txt").read_text() == "text"
    picture = (tmp_path / "x" / "explanation.png").read_bytes()
    assert picture.startswith(b"\x89PNG")
    assert (tmp_path / "p.png").read_bytes() == picture
    with pytest.raises(ResultError, match="exists already"):
        asked(recorded_run.folder, "1", out=tmp_path / "x")
    with pytest.raises(RequestError, match="does not exist yet"):
        asked(recorded_run.folder, "1", picture=tmp_path / "p.png")


def test_a_folder_is_not_left_half_written(recorded_run, tmp_path):
    """If there is no such recognition, there is no folder either."""
    with pytest.raises(ExplanationError):
        asked(recorded_run.folder, "999", out=tmp_path / "x")

    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("option", ["picture", "out"])
def test_a_list_has_no_picture(recorded_run, tmp_path, option):
    """An option that would have no effect is refused."""
    with pytest.raises(RequestError, match="only has a meaning with a recognition"):
        ExplanationRequest.from_texts(
            run=recorded_run.folder, recognition=None, **{option: tmp_path / "x.png"}
        )


def test_the_command_prints_text_or_json(recorded_run):
    """Both tell of the same recognition; without a number there is a list."""
    runner, folder = CliRunner(), str(recorded_run.folder)

    text = runner.invoke(app, ["explain", folder, "1"], env={"COLUMNS": "200"}).output
    document = json.loads(runner.invoke(app, ["explain", folder, "1", "--json"]).stdout)
    listed = json.loads(runner.invoke(app, ["explain", folder, "--json"]).stdout)
    table = runner.invoke(app, ["explain", folder], env={"COLUMNS": "200"}).output

    first = listed["recognitions"][0]
    assert document["recognition"]["chronicle"] == first["chronicle"]
    for part in ("events", "constraints", "counted", "objects", "frames", "let through by"):
        assert part in text
    assert first["chronicle"].replace("_", " ") in text
    assert first["chronicle"].replace("_", " ") in table

"""A recognition that is made of recognitions is explained down to their events."""

import json
import shutil

import pytest

from traffic.explaining.kept import open_kept_run
from traffic.explaining.pictures import picture_of
from traffic.explaining.walking import Walker

pytestmark = pytest.mark.sumo


@pytest.fixture
def walker(recorded_run, tmp_path):
    """Return a run with one more recognition: an event of it is the first recognition."""
    folder = shutil.copytree(recorded_run.folder, tmp_path / "run")
    path = folder / "result.json"
    document = json.loads(path.read_text())
    first = document["recognitions"][0]
    at, parameters = first["recognised_at"], ", ".join(f"?{name}" for name in first["arguments"])
    event = {
        "t": at,
        "attribute": first["chronicle"],
        "arguments": list(first["arguments"].values()),
        "from": f"{first['begin']:g}",
        "to": f"{first['end']:g}",
    }
    above = {
        "chronicle": "above", "arguments": {"c": first["arguments"]["c"]}, "times": {"t": at},
        "begin": at, "end": at, "recognised_at": at, "events": [event],
    }  # fmt: skip
    document["recognitions"].append({**first, **above})
    path.write_text(json.dumps(document))
    name = f"{first['chronicle']}[{parameters}]"
    text = f"attribute {name}\nchronicle above[?c] {{ event({name}:(?, ?), t) }}\n"
    (folder / "specification" / "above.chronicle").write_text(text)
    return Walker(open_kept_run(folder))


def test_the_walk_goes_on_below(walker):
    """What is below is explained as it is by itself."""
    above = walker.explanation(len(walker.run.result.recognitions)).recognition

    (event,) = above.events
    assert event.recognition == walker.explanation(1).recognition
    assert event.sample is None
    assert event.objects == [above.values["c"]]


def test_the_picture_shows_the_frames_below(walker):
    """The frames of what it is made of are shown as well."""
    explanation = walker.explanation(len(walker.run.result.recognitions))

    assert picture_of(walker, explanation, lambda *_: None).startswith(b"\x89PNG")

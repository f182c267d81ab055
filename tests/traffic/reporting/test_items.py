"""What a page lists: verdicts, numbers, and what is known of a miss."""

from traffic.reporting.items import items_of, symbols_of
from traffic.results import Manoeuvre, RecognitionResult, RunResult, Score, Timing


def recognition(agrees, begin=1000.0, truth="car.7", kind="turn"):
    """Return a recognised left turn of car3."""
    return RecognitionResult(
        chronicle="turn_left",
        arguments={"c": "car3", "from": "a", "crossing": "x", "to": "b"},
        times={},
        begin=begin,
        end=begin + 2000,
        recognised_at=begin + 2100,
        events=[],
        truth=None if truth is None else {"c": truth},
        agrees=agrees,
        kind=kind,
    )


def result(*recognitions, missed=(), scored=True):
    """Return the result of a run."""
    return RunResult(
        scenario="crossing",
        settings={},
        recognitions=list(recognitions),
        missed=list(missed),
        score={"turn": Score.of(1, 1, 1, 0)} if scored else {},
        timing=Timing(simulated_s=10, wall_s=1, real_time_factor=10, stages={}),
    )


def miss(*vehicles, begin=2000.0):
    """Return a missed left turn."""
    return Manoeuvre(
        kind="turn_left",
        vehicles=list(vehicles),
        place=["a", "x", "b"],
        begin=begin,
        end=begin + 1,
    )


def test_verdicts_tell_all_cases_apart():
    """Correct, false, not wholly in view, not judged, and missed."""
    said = [recognition(True), recognition(False), recognition(None), recognition(None, kind=None)]

    items = items_of(result(*said, missed=[miss("car.1")]))

    assert [i["verdict"] for i in items] == ["hit", "false", "outside", "unjudged", "missed"]
    assert [i["number"] for i in items] == [1, 2, 3, 4, None]
    assert items[0]["id"] == "recognition=1"
    assert items[4]["id"] == "missed=1"
    assert (items[0]["cars"], items[0]["where"]) == (["car3"], ["a", "x", "b"])


def test_a_miss_knows_what_was_recognised_instead():
    """Of the same vehicle, at about the same time; later ones and others are not meant."""
    said = [recognition(False), recognition(True, 90_000.0), recognition(False, truth="van.2")]

    item = items_of(result(*said, missed=[miss("car.7")]))[-1]

    assert item["instead"] == [1]
    assert item["cars"] == ["car3"]


def test_vehicles_that_were_never_recognised_have_no_symbol():
    """Recognitions of nothing real tell nothing either."""
    assert symbols_of(result(recognition(False, truth=None)), ["car.7"]) == []

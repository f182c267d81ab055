"""What users ask for on the command line."""

from pathlib import Path

import pytest

from dyknow.time import MILLISECOND, SECOND
from traffic.errors import RequestError, ScenarioError
from traffic.request import RunRequest, View


def test_a_bundled_name_is_enough():
    """Everything else has a default."""
    request = RunRequest.from_texts(scenario="crossing")

    assert request.view is View.VISION
    assert request.sample_period == 100 * MILLISECOND
    assert request.scenario.step_length == 40 * MILLISECOND


@pytest.mark.parametrize(
    ("period", "step"),
    [("100", 100), ("200 ms", 100), ("50", 50), ("250", 50), ("1.5 s", 100), ("110", 55)],
)
def test_the_simulator_steps_as_far_as_the_period_allows(period, step):
    """Without cameras the step is the longest part of the period up to 100 ms."""
    request = RunRequest.from_texts(scenario="crossing", view="truth", sample_period=period)

    assert request.scenario.step_length == step * MILLISECOND


def test_duration_and_camera_of_the_scenario_can_be_replaced():
    """What the command line says wins over the scenario."""
    request = RunRequest.from_texts(scenario="crossing", duration="7 s", look_at="-3,4.5")

    assert request.scenario.duration == 7 * SECOND
    assert request.scenario.camera is not None
    assert request.scenario.camera.look_at == (-3.0, 4.5)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({}, "either a scenario or --sumocfg, found 'neither'"),
        ({"scenario": "crossing", "sumocfg": Path("x")}, "found 'both'"),
        ({"view": "sonar"}, "--view: expected 'vision' or 'truth', found 'sonar'"),
        ({"position_noise": 2.0}, "--position-noise: expected nothing"),
        ({"position_noise": -2.0, "view": "truth"}, "at least 0, found '-2.0'"),
        ({"look_at": "centre", "view": "truth"}, "--look-at: expected nothing"),
        ({"overlay": Path("x.mp4"), "view": "truth"}, "--overlay: expected nothing"),
        ({"sample_period": "fast"}, "--sample-period: expected a duration"),
        ({"sample_period": "25"}, "--sample-period: expected a multiple of 10 ms"),
        ({"duration": "0"}, "--duration: expected a duration above zero"),
        ({"duration": "3 fortnights"}, "--duration: expected a duration"),
        ({"seed": -1}, "--seed: expected a number of at least 0"),
        ({"streams": "cars"}, "--streams: expected nothing, because it only has a meaning with"),
        ({"record_images": True}, "--record-images: expected nothing, because it only has"),
        (
            {"longest_frame_period": "80"},
            "nothing, because it only has a meaning with --real-time",
        ),
        ({"longest_frame_period": "90", "real_time": True}, "expected a multiple of 40 ms"),
        (
            {"longest_frame_period": "80", "view": "truth"},
            "--longest-frame-period: expected nothing",
        ),
        ({"record": Path("x.bag")}, "--record: expected a name that ends in .mcap"),
        ({"record": Path("no/x.mcap")}, "--record: expected a file in a folder that exists"),
        ({"record": Path("x.mcap"), "streams": " , "}, "--streams: expected labels of streams"),
        (
            {"record": Path("x.mcap"), "record_images": True, "view": "truth"},
            "--record-images: expected nothing, because it only has a meaning with --view vision",
        ),
    ],
)
def test_impossible_requests_say_what_was_expected_and_found(options, message):
    """Each fault of the command line names the option, the expectation and the finding."""
    defaults = {} if message.endswith("'neither'") else {"scenario": "crossing"}

    with pytest.raises(RequestError) as caught:
        RunRequest.from_texts(**{**defaults, **options})
    assert message in str(caught.value)


@pytest.mark.parametrize(
    ("text", "labels"),
    [
        ("cars", ("cars",)),
        ("cars, percepts[vision],cars", ("cars", "percepts[vision]")),
        ("sync(a, sync(b, c)),d[x, y]", ("sync(a, sync(b, c))", "d[x, y]")),
    ],
)
def test_streams_to_record_are_separated_by_commas(text, labels):
    """Those in brackets belong to a label; a label counts once."""
    request = RunRequest.from_texts(scenario="crossing", record=Path("x.mcap"), streams=text)

    assert request.recording is not None
    assert request.recording.streams == labels


def test_an_unknown_scenario_is_answered_with_the_nearest_name():
    """A misspelt name is recognised."""
    with pytest.raises(ScenarioError, match="did you mean 'crossing'"):
        RunRequest.from_texts(scenario="crosing")


@pytest.mark.parametrize(
    ("options", "names"),
    [
        ({}, ("turns", "overtakes")),
        ({"recognise": "all"}, None),
        ({"recognise": "wrong_way, turns"}, ("wrong_way", "turns")),
        ({"specification": Path("mine.kpl")}, None),
    ],
)
def test_a_scenario_says_what_is_recognised_unless_a_user_does(options, names):
    """Of a specification of one's own everything: the scenario speaks of the bundled one."""
    assert RunRequest.from_texts(scenario="crossing", **options).recognise == names

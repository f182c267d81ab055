"""What the symbols of formulas stand for."""

import pytest

from dyknow.errors import SpecificationErrors
from dyknow.kpl.names import Declarations
from dyknow.kpl.parser import parse_specification
from dyknow.monitoring.interpretation import Interpretation, Origin, origins_of
from dyknow.mtl.parser import parse_formula
from dyknow.mtl.symbols import extract_symbols

DECLARED = """
source n sensor
source ids members
strmgen speed[uav1] = sensor
strmgen distance[uav1, uav2] = sensor
strmgen pose[uav1] = sensor
strmgen wind = sensor
strmgen cars = sensor
for each car in cars { strmgen lane[car] = sensor }
"""


def _origins(formula, **interpretation):
    features = extract_symbols([parse_formula(formula)]).features
    declared = Declarations(parse_specification(DECLARED))
    return origins_of(features, Interpretation(**interpretation), declared)


def _fault(formula, **interpretation):
    with pytest.raises(SpecificationErrors) as caught:
        _origins(formula, **interpretation)
    (fault,) = caught.value.exceptions
    return fault.message


def test_a_feature_stands_for_the_stream_of_its_label():
    """In both notations, with any number of objects; objects may be written as texts."""
    assert _origins('speed(uav1) > 1 and distance["uav1", uav2] > wind') == (
        Origin("speed(uav1)", "speed[uav1]"),
        Origin('distance("uav1", uav2)', "distance[uav1, uav2]"),
        Origin("wind", "wind"),
    )


def test_a_name_behind_a_point_is_a_field_or_a_column():
    """Of the values of a generator with these objects, or else of the rows of a table."""
    assert _origins("pose.height[uav1] > cars.speed[car3] + cars.count + wind.at.sea") == (
        Origin("pose.height(uav1)", "pose[uav1]", ("height",)),
        Origin("cars.speed(car3)", "cars", ("speed",), "car3"),
        Origin("cars.count", "cars", ("count",)),
        Origin("wind.at.sea", "wind", ("at", "sea")),
    )


@pytest.mark.parametrize(
    ("features", "origin"),
    [
        ({"v": "speed"}, Origin("v(uav1)", "speed[uav1]")),
        ({"v": "wind"}, None),
        ({"v": "speed[uav1]"}, Origin("v(uav1)", "speed[uav1]")),
        ({"v": "distance[uav1,uav2]"}, Origin("v(uav1)", "distance[uav1, uav2]")),
        ({"v": "pose.speed"}, Origin("v(uav1)", "pose[uav1]", ("speed",))),
        ({"v": "cars.speed"}, Origin("v(uav1)", "cars", ("speed",), "uav1")),
        ({"v[uav1]": "wind"}, Origin("v(uav1)", "wind")),
        ({"v": "speed", "v(uav1)": "wind.speed"}, Origin("v(uav1)", "wind", ("speed",))),
    ],
)
def test_an_interpretation_comes_before_the_name(features, origin):
    """What it says of a feature with its objects comes before what it says of the feature."""
    if origin is None:
        assert "expected a column of the table stream 'wind'" in _fault(
            "v(uav1)", features=features
        )
    else:
        assert _origins("v(uav1)", features=features) == (origin,)


def test_what_no_stream_stands_for_is_told_with_what_was_expected():
    """Together with the labels that are nearest."""
    assert _fault("sped(uav1)") == (
        "no stream for the feature 'sped(uav1)': expected a stream generator called 'sped[uav1]'; "
        "nearest are 'speed[uav1]', 'pose[uav1]'"
    )
    assert _fault("cars[car3] = 5") == (
        "no stream for the feature 'cars(car3)': expected a column of the table stream 'cars', "
        "as in 'cars.COLUMN'"
    )
    assert _fault("speed(3)") == (
        "no stream for the feature 'speed(3)': expected a label for it in the interpretation, "
        "since it cannot be one itself"
    )
    assert _fault("lane[car3] = 5").startswith(
        "no stream for the feature 'lane(car3)': expected a stream generator called 'lane[car3]' "
        "that is always there, not for each 'car' in 'cars' alone"
    )
    assert _fault("été[uav1] > 3") == (
        "no stream for the feature 'été(uav1)': expected a label for it in the interpretation, "
        "since it cannot be one itself"
    )


def test_names_are_constants_or_objects_or_neither():
    """A constant comes before an object of the same name."""
    meaning = Interpretation(constants={"limit": 3, "uav2": 5}, domains={"UAV": ("uav1", "uav2")})

    assert meaning.constant("limit") == 3
    assert meaning.constant("uav1") == "uav1"
    assert meaning.constant("uav2") == 5
    assert meaning.constant("speed") is None
    later = Interpretation(constants={"limit": 4}, domains={"Car": ["car1"]})
    assert meaning.joined(later) == Interpretation(
        constants={"limit": 4, "uav2": 5}, domains={"UAV": ("uav1", "uav2"), "Car": ["car1"]}
    )


def test_what_can_be_no_interpretation_is_refused():
    """A label that is none, and a domain that is a single name."""
    with pytest.raises(ValueError, match=r"for the feature 'speed', found 'cars\.\.speed'"):
        Interpretation({"speed": "cars..speed"})
    with pytest.raises(ValueError, match="expected names of objects for 'UAV', found 'uav1'"):
        Interpretation(domains={"UAV": "uav1"})

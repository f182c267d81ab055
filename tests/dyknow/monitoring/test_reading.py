"""Values of features, read out of states."""

from dataclasses import dataclass

import numpy as np
import pytest

from dyknow.errors import FeatureError
from dyknow.monitoring.interpretation import Origin
from dyknow.monitoring.reading import StateReader
from dyknow.streams.sample import NO_VALUE
from dyknow.streams.table import Table
from tests.support.streams import ms


@dataclass
class Pose:
    """A value with fields."""

    height: float
    wind: dict[str, object]


def _cars(ids, **columns):
    return Table("car", ids, {name: np.array(column) for name, column in columns.items()})


SPEED = Origin("speed(car3)", "cars", ("speed",), "car3")
LANE = Origin("lane(car7)", "cars", ("lane",), "car7")


def test_each_feature_finds_its_value():
    """Whole values, fields of values, and columns of rows, as plain values of Python."""
    origins = [
        Origin("p", "flag"),
        Origin("height(uav1)", "pose[uav1]", ("height",)),
        Origin("wind(uav1)", "pose[uav1]", ("wind", "north")),
        SPEED,
        LANE,
    ]
    reader = StateReader(
        origins, ["cars", "flag", "pose[uav1]"], {"limit": 3}, {"at": lambda time: time}
    )
    cars = _cars([7, 3], speed=[1.5, 2.5], lane=["A", "B"])

    values = reader.read((cars, True, Pose(4.0, {"north": np.float64(2)})), ms(7))

    assert values == {
        "limit": 3,
        "at": ms(7),
        "p": True,
        "height(uav1)": 4.0,
        "wind(uav1)": 2.0,
        "speed(car3)": 2.5,
        "lane(car7)": "A",
    }
    assert type(values["speed(car3)"]) is float


@pytest.mark.parametrize(
    ("origin", "value", "message"),
    [
        (Origin("p", "s"), NO_VALUE, "feature 'p': expected a value, found none"),
        (Origin("p", "s", ("x",)), NO_VALUE, "feature 'p': expected a value, found none"),
        (
            Origin("p", "s", ("x",)),
            {"y": 1},
            "expected a field 'x' in the values of 's', found no field 'x': expected one of y",
        ),
        (SPEED, NO_VALUE, "feature 'speed(car3)': expected a table in 'cars', found none"),
        (SPEED, 5, "feature 'speed(car3)': expected a table in 'cars', found int"),
        (SPEED, _cars([7], speed=[1.0]), "expected a row of 'car3', found none in the table"),
        (
            Origin("speed(bus3)", "cars", ("speed",), "bus3"),
            _cars([3], speed=[1.0]),
            "expected a row of 'bus3', found none in the table",
        ),
        (
            Origin("speed(car03)", "cars", ("speed",), "car03"),
            _cars([3], speed=[1.0]),
            "expected a row of 'car03', found none in the table",
        ),
        (LANE, _cars([7], speed=[1.0]), "expected a field 'lane' in the values of 'cars'"),
    ],
)
def test_what_is_missing_is_told_by_its_feature(origin, value, message):
    """With what was expected and what was found."""
    with pytest.raises(FeatureError) as caught:
        StateReader([origin], [origin.stream], {}).read((value,), ms(0))
    assert message in str(caught.value)

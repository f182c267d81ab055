"""Cameras and perception on streams."""

import numpy as np

from dyknow.streams.sample import NO_SAMPLE, NO_VALUE, Sample
from dyknow.streams.table import Table
from dyknow.time import TimePoint
from perception.painting import GroundPainter
from perception.processes import ColourCamera, ThermalCamera, VisionPercepts
from perception.scene import Surroundings
from tests.perception.scenes import CAR, FRAME, camera, road, texture, vehicles
from tests.support.laws import assert_unit_laws
from tests.support.streams import run_unit

COLUMNS = {
    "position",
    "velocity",
    "covariance",
    "length",
    "width",
    "colour",
    "temperature",
    "observed_at",
}
POSE = [Sample(camera(), TimePoint(0), TimePoint(0))]


def make_colour():
    """Return a colour camera; each one made is the same."""
    painter = GroundPainter(road(), Surroundings(), texture())
    return ColourCamera(painter=painter, generator=np.random.default_rng(1))


def make_thermal():
    """Return a thermal camera."""
    painter = GroundPainter(road(), Surroundings(), texture())
    return ThermalCamera(painter=painter, generator=np.random.default_rng(2))


def make_percepts():
    """Return the unit that perceives."""
    return VisionPercepts(roads=road().paved)


def vehicle_stream(frames):
    """Return tables of one moving car, every 40 ms."""
    samples = []
    for frame in range(frames):
        seen = vehicles([(1, -20 + 0.5 * frame, -3.0, 0.0, CAR)])
        names = ("position", "heading", "length", "width", "height", "colour")
        table = Table("vehicle", seen.ids, {name: getattr(seen, name) for name in names})
        samples.append(Sample(table, TimePoint(frame * FRAME), TimePoint(frame * FRAME + 1)))
    return samples


def states_of(frames):
    """Return states of both images, as synchronisation delivers them."""
    end = TimePoint(frames * FRAME)
    colour = run_unit(make_colour(), vehicle_stream(frames), POSE, until=end)
    thermal = run_unit(make_thermal(), vehicle_stream(frames), POSE, until=end)
    return [
        Sample((c.value, t.value), c.valid_time, c.available_time)
        for c, t in zip(colour, thermal, strict=True)
    ]


def test_a_camera_gives_one_image_for_each_table_of_vehicles():
    """The image has the valid time of the vehicles; a pose alone gives none."""
    images = run_unit(make_colour(), vehicle_stream(3), POSE, until=TimePoint(10 * FRAME))

    assert [image.valid_time for image in images] == [0, FRAME, 2 * FRAME]
    assert images[0].value.shape == (360, 640, 3)


def test_percepts_are_tables_with_the_columns_of_the_stream():
    """Each state of images gives a table; after a few frames it has the car."""
    percepts = run_unit(make_percepts(), states_of(8), POSE, until=TimePoint(10 * FRAME))

    last = percepts[-1].value
    assert len(percepts) == 8
    assert last.sort == "percept"
    assert set(last.columns) == COLUMNS
    assert last.ids.tolist() == [1]
    assert last["covariance"].shape == (1, 2, 2)
    assert last["observed_at"].tolist() == [7 * FRAME]
    np.testing.assert_allclose(last["position"], [[-16.5, -3.0]], atol=0.3)


def test_a_state_may_lack_an_image():
    """With NO_VALUE for one image the other one is used."""
    states = [Sample((NO_VALUE, s.value[1]), s.valid_time, s.available_time) for s in states_of(6)]

    percepts = run_unit(make_percepts(), states, POSE, until=TimePoint(10 * FRAME))

    assert len(percepts[-1].value) == 1
    assert np.isnan(percepts[-1].value["colour"]).all()


def test_nothing_is_emitted_before_there_is_a_pose():
    """Neither cameras nor percepts say anything without a pose, or for an explicit no value."""
    (vehicle,) = vehicle_stream(1)
    nothing = Sample(NO_VALUE, TimePoint(0), TimePoint(0))

    for unit in (make_colour(), make_thermal(), make_percepts()):
        assert list(unit.push(TimePoint(1), (vehicle, NO_SAMPLE))) == []
        assert list(unit.push(TimePoint(1), (nothing, POSE[0]))) == []
        assert list(unit.advance(TimePoint(5))) == []
        assert unit.due() is None


def test_the_units_keep_the_laws():
    """Repeatable, independent of the ticking of the clock, in order, and causal."""
    for make in (make_colour, make_thermal):
        assert_unit_laws(
            make, vehicle_stream(4), POSE, until=TimePoint(5 * FRAME), tick=FRAME // 2
        )
    assert_unit_laws(
        make_percepts, states_of(6), POSE, until=TimePoint(7 * FRAME), tick=FRAME // 2
    )

"""What viewers are shown of a recording."""

import math

import cv2
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from chronicles.events import Recognition
from dyknow.streams.sample import Sample
from dyknow.streams.table import Table
from networks.reading import read_road_map
from perception.camera import Camera
from traffic.bundled import data_folder
from traffic.recording.views import (
    CarScenes,
    image_view,
    log_of_recognitions,
    pose_of_camera,
    scene_of_map,
    transform_of_camera,
)

CROSSING = data_folder() / "networks" / "crossing" / "crossing.net.xml"


def cars(*ids, observed=True):
    """Return cars in a row, heading north."""
    n = len(ids)
    columns = {
        "position": np.column_stack([np.arange(n) * 10.0, np.zeros(n)]),
        "heading": np.full(n, math.pi / 2),
        "length": np.full(n, 4.5),
        "width": np.full(n, 1.8),
        "observed": np.full(n, observed),
    }
    return Table("car", np.array(ids, dtype=np.int64), columns)


def shown(scenes):
    """Return the ids that a viewer shows after a number of updates, by their definition."""
    ids = set()
    for scene in scenes:
        ids -= {deletion.id for deletion in scene.deletions}
        ids |= {entity.id for entity in scene.entities}
    return ids


def test_a_car_is_a_box_with_its_symbol():
    """The box has the car's place, size and heading, in the frame 'map', at the valid time."""
    scene = CarScenes().scene(Sample(cars(3, 7), 1_500_000_000, 1_600_000_000))

    _, second = scene.entities
    (box,), (text,) = second.cubes, second.texts
    assert (second.id, second.frame_id, text.text) == ("car7", "map", "car7")
    assert (second.timestamp.seconds, second.timestamp.nanos) == (1, 500_000_000)
    assert (box.pose.position.x, box.pose.position.y) == (10.0, 0.0)
    assert (box.size.x, box.size.y) == (4.5, 1.8)
    turned = box.pose.orientation
    assert Rotation.from_quat([turned.x, turned.y, turned.z, turned.w]).apply(
        [1, 0, 0]
    ) == pytest.approx([0, 1, 0])


def test_a_car_that_is_only_predicted_is_grey():
    """Seen cars have a colour of their own, opaque."""
    scenes = CarScenes()
    seen = scenes.scene(Sample(cars(1, 2), 0, 0)).entities
    predicted = scenes.scene(Sample(cars(1, 2, observed=False), 1, 1)).entities

    assert seen[0].cubes[0].color != seen[1].cubes[0].color
    assert predicted[0].cubes[0].color == predicted[1].cubes[0].color
    assert predicted[0].cubes[0].color.a < seen[0].cubes[0].color.a


@settings(derandomize=True, deadline=None, max_examples=50)
@given(st.lists(st.sets(st.integers(0, 5)), max_size=8))
def test_the_scene_always_shows_the_cars_of_the_last_table(tables):
    """Whatever came before: a car that is gone is deleted, also after a table without cars."""
    made = CarScenes()
    scenes = [made.scene(Sample(cars(*sorted(ids)), t, t)) for t, ids in enumerate(tables)]

    expected = {f"car{one}" for one in tables[-1]} if tables else set()
    assert shown(scenes) == expected


def test_the_map_is_drawn_once_as_lines():
    """Outlines are closed; all points lie within the map."""
    road_map = read_road_map(CROSSING)
    roads, markings = scene_of_map(road_map).entities

    left, bottom, right, top = road_map.bounds
    assert (roads.id, markings.id) == ("roads", "markings")
    assert len(markings.lines) == len(road_map.markings)
    assert all(line.type == line.LINE_LOOP for line in roads.lines)
    points = [(point.x, point.y) for line in roads.lines for point in line.points]
    assert all(left - 1 <= x <= right + 1 and bottom - 1 <= y <= top + 1 for x, y in points)


@pytest.mark.parametrize("heading", [0.0, 1.0, math.pi / 2, -2.0])
@pytest.mark.parametrize("pitch", [math.pi / 2, 1.2])
def test_the_pose_of_the_camera_is_that_of_its_frame(heading, pitch):
    """Its z axis points where the camera looks, its y axis down in the image."""
    camera = Camera.looking_at(5.0, 6.0, 100.0, heading=heading, pitch=pitch)
    sample = Sample(camera, 0, 0)
    pose, transform = pose_of_camera(sample).pose, transform_of_camera(sample)

    turned = pose.orientation
    axes = Rotation.from_quat([turned.x, turned.y, turned.z, turned.w]).as_matrix()
    at = (pose.position.x, pose.position.y, pose.position.z)
    assert at == camera.position
    assert np.allclose(axes.T, camera.camera_from_world)
    assert transform.rotation == turned
    assert (transform.parent_frame_id, transform.child_frame_id) == ("map", "camera")


@pytest.mark.parametrize("shape", [(16, 24), (16, 24, 3)])
def test_images_are_jpeg(shape):
    """A viewer decodes nearly the same image, grey or in colour."""
    image = np.full(shape, 120, dtype=np.uint8)
    view = image_view(Sample(image, 0, 0))

    decoded = cv2.imdecode(np.frombuffer(view.data, dtype=np.uint8), cv2.IMREAD_UNCHANGED)
    assert view.format == "jpeg"
    assert decoded.shape == shape
    assert np.abs(decoded.astype(int) - image).max() <= 3


def test_recognitions_are_lines_of_a_log():
    """One for each, at the time at which they were recognised; nothing if there are none."""
    one = Recognition("turn_left", {"c": "car7", "x": "centre"}, {}, (), 0, 1, 2)
    other = Recognition("overtake", {"c1": "car1", "c2": "car2"}, {}, (), 0, 1, 2)
    log = log_of_recognitions(Sample((one, other), 1, 2_000_000_000))

    assert log is not None
    assert log.message == "turn left: car7, centre\novertake: car1, car2"
    assert log.timestamp.seconds == 2
    assert log_of_recognitions(Sample((), 1, 2)) is None

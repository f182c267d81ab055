"""One list from two cameras."""

import numpy as np

from perception.fusion import fuse, lies_in
from tests.perception.sightings import sightings


def test_where_both_see_a_vehicle_the_thermal_camera_is_believed():
    """The position of the fused sighting is the thermal one's."""
    fused = fuse(sightings((0.0, 0.0, 0, 5, 1.8)), sightings((0.5, 0.2, 0, 5, 2.4)))

    np.testing.assert_allclose(fused.position, [[0.0, 0.0]])


def test_what_one_camera_alone_sees_is_kept():
    """Thermal-only and colour-only sightings are both in the result."""
    fused = fuse(sightings((0.0, 0.0, 0, 5, 1.8)), sightings((20.0, 0.0, 0, 5, 1.8)))

    np.testing.assert_allclose(fused.position[:, 0], [0.0, 20.0])


def test_a_colour_blob_over_two_thermal_ones_is_dropped():
    """Two cars that have grown together in the colour image stay two."""
    fused = fuse(
        sightings((0.0, 0.0, 0, 5, 1.8), (0.0, 3.2, 0, 5, 1.8)),
        sightings((0.0, 1.6, 0, 5.2, 5.0)),
    )

    assert len(fused) == 2


def test_several_colour_pieces_of_one_thermal_blob_are_dropped():
    """Bonnet and boot of a grey car do not count beside its whole thermal blob."""
    fused = fuse(
        sightings((0.0, 0.0, 0, 5, 1.8)),
        sightings((1.8, 0.0, 0, 1.3, 1.7), (-1.8, 0.0, 0, 1.3, 1.7)),
    )

    assert len(fused) == 1
    assert fused.length[0] == 5


def test_a_thermal_blob_that_shows_only_a_part_gives_way():
    """When the colour blob is a solid vehicle and the thermal one a warm engine, colour wins."""
    fused = fuse(sightings((1.5, 0.0, 0, 1.5, 1.5)), sightings((0.0, 0.0, 0, 5, 1.8)))

    np.testing.assert_allclose(fused.position, [[0.0, 0.0]])


def test_one_empty_list_leaves_the_other():
    """Without colour (or thermal) sightings the others are the result."""
    some = sightings((0.0, 0.0, 0, 5, 1.8), (9.0, 0.0, 0, 5, 1.8))

    assert len(fuse(some, sightings())) == 2
    assert len(fuse(sightings(), some)) == 2
    assert len(fuse(sightings(), sightings())) == 0


def test_rectangles_are_turned_by_their_angle():
    """A point beside a vehicle that points north is outside, one ahead of it is inside."""
    north = sightings((0.0, 0.0, np.pi / 2, 5, 1.8))

    inside = lies_in(np.array([[0.0, 2.4], [2.4, 0.0]]), north)

    assert inside[:, 0].tolist() == [True, False]

"""Buildings and parking areas beside the roads."""

from pathlib import Path

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from networks.errors import NetworkFileError
from networks.reading import read_road_map
from networks.surroundings import Surroundings, read_surroundings, surroundings_file

HIGH_STREET = Path(__file__).parents[2] / "data/networks/high_street/high_street.net.xml"

TEXT = """<additional>
    <poly id="inn" type="building.hotel" shape="0,0 10,0 10,8 0,8"/>
    <poly id="lot" type="amenity.parking" shape="20,0 30,0 30,5"/>
    <poly id="pond" type="natural.water" shape="1,1"/>
</additional>"""


def surroundings(text: str, folder: Path) -> Surroundings:
    """Return what a text beside a network says."""
    (folder / "town.poly.xml").write_text(text, encoding="utf-8")
    return read_surroundings(folder / "town.net.xml")


def fault(text: str, folder: Path) -> str:
    """Return the fault of such a text, without the folder."""
    with pytest.raises(NetworkFileError) as caught:
        surroundings(text, folder)
    return str(caught.value).removeprefix(f"{folder}/")


def test_parts_of_the_type_tell_what_a_polygon_is(tmp_path: Path) -> None:
    """Buildings have names, parking areas need none, all else is left out."""
    found = surroundings(TEXT, tmp_path)

    assert found.names == ("inn",)
    assert [shape.area for shape in found.buildings] == [80.0]
    assert [shape.area for shape in found.parking] == [25.0]


def test_a_network_without_polygons_has_no_surroundings(tmp_path: Path) -> None:
    """The file may be missing, and its name follows that of the network."""
    assert read_surroundings(tmp_path / "town.net.xml").names == ()
    assert surroundings_file(Path("a/b.net.xml.gz")) == Path("a/b.poly.xml")


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ('id="inn"', 'id=""', "town.poly.xml:2:5: expected a name that no other building has"),
        ("10,8 0,8", "10,8 0;8", "town.poly.xml:2:5: expected corners such as"),
        ("0,0 10,0 10,8 0,8", "0,0 10,0", "2:5: expected at least 3 corners, found 2"),
        ('type="building.hotel"', 'type="building" geo="1"', "expected a shape in metres"),
        ("20,0", "nan,0", "town.poly.xml:3:5: expected a shape in metres"),
        ("</additional>", "", "town.poly.xml:5:1: not well-formed XML: no element found"),
    ],
)
def test_faults_have_places(tmp_path: Path, old: str, new: str, expected: str) -> None:
    """Line and column of the polygon, and what is wrong with it."""
    assert expected in fault(TEXT.replace(old, new, 1), tmp_path)


def test_the_bundled_high_street_has_buildings_and_bays() -> None:
    """Vehicles may stand in the bays, which are ground for them beside the lanes."""
    road_map = read_road_map(HIGH_STREET)

    bay = np.array([[-60.0, -4.8]])
    assert "library" in road_map.surroundings.names
    assert road_map.distance_to_road(bay) == 0.0
    assert road_map.locate(bay).lane == -1
    assert len(road_map.road_polygons()) > len(road_map.areas.shapes)


boxes = st.lists(
    st.tuples(st.integers(-50, 50), st.integers(-50, 50), st.integers(1, 20), st.integers(1, 20)),
    min_size=1, max_size=6,
).map(lambda all_: [shapely.box(x, y, x + w, y + h) for x, y, w, h in all_])  # fmt: skip
places = st.lists(st.tuples(st.floats(-60, 60), st.floats(-60, 60)), min_size=1, max_size=8)


@settings(derandomize=True, deadline=None, max_examples=100)
@given(shapes=boxes, points=places, within=st.floats(0.5, 30))
def test_the_nearest_building_is_that_of_the_definition(
    shapes: list[shapely.Polygon], points: list[tuple[float, float]], within: float
) -> None:
    """No other is nearer, and it is near enough; distances to parking areas are the least."""
    array = np.array(shapes, dtype=np.object_)
    known = Surroundings(tuple(map(str, range(len(shapes)))), array, array)

    nearest = known.nearest_building(np.array(points), within)

    for point, found in zip(points, nearest.tolist(), strict=True):
        distances = [shape.distance(shapely.Point(point)) for shape in shapes]
        if found < 0:
            assert min(distances) > within - 1e-9
        else:
            assert distances[found] == pytest.approx(min(distances))
            assert distances[found] <= within + 1e-9
    expected = [min(shape.distance(shapely.Point(point)) for shape in shapes) for point in points]
    np.testing.assert_allclose(known.distance_to_parking(np.array(points)), expected)

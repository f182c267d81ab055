"""On-road objects stay with vehicles that cruise, stand, overtake, turn, and are not seen."""

import numpy as np
import pytest

from anchoring.on_road_objects import OnRoadObject
from anchoring.world_objects import WorldObject
from dyknow.time import milliseconds
from networks.building import bend, four_arm_crossing, ring, straight_road
from tests.anchoring.drives import Drive, nanoseconds, percepts, straight_on

COPIES = 12
WARM_UP = 2.0


def _followed(roads, drive, half_width, until, *, hidden=(np.inf, np.inf)):
    """Yield (time, on-road objects) of copies of one drive, measured every 100 ms."""
    rng = np.random.default_rng(5)
    world_unit, unit = WorldObject(), OnRoadObject(roads)
    ids = np.arange(COPIES)
    world = found = None
    for k in range(int(until * 10)):
        time, now = k / 10, milliseconds(100 * k)
        if hidden[0] <= time < hidden[1]:
            found = unit.predict(found, now)
            yield time, found
            continue
        seen = percepts(ids, np.tile(drive.position(time), (COPIES, 1)), now, half_width, rng)
        world = (
            world_unit.create(ids, seen, now)
            if world is None
            else world_unit.update(world, seen, now)
        )
        lower = world_unit.published(world)
        if found is not None:
            found = unit.update(found, lower, now)
        elif time >= WARM_UP:
            found = unit.create(ids, lower, now)
        if found is not None:
            yield time, found


def _errors(roads, drive, half_width, until, settled=3.0, **options):
    """Return errors along and across (t, copies), and whether the road is the true one."""
    along, across, right = [], [], []
    for time, found in _followed(roads, drive, half_width, until, **options):
        if time < WARM_UP + settled:
            continue
        apart, ahead = found["position"] - drive.position(time), drive.ahead(time)
        along.append(apart @ ahead)
        across.append(apart @ np.array([-ahead[1], ahead[0]]))
        right.append(found["road"] == drive.place(time)[0])
    return np.array(along), np.array(across), np.array(right)


def _rms(error):
    return float(np.sqrt((error**2).mean()))


@pytest.mark.parametrize(
    ("half_width", "along", "across"), [(0, 0.05, 0.05), (1, 0.3, 0.2), (4, 0.8, 0.6)]
)
def test_steady_driving_is_smooth(half_width, along, across):
    """At steady speed round a bend s and d are far better than the measurements."""
    roads = bend(60.0)
    drive = Drive(roads, [roads.roads.index("start_end")], lambda _: 14.0)

    s_error, d_error, right = _errors(roads, drive, half_width, until=18.0)

    assert _rms(s_error) < along
    assert _rms(d_error) < across
    assert right.all()


@pytest.mark.parametrize(("half_width", "lag"), [(0, 0.5), (1, 1.0), (4, 2.5)])
def test_braking_standing_and_starting_are_followed(half_width, lag):
    """Braking at 4.5 m/s², standing and accelerating at 2.6 m/s² are followed with little lag."""
    roads = straight_road(400.0)
    road = roads.roads.index("west_east")

    def speed(t):
        return float(np.interp(t, [0, 8, 8 + 14 / 4.5, 16, 16 + 14 / 2.6], [14, 14, 0, 0, 14]))

    drive = Drive(roads, [road], speed)

    s_error, _, right = _errors(roads, drive, half_width, until=24.0)

    assert np.abs(s_error.mean(axis=1)).max() < lag
    assert right.all()


@pytest.mark.parametrize("half_width", [0, 1, 4])
def test_overtaking_on_the_opposite_lane_keeps_the_road(half_width):
    """A vehicle that moves out and back by a lane is followed, and stays on its road."""
    roads = straight_road(600.0)
    road = roads.roads.index("west_east")

    def beside(t):
        return float(np.interp(t, [0, 8, 10.5, 16, 18.5], [0, 0, 3.2, 3.2, 0]))

    drive = Drive(roads, [road], lambda _: 18.0, beside=beside)

    _, d_error, right = _errors(roads, drive, half_width, until=24.0)

    assert right.all()
    assert _rms(d_error) < 0.3 + 0.12 * half_width
    out = slice(int((14 - WARM_UP - 3) * 10), int((16 - WARM_UP - 3) * 10))
    assert _rms(d_error[out]) < 0.8


def test_standing_vehicles_keep_their_direction():
    """Noise does not turn a vehicle round while it stands."""
    roads = straight_road(200.0)
    road = roads.roads.index("west_east")
    drive = Drive(roads, [road], lambda t: 12.0 if t < 5 else 0.0)

    headings = [f["heading"] for t, f in _followed(roads, drive, 4, until=25.0) if t > 5]

    np.testing.assert_allclose(headings, 0.0, atol=1e-9)


@pytest.mark.parametrize("half_width", [0, 1, 4])
@pytest.mark.parametrize("way", range(4))
def test_every_way_through_a_crossing_is_found(half_width, way):
    """Whichever way a vehicle takes at a crossing, it is on the right road behind it."""
    roads = four_arm_crossing(150.0, u_turns=True)
    arm = roads.roads.index("west_centre")
    inside = roads.successors(arm)[way]
    route = [arm, inside, roads.successors(inside)[0]]
    drive = Drive(roads, route, lambda t: 10.0 if t < 4 else 6.0, start=75.0)

    _, d_error, right = _errors(roads, drive, half_width, until=18.0)

    assert right[-30:].all()
    assert right.mean() > 0.85
    assert np.abs(d_error.mean(axis=1)).max() < 0.5 + 0.25 * half_width


@pytest.mark.parametrize("quarters", [4, 12])
def test_road_ends_are_passed_while_nothing_is_seen(quarters):
    """A vehicle hidden for 3 s on a bend is predicted along its road, over the ends of roads."""
    roads = ring(60.0, quarters)
    route = straight_on(roads, roads.roads.index("q0_q1"))
    drive = Drive(roads, route, lambda _: 12.0)

    s_error, d_error, right = _errors(roads, drive, 1, until=14.0, hidden=(8.0, 11.0))

    assert _rms(s_error[60]) < 2.0
    assert np.abs(d_error).max() < 1.5
    assert right.mean() > 0.9


def test_predicted_objects_branch_at_crossings():
    """Behind a crossing a predicted object may be on every way out, and the nearest counts."""
    roads = four_arm_crossing(60.0)
    arm = roads.roads.index("west_centre")
    drive = Drive(roads, [arm], lambda _: 10.0)
    unit = OnRoadObject(roads)
    *_, (_, found) = _followed(roads, drive, 0, until=4.5)
    found = found.select(np.array([0]))

    predicted = unit.predict(found, nanoseconds(7.4))

    points, rows = unit.places(predicted)
    assert set(rows) == {0}
    assert len(points) == 3
    lower = percepts([1, 2, 3], points, nanoseconds(7.4))
    upper = predicted.select(np.array([0, 0, 0]))
    distance = unit.feature("xydist", ("from", "to"), lower, upper)
    np.testing.assert_allclose(distance, 0.0, atol=1e-9)


def test_the_number_of_branches_is_limited():
    """However long nothing is seen, an object has no more branches than allowed."""
    roads = ring(30.0, 8)
    drive = Drive(roads, straight_on(roads, roads.roads.index("q0_q1")), lambda _: 12.0)
    unit = OnRoadObject(roads)
    *_, (_, found) = _followed(roads, drive, 0, until=4.5)

    for second in range(5, 60):
        found = unit.predict(found, nanoseconds(second))

    count = (found["branches"]["road"] >= 0).sum(axis=1)
    assert (count >= 1).all()
    assert (count <= found["branches"].shape[1]).all()
    assert np.isfinite(found["position"]).all()


def test_a_vehicle_put_on_the_wrong_road_gets_to_the_right_one():
    """An object that was matched against its direction of travel changes to the other road."""
    roads = straight_road(300.0)
    right, wrong = roads.roads.index("west_east"), roads.roads.index("east_west")
    drive = Drive(roads, [right], lambda t: 0.0 if t < 3 else 10.0, start=20.0)
    unit, world_unit = OnRoadObject(roads), WorldObject()
    seen = percepts([1], [drive.position(0) + np.array([0.0, 3.2])], 0)
    world = world_unit.create(seen.ids, seen, 0)
    found = unit.create(seen.ids, world_unit.published(world), 0)
    assert found["road"][0] == wrong

    for k in range(1, 100):
        now = milliseconds(100 * k)
        world = world_unit.update(world, percepts([1], [drive.position(k / 10)], now), now)
        found = unit.update(found, world_unit.published(world), now)

    assert found["road"][0] == right
    np.testing.assert_allclose(found["position"][0], drive.position(9.9), atol=0.5)
    np.testing.assert_allclose(found["speed"], 10.0, atol=0.5)


def test_the_deviation_tells_directions_apart():
    """Where a vehicle is expected, one that comes the other way deviates far more."""
    roads = straight_road(400.0)
    drive = Drive(roads, [roads.roads.index("west_east")], lambda _: 14.0)
    unit, world_unit = OnRoadObject(roads), WorldObject()
    *_, (_, found) = _followed(roads, drive, 1, until=8.0)
    upper = unit.predict(found.select(np.array([0])), nanoseconds(10.0))
    deviations = []
    for speed, beside in ((14.0, 0.0), (-14.0, 3.2)):
        world = None
        for k in range(5):
            now = nanoseconds(9.6 + k / 10)
            place = drive.position(10.0) + np.array([speed * (k - 4) / 10, beside])
            seen = percepts([1], [place], now)
            seen.columns["covariance"] = np.eye(2)[None]
            world = (
                world_unit.create(seen.ids, seen, now)
                if world is None
                else world_unit.update(world, seen, now)
            )
        lower = world_unit.published(world)
        deviations.append(unit.feature("deviation", ("from", "to"), lower, upper)[0])

    same, other = deviations

    assert same < 1.5
    assert other > 3.5


def test_on_road_depends_on_how_well_the_position_is_known():
    """A place beside the road is on it if the uncertainty of the position allows."""
    roads = straight_road(100.0)
    unit, world_unit = OnRoadObject(roads), WorldObject()
    places = [(50.0, -1.6), (50.0, -6.0), (50.0, -30.0)]
    exact = world_unit.create(np.arange(3), percepts(range(3), places, 0), 0)
    vague = world_unit.create(
        np.arange(3),
        percepts(range(3), places, 0).with_columns(covariance=np.tile(np.eye(2) * 4.0, (3, 1, 1))),
        0,
    )

    def on_road(table):
        return unit.feature("on_road", ("from",), table, table).tolist()

    assert on_road(exact) == [True, False, False]
    assert on_road(vague) == [True, True, False]

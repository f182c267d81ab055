"""What the map says about turning, as events."""

from networks.building import four_arm_crossing
from traffic.features.link_turns import LinkTurns


def test_each_way_through_a_crossing_is_told_by_name_and_by_value() -> None:
    """Once as the attribute of its turn, which is true, and once as the value of `links.turn`."""
    road_map = four_arm_crossing(u_turns=True)

    (sample,) = LinkTurns(road_map).samples()

    told = {(event.attribute, event.arguments): event.to_value for event in sample.value}
    assert told == {
        **{(f"links.{turn.value}", way): "true" for way, turn in road_map.turn_names.items()},
        **{("links.turn", way): turn.value for way, turn in road_map.turn_names.items()},
    }
    assert {"links.left", "links.right", "links.straight", "links.uturn"} < {a for a, _ in told}
    assert (sample.valid_time, sample.available_time) == (0, 0)

"""Scenarios in which drivers overtake, try to, or keep beside others."""

import pytest

from traffic.scenarios import find_scenario
from traffic.scenarios.acts.overtaking import AbortOvertake, DriveBeside, Overtake

SCENARIOS = {
    "overtaking": {"overtakes"},
    "overtaking_wrong_side": {"overtakes", "reckless_overtakes"},
    "overtaking_facing_traffic": {"overtakes", "reckless_overtakes"},
    "overtaking_again_and_again": {"overtakes", "reckless_overtakes"},
}


@pytest.mark.parametrize(("name", "recognised"), SCENARIOS.items())
def test_the_bundled_scenarios_say_what_is_to_be_recognised(name: str, recognised: set[str]):
    """Each has acts of two drivers, and names the families that matter in it."""
    scenario = find_scenario(name)

    assert set(scenario.recognise or ()) == recognised
    assert any(isinstance(act, Overtake | AbortOvertake | DriveBeside) for act in scenario.acts)


def test_all_vehicle_types_and_roads_of_an_act_are_known():
    """Those of the other driver, and of who comes the other way, are among them."""
    acts = find_scenario("overtaking_facing_traffic").acts
    meeting = next(act for act in acts if isinstance(act, Overtake) and act.oncoming)

    assert set(meeting.casts) == {"types", "others", "oncoming"}
    assert meeting.routes == {"route": ("west_east",), "oncoming": ("east_west",)}

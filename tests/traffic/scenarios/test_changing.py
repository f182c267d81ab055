"""New values in the tables of a scenario."""

import copy
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from traffic.errors import RequestError, ScenarioError
from traffic.scenarios import find_scenario
from traffic.scenarios.changing import put_all

TABLES: dict[str, Any] = {
    "duration": "1 s",
    "camera": {"altitude": 10},
    "flows": [{"rate": 1}, {"rate": 2}],
    "types": [{"name": "car", "length": 4}, {"name": "bus", "length": 12}],
    "acts": [{"kind": "sway", "times": 3}],
}


@settings(derandomize=True, deadline=None, max_examples=100)
@given(
    st.dictionaries(
        st.sampled_from(["duration", "camera.altitude", "flows.1.rate", "new.table.key"]),
        st.integers(),
    )
)
def test_only_what_is_named_changes(changes: dict[str, int]) -> None:
    """Walking the path by hand finds the new value; put back, everything is as it was."""
    values = copy.deepcopy(TABLES)
    paths = put_all(changes, values)

    for path, name in paths.items():
        found: Any = values
        for step in path:
            found = found[step]
        assert found == changes[name.removeprefix("scenario.")]
    if "new.table.key" not in changes:
        originals = {"duration": "1 s", "camera.altitude": 10, "flows.1.rate": 2}
        put_all({name: originals[name] for name in changes}, values)
        assert values == TABLES


def test_tables_of_an_array_are_numbered_or_called_by_name_or_kind() -> None:
    """The second type is `types.1` and `types.bus`; an act is called by its kind."""
    values = copy.deepcopy(TABLES)
    put_all({"types.bus.length": 11, "types.0.length": 5, "acts.sway.times": 4}, values)

    assert [each["length"] for each in values["types"]] == [5, 11]
    assert values["acts"][0]["times"] == 4


@pytest.mark.parametrize("name", ["flows.2.rate", "flows.x.rate", "duration.x", "types.-1.length"])
def test_what_stands_for_nothing_is_refused(name: str) -> None:
    """The message says where the path leaves the tables."""
    with pytest.raises(RequestError, match=r"--set: expected .*found 'scenario\."):
        put_all({name: 1}, copy.deepcopy(TABLES))


def test_a_change_that_makes_a_scenario_impossible_is_blamed() -> None:
    """The fault is that of the change, not of the file."""
    with pytest.raises(ScenarioError) as caught:
        find_scenario("rural", {"flows.0.rate_per_hour": -1, "camera.altitude": "high"})

    assert [fault.split(":")[0] for fault in caught.value.faults] == [
        "--set scenario.camera.altitude",
        "--set scenario.flows.0.rate_per_hour",
    ]
    assert find_scenario("rural", {"camera.altitude": 99}).camera.altitude == 99  # type: ignore[union-attr]

"""What traffic lights show, as SUMO has it."""

from pathlib import Path

import numpy as np
import pytest

from dyknow.time import SECOND, Duration
from networks.reading import read_road_map
from networks.signals import SignalState
from perception.lamps import Light
from traffic.scenarios import Scenario, find_scenario
from traffic.sumo.feeding import SignalMemory
from traffic.sumo.opening import network_of, open_simulation


def test_lamps_show_what_signals_do() -> None:
    """Perception, which knows no map, has the same names and numbers for it."""
    assert [(each.name, each.value) for each in Light] == [
        (each.name, each.value) for each in SignalState
    ]


@pytest.mark.sumo
def test_the_arms_of_the_town_are_green_in_turn(tmp_path: Path) -> None:
    """Half a minute of green, three seconds of yellow, and red; one direction after the other."""
    town = find_scenario("crossing")
    scenario = Scenario(
        name="lights",
        network=town.network,
        duration=Duration(80 * SECOND),
        step_length=Duration(SECOND),
    )
    signals = read_road_map(network_of(scenario)).signals
    history = []
    with open_simulation(scenario, tmp_path, np.random.default_rng(1)) as simulation:
        memory = SignalMemory(simulation.lanes, signals)
        while (frame := simulation.step()) is not None:
            history.append(memory.table(frame)["state"])

    states = np.array(history)[:80]
    arm = [name.partition("_")[0] for name in signals.names]
    one, other = (states[:, arm.index(each)] for each in ("east", "north"))
    for column in (one, other):
        counts = [np.count_nonzero(column == state) for state in SignalState]
        assert counts == [0, 36, 3, 41, 0]
    assert not ((one == SignalState.GREEN) & (other != SignalState.RED)).any()

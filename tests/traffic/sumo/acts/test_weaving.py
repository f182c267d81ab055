"""Drivers who sway sway, and those who swerve go aside once."""

from pathlib import Path

import numpy as np
import pytest

from dyknow.time import SECOND
from networks.reading import read_road_map
from tests.support.staging import frames, rural
from traffic.scenarios import find_scenario
from traffic.scenarios.acts import AnyAct
from traffic.scenarios.acts.weaving import Swerve, Weave

pytestmark = pytest.mark.sumo

COMMON = {"types": {"car": 1}, "route": ("west_junction",), "times": (0,), "speed": (12, 12)}


def across(act: AnyAct, folder: Path) -> np.ndarray:
    """Return where the vehicle of the act is across the road, frame by frame."""
    road_map = read_road_map(find_scenario("rural").network or "")
    run, _ = frames(rural(act, seconds=40), folder)
    positions = [f.vehicles["position"][0] for f in run if len(f.vehicles)]
    road = np.full(len(positions), road_map.roads.index("west_junction"))
    return road_map.project(np.array(positions), road)[1]


def test_a_driver_sways_as_wide_as_was_said(tmp_path: Path) -> None:
    """To both sides of the middle of the lane, about as often as the period says."""
    act = Weave(
        kind="weave", place=(100, 100), duration=(12 * SECOND, 12 * SECOND), width=(1.6, 1.6),
        period=(3 * SECOND, 3 * SECOND), **COMMON,
    )  # fmt: skip

    d = across(act, tmp_path)

    middle = np.median(d[:50])
    sides = np.sign((d - middle)[np.abs(d - middle) > 0.4])
    crossings = np.count_nonzero(np.diff(sides) != 0)
    assert np.ptp(d) == pytest.approx(1.6, abs=0.3)
    assert crossings == pytest.approx(8, abs=2)
    assert d[-1] == pytest.approx(middle, abs=0.1)


def test_a_driver_swerves_once(tmp_path: Path) -> None:
    """Aside by as much as was said, for as long, and back to the middle of the lane."""
    act = Swerve(
        kind="swerve", place=(100, 100), width=(1.2, 1.2), going=(2 * SECOND, 2 * SECOND),
        staying=(3 * SECOND, 3 * SECOND), **COMMON,
    )  # fmt: skip

    d = across(act, tmp_path)

    middle = np.median(d[:50])
    aside = d - middle
    assert aside.max() == pytest.approx(1.2, abs=0.1)
    assert aside.min() > -0.2
    assert np.count_nonzero(aside > 1.0) == pytest.approx(35, abs=10)
    assert abs(aside[-1]) < 0.1

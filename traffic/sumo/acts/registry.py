"""Which performance belongs to which act."""

from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

import numpy as np

from traffic.scenarios.acts import Act
from traffic.scenarios.acts.crossings import CreepOverLine, HaltInCrossing, RunRedLight
from traffic.scenarios.acts.danger import BrakeLate, CrossWithRoom, CutOff
from traffic.scenarios.acts.driving import Drive, Halt
from traffic.scenarios.acts.following import CloseUp, Column, Tail, Tailgate
from traffic.scenarios.acts.overtaking import AbortOvertake, DriveBeside, Overtake
from traffic.scenarios.acts.parking import Park
from traffic.scenarios.acts.weaving import Swerve, Weave
from traffic.scenarios.acts.wrong_way import DriveOpposite
from traffic.sumo.acts.crossings import creep_over_line, halt_in_crossing, run_red_light
from traffic.sumo.acts.danger import brake_late, cross_with_room, cut_off
from traffic.sumo.acts.driving import drive, halt
from traffic.sumo.acts.following import close_up, column, tail, tailgate
from traffic.sumo.acts.overtaking import abort_overtake, drive_beside, overtake
from traffic.sumo.acts.parking import park
from traffic.sumo.acts.performance import Performance, Script
from traffic.sumo.acts.stage import Stage
from traffic.sumo.acts.weaving import swerve, weave
from traffic.sumo.acts.wrong_way import drive_opposite

__all__ = ["Perform", "performance_of"]

Perform = Callable[[Any, Stage, np.random.Generator], Performance]
"""Makes a performance of an act on a stage; draws from the generator all that is random in it."""


def performance_of(act: Act, stage: Stage, generator: np.random.Generator) -> Performance:
    """Return a performance of *act* that is about to begin."""
    return _PERFORM[type(act)](act, stage, generator)


def _script(play: Callable[..., Any]) -> Perform:
    """Return what performs *play*, a function with `yield` at each step."""
    return lambda act, stage, generator: Script(partial(play, act, stage, generator))


_PERFORM: Mapping[type[Act], Perform] = {
    Drive: _script(drive),
    Halt: _script(halt),
    Weave: _script(weave),
    Swerve: _script(swerve),
    Column: _script(column),
    Tailgate: _script(tailgate),
    CloseUp: _script(close_up),
    Tail: _script(tail),
    Park: _script(park),
    RunRedLight: _script(run_red_light),
    CreepOverLine: _script(creep_over_line),
    HaltInCrossing: _script(halt_in_crossing),
    DriveOpposite: _script(drive_opposite),
    CutOff: _script(cut_off),
    CrossWithRoom: _script(cross_with_room),
    BrakeLate: _script(brake_late),
    Overtake: _script(overtake),
    AbortOvertake: _script(abort_overtake),
    DriveBeside: _script(drive_beside),
}

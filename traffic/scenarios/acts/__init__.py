"""Acts: what drivers do on purpose, so that there is something to recognise.

Read in this order: `base` (what all acts have in common), then the families: `driving` (at a
speed; halting), `weaving` (swaying, and going around something), `following` (close behind, in a
row, wherever another turns), `parking`, `danger` (too near to others), `crossings` (red lights,
halting inside), `wrong_way`, `overtaking`. A new kind is a class in its family's module and a line
in `ACTS` and `AnyAct` here, and a performance in `traffic.sumo.acts`.
"""

from collections.abc import Mapping
from typing import Annotated

from pydantic import Field

from traffic.scenarios.acts.base import Act
from traffic.scenarios.acts.crossings import CreepOverLine, HaltInCrossing, RunRedLight
from traffic.scenarios.acts.danger import BrakeLate, CrossWithRoom, CutOff
from traffic.scenarios.acts.driving import Drive, Halt
from traffic.scenarios.acts.following import CloseUp, Column, Tail, Tailgate
from traffic.scenarios.acts.overtaking import AbortOvertake, DriveBeside, Overtake
from traffic.scenarios.acts.parking import Park
from traffic.scenarios.acts.weaving import Swerve, Weave
from traffic.scenarios.acts.wrong_way import DriveOpposite

__all__ = ["ACTS", "Act", "AnyAct"]

AnyAct = Annotated[
    Drive
    | Halt
    | Weave
    | Swerve
    | Column
    | Tailgate
    | CloseUp
    | Tail
    | Park
    | RunRedLight
    | CreepOverLine
    | HaltInCrossing
    | DriveOpposite
    | CutOff
    | CrossWithRoom
    | BrakeLate
    | Overtake
    | AbortOvertake
    | DriveBeside,
    Field(discriminator="kind"),
]
"""One of the acts, told apart by its `kind`."""

ACTS: Mapping[str, type[Act]] = {
    "drive": Drive,
    "halt": Halt,
    "weave": Weave,
    "swerve": Swerve,
    "column": Column,
    "tailgate": Tailgate,
    "close_up": CloseUp,
    "tail": Tail,
    "park": Park,
    "run_red_light": RunRedLight,
    "creep_over_line": CreepOverLine,
    "halt_in_crossing": HaltInCrossing,
    "drive_opposite": DriveOpposite,
    "cut_off": CutOff,
    "cross_with_room": CrossWithRoom,
    "brake_late": BrakeLate,
    "overtake": Overtake,
    "abort_overtake": AbortOvertake,
    "drive_beside": DriveBeside,
}
"""The class of each kind."""

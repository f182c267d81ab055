"""Acts: what drivers do on purpose, so that there is something to recognise.

Read in this order: `base` (what all acts have in common), then the families: `driving` (at a
speed; halting), `weaving` (swaying, and going around something), `following` (close behind, in a
row, wherever another turns), `parking`. A new kind is a class in its family's module and a line in
`ACTS` and `AnyAct` here, and a performance in `traffic.sumo.acts`.
"""

from collections.abc import Mapping
from typing import Annotated

from pydantic import Field

from traffic.scenarios.acts.base import Act
from traffic.scenarios.acts.driving import Drive, Halt
from traffic.scenarios.acts.following import CloseUp, Column, Tail, Tailgate
from traffic.scenarios.acts.parking import Park
from traffic.scenarios.acts.weaving import Swerve, Weave

__all__ = ["ACTS", "Act", "AnyAct"]

AnyAct = Annotated[
    Drive | Halt | Weave | Swerve | Column | Tailgate | CloseUp | Tail | Park,
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
}
"""The class of each kind."""

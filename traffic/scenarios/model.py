"""What a scenario consists of, and which values are possible.

A scenario names either a network and the traffic on it, or a SUMO configuration that brings
its own. As TOML:

    network = "crossing"          # a bundled network, or a path beside the scenario
    duration = "60 s"
    recognise = ["turns"]         # all that the specification tells, if this is left out
    [camera]                      # look_at, altitude, field_of_view, heading, width, height
    [[vehicle_types]]             # what vehicles are like
    [[flows]]                     # vehicles along given roads
    [[trips]]                     # vehicles between random roads
    [[circulations]]              # vehicles that drive about for ever
    [[acts]]                      # drivers who do things on purpose
    [sumo]                        # further options of the simulator

Durations are texts such as `"60 s"`; a bare number is milliseconds. Everything else is in SI
units, except where a name says otherwise; angles of the camera are degrees.
"""

from pathlib import Path
from typing import Annotated, Literal, Self

from pydantic import Field, ValidationInfo, model_validator

from dyknow.time import MILLISECOND, Duration
from traffic.bundled import data_folder
from traffic.scenarios.acts import AnyAct
from traffic.scenarios.fields import (
    AnyDuration,
    LongDuration,
    Option,
    Point,
    Range,
    Rate,
    Roads,
    Settings,
    StepLength,
    TypeWeights,
    Weight,
    ordered,
)

__all__ = [
    "CameraSettings",
    "Circulation",
    "Flow",
    "Scenario",
    "Trips",
    "TurnShares",
    "VehicleType",
]


class CameraSettings(Settings):
    """A camera that hovers and looks straight down.

    Attributes:
        look_at: Name of a junction, or x and y in the world frame, metres.
        altitude: Height above the ground, metres.
        field_of_view: Angle that the width of the image spans, degrees.
        heading: What is up in the image, degrees clockwise from north.
        width: Of the image, pixels.
        height: Of the image, pixels.
    """

    look_at: Point
    altitude: Annotated[float, Field(gt=0, le=10_000)] = 120.0
    field_of_view: Annotated[float, Field(gt=0, lt=170)] = 67.0
    heading: float = 0.0
    width: Annotated[int, Field(ge=16, le=8192)] = 1280
    height: Annotated[int, Field(ge=16, le=8192)] = 720


class VehicleType(Settings):
    """What the vehicles of one type are like; each vehicle draws its own values.

    Attributes:
        name: How flows refer to the type.
        vehicle_class: SUMO's vehicle class, such as `passenger` or `truck`.
        length: metres.
        width: metres.
        height: metres.
        max_speed: What the vehicle can do, m/s.
        speed_factor: What the driver does where a limit says 1.
        sumo: Further attributes of SUMO's vehicle type, such as `lcOpposite`.
    """

    name: Annotated[str, Field(pattern=r"^[A-Za-z][A-Za-z0-9_]*$")]
    vehicle_class: Literal[
        "passenger", "taxi", "delivery", "truck", "trailer", "bus", "coach", "motorcycle",
        "moped", "bicycle", "emergency",
    ] = "passenger"  # fmt: skip
    length: Range = (3.8, 5.2)
    width: Range = (1.7, 1.9)
    height: Range = (1.4, 1.6)
    max_speed: Range = (40.0, 55.0)
    speed_factor: Range = (0.9, 1.1)
    sumo: dict[str, Option] = Field(default_factory=dict)

    @model_validator(mode="after")
    def _ranges_are_ordered(self) -> Self:
        for span in (self.length, self.width, self.height, self.max_speed, self.speed_factor):
            ordered(span)
        return self


class Flow(Settings):
    """Vehicles that come at random times, with a mean rate, and drive the same way.

    Attributes:
        route: Roads from the first to the last; between two that do not touch, the fastest way.
        rate_per_hour: Mean number of vehicles in an hour.
        types: Weight of each vehicle type.
    """

    route: Roads
    rate_per_hour: Rate
    types: TypeWeights


class Trips(Settings):
    """Vehicles that come at random times, from a random road to another.

    Attributes:
        rate_per_hour: Mean number of vehicles in an hour.
        types: Weight of each vehicle type.
        min_distance: Between the two roads as the crow flies, metres.
    """

    rate_per_hour: Rate
    types: TypeWeights
    min_distance: Annotated[float, Field(ge=0)] = 0.0


class TurnShares(Settings):
    """How much drivers favour each way out of a junction; only ways that exist count."""

    left: Weight = 1.0
    right: Weight = 1.0
    straight: Weight = 1.0
    uturn: Weight = 0.0


class Circulation(Settings):
    """Vehicles that drive about at random for the whole duration.

    Attributes:
        vehicles: How many.
        types: Weight of each vehicle type.
        turns: How much drivers favour each way out of a junction.
    """

    vehicles: Annotated[int, Field(ge=1, le=100_000)]
    types: TypeWeights
    turns: TurnShares = TurnShares()


class Scenario(Settings):
    """What happens where, for how long, and from where it is watched.

    Attributes:
        name: Of the file, without its ending.
        description: One sentence for the list of scenarios.
        network: Path of the compiled network; None if `sumocfg` brings one.
        sumocfg: Path of a SUMO configuration; None if `network` is given.
        duration: How long the scenario lasts, from time 0.
        warm_up: How long traffic runs before time 0, unseen.
        step_length: Of the simulator.
        camera: From where it is watched, if the scenario says so.
        vehicle_types: What vehicles are like.
        flows: Vehicles along given roads.
        trips: Vehicles between random roads.
        circulations: Vehicles that drive about for ever.
        acts: Drivers who do things on purpose.
        recognise: What is to be recognised unless a run asks for something else, such as
            `turns`; everything if the scenario does not say.
        sumo: Further options of the simulator.
    """

    name: str
    description: str = ""
    network: Path | None = None
    sumocfg: Path | None = None
    duration: LongDuration
    warm_up: AnyDuration = Duration(0)
    step_length: StepLength = Duration(40 * MILLISECOND)
    camera: CameraSettings | None = None
    vehicle_types: tuple[VehicleType, ...] = ()
    flows: tuple[Flow, ...] = ()
    trips: tuple[Trips, ...] = ()
    circulations: tuple[Circulation, ...] = ()
    acts: tuple[AnyAct, ...] = ()
    recognise: Annotated[tuple[str, ...], Field(min_length=1)] | None = None
    sumo: dict[str, Option] = Field(default_factory=dict)

    @model_validator(mode="before")
    @classmethod
    def _find_files(cls, values: object, info: ValidationInfo) -> object:
        folder = (info.context or {}).get("folder")
        if not isinstance(values, dict) or folder is None:
            return values
        found = dict(values)
        if isinstance(found.get("network"), str):
            found["network"] = _find_network(found["network"], folder)
        if isinstance(found.get("sumocfg"), str):
            found["sumocfg"] = folder / found["sumocfg"]
        return found

    @model_validator(mode="after")
    def _has_one_source_of_traffic(self) -> Self:
        if (self.network is None) == (self.sumocfg is None):
            raise ValueError("expected either 'network' or 'sumocfg'")
        if self.sumocfg is not None and (self.flows or self.trips or self.circulations):
            raise ValueError("a 'sumocfg' brings its own traffic; expected no flows beside it")
        return self


def _find_network(name: str, folder: Path) -> Path:
    bundled = data_folder() / "networks" / name / f"{name}.net.xml"
    return bundled if bundled.is_file() else folder / name

"""What performances know of traffic lights: what a signal shows, and when it will be red."""

from dataclasses import dataclass
from typing import Any

from networks.signals import SignalState, permissive
from traffic.sumo.acts.stage import Stage

__all__ = ["LaneSignal", "signal_of"]


@dataclass(frozen=True, slots=True)
class LaneSignal:
    """The signal at the end of a lane.

    Attributes:
        stage: Where.
        light: SUMO's id of the traffic light; empty if the lane has no signal.
        places: Of the ways out of the lane in the state of the light.
    """

    stage: Stage
    light: str = ""
    places: tuple[int, ...] = ()

    @property
    def state(self) -> SignalState:
        """What it shows now; off if there is none."""
        if not self.light:
            return SignalState.OFF
        return self._shown(self.stage.api.trafficlight.getRedYellowGreenState(self.light))

    @property
    def is_free(self) -> bool:
        """Whether one may go."""
        return self.state in {SignalState.GREEN, SignalState.OFF}

    def seconds_until_red(self) -> float:
        """Return how long it is until the signal turns red the next time; infinite for never."""
        if not self.light:
            return float("inf")
        lights: Any = self.stage.api.trafficlight
        phases = lights.getAllProgramLogics(self.light)[0].phases
        current = lights.getPhase(self.light)
        wait = lights.getNextSwitch(self.light) - self.stage.api.simulation.getTime()
        for step in range(len(phases)):
            before = phases[(current + step) % len(phases)]
            after = phases[(current + step + 1) % len(phases)]
            was_red, is_red = (
                self._shown(each.state) is SignalState.RED for each in (before, after)
            )
            if is_red and not was_red:
                return float(wait)
            wait += after.duration
        return float("inf")

    def _shown(self, letters: str) -> SignalState:
        return permissive("".join(letters[place] for place in self.places))


def signal_of(lane: str, stage: Stage) -> LaneSignal:
    """Return the signal at the end of a lane, which may be none."""
    lights: Any = stage.api.trafficlight
    for light in lights.getIDList():
        controlled = enumerate(lights.getControlledLinks(light))
        places = tuple(i for i, links in controlled if any(lane == link[0] for link in links))
        if places:
            return LaneSignal(stage, light, places)
    return LaneSignal(stage)

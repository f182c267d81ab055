"""Precision and recall of a run: recognised turns and overtakes against the true ones."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from chronicles.events import Recognition, json_from_event
from dyknow.streams.sample import Sample
from dyknow.streams.table import Table
from dyknow.time import MILLISECOND, SECOND, Duration
from networks.roads import RoadMap
from traffic.results import Manoeuvre, RecognitionResult, Score
from traffic.scoring.association import Association
from traffic.scoring.matching import Episode, match
from traffic.sumo.simulation import Frame, Simulation
from traffic.truth.ground_truth import GroundTruth
from traffic.truth.overtakes import TrueOvertake
from traffic.truth.turns import TrueTurn

__all__ = ["Scorer", "Verdict", "unjudged"]

_MARGIN = Duration(2 * SECOND)
"""A manoeuvre has been seen if its vehicles were in view from so long before it to so long after:
a turn needs the links it leads from and to, an overtake being behind and being in front."""

_TOLERANCE = Duration(3 * SECOND)
"""How far apart in time a recognition and the manoeuvre that explains it may be."""

_TURN = "turn_"
_OVERTAKE = "overtake"

Points = npt.NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Verdict:
    """What the truth says about a run.

    Attributes:
        recognitions: In the order given, with what the truth says about each.
        missed: True manoeuvres in view that no recognition explains.
        score: Counts, precision and recall of `turn` and `overtake`.
    """

    recognitions: list[RecognitionResult]
    missed: list[Manoeuvre]
    score: dict[str, Score]


class Scorer:
    """Watches a run from outside, and judges its recognitions at the end.

    Args:
        road_map: The map.
        simulation: Names vehicles and lanes.
        footprint: The ground in view, shape (k, 2), metres; None if everything is.
    """

    def __init__(
        self, road_map: RoadMap, simulation: Simulation, footprint: Points | None
    ) -> None:
        self._map = road_map
        self._names = simulation.names
        self._footprint = footprint
        self._truth = GroundTruth(road_map, simulation.lanes, _MARGIN)
        self._association = Association()
        self._frame: Frame | None = None

    def observe_frame(self, frame: Frame) -> None:
        """Take in the next frame of the simulation."""
        self._frame = frame
        self._truth.observe(frame, self._footprint)

    def observe_cars(self, sample: Sample[Table]) -> None:
        """Take in the cars that are believed in, after the frame of the same time."""
        if self._frame is None:
            return
        cars, vehicles = sample.value, self._frame.vehicles
        observed = cars.select(cars["observed"])
        self._association.observe(
            sample.valid_time,
            (observed.ids, observed["position"]),
            (vehicles.ids, vehicles["position"]),
        )

    def judge(self, recognitions: Sequence[Recognition]) -> Verdict:
        """Compare *recognitions* with the truth."""
        vehicles = [self._vehicles(recognition) for recognition in recognitions]
        claims = list(map(_claim, recognitions, vehicles))
        turns, overtakes = self._truth.turns(), self._truth.overtakes()
        truths = [*map(self._true_turn, turns), *map(self._true_overtake, overtakes)]
        in_view = [turn.in_view for turn in turns] + [overtake.in_view for overtake in overtakes]
        pairs = match(claims, truths, _TOLERANCE)
        agreement = [_agreement(pairs.get(i), in_view) for i in range(len(claims))]
        found = set(pairs.values())
        missed = [
            self._manoeuvre(truth)
            for j, truth in enumerate(truths)
            if in_view[j] and j not in found
        ]
        results = list(map(self._result, recognitions, vehicles, agreement))
        return Verdict(results, missed, _scores(claims, agreement, truths, in_view))

    def _vehicles(self, recognition: Recognition) -> dict[str, int] | None:
        """Return the vehicle that each car among the arguments stood for, if all stood for one."""
        found = {
            name: self._association.vehicle_of(
                int(symbol.removeprefix("car")), recognition.begin, recognition.end
            )
            for name, symbol in recognition.arguments.items()
            if name.startswith("c")
        }
        known = {name: vehicle for name, vehicle in found.items() if vehicle is not None}
        return known if len(known) == len(found) else None

    def _true_turn(self, true: TrueTurn) -> Episode:
        links, crossings = self._map.links, self._map.crossings
        place = (links[true.link1], crossings[true.crossing], links[true.link2])
        return Episode(("turn", true.turn.value, (true.vehicle,), place), true.begin, true.end)

    def _true_overtake(self, true: TrueOvertake) -> Episode:
        vehicles = (true.overtaker, true.overtaken)
        return Episode(("overtake", _OVERTAKE, vehicles, ()), true.begin, true.end)

    def _manoeuvre(self, episode: Episode) -> Manoeuvre:
        _, what, vehicles, place = episode.key
        return Manoeuvre(
            kind=what,
            vehicles=[self._names[vehicle] for vehicle in vehicles],
            place=list(place),
            begin=episode.begin / MILLISECOND,
            end=episode.end / MILLISECOND,
        )

    def _result(
        self,
        recognition: Recognition,
        vehicles: dict[str, int] | None,
        agrees: bool | None,  # noqa: FBT001, a value of the result
    ) -> RecognitionResult:
        known = vehicles if vehicles is not None else {}
        names = {name: self._names[one] for name, one in known.items()}
        return _result(recognition, names or None, agrees)


def unjudged(recognitions: Sequence[Recognition]) -> Verdict:
    """Return what is said of *recognitions* when no truth is known."""
    return Verdict([_result(recognition, None, None) for recognition in recognitions], [], {})


def _result(
    recognition: Recognition,
    truth: dict[str, str] | None,
    agrees: bool | None,  # noqa: FBT001, a value of the result
) -> RecognitionResult:
    return RecognitionResult(
        chronicle=recognition.chronicle,
        arguments=recognition.arguments,
        times={name: at / MILLISECOND for name, at in recognition.instants.items()},
        begin=recognition.begin / MILLISECOND,
        end=recognition.end / MILLISECOND,
        recognised_at=recognition.recognised_at / MILLISECOND,
        events=[json_from_event(event) for event in recognition.events],
        truth=truth,
        agrees=agrees,
    )


def _claim(recognition: Recognition, vehicles: dict[str, int] | None) -> Episode:
    """Return what a recognition says, in the words of the truth."""
    who = tuple(vehicles.values()) if vehicles is not None else ()
    begin, end = recognition.begin, recognition.end
    if recognition.chronicle.startswith(_TURN):
        direction = recognition.chronicle.removeprefix(_TURN).split("_")[0]
        place = tuple(recognition.arguments[name] for name in ("l1", "x", "l2"))
        return Episode(("turn", direction, who, place), begin, end)
    return Episode((recognition.chronicle, _OVERTAKE, who, ()), begin, end)


def _agreement(truth: int | None, in_view: Sequence[bool]) -> bool | None:
    """Return whether a claim is right, or None if what it claims was not wholly in view."""
    if truth is None:
        return False
    return True if in_view[truth] else None


def _scores(
    claims: Sequence[Episode],
    agreement: Sequence[bool | None],
    truths: Sequence[Episode],
    in_view: Sequence[bool],
) -> dict[str, Score]:
    return {
        kind: _score(
            [seen for seen, truth in zip(in_view, truths, strict=True) if truth.key[0] == kind],
            [
                right
                for right, claim in zip(agreement, claims, strict=True)
                if claim.key[0] == kind
            ],
        )
        for kind in ("turn", "overtake")
    }


def _score(truths_in_view: Iterable[bool], agreement: Iterable[bool | None]) -> Score:
    seen = list(truths_in_view)
    judged = [agrees for agrees in agreement if agrees is not None]
    return Score.of(sum(seen), len(judged), sum(judged), left_out=seen.count(False))

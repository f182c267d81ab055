"""Precision and recall of a run: what was recognised against what vehicles truly did."""

from collections import deque
from collections.abc import Collection, Iterable, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from chronicles.events import Recognition, json_from_event
from dyknow.streams.sample import Sample
from dyknow.streams.table import Table
from dyknow.time import MILLISECOND
from networks.roads import RoadMap
from traffic.results import Manoeuvre, RecognitionResult, Score, car_names
from traffic.scoring.association import Association
from traffic.scoring.claims import claim_of, kinds_claimed
from traffic.scoring.matching import Episode, match
from traffic.sumo.simulation import Frame, Simulation
from traffic.truth.ground_truth import GroundTruth
from traffic.truth.manoeuvres import TrueManoeuvre
from traffic.truth.watchers import WATCHERS

__all__ = ["Scorer", "Verdict", "lines_scored", "unjudged"]

_LATEST_FRAMES = 250
"""How many frames are remembered: cars are known later than they were seen, by seconds at most."""

_GATE = 4.0
"""Metres within which a car may stand for a vehicle when positions are exact."""

Points = npt.NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Verdict:
    """What the truth says about a run.

    Attributes:
        recognitions: In the order given, with what the truth says about each.
        missed: True manoeuvres in view that no recognition explains.
        score: Counts, precision and recall of each kind that the run could recognise and the
            truth knows; all turns are one kind.
    """

    recognitions: list[RecognitionResult]
    missed: list[Manoeuvre]
    score: dict[str, Score]


def lines_scored(chronicles: Collection[str]) -> tuple[str, ...]:
    """Return the lines of the score of runs that may recognise *chronicles*."""
    claimed = kinds_claimed(chronicles)
    lines = [each.score or kind for kind, each in WATCHERS.items() if kind in claimed]
    return tuple(dict.fromkeys(lines))


class Scorer:
    """Watches a run from outside, and judges its recognitions at the end.

    Args:
        road_map: The map.
        simulation: Names vehicles and lanes.
        footprint: The ground in view, shape (k, 2), metres; None if everything is.
        chronicles: Names of the chronicles that the run may recognise.
        position_error: The largest error of measured positions along an axis, metres.
    """

    def __init__(
        self,
        road_map: RoadMap,
        simulation: Simulation,
        footprint: Points | None,
        chronicles: Collection[str],
        *,
        position_error: float = 0.0,
    ) -> None:
        claimed = kinds_claimed(chronicles)
        self._kinds = {kind: each for kind, each in WATCHERS.items() if kind in claimed}
        self._names = simulation.names
        self._footprint = footprint
        self._truth = GroundTruth(road_map, simulation.lanes, self._kinds)
        self._association = Association(gate=_GATE + position_error)
        self._frames: deque[Frame] = deque(maxlen=_LATEST_FRAMES)

    def observe_frame(self, frame: Frame) -> None:
        """Take in the next frame of the simulation."""
        self._frames.append(frame)
        self._truth.observe(frame, self._footprint)

    def observe_cars(self, sample: Sample[Table]) -> None:
        """Take in the cars that are believed in; the frame of that time is known already."""
        frame = next((f for f in reversed(self._frames) if f.time <= sample.valid_time), None)
        if frame is None:
            return
        cars, vehicles = sample.value, frame.vehicles
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
        found = self._truth.manoeuvres()
        truths = list(map(_truth, found))
        in_view = [each.in_view for each in found]
        tolerances = {kind: each.tolerance for kind, each in self._kinds.items()}
        pairs = match(claims, truths, tolerances)
        agreement = [_agreement(pairs.get(i), in_view) for i in range(len(claims))]
        explained = set(pairs.values())
        missed = [
            self._manoeuvre(truth)
            for j, truth in enumerate(truths)
            if in_view[j] and j not in explained
        ]
        lines = [self._line(claim) for claim in claims]
        results = list(map(self._result, recognitions, vehicles, agreement, lines))
        return Verdict(results, missed, self._scores(lines, agreement, found))

    def _vehicles(self, recognition: Recognition) -> dict[str, int] | None:
        """Return the vehicle that each car among the arguments stood for, if all stood for one."""
        found = {
            name: self._association.vehicle_of(
                int(recognition.arguments[name].removeprefix("car")),
                recognition.begin,
                recognition.end,
            )
            for name in car_names(recognition.arguments)
        }
        known = {name: vehicle for name, vehicle in found.items() if vehicle is not None}
        return known if len(known) == len(found) else None

    def _line(self, claim: Episode) -> str | None:
        """Return the line of the score in which a claim counts, if the truth knows its kind."""
        kind = claim.key[0]
        return (self._kinds[kind].score or kind) if kind in self._kinds else None

    def _scores(
        self,
        lines: Sequence[str | None],
        agreement: Sequence[bool | None],
        truths: Sequence[TrueManoeuvre],
    ) -> dict[str, Score]:
        """Return the counts of each line, in the order of the kinds."""
        line_by_kind = {kind: each.score or kind for kind, each in self._kinds.items()}
        return {
            line: _score(
                [true.in_view for true in truths if line_by_kind[true.kind] == line],
                [right for right, its in zip(agreement, lines, strict=True) if its == line],
            )
            for line in dict.fromkeys(line_by_kind.values())
        }

    def _manoeuvre(self, episode: Episode) -> Manoeuvre:
        kind, vehicles, place = episode.key
        return Manoeuvre(
            kind=kind,
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
        line: str | None,
    ) -> RecognitionResult:
        known = vehicles if vehicles is not None else {}
        names = {name: self._names[one] for name, one in known.items()}
        said = _result(recognition, names or None)
        return said.model_copy(update={"agrees": agrees if line else None, "kind": line})


def unjudged(recognitions: Sequence[Recognition]) -> Verdict:
    """Return what is said of *recognitions* when no truth is known."""
    return Verdict([_result(recognition, None) for recognition in recognitions], [], {})


def _result(recognition: Recognition, truth: dict[str, str] | None) -> RecognitionResult:
    return RecognitionResult(
        chronicle=recognition.chronicle,
        arguments=recognition.arguments,
        times={name: at / MILLISECOND for name, at in recognition.instants.items()},
        begin=recognition.begin / MILLISECOND,
        end=recognition.end / MILLISECOND,
        recognised_at=recognition.recognised_at / MILLISECOND,
        events=[json_from_event(event) for event in recognition.events],
        truth=truth,
        agrees=None,
    )


def _claim(recognition: Recognition, vehicles: dict[str, int] | None) -> Episode:
    """Return what a recognition says, in the words of the truth."""
    said = claim_of(recognition.chronicle)
    who = said.vehicles_of(vehicles.values()) if vehicles is not None else ()
    key = said.kind, who, said.place_of(recognition)
    return Episode(key, recognition.begin, recognition.end)


def _truth(found: TrueManoeuvre) -> Episode:
    return Episode((found.kind, found.vehicles, found.place), found.begin, found.end)


def _agreement(truth: int | None, in_view: Sequence[bool]) -> bool | None:
    """Return whether a claim is right, or None if what it claims was not wholly in view."""
    if truth is None:
        return False
    return True if in_view[truth] else None


def _score(truths_in_view: Iterable[bool], agreement: Iterable[bool | None]) -> Score:
    seen = list(truths_in_view)
    judged = [agrees for agrees in agreement if agrees is not None]
    return Score.of(sum(seen), len(judged), sum(judged), left_out=seen.count(False))

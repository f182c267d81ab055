"""From a recognition down to the frames: puts the steps of an explanation together."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

from chronicles.constraints import floor_to_instant
from chronicles.events import (
    Event,
    Recognition,
    event_from_recognition,
    recognition_from_json,
)
from chronicles.syntax import ReportNonOverlapping
from dyknow.time import MILLISECOND, TimePoint
from networks.reading import read_road_map
from networks.roads import RoadMap
from perception.camera import Camera
from traffic.errors import ExplanationError
from traffic.explaining.attributes import Attributes
from traffic.explaining.explanation import (
    Counted,
    EventExplanation,
    Explanation,
    Provenance,
    RecognitionExplanation,
)
from traffic.explaining.frames import Frames
from traffic.explaining.kept import KeptRun
from traffic.explaining.matching import Match, fact_of, match_of, named_in
from traffic.explaining.objects import Objects
from traffic.recording.rebuilding import network_of_origin
from traffic.request import View
from traffic.results import RecognitionResult
from traffic.world import camera_of

__all__ = ["Walker"]


@dataclass(frozen=True, slots=True)
class _Found:
    """A recognition, and the stream that told it."""

    row: Mapping[str, object]
    recognition: Recognition


class Walker:
    """Walks from recognitions to frames in one run.

    Attributes:
        run: The run.
        attributes: Its attributes.
        objects: Its objects.
        frames: The images in which these were seen.
    """

    def __init__(self, run: KeptRun) -> None:
        self.run = run
        self.attributes = Attributes(run)
        self.objects = Objects(run, self.camera)
        self.frames = Frames(run, self.objects, self.camera)

    @cached_property
    def road_map(self) -> RoadMap:
        """The map of the run."""
        return read_road_map(network_of_origin(self.run.origin, self.run.folder))

    @cached_property
    def camera(self) -> Camera | None:
        """Where the images were taken from; None if there were none."""
        origin = self.run.origin
        if origin.request["view"] != View.VISION:
            return None
        return camera_of(origin.scenario.camera, self.road_map)

    def explanation(self, number: int) -> Explanation:
        """Explain recognition *number*, counted from 1 as `traffic report` lists them.

        Raises:
            ExplanationError: There is no such recognition, or what explains it is damaged.
        """
        return Explanation(
            run=str(self.run.folder),
            scenario=self.run.result.scenario,
            settings=dict(self.run.result.settings),
            recognition=self._recognition(number),
        )

    def _recognition(self, number: int) -> RecognitionExplanation:
        results = self.run.result.recognitions
        if not 1 <= number <= len(results):
            there = f"1 to {len(results)}" if results else "none at all"
            raise ExplanationError(
                f"'{self.run.folder}' has no recognition {number}; it has {there}, as "
                f"'traffic report {self.run.folder}' lists them"
            )
        result = results[number - 1]
        recognition = recognition_from_json(result.model_dump())
        return self._explained(recognition, number, result)

    def is_chronicle(self, name: str) -> bool:
        """Return whether events of this name are recognitions."""
        return any(each.chronicle.name == name for each in self.run.chronicles)

    def streams_to(self, sample: Provenance | None) -> frozenset[str]:
        """Return the streams of events that a recognition told in *sample* was made of.

        Where that is not known, there are none, which stands for all.
        """
        return frozenset() if sample is None else self.run.roles.told_to(sample.stream)

    def match(self, recognition: Recognition, stream: str = "") -> tuple[str, Match]:
        """Put a recognition, told in a stream, beside its chronicle; return also its file."""
        named = [e for e in self.run.chronicles if e.chronicle.name == recognition.chronicle]
        named.sort(key=lambda each: each.stream != stream)
        if not named:
            raise ExplanationError(
                f"'{self.run.folder}' has no chronicle '{recognition.chronicle}' among the files "
                "that it keeps"
            )
        faults = []
        for each in named:
            try:
                return each.path.name, match_of(recognition, each.chronicle, each.file)
            except ExplanationError as error:
                faults.append(error)
        raise faults[0]

    def _explained(
        self,
        recognition: Recognition,
        number: int | None,
        result: RecognitionResult | None,
        path: tuple[Recognition, ...] = (),
    ) -> RecognitionExplanation:
        found = self._told(recognition)
        sample = None if found is None else self.attributes.provenance(dict(found.row))
        file, match = self.match(recognition, "" if sample is None else sample.stream)
        streams = self.streams_to(sample)
        events = list(self._events(match, streams, (*path, recognition)))
        counted = list(self._counted(match, streams))
        moments = _moments(match)
        symbols = self._symbols(match)
        own = {symbol: _moments_of(symbol, events, counted, moments) for symbol in symbols}
        shown = _shown(match, moments, symbols)
        return RecognitionExplanation(
            number=number,
            chronicle=recognition.chronicle,
            file=file,
            values={name[1:]: value for name, value in match.values.items()},
            instants={name: time / MILLISECOND for name, time in recognition.instants.items()},
            begin=recognition.begin / MILLISECOND,
            end=recognition.end / MILLISECOND,
            recognised_at=recognition.recognised_at / MILLISECOND,
            sample=sample,
            truth=None if result is None else result.truth,
            agrees=None if result is None else result.agrees,
            events=events,
            constraints=list(match.constraints()),
            counted=counted,
            objects=[
                self.objects.explained(
                    symbol, named_in(match, symbol), times, recognition.recognised_at
                )
                for symbol, times in own.items()
            ],
            frames=self.frames.frames(shown, symbols),
        )

    def _told(self, recognition: Recognition) -> _Found | None:
        """Return the recognition as it was kept."""
        for row, kept in self.run.recognitions:
            if _same(kept, recognition):
                return _Found(row, kept)
        return None

    def _events(
        self, match: Match, streams: frozenset[str], path: tuple[Recognition, ...]
    ) -> Iterator[EventExplanation]:
        for event, predicates in match.predicates_met():
            told = self.attributes.told(event, streams)
            yield EventExplanation(
                event=fact_of(event),
                predicates=[match.text_with_values(each) for each in predicates],
                instants=list(dict.fromkeys(each.instant for each in predicates)),
                sample=None if told is None else self.attributes.provenance(told),
                change=None if told is None else self.attributes.change(event, told),
                objects=self.objects.are_among(event.arguments),
                near=self.attributes.near(event, streams),
                recognition=self._below(event, path),
            )

    def _below(self, event: Event, path: tuple[Recognition, ...]) -> RecognitionExplanation | None:
        """Explain the recognition that *event* is; None if it is none."""
        for _, kept in self.run.recognitions:
            if kept.chronicle == event.attribute and _is_event(kept, event):
                if any(_same(kept, above) for above in path):
                    return None
                number, result = self._listed(kept)
                return self._explained(kept, number, result, path)
        return None

    def _listed(
        self, recognition: Recognition
    ) -> tuple[int, RecognitionResult] | tuple[None, None]:
        for number, result in enumerate(self.run.result.recognitions, start=1):
            if _same(recognition_from_json(result.model_dump()), recognition):
                return number, result
        return None, None

    def _counted(self, match: Match, streams: frozenset[str]) -> Iterator[Counted]:
        for predicate in match.counters():
            name = predicate.event_type.name
            told = [*self.attributes.events_of(name, streams), *self._recognised(name)]
            yield match.counted(predicate, told)

    def _recognised(self, name: str) -> Iterator[Event]:
        for _, kept in self.run.recognitions:
            if kept.chronicle == name:
                yield event_from_recognition(kept)

    def _symbols(self, match: Match) -> list[str]:
        """Return the objects that take part, those of the recognition's arguments first."""
        words = [*match.values.values(), *(a for event in match.events for a in event.arguments)]
        return self.objects.are_among(words)


def _moments(match: Match) -> dict[int, list[str]]:
    """Return the times of the events, and the instants at each."""
    moments: dict[int, list[str]] = {}
    for predicate in match.expansion.events:
        names = moments.setdefault(match.times[predicate.instant], [])
        if predicate.instant not in names:
            names.append(predicate.instant)
    return moments


def _moments_of(
    symbol: str,
    events: Sequence[EventExplanation],
    counted: Sequence[Counted],
    moments: Mapping[int, list[str]],
) -> dict[int, list[str]]:
    """Return the times of the events that are about an object, and the instants at each."""
    told = [each.event for each in events]
    told += [event for each in counted for event in each.events]
    times = {round(each.time * MILLISECOND) for each in told if symbol in each.arguments}
    return {time: moments.get(floor_to_instant(time), []) for time in times}


def _shown(
    match: Match, moments: Mapping[int, list[str]], symbols: Sequence[str]
) -> dict[int, list[str]]:
    """Return the times that are worth a picture: of events about objects, and of the report."""
    wanted = {
        match.times[predicate.instant]
        for event, predicate in zip(match.events, match.expansion.events, strict=True)
        if set(event.arguments) & set(symbols)
    }
    reported = [s for s in match.expansion.statements if isinstance(s, ReportNonOverlapping)]
    wanted |= {match.times[name] for each in reported for name in (each.begin, each.end)}
    return {TimePoint(time): list(moments.get(time, [])) for time in sorted(wanted)}


def _is_event(recognition: Recognition, event: Event) -> bool:
    told = event_from_recognition(recognition)
    return (floor_to_instant(told.time), told.arguments, told.from_value, told.to_value) == (
        floor_to_instant(event.time),
        event.arguments,
        event.from_value,
        event.to_value,
    )


def _same(one: Recognition, other: Recognition) -> bool:
    return (one.chronicle, one.arguments, one.instants, one.recognised_at) == (
        other.chronicle,
        other.arguments,
        other.instants,
        other.recognised_at,
    )

"""Keeps of a run, while it goes on, what its explanations need and what is dear to make again.

While the network works only references to samples are collected; whole columns of many of them
are written at a time.
"""

import json
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

from anchoring.links import Link
from chronicles.events import Event, Recognition, json_from_recognition
from dyknow.runtime.generators import Label
from dyknow.streams.sample import Sample
from dyknow.streams.table import Table
from dyknow.time import TimePoint
from networks.roads import RoadMap
from traffic.explaining.arrays import array_of
from traffic.explaining.columns import (
    Columns,
    changes_kept,
    digest_of,
    qualities_of,
    states_kept,
)
from traffic.explaining.format import DESCRIPTION, FOLDER, SCHEMAS, Description
from traffic.explaining.roles import Roles
from traffic.system import IMAGE_SORTS, MonitoringSystem, vocabularies_of

__all__ = ["explanations_kept"]

_MOST_ROWS = 100_000
_MOST_TABLES = 2_000
_NOTHING = Table("nothing", (), {})
_KEY = "explanations"


@contextmanager
def explanations_kept(system: MonitoringSystem, road_map: RoadMap, folder: Path) -> Iterator[None]:
    """Keep what explains the recognitions of *system* in *folder* while the block lasts."""
    place = folder / FOLDER
    place.mkdir()
    with ExitStack() as stack:
        keeper = _Keeper(system, _Files(place, stack))
        yield
        keeper.finish()
        said = keeper.description(road_map)
    text = said.model_dump_json(indent=1)
    (place / DESCRIPTION).write_text(f"{text}\n", encoding="utf-8")


class _Files:
    """The files of a folder, each of which grows by whole columns."""

    def __init__(self, folder: Path, stack: ExitStack) -> None:
        self._writers = {
            name: stack.enter_context(
                pq.ParquetWriter(
                    folder / f"{name}.parquet",
                    schema,
                    compression="zstd",
                    use_dictionary=["stream", "column"],
                    use_byte_stream_split=_numbers_in(schema),
                )
            )
            for name, schema in SCHEMAS.items()
        }

    def write(self, name: str, stream: str, columns: Columns) -> None:
        """Add rows about one *stream* to a file; columns that are not given are empty."""
        schema = SCHEMAS[name]
        n = len(columns["valid_time" if "valid_time" in schema.names else "begin"])
        if not n:
            return
        given = {**columns, "stream": stream}
        arrays = [array_of(given.get(field.name), field.type, n) for field in schema]
        self._writers[name].write_table(pa.Table.from_arrays(arrays, schema=schema))


def _numbers_in(schema: pa.Schema) -> list[str]:
    return [field.name for field in schema if pa.types.is_floating(field.type)]


@dataclass
class _Tables:
    """The tables of one stream that are not written yet.

    Attributes:
        samples: They.
        previous: The last one that has been written.
    """

    samples: list[Sample[Table]] = field(default_factory=list)
    previous: Table = _NOTHING

    def take(self) -> list[Sample[Table]]:
        """Return the samples, and forget them."""
        taken, self.samples = self.samples, []
        if taken:
            self.previous = taken[-1].value
        return taken


class _Keeper:
    """Listens to the streams of a network and writes what matters."""

    def __init__(self, system: MonitoringSystem, files: _Files) -> None:
        self._kernel = system.network.kernel
        self._network = system.network.description
        self._histories = system.structures.histories
        self._files = files
        self._roles = Roles(self._network, IMAGE_SORTS)
        self._sorts: dict[str, str] = {}
        self._tables: dict[str, _Tables] = {}
        self._events: dict[str, list[Sample[tuple[Event, ...]]]] = {}
        self._recognitions: dict[str, list[Sample[tuple[Recognition, ...]]]] = {}
        self._images: dict[str, list[tuple[TimePoint, int]]] = {}
        self._filmed: dict[str, Any] = {}
        self._waiting = 0
        self._is_full = False
        self._now = TimePoint(-1)
        self._links_of = [
            label for label in self._roles.links if self._roles.generators[label]["kind"] == "link"
        ]
        self._listen()

    def finish(self) -> None:
        """Write everything that is not written yet."""
        self._flush()
        for label, samples in self._events.items():
            self._files.write("events", label, _events_kept(samples))
        for label, found in self._recognitions.items():
            self._files.write("recognitions", label, _recognitions_kept(found))
        for label, images in self._images.items():
            self._files.write("images", label, _images_kept(images))
        for label, history in zip(self._links_of, self._histories, strict=False):
            self._files.write("links", label, _links_kept(list(history)))

    def description(self, road_map: RoadMap) -> Description:
        """Return what the files are about."""
        names = {**vocabularies_of(road_map), "lane": road_map.lanes}
        return Description(
            network=json.loads(json.dumps(self._network)),
            sorts=self._sorts,
            vocabularies={column: list(values) for column, values in names.items()},
        )

    def _listen(self) -> None:
        roles = self._roles
        for label in roles.events:
            self._connect(label, self._events.setdefault(label, []).append)
        for label in roles.recognitions:
            self._connect(label, self._recognitions.setdefault(label, []).append)
        objects = (*roles.anchored, *roles.percepts)
        kept = (*objects, *roles.attributes, *roles.raw, *roles.measured)
        for label in dict.fromkeys(kept):
            self._connect(label, self._taker(self._tables.setdefault(label, _Tables())))
        for label in roles.images:
            self._connect(label, self._photographer(label, self._images.setdefault(label, [])))
        for label in roles.filmed:
            self._connect(label, self._watcher(label), "filmed")

    def _connect(
        self, label: str, receive: Callable[[Sample[Any]], None], purpose: str = "kept"
    ) -> None:
        self._kernel.generator(Label(label)).connect((_KEY, purpose), receive)

    def _taker(self, tables: _Tables) -> Callable[[Sample[Any]], None]:
        def take(sample: Sample[Any]) -> None:
            if isinstance(sample.value, Table):
                if self._is_full and sample.available_time > self._now:
                    self._flush()
                self._now = sample.available_time
                tables.samples.append(sample)
                self._waiting += len(sample.value)
                is_long = len(tables.samples) >= _MOST_TABLES
                self._is_full |= is_long or self._waiting >= _MOST_ROWS

        return take

    def _watcher(self, label: str) -> Callable[[Sample[Any]], None]:
        def note(sample: Sample[Any]) -> None:
            self._filmed[label] = sample.value

        return note

    def _photographer(
        self, label: str, images: list[tuple[TimePoint, int]]
    ) -> Callable[[Sample[Any]], None]:
        providers = self._roles.providers(label)

        def note(sample: Sample[Any]) -> None:
            shown = (self._filmed.get(provider) for provider in providers)
            images.append((sample.valid_time, digest_of(shown)))

        return note

    def _flush(self) -> None:
        """Write all tables that are waiting."""
        self._waiting, self._is_full = 0, False
        roles = self._roles
        qualities = self._qualities()
        previous_by_label = {label: tables.previous for label, tables in self._tables.items()}
        taken = {label: tables.take() for label, tables in self._tables.items()}
        for label, samples in taken.items():
            example = next((each.value for each in samples if len(each.value)), None)
            if example is None:
                continue
            self._sorts[label] = example.sort
            for name, labels in (("states", roles.anchored), ("percepts", roles.percepts)):
                if label in labels:
                    self._files.write(name, label, states_kept(samples, SCHEMAS[name].names[3:]))
            if label in qualities:
                measured = [p for p in roles.providers(label) if p in roles.measured]
                changes, quantities = changes_kept(
                    samples,
                    previous_by_label[label],
                    qualities[label],
                    [sample for each in measured for sample in taken.get(each, ())],
                )
                self._files.write("changes", label, changes)
                self._files.write("measures", label, quantities)

    def _qualities(self) -> dict[str, list[str]]:
        """Return the columns whose changes are kept: attributes, and what these are made of."""
        found = {label: self._columns(label) for label in self._roles.attributes}
        for label, names in list(found.items()):
            for provider in self._roles.providers(label):
                if provider in self._roles.raw:
                    own = self._columns(provider)
                    known = found.setdefault(provider, [])
                    known += [name for name in names if name in own and name not in known]
        return {label: names for label, names in found.items() if names}

    def _columns(self, label: str) -> list[str]:
        tables = self._tables[label]
        candidates = [tables.previous, *(sample.value for sample in tables.samples)]
        example = next((each for each in reversed(candidates) if len(each)), None)
        return [] if example is None else list(qualities_of(example))


def _events_kept(samples: Sequence[Sample[tuple[Event, ...]]]) -> Columns:
    rows = [(sample, event) for sample in samples for event in sample.value]
    return {
        "valid_time": [sample.valid_time for sample, _ in rows],
        "available_time": [sample.available_time for sample, _ in rows],
        "time": [event.time for _, event in rows],
        "attribute": [event.attribute for _, event in rows],
        "arguments": [list(event.arguments) for _, event in rows],
        "before": [event.from_value for _, event in rows],
        "after": [event.to_value for _, event in rows],
    }


def _recognitions_kept(samples: Sequence[Sample[tuple[Recognition, ...]]]) -> Columns:
    rows = [(sample, recognition) for sample in samples for recognition in sample.value]
    return {
        "valid_time": [sample.valid_time for sample, _ in rows],
        "available_time": [sample.available_time for sample, _ in rows],
        "chronicle": [recognition.chronicle for _, recognition in rows],
        "document": [json.dumps(json_from_recognition(recognition)) for _, recognition in rows],
    }


def _images_kept(images: Sequence[tuple[TimePoint, int]]) -> Columns:
    return {
        "valid_time": np.array([time for time, _ in images], dtype=np.int64),
        "number": np.arange(len(images)),
        "digest": np.array([digest for _, digest in images], dtype=np.uint32),
    }


def _links_kept(links: Sequence[Link]) -> Columns:
    """Return links, of which the first one of each upper object established it."""
    firsts = {link.upper: at for at, link in reversed(list(enumerate(links)))}
    return {
        "upper": [link.upper for link in links],
        "lower": [link.lower for link in links],
        "begin": [link.begin for link in links],
        "end": [link.end for link in links],
        "made_by": [
            "establish" if firsts[link.upper] == at else "reestablish"
            for at, link in enumerate(links)
        ],
        "ended_by": ["" if link.ended_by is None else str(link.ended_by) for link in links],
    }

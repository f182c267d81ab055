"""From an event to the samples that changed its attribute: after a filter, and before it."""

from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import pandas as pd

from chronicles.events import Event
from dyknow.time import MILLISECOND, SECOND
from traffic.explaining.changing import ABSENT
from traffic.explaining.explanation import Change, FactEvent, Provenance, ValueChange
from traffic.explaining.kept import KeptRun, records_of
from traffic.explaining.matching import fact_of
from traffic.explaining.symbols import id_of, sort_of_symbol

__all__ = ["Attributes", "Steps"]

_NEAR = 15 * SECOND
_MOST_NEAR = 3
_SAMPLED = SECOND
"""How much later than it began a value may be told by a stream that samples it."""


@dataclass(frozen=True, slots=True)
class Steps:
    """The values of one attribute of some objects over time.

    Attributes:
        attribute: Its name.
        arguments: The objects that it is about.
        times: When each value began, nanoseconds.
        values: The values; None for none.
    """

    attribute: str
    arguments: tuple[str, ...]
    times: tuple[int, ...]
    values: tuple[str | None, ...]


class Attributes:
    """Finds where events were told, and how the values behind them changed."""

    def __init__(self, run: KeptRun) -> None:
        self._run = run

    @cached_property
    def _by_attribute(self) -> dict[str, pd.DataFrame]:
        events = self._run.events
        return {str(name): of for name, of in events.groupby("attribute", observed=True)}

    @cached_property
    def _changes(self) -> pd.DataFrame:
        return self._run.read("changes")

    @cached_property
    def _measures(self) -> pd.DataFrame:
        return self._run.read("measures")

    def events_of(self, attribute: str, streams: Collection[str] = ()) -> Iterator[Event]:
        """Yield all events of an attribute in order of time, each as often as it was told.

        Only those of some *streams* are told, if any are given.
        """
        known = self._by_attribute.get(attribute)
        if known is not None:
            known = known[known["stream"].isin(list(streams))] if streams else known
            for row in records_of(known.sort_values("time")):
                yield _event(row)

    def told(self, event: Event, streams: Collection[str] = ()) -> dict[str, Any] | None:
        """Return the row of *event* among what was kept of some *streams*; None if it was not."""
        known = self._by_attribute.get(event.attribute)
        if known is None:
            return None
        known = known[known["stream"].isin(list(streams))] if streams else known
        whole = event.time // MILLISECOND
        for row in records_of(known[known["time"] // MILLISECOND == whole]):
            if _parts(_event(row)) == _parts(event):
                return row
        return None

    def provenance(self, row: dict[str, Any]) -> Provenance:
        """Return in which sample a kept event or recognition was told."""
        label = str(row["stream"])
        return Provenance(
            stream=label,
            process=self._run.process_of(label),
            valid_time=row["valid_time"] / MILLISECOND,
            available_time=row["available_time"] / MILLISECOND,
        )

    def near(self, event: Event, streams: Collection[str] = ()) -> list[FactEvent]:
        """Return the events of the same attribute and arguments shortly before and after."""
        told = self.events_of(event.attribute, streams)
        same = [each for each in told if each.arguments == event.arguments]
        before = [e for e in same if 0 < event.time - e.time <= _NEAR][-_MOST_NEAR:]
        after = [e for e in same if 0 < e.time - event.time <= _NEAR][:_MOST_NEAR]
        return [fact_of(each) for each in (*before, *after)]

    def change(self, event: Event, told: dict[str, Any]) -> Change | None:
        """Return how the attribute of a kept event changed; None if it is no column."""
        column = event.attribute.rpartition(".")[2]
        for label in self._run.roles.providers(str(told["stream"])):
            at = self._rows(label, column, event.arguments)
            filtered = self._at(at, column, told["valid_time"], event.to_value)
            if filtered is not None:
                raw = self._raw(label, column, event.arguments, filtered)
                delay = int(filtered["available_time"] - filtered["valid_time"])
                return Change(
                    filtered=self._value_change(filtered),
                    raw=None if raw is None else self._value_change(raw),
                    held_ms=delay / MILLISECOND if raw is not None else 0.0,
                )
        return None

    def steps(
        self, attribute: str, arguments: tuple[str, ...], streams: Collection[str] = ()
    ) -> Steps:
        """Return how an attribute of some objects changed over the whole run."""
        told = self.events_of(attribute, streams)
        found = [each for each in told if each.arguments == arguments]
        return Steps(
            attribute=attribute,
            arguments=arguments,
            times=tuple(event.time for event in found),
            values=tuple(event.to_value for event in found),
        )

    def raw_steps(
        self, attribute: str, arguments: tuple[str, ...], streams: Collection[str] = ()
    ) -> Steps | None:
        """Return how it changed before the filter; None if there was none."""
        column = attribute.rpartition(".")[2]
        told = self._by_attribute.get(attribute)
        known = [] if told is None else list(dict.fromkeys(map(str, told["stream"])))
        asked = [stream for stream in known if not streams or stream in streams]
        for label in (each for stream in asked for each in self._run.roles.providers(stream)):
            for provider in self._run.roles.providers(label):
                rows = self._rows(provider, column, arguments)
                if len(rows):
                    times = tuple(int(each) for each in rows["valid_time"])
                    codes = [int(code) for code in rows["after"]]
                    values = tuple(self._run.value_of(column, code) for code in codes)
                    return Steps(attribute, arguments, times, values)
        return None

    def _at(
        self, rows: pd.DataFrame, column: str, time: int, value: str | None
    ) -> pd.Series | None:
        """Return the change to *value* at *time*, or of a sampled stream the last before it."""
        codes = rows["after"].astype(int)
        is_it = np.array([self._run.value_of(column, code) == value for code in codes], bool)
        found = rows[is_it & (rows["valid_time"] <= time).to_numpy(bool)]
        if found.empty:
            return None
        last: pd.Series = found.iloc[-1]
        is_exact = bool(last["valid_time"] == time)
        return last if is_exact or time - last["valid_time"] <= _SAMPLED else None

    def _raw(
        self, label: str, column: str, arguments: Sequence[str], filtered: pd.Series
    ) -> pd.Series | None:
        """Return the change before the filter *label* that became the *filtered* one."""
        found: pd.Series
        code, time = filtered["after"], filtered["valid_time"]
        for provider in self._run.roles.providers(label):
            rows = self._rows(provider, column, arguments)
            rows = rows[rows["after"] == code]
            earlier = rows[rows["valid_time"] <= time]
            if len(earlier):
                found = earlier.iloc[-1]
                return found
            if code == ABSENT and len(rows):
                found = rows.iloc[0]
                return found
        return None

    def _rows(self, label: str, column: str, arguments: Sequence[str]) -> pd.DataFrame:
        """Return the changes of a column of one stream for some objects, in order of time."""
        rows = self._changes
        rows = rows[(rows["stream"] == label) & (rows["column"] == column)]
        ids = [self._id(label, argument) for argument in arguments]
        if None in ids or not 1 <= len(ids) <= 2:  # noqa: PLR2004, an object or a pair
            return rows.iloc[:0]
        names = ["id"] if len(ids) == 1 else ["first", "second"]
        for name, one in zip(names, ids, strict=True):
            rows = rows[(rows[name] == one).fillna(value=False).astype(bool)]
        return rows.sort_values("valid_time", kind="stable")

    def _id(self, label: str, argument: str) -> int | None:
        """Return the id of what is called *argument* in a stream; None if it is no object."""
        described = self._run.description
        names = described.vocabularies.get(described.sorts.get(label, ""), [])
        if argument in names:
            return names.index(argument)
        is_known = sort_of_symbol(argument) in described.sorts.values()
        return id_of(argument) if is_known else None

    def _value_change(self, row: pd.Series) -> ValueChange:
        label, column = str(row["stream"]), str(row["column"])
        return ValueChange(
            stream=label,
            process=self._run.process_of(label),
            column=column,
            valid_time=int(row["valid_time"]) / MILLISECOND,
            available_time=int(row["available_time"]) / MILLISECOND,
            before=self._run.value_of(column, int(row["before"])),
            after=self._run.value_of(column, int(row["after"])),
            quantities=self._quantities(label, int(row["id"]), int(row["valid_time"])),
        )

    def _quantities(self, label: str, one: int, time: int) -> dict[str, float]:
        rows = self._measures
        rows = rows[(rows["stream"] == label) & (rows["id"] == one) & (rows["valid_time"] == time)]
        return {
            str(name): float(value)
            for name, value in zip(rows["column"], rows["value"], strict=True)
            if pd.notna(value)
        }


def _event(row: dict[str, Any]) -> Event:
    return Event(
        attribute=str(row["attribute"]),
        arguments=tuple(row["arguments"]),
        from_value=_text(row["before"]),
        to_value=_text(row["after"]),
        time=row["time"],
    )


def _text(value: Any) -> str | None:
    return None if pd.isna(value) else str(value)


def _parts(event: Event) -> tuple[object, ...]:
    return event.arguments, event.from_value, event.to_value

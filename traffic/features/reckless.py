"""Who was a reckless driver, from when until when, out of the stream of those who are."""

from dataclasses import dataclass, replace
from typing import Any

from dyknow.streams.sample import Sample
from dyknow.streams.table import Table
from dyknow.time import TimePoint

__all__ = ["RecklessCar", "RecklessCars"]

_CAR = "car"


@dataclass(frozen=True, slots=True)
class RecklessCar:
    """A car that was linked to a reckless driver.

    Attributes:
        symbol: Of the reckless driver, such as `reckless_driver1`.
        car: The symbol of its car.
        since: When the car was linked.
        until: When the link was dropped; None if it still stood at the end.
        n_acts: How many reckless acts of the car were recognised.
        last_act_at: When the last of them was.
    """

    symbol: str
    car: str
    since: TimePoint
    until: TimePoint | None
    n_acts: int
    last_act_at: TimePoint


class RecklessCars:
    """Follows a stream of tables of reckless drivers."""

    def __init__(self) -> None:
        self._found: dict[str, RecklessCar] = {}
        self._standing: frozenset[str] = frozenset()

    @property
    def found(self) -> tuple[RecklessCar, ...]:
        """All reckless drivers so far, in the order in which they became so."""
        return tuple(self._found.values())

    def receive(self, sample: Sample[Table]) -> None:
        """Take in who is a reckless driver at the valid time of *sample*."""
        table = sample.value
        here = {table.symbol(each): at for at, each in enumerate(table.ids.tolist())}
        for symbol in self._standing - here.keys():
            self._found[symbol] = replace(self._found[symbol], until=sample.valid_time)
        for symbol, at in here.items():
            self._found[symbol] = _of_row(symbol, table, at)
        self._standing = frozenset(here)


def _of_row(symbol: str, table: Table, at: int) -> RecklessCar:
    def number(column: str) -> Any:
        return table[column][at].item()

    return RecklessCar(
        symbol=symbol,
        car=f"{_CAR}{number(_CAR)}",
        since=TimePoint(number("since")),
        until=None,
        n_acts=number("n_acts"),
        last_act_at=TimePoint(number("last_act_at")),
    )

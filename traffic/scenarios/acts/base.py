"""What all acts have in common: who acts, where, and how often."""

from collections.abc import Mapping
from typing import Self

from pydantic import model_validator

from traffic.scenarios.fields import AnyDuration, Rate, Roads, Settings, TypeWeights

__all__ = ["Act"]


class Act(Settings):
    """A driver who does something on purpose, again and again.

    A kind of act is a class that adds a literal `kind` and what each performance draws. Acts
    begin at random times with a mean rate, before time 0 too, or at given times.

    Attributes:
        types: Weight of each vehicle type of the driver.
        route: The roads that the driver passes.
        rate_per_hour: Mean number of performances in an hour; None if `times` are given.
        times: When performances begin, from time 0.
    """

    types: TypeWeights
    route: Roads
    rate_per_hour: Rate | None = None
    times: tuple[AnyDuration, ...] = ()

    @model_validator(mode="after")
    def _begins_by_rate_or_times(self) -> Self:
        if (self.rate_per_hour is None) == (not self.times):
            raise ValueError("expected either 'rate_per_hour' or 'times'")
        return self

    @property
    def casts(self) -> Mapping[str, TypeWeights]:
        """The weights of vehicle types that the act names, by the key that holds them."""
        return {"types": self.types}

    @property
    def routes(self) -> Mapping[str, Roads]:
        """The roads that the act names, by the key that holds them."""
        return {"route": self.route}

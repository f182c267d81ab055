"""What a suite has: how long and how large its recordings are, and what is expected of them."""

from dataclasses import dataclass

from dyknow.errors import DyKnowError
from dyknow.time import SECOND
from traffic.errors import TrafficError
from traffic.recording.rebuilding import describe, open_run
from traffic.regression.expectations import tally_of
from traffic.regression.manifest import Making
from traffic.regression.suite import Entry

__all__ = ["Listed", "listed"]


@dataclass(frozen=True, slots=True)
class Listed:
    """What there is to say about a recording.

    Attributes:
        entry: Of the suite.
        shows: What it is in the suite for; empty if nothing says so.
        made: Scenario, seed, and piece of the run.
        view: Through the cameras or not, and how large errors of positions are.
        seconds: How long it is.
        size: In bytes.
        expected: What is expected of it, counted.
        fault: Why nothing more is known of it; else empty.
    """

    entry: Entry
    shows: str = ""
    made: str = ""
    view: str = ""
    seconds: float = 0.0
    size: int = 0
    expected: str = ""
    fault: str = ""


def listed(entry: Entry, making: Making | None) -> Listed:
    """Return what there is to say about a recording, from its own words and the manifest's."""
    shows = making.shows if making is not None else ""
    try:
        with open_run(entry.recording) as recording:
            origin = describe(recording).origin
        expected = str(tally_of(entry.read_expected()))
        size = entry.recording.stat().st_size
    except (DyKnowError, TrafficError, OSError) as error:
        return Listed(entry, shows, fault=entry.fault_of(error))
    asked = origin.request
    noise = f", {asked['position_noise']:g} m" if asked["position_noise"] else ""
    piece = f", {making.begin} to {making.end}" if making is not None else ""
    return Listed(
        entry,
        shows,
        f"{origin.scenario.name}, seed {asked['seed']}{piece}",
        f"{asked['view']}{noise}",
        origin.scenario.duration / SECOND,
        size,
        expected,
    )

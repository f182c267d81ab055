"""The same work done by other stream libraries for Python, where they are installed.

They do not know valid times, delays or policies, so that they get the nearest that they have: a
filter per stream in place of a policy, and `zip`, which pairs by position, in place of
synchronisation by valid time. Both libraries are optional and are imported only here.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from importlib import import_module
from typing import Any

from dyknow.streams.sample import Sample
from traffic.benchmarks.machine import missing_distributions, version_of
from traffic.benchmarks.results import Measurement, Ratio
from traffic.benchmarks.workloads import PERIOD

__all__ = ["PEERS", "Peer", "installed_peers", "missing_peers", "ratio_to"]

PEERS = ("reactivex", "streamz")

Emit = Callable[[Sample[Any]], object]
"""Gives a sample to a library."""

Passes = Callable[[Sample[Any]], bool]
Receive = Callable[[Any], object]


@dataclass(frozen=True, slots=True)
class Peer:
    """Another library and what it is asked to do.

    Attributes:
        name: Of the distribution.
        version: Of the installed one.
        fan_out: Hands each sample to so many receivers, through a sampling filter for each.
        fan_out_shared: The same through one filter for all.
        join: Makes tuples of one sample of each of so many inputs, for one receiver.
    """

    name: str
    version: str
    fan_out: Callable[[int, Receive], Emit]
    fan_out_shared: Callable[[int, Receive], Emit]
    join: Callable[[int, Receive], Sequence[Emit]]


def installed_peers() -> list[Peer]:
    """Return the peers that are installed."""
    work = {
        "reactivex": (_fan_out_of_reactivex, _shared_in_reactivex, _join_of_reactivex),
        "streamz": (_fan_out_of_streamz, _shared_in_streamz, _join_of_streamz),
    }
    versions = {name: version_of(name) for name in PEERS}
    return [
        Peer(name, version, *work[name])
        for name, version in versions.items()
        if version is not None
    ]


def missing_peers() -> list[str]:
    """Return a sentence for each peer that is not installed."""
    return missing_distributions(PEERS)


def ratio_to(
    peer: Peer, what: str, ours: Callable[[], float], theirs: Callable[[], float], rounds: int
) -> Ratio:
    """Measure both in turn and return how much longer the peer takes."""
    ratios = [theirs() / ours() for _ in range(rounds)]
    return Ratio(
        peer=peer.name, version=peer.version, what=what, times_as_long=Measurement.of(ratios)
    )


def sampling_filter() -> Passes:
    """Return what lets a sample through at each multiple of the period, once."""
    expected = 0

    def passes(sample: Sample[Any]) -> bool:
        nonlocal expected
        if sample.valid_time != expected:
            return False
        expected += PERIOD
        return True

    return passes


def _fan_out_of_reactivex(n: int, receive: Receive) -> Emit:
    operators = import_module("reactivex.operators")
    subject = import_module("reactivex.subject").Subject()
    for _ in range(n):
        subject.pipe(operators.filter(sampling_filter())).subscribe(receive)
    emit: Emit = subject.on_next
    return emit


def _shared_in_reactivex(n: int, receive: Receive) -> Emit:
    operators = import_module("reactivex.operators")
    subject = import_module("reactivex.subject").Subject()
    sampled = subject.pipe(operators.filter(sampling_filter()), operators.share())
    for _ in range(n):
        sampled.subscribe(receive)
    emit: Emit = subject.on_next
    return emit


def _join_of_reactivex(n: int, receive: Receive) -> Sequence[Emit]:
    make = import_module("reactivex.subject").Subject
    subjects = [make() for _ in range(n)]
    import_module("reactivex").zip(*subjects).subscribe(receive)
    return [subject.on_next for subject in subjects]


def _fan_out_of_streamz(n: int, receive: Receive) -> Emit:
    source = import_module("streamz").Stream()
    for _ in range(n):
        source.filter(sampling_filter()).sink(receive)
    emit: Emit = source.emit
    return emit


def _shared_in_streamz(n: int, receive: Receive) -> Emit:
    source = import_module("streamz").Stream()
    sampled = source.filter(sampling_filter())
    for _ in range(n):
        sampled.sink(receive)
    emit: Emit = source.emit
    return emit


def _join_of_streamz(n: int, receive: Receive) -> Sequence[Emit]:
    library = import_module("streamz")
    streams = [library.Stream() for _ in range(n)]
    library.zip(*streams).sink(receive)
    return [stream.emit for stream in streams]

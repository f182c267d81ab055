"""Other libraries are measured if they are installed, and passed over with a sentence if not."""

import importlib.util

import pytest

from dyknow.streams.sample import Sample
from traffic.benchmarks.peers import (
    PEERS,
    Peer,
    installed_peers,
    missing_peers,
    ratio_to,
    sampling_filter,
)
from traffic.benchmarks.workloads import PERIOD


def test_every_peer_is_measured_or_passed_over():
    """Each peer is either installed or told to be missing."""
    installed = {peer.name for peer in installed_peers()}

    assert len(installed) + len(missing_peers()) == len(PEERS)
    for name in PEERS:
        assert (name in installed) == (importlib.util.find_spec(name) is not None)


def test_the_filter_samples():
    """A sample passes if its valid time is the next multiple of the period."""
    passes = sampling_filter()
    times = [0, PERIOD // 2, PERIOD, PERIOD, 2 * PERIOD]

    assert [passes(Sample(0, time, time)) for time in times] == [True, False, True, False, True]


def test_a_ratio_says_how_much_longer_the_peer_takes():
    """Both are measured in turn, and their time is divided by ours."""
    turns = []
    peer = Peer(
        "other",
        "1.0",
        lambda n, receive: ignore,
        lambda n, receive: ignore,
        lambda n, receive: [],
    )

    ratio = ratio_to(
        peer, "work", lambda: turns.append("ours") or 2.0, lambda: turns.append("theirs") or 6.0, 2
    )

    assert turns == ["theirs", "ours"] * 2
    assert ratio.times_as_long.median == 3.0


def ignore(sample):
    """Take a sample."""


@pytest.mark.parametrize("peer", installed_peers(), ids=lambda peer: peer.name)
def test_peers_do_the_work(peer):
    """A peer hands a sample to all receivers, and joins one sample of each input."""
    received, joined = [], []

    peer.fan_out(3, received.append)(Sample(1, 0, 0))
    peer.fan_out_shared(3, received.append)(Sample(1, 0, 0))
    for emit in peer.join(2, joined.append):
        emit(Sample(1, 0, 0))

    assert len(received) == 6
    assert len(joined) == 1

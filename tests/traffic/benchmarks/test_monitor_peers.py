"""Other libraries for monitoring are measured if they are installed, and passed over if not."""

import importlib.util

import pytest

from traffic.benchmarks.monitor_peers import PEERS, installed_peers, missing_peers
from traffic.benchmarks.sequences import FORMULAS, times


def test_every_peer_is_measured_or_passed_over():
    """Each peer is either installed or told to be missing."""
    installed = {peer.name for peer in installed_peers()}

    assert len(installed) + len(missing_peers()) == len(PEERS)
    for name in PEERS:
        module = name.replace("-", "_")
        assert (name in installed) == (importlib.util.find_spec(module) is not None)


@pytest.mark.filterwarnings("ignore::DeprecationWarning")
@pytest.mark.parametrize("peer", installed_peers(), ids=lambda peer: peer.name)
@pytest.mark.parametrize("under_test", FORMULAS, ids=lambda formula: formula.name)
def test_peers_do_the_work(peer, under_test):
    """A peer answers to each state."""
    step = peer.monitor(under_test)

    for now in times(30, 0.0):
        assert step(now, value=True) is not None

"""Other engines for chronicles do the work if they can be run here, and are passed over if not."""

import pytest

from traffic.benchmarks.chronicles_events import changes, overtakes
from traffic.benchmarks.chronicles_peers import PEERS, installed_peers, missing_peers


def test_every_engine_is_measured_or_passed_over():
    """Each engine can either be run, or a sentence says why not."""
    assert len(installed_peers()) + len(missing_peers()) == len(PEERS)


@pytest.mark.parametrize("peer", installed_peers(), ids=lambda peer: peer.name)
def test_engines_find_overtakes_and_no_others(peer):
    """What an engine finds is an overtake; each round is timed."""
    events = changes(100, 3_000)

    found = peer.recognise(events, 1)

    assert found.overtakes
    assert found.overtakes <= overtakes(events)
    assert len(found.seconds) == 1

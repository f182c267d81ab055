"""What a process makes of recorded streams."""

from dyknow.judging.declared import DeclaredNetwork
from dyknow.judging.execution import Interpretation
from dyknow.judging.judgement import Basis
from dyknow.judging.recomputing import Recomputation, unknown_behind
from dyknow.judging.streams import KnownStreams
from dyknow.runtime.generators import Label
from dyknow.streams.policy import Policy
from tests.dyknow.judging.units import Counting, Late
from tests.support.small_networks import SmallNetwork
from tests.support.streams import ms, stream, text

CHAIN = SmallNetwork(
    {"source": stream("0:a 100:b 200:c")},
    {
        "late": (Late, [("source", Policy())]),
        "counted": (Counting, [("late", Policy(max_delay=ms(35)))]),
    },
)


def computed(
    topics: tuple[str, ...], distrusted: frozenset[str] = frozenset()
) -> tuple[str, Basis]:
    """Return what `counted` makes when only *topics* of the chain are known, and of what."""
    streams = CHAIN.run(ms(1000)).streams
    known = KnownStreams(Interpretation(ms(1000), {topic: streams[topic] for topic in topics}))
    made = []
    recomputation = Recomputation(CHAIN.declared(), known, distrusted)
    recomputation.run(Label("counted"), made.append, ms(1000))
    return text(made), recomputation.basis


def test_a_unit_is_fed_with_its_recorded_inputs() -> None:
    """Where the input stream was recorded, nothing else is looked at."""
    made, basis = computed(("counted/1",))

    assert made == "0:(1, 'a')@35 100:(2, 'b')@135 200:(3, 'c')@235"
    assert basis is Basis.RECORDED


def test_an_input_that_was_not_recorded_is_made_of_the_providers_stream() -> None:
    """The policy is applied to the recorded stream, or to one that is computed in turn."""
    expected = "0:(1, 'a')@35 100:(2, 'b')@135 200:(3, 'c')@235"

    assert computed(("late",)) == (expected, Basis.RECORDED)
    assert computed(("late/1",)) == (expected, Basis.COMPUTED)
    assert computed(("source",)) == (expected, Basis.COMPUTED)


def test_what_is_distrusted_is_computed_again() -> None:
    """A recorded stream that is at fault is made again from what feeds it, if that can be done."""
    expected = "0:(1, 'a')@35 100:(2, 'b')@135 200:(3, 'c')@235"

    assert computed(("late", "source"), frozenset({"late"})) == (expected, Basis.CORRECTED)
    assert computed(("late",), frozenset({"late"})) == (expected, Basis.RECORDED)


def test_sources_that_are_missing_are_named() -> None:
    """A source that was not recorded and cannot be asked again is in the way of what follows."""
    network: DeclaredNetwork = CHAIN.declared()

    assert list(unknown_behind(network, Label("counted"), frozenset())) == ["source"]
    assert list(unknown_behind(network, Label("counted"), frozenset({"late/1"}))) == []

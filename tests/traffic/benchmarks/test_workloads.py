"""The networks of the benchmarks are those of the thesis."""

import pytest

from traffic.benchmarks.workloads import (
    Steady,
    Workload,
    ignore,
    many_deadlines,
    many_policies,
    many_sources,
    many_streams,
    many_units,
)


def test_figure_5_6():
    """With n streams there is one source, and every stream takes from it."""
    network = Workload(many_streams(3)).build([Steady(1)])

    assert network.kernel.labels == ("gen",)
    assert network.outputs == ("strm1", "strm2", "strm3")


def test_figure_5_8():
    """The streams take turns with the sources."""
    assert many_sources(2, 3).splitlines()[-3:] == [
        "stream strm1 = gen1 with sample every 100",
        "stream strm2 = gen2 with sample every 100",
        "stream strm3 = gen1 with sample every 100",
    ]


def test_figure_5_10():
    """Of m streams n feed units, and the others take turns with these."""
    text = many_units(2, 5)

    assert text.count("with sample every 100") == 5
    assert text.splitlines()[-1] == "stream strm3 = gen1 with sample every 100"


@pytest.mark.parametrize(
    ("text", "n_sources"),
    [
        (many_streams(4), 1),
        (many_policies(4), 1),
        (many_deadlines(4), 1),
        (many_sources(3, 5), 3),
        (many_units(2, 6), 1),
    ],
)
def test_every_stream_gets_every_sample(text, n_sources):
    """All samples reach all streams, so that the delay of the last one is that of the whole."""
    network = Workload(text, n_sources).build([Steady(5) for _ in range(n_sources)])
    received = {output: [] for output in network.outputs}
    for output, samples in received.items():
        network.subscribe(output, samples.append)

    network.kernel.run()

    assert {len(samples) for samples in received.values()} == {5}


def test_a_delay_is_positive():
    """Time passes between the offer of a sample and its delivery."""
    assert Workload(many_streams(2)).delay(3) > 0
    assert ignore(None) is None

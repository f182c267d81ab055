"""Figures are written short, with a unit, and with no more digits than they deserve."""

from dataclasses import replace

import pytest

from dyknow.inspection.snapshot import Kind
from dyknow.inspection.wording import (
    amount_text,
    count_text,
    delay_text,
    implementation_text,
    process_text,
    pulse_text,
    rate_text,
    stream_text,
)
from tests.support.snapshots import small_network


@pytest.mark.parametrize(
    ("count", "text"),
    [(0, "0"), (950, "950"), (12_345, "12 345"), (123_456, "123 k"), (2_880_000, "2.88 M")],
)
def test_counts(count, text):
    """Counts are exact as long as they are short."""
    assert count_text(count) == text.replace(" ", "\u202f")


@pytest.mark.parametrize(
    ("rate", "text"),
    [(None, "–"), (0.5, "0.5 Hz"), (25.0, "25 Hz"), (9.97, "9.97 Hz"), (2_500.0, "2.5 kHz")],
)
def test_rates(rate, text):
    """Rates have a unit, and a dash stands for none."""
    assert rate_text(rate) == text.replace(" ", "\u202f")


@pytest.mark.parametrize(
    ("delay", "text"),
    [
        (None, "–"),
        (0, "0"),
        (500, "500 ns"),
        (12_000, "12 µs"),
        (40_500_000, "40.5 ms"),
        (1_500_000_000, "1.5 s"),
        (-2_000_000, "-2 ms"),
    ],
)
def test_delays(delay, text):
    """Delays are written in the unit in which they are short."""
    assert delay_text(delay) == text.replace(" ", "\u202f")


def test_processes_tell_everything():
    """All that is known of a process can be read."""
    process = replace(
        small_network().processes[1], policy="strict order", heartbeats=3, violations=4, failures=1
    )

    told = process_text(process)

    for piece in ("Vision(images)", "promises strict order", "3 heartbeats", "4 violations"):
        assert piece in told
    assert "cache: 8 of at most 16 samples" in told
    assert "1 failure" in told
    assert implementation_text(process) == "Vision"


def test_streams_tell_everything():
    """All that is known of a stream can be read."""
    told = stream_text(small_network().streams[1])

    assert told.startswith("percepts[vision] with sample every 100 → cars/1\n")
    assert "99 % 80\u202fms" in told
    assert "1 late sample" in told


@pytest.mark.parametrize(
    ("kind", "text", "words"),
    [
        (Kind.SOURCE, "camera", "camera"),
        (Kind.UNIT, "Vision(images, size = 3)", "Vision"),
        (Kind.LINK, "link(\n    a with strict order,\n    Car,\n    maintain = true)", "link Car"),
        (Kind.SYNCHRONISATION, "sync(a, b)", "synchronisation"),
        (Kind.MERGING, "", "merging"),
        (Kind.UNIT, "", "unit"),
    ],
)
def test_what_a_process_is_made_of(kind, text, words):
    """A unit and a source are called by their symbols, a link by the unit that it feeds."""
    process = replace(small_network().processes[0], kind=kind, text=text)

    assert implementation_text(process) == words


def test_one_of_something_is_not_many():
    """Nouns follow their number."""
    assert amount_text(1, "sample") == "1 sample"
    assert amount_text(0, "sample") == "0 samples"


def test_a_pulse_needs_two_samples():
    """With fewer than two samples there is no rate, and the pulse says how many there are."""
    stream = small_network().streams[1]

    assert pulse_text(stream) == "10\u202fHz · 40\u202fms"
    assert pulse_text(replace(stream, rate=None, samples=1)) == "1 sample"
    assert pulse_text(replace(stream, rate=None, samples=0)) == "nothing yet"

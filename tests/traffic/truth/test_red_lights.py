"""Who drives past a red light, on hand-made cases and against the definition read word by word."""

from collections.abc import Sequence

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from dyknow.streams.table import Table
from dyknow.time import SECOND, TimePoint
from networks.signals import SignalState
from traffic.sumo.simulation import Frame
from traffic.truth.manoeuvres import TrueManoeuvre
from traffic.truth.places import TruePlaces
from traffic.truth.red_lights import RedLightWatcher

STEP = SECOND // 5
LENGTH = 4.0
SIGNAL, NEXT = 7, 3
"""The lane before the line, whose signal it is, and the lane inside the crossing."""

RED, GREEN, YELLOW = SignalState.RED, SignalState.GREEN, SignalState.YELLOW


def watch(front: Sequence[float], states: Sequence[SignalState]) -> list[TrueManoeuvre]:
    """Return who runs the light when a car drives east over the line at x = 0."""
    watcher, found = RedLightWatcher(), []
    for i, (x, state) in enumerate(zip(front, states, strict=True)):
        columns = {
            "position": np.array([[x - LENGTH / 2, 0.0]]),
            "heading": np.zeros(1),
            "length": np.full(1, LENGTH),
        }
        inside = x >= 0
        lane = np.array([NEXT if inside else SIGNAL], dtype=np.int32)
        signals = Table("signal", (SIGNAL,), {"state": np.array([state], dtype=np.int8)})
        frame = Frame(
            TimePoint(i * STEP),
            Table("vehicle", (5,), columns),
            Table("vehicle", (5,), {"lane": lane}),
            signals,
        )
        link = np.array([-1 if inside else 0], dtype=np.int32)
        crossing = np.array([0 if inside else -1], dtype=np.int32)
        nan = np.full(1, np.nan)
        places = TruePlaces(link, crossing, np.ones(1), nan, link, nan, nan)
        found += watcher.observe(frame, places)
    return found + watcher.finish()


def drive(red_for: int, n: int = 20) -> tuple[list[float], list[SignalState]]:
    """Return a car that passes the line in frame 10, and a signal that turned red before."""
    front = [2.0 * (i - 10) + 0.5 for i in range(n)]
    return front, [YELLOW if i < 10 - red_for else RED for i in range(n)]


def test_who_passes_a_signal_that_has_been_red_for_a_second_runs_it() -> None:
    """From the first frame behind the line to the first four metres further on."""
    assert watch(*drive(red_for=5)) == [
        TrueManoeuvre("red_light", (5,), (), TimePoint(10 * STEP), TimePoint(12 * STEP))
    ]


def test_who_passes_as_it_turns_does_not_run_it() -> None:
    """Less than a second of red is too little, and so are yellow and green."""
    assert watch(*drive(red_for=4)) == []
    assert watch(*drive(red_for=-30)) == []


def test_who_stops_a_little_past_the_line_does_not_run_it() -> None:
    """Waiting there until it is green, and driving on then, is allowed."""
    front = [*np.linspace(-8, 2, 10), *[2.0] * 10, *np.linspace(3, 20, 10)]
    states = [RED] * 18 + [GREEN] * 12

    assert watch(front, states) == []


def naive(front: Sequence[float], states: Sequence[SignalState]) -> list[tuple[int, int]]:
    """Return first and last frame by reading the definition for each passing of the line."""
    found = []
    for begin in range(1, len(front)):
        if not front[begin - 1] < 0 <= front[begin]:
            continue
        since = begin
        while since > 0 and states[since - 1] == RED:
            since -= 1
        if states[begin] != RED or (begin - since) * STEP < SECOND:
            continue
        for end in range(begin, len(front)):
            if states[end] != RED or (end > begin and front[end - 1] < 0 <= front[end]):
                break
            if abs(front[end] - front[begin]) >= 4.0:
                found.append((begin, end))
                break
    return found


@given(
    st.lists(
        st.tuples(st.sampled_from([-3, 1, 2, 3, 5]), st.sampled_from([RED] * 12 + [GREEN])),
        min_size=1,
        max_size=25,
    )
)
@settings(derandomize=True, deadline=None, max_examples=300)
def test_the_watcher_agrees_with_the_definition(
    steps: list[tuple[int, SignalState]],
) -> None:
    """Frame by frame it finds what looking at the whole drive finds."""
    front = np.cumsum([-9.5, *(float(step) for step, _ in steps)]).tolist()
    states = [RED, *(state for _, state in steps)]

    found = [(each.begin // STEP, each.end // STEP) for each in watch(front, states)]

    assert found == naive(front, states)

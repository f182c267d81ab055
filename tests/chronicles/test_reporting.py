"""Which matches are reported."""

from hypothesis import given, settings
from hypothesis import strategies as st

from chronicles.events import Event
from chronicles.models import models_from_chronicles
from chronicles.parser import parse_chronicles
from chronicles.recognition import Recogniser
from dyknow.time import TimePoint

MS = 1_000_000
MODEL = "chronicle c[?x] {{ {} event(a[?x], t1) event(b[?x], t2) t1 <= t2 <= t1 + 10 }}"


def intervals(report: str, steps: list[tuple[int, str, str]]) -> list[tuple[str, int, int]]:
    """Return the intervals of the recognitions, in milliseconds and in order."""
    recogniser = Recogniser(models_from_chronicles(parse_chronicles(MODEL.format(report))))
    found = []
    time = 0
    for step, name, value in steps:
        time += step
        event = Event(name, (value,), None, None, TimePoint(time * MS))
        found += recogniser.push(event.time, [event])
    return [(one.arguments["x"], one.begin // MS, one.end // MS) for one in found]


@settings(derandomize=True, deadline=None, max_examples=60)
@given(
    st.lists(
        st.tuples(st.integers(0, 4), st.sampled_from("ab"), st.sampled_from("uv")), max_size=20
    )
)
def test_non_overlapping_reports_are_a_greedy_choice_of_all(
    steps: list[tuple[int, str, str]],
) -> None:
    """Those left out share an instant with one reported before; those reported do not."""
    everything = intervals("report all", steps)
    chosen: list[tuple[str, int, int]] = []
    for value, begin, end in sorted(everything, key=lambda one: (one[2], one[1], one[0])):
        if all(value != v or end < first or last < begin for v, first, last in chosen):
            chosen.append((value, begin, end))

    found = intervals("report non_overlapping (t1, t2)", steps)

    assert sorted(map(by_end, found)) == sorted(map(by_end, chosen))
    assert everything == intervals("", steps)


def by_end(interval: tuple[str, int, int]) -> tuple[str, int]:
    """Return what does not depend on the order in which one instant is told."""
    return interval[0], interval[2]

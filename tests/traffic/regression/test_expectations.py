"""What was recognised, as text, and that text counted."""

from collections import Counter

from hypothesis import given, settings
from hypothesis import strategies as st

from traffic.regression.expectations import tally_of, text_from_result
from traffic.results import Manoeuvre, RecklessDriverResult, RecognitionResult, RunResult, Timing

_TIMING = Timing(simulated_s=1, wall_s=1, real_time_factor=1, stages={})
_NAMES = st.sampled_from(["overtake", "turn_left", "missed", "red_light"])
_TIMES = st.integers(0, 999_999).map(lambda tenths: tenths * 100.0)


def recognised(chronicle: str, agrees: bool | None, begin: float) -> RecognitionResult:
    """Return a recognition of two cars, of which the truth says *agrees*."""
    return RecognitionResult(
        chronicle=chronicle,
        arguments={"car1": "car3", "x": "true: false"},
        times={},
        begin=begin,
        end=begin + 100,
        recognised_at=begin + 200,
        events=[],
        truth={"car1": "car.1"},
        agrees=agrees,
    )


def result_of(
    recognitions: list[RecognitionResult],
    missed: list[Manoeuvre],
    failures: tuple[str, ...] = (),
    reckless: list[RecklessDriverResult] | None = None,
) -> RunResult:
    """Return a result that has these."""
    return RunResult(
        scenario="rural",
        settings={"view": "truth", "changes": None},
        recognitions=recognitions,
        missed=missed,
        score={},
        timing=_TIMING,
        failures=list(failures),
        reckless_drivers=reckless,
    )


@settings(derandomize=True, deadline=None, max_examples=60)
@given(
    found=st.lists(st.tuples(_NAMES, st.sampled_from([True, False, None]), _TIMES), max_size=8),
    missed=st.lists(st.tuples(_NAMES, _TIMES), max_size=4),
)
def test_the_text_has_all_that_was_found_and_missed(
    found: list[tuple[str, bool | None, float]], missed: list[tuple[str, float]]
) -> None:
    """Counted from its lines as from the result, and in order of time."""
    result = result_of(
        [recognised(*each) for each in found],
        [
            Manoeuvre(kind=kind, vehicles=["car.1"], place=["a: true"], begin=at, end=at)
            for kind, at in missed
        ],
    )

    text = text_from_result(result)

    verdicts = {True: "true", False: "false", None: "not in view"}
    expected: dict[str, Counter[str]] = {}
    for name, agrees, _ in found:
        expected.setdefault(verdicts[agrees], Counter())[name] += 1
    for name, _ in missed:
        expected.setdefault("missed", Counter())[name] += 1
    assert tally_of(text).counts == expected
    begins = [float(line.split()[0]) for line in text.splitlines()[1:]]
    assert begins == sorted(begins)


def test_failures_and_reckless_drivers_stand_at_the_end() -> None:
    """A process that fails must not look like nothing to recognise."""
    driver = RecklessDriverResult(
        symbol="reckless1", car="car3", since=1500, until=None, acts=1, last_act_at=1500
    )
    text = text_from_result(
        result_of([recognised("overtake", True, 100)], [], ("process 'x' failed",), [driver])
    )

    assert text.splitlines() == [
        "rural: view truth",
        "     0.1      0.2  overtake[car1 = car3, x = true: false]  certain at 0.3  car.1: true",
        "     1.5        –  reckless1 is car3: 1 reckless act",
        "process 'x' failed",
    ]
    assert str(tally_of(text)) == "true: overtake 1"
    assert tally_of(text).names("true") == ("overtake",)
    assert str(tally_of("rural: view truth\n")) == "nothing"

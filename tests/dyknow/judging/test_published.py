"""Whether the right violations were published."""

from dyknow.judging.published import PublishedViolations
from dyknow.runtime.generators import Label
from dyknow.runtime.subscriptions import StreamViolation
from dyknow.streams.policy import Constraint, Violation
from tests.support.streams import ms

POSITIONS, SPEED = Label("positions"), Label("speed")
INPUT = (POSITIONS, SPEED, 1)
MISSING = Violation(Constraint.CHANGE, ms(100), ms(150), "no sample of valid time 100")
LATE = Violation(Constraint.DELAY, ms(200), ms(250), "too late")


def test_violations_that_there_should_be_are_no_breach() -> None:
    """What is expected and was published is in order, whatever the reasons say."""
    published = PublishedViolations([StreamViolation(POSITIONS, SPEED, MISSING, 1)])
    published.expect(INPUT, [Violation(Constraint.CHANGE, ms(100), ms(150), "why not")])

    assert list(published.breaches()) == []


def test_a_violation_that_was_not_published_is_a_breach() -> None:
    """Nothing may be dropped unseen."""
    published = PublishedViolations([])
    published.expect(INPUT, [MISSING])

    (breach,) = published.breaches()

    assert breach.stream == "violations of 'positions' to 'speed'"
    assert breach.found == "none"
    assert "no sample of valid time 100" in breach.expected


def test_a_violation_without_a_cause_is_a_breach() -> None:
    """Nothing else may be published, not of streams that nobody has declared either."""
    published = PublishedViolations(
        [StreamViolation(POSITIONS, SPEED, MISSING, 1), StreamViolation(SPEED, SPEED, LATE)]
    )
    published.expect(INPUT, [])

    found = list(published.breaches())

    assert [breach.expected for breach in found] == ["no violation", "no violation"]
    assert found[1].stream == "violations of 'speed'"


def test_what_nobody_can_tell_is_left_open() -> None:
    """Of streams that cannot be made again, no violation is missing or too much."""
    published = PublishedViolations([StreamViolation(POSITIONS, SPEED, MISSING, 1)])
    published.leave_open(INPUT)

    assert list(published.breaches()) == []
    assert published.of(INPUT) == [MISSING]

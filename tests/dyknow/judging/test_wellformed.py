"""What every stream must be."""

from dyknow.judging.judgement import Definition
from dyknow.judging.wellformed import heartbeat_breaches, order_breaches, sort_breaches
from dyknow.streams.sample import Heartbeat
from tests.support.streams import ms, stream


def test_available_times_are_in_order() -> None:
    """A sample that goes back in available time breaks definition 4.3.5."""
    (breach,) = order_breaches("speed", stream("0:a 200:b 100:c 300:d"))

    assert breach.definition is Definition.FLUENT_STREAM
    assert (breach.expected, breach.found) == ("an available time after 200", "100")


def test_available_times_are_unique() -> None:
    """So does one that shares its available time with the one before it."""
    (breach,) = order_breaches("speed", stream("0:a 100:b 150:c@100"))

    assert breach.valid_time == ms(150)
    assert breach.found == "the same one again"


def test_what_is_available_before_it_is_valid_is_no_breach() -> None:
    """Valid and available times are independent: predictions are welcome."""
    assert list(order_breaches("speed", stream("100:a@50 200:b@60"))) == []


def test_values_are_of_their_sort() -> None:
    """The application says what is wrong with a value."""

    def fault_of(value: str) -> str | None:
        return None if value == "a" else "not an a"

    (breach,) = sort_breaches("speed", stream("0:a 100:b"), fault_of, "first_letter")

    assert breach.definition is Definition.SORT
    assert breach.expected == "a value of sort 'first_letter'"
    assert breach.found == "'b': not an a"


def test_heartbeats_are_kept() -> None:
    """After the promise of nothing up to a valid time, nothing older may come."""
    heartbeats = [Heartbeat(ms(100), ms(110))]

    assert list(heartbeat_breaches("speed", stream("100:a@110 101:b@120"), heartbeats)) == []
    (breach,) = heartbeat_breaches("speed", stream("100:a@110 100:b@120"), heartbeats)
    assert breach.available_time == ms(120)
    assert breach.expected == "a valid time after 100, as a heartbeat has promised"

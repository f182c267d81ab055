"""What sorts contain."""

from dyknow.judging.sorts import sort_test
from dyknow.kpl.syntax import Sort

SORTS = {"speed": lambda value: None if value >= 0 else "a speed is not negative"}


def test_a_sort_is_what_the_application_says() -> None:
    """The application's test is asked; of other sorts nothing is known."""
    test = sort_test(Sort("speed"), SORTS)

    assert test is not None
    assert test(3) is None
    assert test(-3) == "a speed is not negative"
    assert sort_test(Sort("position"), SORTS) is None
    assert sort_test(Sort("any"), SORTS) is None
    assert sort_test(None, SORTS) is None


def test_a_state_has_values_of_the_sorts_of_its_parts() -> None:
    """A state is a tuple with one value for each part; what is not known is not tested."""
    test = sort_test(Sort("state", (Sort("any"), Sort("speed"))), SORTS)

    assert test is not None
    assert test(("x", 3)) is None
    assert test(("x", -3)) == "in place 2, a speed is not negative"
    assert test(("x",)) == "expected a tuple of 2 values"
    assert test(5) == "expected a tuple of 2 values"

"""Which events are as chronicle files declare them."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from chronicles.acceptance import Acceptance, RefusalKind
from chronicles.conditions import holds
from chronicles.events import Event
from chronicles.parser import parse_chronicles
from dyknow.time import TimePoint

TEXT = """
domain Car = {a, b}
attribute p[?x, ?y] { ?x in Car; ?x != ?y; ?value in {v, w}; ?x == a => ?value == v }
message m[?x] { ?x in Car }
chronicle c[?x] { event(p[?x, ?]:(?, ?), t) }
"""
values = st.sampled_from(["a", "b", "v", "w"])


def event(name: str, *arguments: str, before: str | None = None, to: str | None = None) -> Event:
    """Return an event at time 0."""
    return Event(name, arguments, before, to, TimePoint(0))


@settings(derandomize=True, deadline=None, max_examples=200)
@given(st.lists(st.tuples(values, values, st.one_of(st.none(), values), values), max_size=8))
def test_an_event_is_accepted_if_all_conditions_hold(rows) -> None:
    """Of both values, whatever was asked before; an unknown value is allowed."""
    file = parse_chronicles(TEXT)
    domains = {domain.name: domain.domain for domain in file.domains}
    acceptance = Acceptance([file])

    for x, y, before, after in rows:
        expected = all(
            holds(condition, {"?x": x, "?y": y, "?value": value}, domains)
            for condition in file.signals[0].conditions
            for value in (before, after)
            if value is not None
        )
        refusal = acceptance.refusal(event("p", x, y, before=before, to=after))
        assert (refusal is None) == expected
        assert refusal is None or refusal.kind is RefusalKind.DOMAIN


@pytest.mark.parametrize(
    ("found", "kind"),
    [
        (event("m", "a"), None),
        (event("m", "z"), RefusalKind.DOMAIN),
        (event("m", "a", "b"), RefusalKind.ARITY),
        (event("m", "a", to="v"), RefusalKind.KIND),
        (event("p", "a", "b"), RefusalKind.KIND),
        (event("p", "a", to="v"), RefusalKind.ARITY),
        (event("c", "a", before="0", to="5"), None),
        (event("q", "a", to="v"), RefusalKind.UNKNOWN),
    ],
)
def test_events_are_refused_for_a_reason(found: Event, kind: RefusalKind | None) -> None:
    """The first time as well as the second."""
    acceptance = Acceptance([parse_chronicles(TEXT)])

    for refusal in (acceptance.refusal(found), acceptance.refusal(found)):
        assert (refusal and refusal.kind) == kind


def test_without_declarations_what_is_used_is_known() -> None:
    """Names, kinds and numbers of arguments are those of the event types, whichever they are."""
    text = "chronicle c { event(p[?x]:(?, ?), t) noevent(p[?x, ?], (t, t + 5)) event(c2, t) }"
    acceptance = Acceptance([parse_chronicles(text)])

    assert acceptance.refusal(event("p", "a", to="v")) is None
    assert acceptance.refusal(event("p", "a", "b")) is None
    assert acceptance.refusal(event("p", "a", "b", to="v")) is not None
    refusal = acceptance.refusal(event("pp", "a", to="v"))
    assert refusal is not None
    assert refusal.message == "no chronicle knows 'pp'; did you mean 'p'?"


def test_several_files_may_declare_one_name() -> None:
    """An event is accepted if it is as any of them says."""
    files = [parse_chronicles(f"attribute p[?x] {{ ?x in {{{x}}} }}") for x in "ab"]
    acceptance = Acceptance(files)

    assert acceptance.refusal(event("p", "a", to="v")) is None
    assert acceptance.refusal(event("p", "b", to="v")) is None
    assert acceptance.refusal(event("p", "c", to="v")) is not None

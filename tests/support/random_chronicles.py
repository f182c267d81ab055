"""Random chronicles and random streams of events for them."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

from hypothesis import strategies as st

from chronicles.events import Event
from chronicles.syntax import EventType, Parameter, Value, Variable
from dyknow.time import MILLISECOND, TimePoint

__all__ = ["SUB", "chronicle_texts", "streams"]

MS = int(MILLISECOND)

VALUE = st.sampled_from(["u", "v"])
VARIABLES = ["?x", "?y", "?z"]
SIGNALS = {"a": (1, True), "b": (2, True), "m": (0, False), "n": (1, False), "sub": (1, False)}
SUB = "chronicle sub[?k] { event(n[?k], t) noevent(m, (t + 1, t + 3)) } "
PAIR = "chronicle pair[?k](u, v) { event(n[?k], u) event(m, v) u <= v <= u + 3 } "
PRELUDE = """
domain D = {u} | {w}
constraint near(p, q) { p <= q + 1; q - p <= 4 }
constraint unlike[?p, ?q] { ?p != ?q or ?p in D }
"""


TIMES = ["end - start <= 4", "end - start >= 3", "2 <= end - start", "t1 <= 6", "start in [1, 9]"]
CONDITIONS = [
    "if ?BOUND0 == u then ?BOUND1 == v else ?BOUND1 in D",
    "?BOUND0 == u => ?BOUND1 not in {u}",
    "?BOUND0 == u <=> not (?BOUND1 == v and ?BOUND0 != ?BOUND1)",
    "unlike[?BOUND0, ?BOUND1]",
]


@st.composite
def event_types(draw: st.DrawFn, variables: list[str]) -> str:
    """Return the text of an event type."""
    name = draw(st.sampled_from(sorted(SIGNALS)))
    arity, is_attribute = SIGNALS[name]
    parameter = st.sampled_from([*variables, *variables, "?", "*s", "u", "v"])
    arguments = draw(st.lists(parameter, min_size=arity, max_size=arity))
    text = name + (f"[{', '.join(arguments)}]" if arguments else "")
    if is_attribute:
        text += f":({draw(parameter)}, {draw(parameter)})"
    return text


@st.composite
def chronicle_texts(draw: st.DrawFn) -> str:  # noqa: C901, PLR0912, PLR0915  # one choice each
    """Return the text of a small chronicle all of whose variables are parameters."""
    n_slots = draw(st.integers(1, 4))
    types = [draw(event_types(VARIABLES)) for _ in range(n_slots)]
    names = draw(
        st.lists(st.sampled_from(["t1", "t2", "t3", "t4"]), min_size=n_slots, max_size=n_slots)
    )
    if draw(st.booleans()):
        names = ["t1", "t2", "t3", "t4"][:n_slots]
    bound = sorted({v for v in VARIABLES for t in types if v in t})
    lines = [f"event({t}, {name})" for t, name in zip(types, names, strict=True)]
    instants = sorted(set(names))
    pick = st.sampled_from(instants)
    offset = st.sampled_from(["", "", " + 1", " - 1", " + 2", " - 3"])
    lines += draw(st.lists(st.sampled_from(TIMES), max_size=1))
    if draw(st.booleans()):
        counted = draw(event_types(bound))
        lines.append(f"event({counted}, {draw(pick)} + {draw(st.sampled_from(['1', '[0, 2]']))})")
    if "?x" in bound and draw(st.integers(0, 4)) == 0:
        lines.append(f"chronicle pair[?x] ({draw(pick)}, v = {draw(st.sampled_from(instants))})")
    if len(bound) > 1:
        lines += draw(st.lists(st.sampled_from(CONDITIONS), max_size=1))
    stars = st.sampled_from(["*s != u", "*s in D", "*s not in ~D"])
    if any("*s" in line for line in lines) and draw(st.booleans()):
        lines.append(draw(stars))
    if draw(st.integers(0, 3)) == 0 and not any("late" in line for line in lines):
        lines.append(f"{draw(pick)} = late - 2; occurs(0, 1, m, (late - 2, late))")
    extremes = [*instants, "start", "end"]
    for _ in range(draw(st.integers(0, 3))):
        first, second = draw(st.sampled_from(extremes)), draw(st.sampled_from(extremes))
        if first != second:
            order = draw(st.sampled_from(["<", "<=", "<=", "<", "=", ">="]))
            lower = draw(st.integers(-2, 3))
            upper = lower + draw(st.integers(0, 4))
            lines.append(
                draw(
                    st.sampled_from(
                        [
                            f"{first} {order} {second}{draw(offset)}",
                            f"{second} - {first} in [{lower}, {upper}]",
                            f"{second} - {first} in [{lower}, oo[",
                            f"{second} - {first} in [{lower}, {upper}] | [{upper}, {upper + 2}]",
                        ]
                    )
                )
            )
    for _ in range(draw(st.integers(0, 2))):
        anchor = st.sampled_from(extremes)
        interval = f"({draw(anchor)}{draw(offset)}, {draw(anchor)}{draw(offset)})"
        counted = draw(event_types(bound))
        least = draw(st.integers(0, 2))
        most = draw(st.sampled_from(["oo", least, least + 1]))
        lines.append(
            draw(
                st.sampled_from(
                    [
                        f"noevent({counted}, {interval})",
                        f"occurs({least}, {most}, {counted}, {interval})",
                    ]
                )
            )
        )
    if len(bound) > 1 and draw(st.booleans()):
        lines.append(f"{bound[0]} {draw(st.sampled_from(['!=', '==']))} {bound[1]}")
    parameters = f"[{', '.join(bound)}]" if bound else ""
    for i, name in enumerate(bound):
        lines = [line.replace(f"?BOUND{i}", name) for line in lines]
    return f"{PRELUDE}{SUB}{PAIR}chronicle c{parameters} {{ {'; '.join(lines)} }}"


@st.composite
def streams(draw: st.DrawFn, asked: Sequence[EventType] = ()) -> list[Event]:
    """Return events in order of time, often several at one instant, and often of types asked for.

    What is asked for with a variable mostly has one and the same value. Sometimes all of it
    happens long ago or in a time to come.
    """
    chosen = {name: draw(VALUE) for name in VARIABLES}
    time = draw(st.sampled_from([0] * 14 + [-4, 1_700_000_000_000, -(10**12)]))
    wanted = [each for each in asked if each.name in SIGNALS]
    in_turn = draw(st.booleans())
    events = []
    for i in range(draw(st.integers(0, 10))):
        time += draw(st.sampled_from([0, 0, 1, 1, 1, 2, 3]))
        if wanted and draw(st.integers(0, 4)):
            next_one = wanted[i % len(wanted)] if in_turn else draw(st.sampled_from(wanted))
            made = _asked_for(draw, next_one, chosen)
        else:
            made = _any_event(draw)
        events.append(replace(made, time=TimePoint(time * MS)))
    return events


def _any_event(draw: st.DrawFn) -> Event:
    name = draw(st.sampled_from(["a", "b", "m", "n"]))
    arity, is_attribute = SIGNALS[name]
    arguments = tuple(draw(VALUE) for _ in range(arity))
    before = draw(st.sampled_from(["u", "v", None])) if is_attribute else None
    after = draw(VALUE) if is_attribute else None
    return Event(name, arguments, before, after, TimePoint(0))


def _asked_for(draw: st.DrawFn, wanted: EventType, chosen: Mapping[str, str]) -> Event:
    def value(parameter: Parameter) -> str:
        if isinstance(parameter, Value):
            return parameter.text
        if isinstance(parameter, Variable) and draw(st.integers(0, 8)):
            return chosen.get(parameter.name, "u")
        return draw(VALUE)

    arguments = tuple(map(value, wanted.arguments))
    if wanted.name == "sub":
        return Event("n", arguments, None, None, TimePoint(0))
    before = after = None
    if SIGNALS[wanted.name][1]:
        change = wanted.change
        before = value(change.before) if change else draw(st.sampled_from(["u", "v", None]))
        after = value(change.after) if change else draw(VALUE)
    return Event(wanted.name, arguments, before, after, TimePoint(0))

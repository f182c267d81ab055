"""How explanations say things: lengths of time, bounds, links that end, counted events."""

from traffic.explaining.explanation import Constraint, Counted, FactEvent, LinkStep, Term

__all__ = [
    "bounds_text",
    "constraint_text",
    "counted_text",
    "end_text",
    "event_text",
    "length_text",
    "term_text",
    "time_text",
]

_UNITS = (("h", 3_600_000.0), ("min", 60_000.0), ("s", 1_000.0))
_UNKNOWN = "unknown"
_ENDS = {
    "vanished": "the lower object vanished or was no longer observed",
    "given up": "the upper object had been without observations for too long",
}


def time_text(milliseconds: float) -> str:
    """Return a time in seconds, with as many digits as it needs."""
    return f"{milliseconds / 1000:.3f}".rstrip("0").rstrip(".") + " s"


def length_text(milliseconds: float) -> str:
    """Return a length of time in the largest unit of which it is a round number."""
    for unit, size in _UNITS:
        share = milliseconds / size
        if abs(share) >= 1 and (unit == "s" or share == round(share)):
            return f"{share:.3f}".rstrip("0").rstrip(".") + f" {unit}"
    return f"{milliseconds:g} ms" if milliseconds else "0"


def bounds_text(least: float | None, most: float | None) -> str:
    """Return what a length of time may be, such as `at most 1 min`."""
    if least is not None and least == most:
        return f"exactly {length_text(least)}"
    parts = []
    if least is not None:
        parts.append(f"at least {length_text(least)}")
    if most is not None:
        parts.append(f"at most {length_text(most)}")
    return " and ".join(parts)


def term_text(term: Term) -> str:
    """Return such as `t2 − t1 = 3.1 s, at most 1 min`."""
    bounds = bounds_text(term.least, term.most)
    said = f"{term.text} = {length_text(term.ms)}"
    return f"{said}, {bounds}" if bounds else said


def constraint_text(constraint: Constraint) -> str:
    """Return what a constraint came to."""
    if constraint.terms:
        return "; ".join(map(term_text, constraint.terms))
    values = ", ".join(f"{name} is {value}" for name, value in constraint.values.items())
    return f"{constraint.text}: {values}" if values else constraint.text


def counted_text(counted: Counted) -> str:
    """Return what was counted, and how much would have been allowed."""
    found = "none" if counted.count == 0 else str(counted.count)
    span = f"from {time_text(counted.begin)} up to {time_text(counted.end)}"
    if counted.most == 0:
        allowed = "none is allowed"
    elif counted.most is None:
        allowed = f"at least {counted.least} asked for"
    elif counted.least == counted.most:
        allowed = f"exactly {counted.least} asked for"
    else:
        allowed = f"{counted.least} to {counted.most} asked for"
    return f"{counted.text}: {found} {span}, {allowed}"


def event_text(event: FactEvent) -> str:
    """Return such as `cars.link[car7]: south-centre → no_link`."""
    listed = f"[{', '.join(event.arguments)}]" if event.arguments else ""
    name = f"{event.attribute}{listed}"
    if event.before is None and event.after is None:
        return name
    return f"{name}: {event.before or _UNKNOWN} → {event.after or _UNKNOWN}"


def end_text(link: LinkStep) -> str:
    """Return why a link was removed."""
    if link.ended_by == "violated":
        return f"its maintain condition became false: {link.end_condition}"
    return _ENDS.get(link.ended_by or "", "")

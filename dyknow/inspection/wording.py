"""How figures are written for people: rates, delays, counts, and what they say of a stream."""

from dyknow.inspection.snapshot import Kind, ProcessFigures, StreamFigures
from dyknow.time import MILLISECOND, SECOND

__all__ = [
    "amount_text",
    "count_text",
    "delay_text",
    "implementation_text",
    "process_text",
    "pulse_text",
    "rate_text",
    "stream_text",
]

_NAMED = (Kind.SOURCE, Kind.UNIT)
_KILO = 1_000
_EXACT_BELOW = 100_000
_THREE_DIGITS = 100
_TWO_DIGITS = 10
_MICROSECOND = 1_000


def count_text(count: int) -> str:
    """Write a count with three digits or more: `950`, `12 345`, `2.88 M`."""
    if abs(count) < _EXACT_BELOW:
        return f"{count:,}".replace(",", "\u202f")
    amount, unit = float(count), ""
    for larger in ("k", "M", "G", "T"):
        if abs(amount) < _KILO:
            break
        amount, unit = amount / _KILO, larger
    return f"{_digits(amount)}\u202f{unit}"


def amount_text(count: int, what: str) -> str:
    """Write how many there are of something: `1 sample`, `501 samples`."""
    return f"{count_text(count)} {what}" if count == 1 else f"{count_text(count)} {what}s"


def rate_text(rate: float | None) -> str:
    """Write a rate: `10 Hz`, `0.5 Hz`; a dash for none."""
    if rate is None:
        return "–"
    return f"{_digits(rate / _KILO)}\u202fkHz" if rate >= _KILO else f"{_digits(rate)}\u202fHz"


def delay_text(delay: float | None) -> str:
    """Write a delay of nanoseconds: `0`, `12 µs`, `500 ms`, `1.5 s`; a dash for none."""
    if delay is None:
        return "–"
    if delay == 0:
        return "0"
    size = abs(delay)
    for unit, name in ((SECOND, "s"), (MILLISECOND, "ms"), (_MICROSECOND, "µs")):
        if size >= unit:
            return f"{_digits(delay / unit)}\u202f{name}"
    return f"{_digits(delay)}\u202fns"


def pulse_text(stream: StreamFigures) -> str:
    """Write rate and mean delay of a stream, `10 Hz · 500 ms`, or how few samples it has had."""
    if stream.rate is None:
        return amount_text(stream.samples, "sample") if stream.samples else "nothing yet"
    return f"{rate_text(stream.rate)} · {delay_text(stream.mean_delay)}"


def implementation_text(process: ProcessFigures) -> str:
    """Write what a process is made of: `VisionPercepts`, `link WorldObject`, or else its kind."""
    if process.kind is Kind.LINK:
        units = (part.strip() for part in process.text.split(","))
        return " ".join(["link", *(unit for unit in units if unit.isidentifier())])
    name = process.text.partition("(")[0].strip()
    return name if name.isidentifier() and process.kind in _NAMED else process.kind.value


def process_text(process: ProcessFigures) -> str:
    """Write all that is known of a process, a line for each thing."""
    lines = [f"{process.label}: {process.kind}"]
    if process.text:
        lines.append(process.text)
    if process.policy:
        lines.append(f"promises {process.policy}")
    lines.append(f"{amount_text(process.samples, 'sample')}{_work_text(process)}")
    if process.heartbeats:
        lines.append(amount_text(process.heartbeats, "heartbeat"))
    if process.cache_limit is not None:
        lines.append(f"cache: {process.cached} of at most {process.cache_limit} samples")
    if process.violations:
        lines.append(f"{amount_text(process.violations, 'violation')} in its input")
    if process.failures:
        lines.append(amount_text(process.failures, "failure"))
    return "\n".join(lines)


def stream_text(stream: StreamFigures) -> str:
    """Write all that is known of a stream, a line for each thing."""
    policy = f" with {stream.policy}" if stream.policy else ""
    lines = [
        f"{stream.provider}{policy} → {stream.name}",
        f"{amount_text(stream.samples, 'sample')}, {rate_text(stream.rate)}",
        f"delay: mean {delay_text(stream.mean_delay)}, 99 % {delay_text(stream.delay_99)}",
    ]
    if stream.violations:
        lines.append(amount_text(stream.violations, "violation"))
    if stream.late:
        lines.append(amount_text(stream.late, "late sample"))
    return "\n".join(lines)


def _work_text(process: ProcessFigures) -> str:
    if process.calls is None or process.seconds is None:
        return ""
    calls = amount_text(process.calls, "call")
    return f" from {calls}, {process.seconds:.3g} s of processor time"


def _digits(amount: float) -> str:
    size = abs(amount)
    places = 0 if size >= _THREE_DIGITS else 1 if size >= _TWO_DIGITS else 2
    text = f"{amount:.{places}f}"
    return text.rstrip("0").rstrip(".") if "." in text else text

"""A network as text in the language of Graphviz, for `dot` and for programs that read it."""

from collections.abc import Iterable

from dyknow.inspection.snapshot import Kind, ProcessFigures, Snapshot, StreamFigures
from dyknow.inspection.wording import (
    amount_text,
    count_text,
    implementation_text,
    process_text,
    pulse_text,
    stream_text,
)

__all__ = ["dot_from"]

_COLOURS = {
    Kind.SOURCE: "#2f7d5b",
    Kind.UNIT: "#3a6fb0",
    Kind.LINK: "#8a55b5",
    Kind.SYNCHRONISATION: "#c07a1c",
    Kind.MERGING: "#c07a1c",
    Kind.SELECTION: "#c07a1c",
    Kind.VIEW: "#c07a1c",
    Kind.MEDIATION: "#c07a1c",
}
_OTHER = "#6b7686"
_BAD = "#c62828"


def dot_from(snapshot: Snapshot, title: str = "Network") -> str:
    """Write *snapshot* as a directed graph, with the figures of streams on the edges."""
    lines = [
        f"digraph {_quoted(title)} {{",
        "  rankdir=LR;",
        '  graph [fontname="Helvetica", labelloc=t];',
        '  node [shape=box, style="rounded", fontname="Helvetica", fontsize=11];',
        '  edge [fontname="Helvetica", fontsize=9];',
        f"  label={_quoted(title)};",
        *(f"  {_process(process)};" for process in snapshot.processes),
        *dict.fromkeys(f"  {_output(s)};" for s in snapshot.streams if s.is_output),
        *(f"  {_edge(stream)};" for stream in snapshot.streams),
        "}",
    ]
    return "\n".join(lines) + "\n"


def _process(process: ProcessFigures) -> str:
    facts: tuple[str, ...] = (
        process.label,
        implementation_text(process),
        amount_text(process.samples, "sample"),
    )
    if process.seconds is not None:
        facts = (*facts, f"{process.seconds:.3g} s")
    colour = _BAD if process.failures else _COLOURS.get(process.kind, _OTHER)
    return _statement(
        _quoted(process.label),
        label=_quoted("\n".join(facts)),
        tooltip=_quoted(process_text(process)),
        color=_quoted(colour),
    )


def _output(stream: StreamFigures) -> str:
    return _statement(
        _quoted(_node_of(stream)), label=_quoted(stream.receiver), shape="ellipse", style="solid"
    )


def _edge(stream: StreamFigures) -> str:
    facts = [pulse_text(stream)]
    attributes = {"tooltip": _quoted(stream_text(stream))}
    if stream.violations:
        facts.append(f"{count_text(stream.violations)} violated")
        attributes |= {"color": _quoted(_BAD), "fontcolor": _quoted(_BAD)}
    ends = f"{_quoted(stream.provider)} -> {_quoted(_node_of(stream))}"
    return _statement(ends, label=_quoted("\n".join(facts)), **attributes)


def _node_of(stream: StreamFigures) -> str:
    """Return the name of the node that a stream leads to; outputs have nodes of their own."""
    return f"output {stream.name} of {stream.provider}" if stream.is_output else stream.receiver


def _statement(what: str, **attributes: str) -> str:
    return f"{what} [{', '.join(_pairs(attributes.items()))}]"


def _pairs(attributes: Iterable[tuple[str, str]]) -> Iterable[str]:
    return (f"{name}={value}" for name, value in attributes)


def _quoted(text: str) -> str:
    r"""Return *text* as a string of the language, in which a new line is `\n`."""
    escaped = text.replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n")
    return f'"{escaped}"'

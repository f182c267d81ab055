"""A picture of a network as SVG, drawn without other programs.

Processes stand in columns by their depth; the figures of a stream stand where it enters its
receiver. The picture follows a light or dark page, its texts can be selected, and pointing at
a box or an arrow tells all that is known of it.
"""

from collections.abc import Container, Iterable, Sequence
from html import escape
from typing import Final

from dyknow.inspection.layout import Arrow, Box, Layout, lay_out
from dyknow.inspection.snapshot import Kind, ProcessFigures, Snapshot, StreamFigures
from dyknow.inspection.wording import (
    amount_text,
    count_text,
    implementation_text,
    process_text,
    pulse_text,
    stream_text,
)
from dyknow.time import SECOND

__all__ = ["svg_from"]

_SVG: Final = "http://www.w3.org/2000/svg"
_MARGIN: Final = 24.0
_HEADER: Final = 52.0
_GAP: Final = 104.0
_SPACING: Final = 22.0
_BOX_HEIGHT: Final = 62.0
_PORT_PITCH: Final = 30.0
_OUTPUT_HEIGHT: Final = 32.0
_PADDING: Final = 12.0
_LONGEST_LABEL: Final = 170.0
_LABEL_SIZE: Final = 13.5
_SMALL_SIZE: Final = 10.5
_POLICY_SIZE: Final = 9.5

_NARROW: Final = frozenset("fijlrtI.,:;|!'()[]/ ·")
_WIDE: Final = frozenset("mwMW@%—→")

_STYLE: Final = """
svg { font-family: system-ui, -apple-system, "Segoe UI", "Liberation Sans", Arial, sans-serif; }
.page { fill: #ffffff; }
.box { fill: #f7f8fa; stroke: #d5d9e0; }
.output { fill: #ffffff; stroke: #8a93a3; }
.bar { fill: #e3e7ee; }
.title { fill: #1b2330; font-size: 17px; font-weight: 600; }
.label { fill: #1b2330; font-size: 13px; font-weight: 600; }
.small { fill: #5a6475; font-size: 10.5px; }
.figure { fill: #39424f; font-size: 10.5px; font-variant-numeric: tabular-nums; }
.policy { fill: #7d8796; font-size: 9.5px; font-style: italic; }
.halo { stroke: #ffffff; stroke-width: 4; stroke-linejoin: round; paint-order: stroke; }
.arrow { fill: none; stroke: #9aa4b5; }
.tip { fill: #9aa4b5; }
.idle { stroke-dasharray: 4 4; }
.bad { fill: #c62828; font-weight: 600; }
.arrow.bad, .box.bad { fill: none; stroke: #d64545; }
.box.bad { fill: #fdf0f0; }
.source { fill: #2f7d5b; }
.unit { fill: #3a6fb0; }
.link { fill: #8a55b5; }
.sync { fill: #c07a1c; }
.other { fill: #6b7686; }
g:hover > .arrow { stroke: #3a6fb0; stroke-width: 3; }
@media (prefers-color-scheme: dark) {
  .page { fill: #14181f; }
  .box { fill: #1f252f; stroke: #3a4352; }
  .output { fill: #14181f; stroke: #7f8aa0; }
  .bar { fill: #333c4a; }
  .title, .label { fill: #eef1f6; }
  .small { fill: #a3adbd; }
  .figure { fill: #c6cedb; }
  .policy { fill: #8b96a8; }
  .halo { stroke: #14181f; }
  .arrow { stroke: #657085; }
  .tip { fill: #657085; }
  .bad { fill: #ff7b72; }
  .arrow.bad, .box.bad { fill: none; stroke: #e5534b; }
  .box.bad { fill: #2b1a1e; }
  .source { fill: #4cb389; }
  .unit { fill: #6aa2e6; }
  .link { fill: #bb8be0; }
  .sync { fill: #e0a54a; }
  .other { fill: #8b96a8; }
}
"""
_CLASS_BY_KIND: Final = {
    Kind.SOURCE: "source",
    Kind.UNIT: "unit",
    Kind.LINK: "link",
    Kind.SYNCHRONISATION: "sync",
    Kind.MERGING: "sync",
    Kind.SELECTION: "sync",
    Kind.VIEW: "sync",
    Kind.MEDIATION: "sync",
}
_LEGEND: Final = (
    ("source", "source"),
    ("unit", "computational unit"),
    ("link", "link process"),
    ("sync", "state, selection, mediation"),
    ("other", "process"),
)


def svg_from(snapshot: Snapshot, title: str = "Network") -> str:
    """Draw *snapshot* as an SVG document under a *title*."""
    picture = _Picture(snapshot)
    width = max(picture.layout.width, 640.0) + 2 * _MARGIN
    height = picture.layout.height + _HEADER + 2 * _MARGIN
    size = f'width="{width:.0f}" height="{height:.0f}"'
    lines = [
        '<?xml version="1.0" encoding="UTF-8"?>',
        f'<svg xmlns="{_SVG}" viewBox="0 0 {width:.0f} {height:.0f}" {size} role="img">',
        f"<title>{escape(title)}</title>",
        f"<style>{_STYLE}</style>",
        f'<rect class="page" {size} rx="10"/>',
        *_header(snapshot, title),
        f'<g transform="translate({_MARGIN:.0f} {_MARGIN + _HEADER:.0f})">',
        *picture.arrows(),
        *picture.boxes(),
        "</g>",
        "</svg>",
    ]
    return "\n".join(lines) + "\n"


class _Picture:
    """The boxes and arrows of a snapshot, placed."""

    def __init__(self, snapshot: Snapshot) -> None:
        self._snapshot = snapshot
        self._total = snapshot.seconds or 1.0
        layer = {process.label: process.depth for process in snapshot.processes}
        self._streams = [s for s in _distinct(snapshot.streams) if _is_shown(s, layer)]
        _push_right(layer, [s for s in self._streams if not s.is_output])
        self._outputs = {_node_of(s): s for s in self._streams if s.is_output}
        heads = [_node_of(stream) for stream in self._streams]
        boxes = [
            self._process_box(process, layer[process.label], heads.count(process.label))
            for process in snapshot.processes
        ]
        for name, stream in self._outputs.items():
            boxes.append(_output_box(name, stream, layer[stream.provider] + 1))
        arrows = [Arrow(s.provider, _node_of(s), at) for at, s in enumerate(self._streams)]
        self._box = {box.name: box for box in boxes}
        self.layout: Layout = lay_out(boxes, arrows, gap=_GAP, spacing=_SPACING)

    def boxes(self) -> Iterable[str]:
        """Yield what draws the boxes."""
        for process in self._snapshot.processes:
            yield from self._process(process)
        for name, stream in self._outputs.items():
            yield from self._output(name, stream)

    def arrows(self) -> Iterable[str]:
        """Yield what draws the arrows, and then the figures on them."""
        for stream, route in zip(self._streams, self.layout.routes, strict=True):
            yield from _arrow(stream, route)
        for stream, route in zip(self._streams, self.layout.routes, strict=True):
            yield from _figures(stream, *route[-1])

    def _process_box(self, process: ProcessFigures, layer: int, n_inputs: int) -> Box:
        facts = [_text_width(text, _SMALL_SIZE) for text in self._facts(process)]
        label = _text_width(_short(process.label), _LABEL_SIZE)
        width = max(label, *facts) + 2 * _PADDING + 4
        height = max(_BOX_HEIGHT, _PORT_PITCH * (n_inputs + 1))
        return Box(process.label, layer, width, height)

    def _facts(self, process: ProcessFigures) -> tuple[str, str]:
        samples = amount_text(process.samples, "sample")
        share = "" if process.seconds is None else f" · {self._share(process):.0%} CPU"
        return implementation_text(process), f"{samples}{share}"

    def _share(self, process: ProcessFigures) -> float:
        return (process.seconds or 0.0) / self._total

    def _process(self, process: ProcessFigures) -> Iterable[str]:
        box = self._box[process.label]
        x, y = self.layout.place[process.label]
        kind = _CLASS_BY_KIND.get(process.kind, "other")
        failed = " bad" if process.failures else ""
        made_of, work = self._facts(process)
        middle = y + box.height / 2
        left = x + _PADDING + 4
        bar = box.width - 2 * _PADDING - 4
        yield "<g>"
        yield f"<title>{escape(process_text(process))}</title>"
        yield _rect(f"box{failed}", x, y, box.width, box.height, 6)
        yield _rect(kind, x, y, 4, box.height, 2)
        yield _text("label", left, middle - 11, _short(process.label))
        yield _text("small", left, middle + 4, made_of)
        yield _text("figure", left, middle + 18, work)
        if process.seconds is not None:
            yield _rect("bar", left, middle + 23, bar, 3, 1.5)
            yield _rect(kind, left, middle + 23, bar * self._share(process), 3, 1.5)
        yield "</g>"

    def _output(self, name: str, stream: StreamFigures) -> Iterable[str]:
        box = self._box[name]
        x, y = self.layout.place[name]
        yield "<g>"
        yield f"<title>{escape(stream_text(stream))}</title>"
        yield _rect("output", x, y, box.width, box.height, box.height / 2)
        text = _short(stream.receiver)
        yield _text("label", x + box.width / 2, y + box.height / 2 + 4, text, "middle")
        yield "</g>"


def _distinct(streams: Iterable[StreamFigures]) -> Iterable[StreamFigures]:
    """Return one of all streams with the same ends and policy: who looks twice sees the same."""
    found = {(s.provider, s.receiver, s.number, s.is_output, s.policy): s for s in streams}
    return found.values()


def _is_shown(stream: StreamFigures, labels: Container[str]) -> bool:
    return stream.provider in labels and (stream.is_output or stream.receiver in labels)


def _push_right(layer: dict[str, int], streams: Sequence[StreamFigures]) -> None:
    """Move processes to the right of those that feed them, where their depth does not do so.

    A process that follows others while the network runs may have got a deeper one to follow.
    """
    for _ in layer:
        behind = [s for s in streams if layer[s.receiver] <= layer[s.provider]]
        if not behind:
            return
        for stream in behind:
            layer[stream.receiver] = layer[stream.provider] + 1


def _node_of(stream: StreamFigures) -> str:
    """Return the name of the box that a stream leads to."""
    if stream.is_output:
        return f"output {stream.receiver} {stream.provider} {stream.number}"
    return stream.receiver


def _output_box(name: str, stream: StreamFigures, layer: int) -> Box:
    width = _text_width(_short(stream.receiver), _LABEL_SIZE) + 2 * _PADDING + 8
    return Box(name, layer, width, _OUTPUT_HEIGHT)


def _header(snapshot: Snapshot, title: str) -> Iterable[str]:
    span = f"{snapshot.now / SECOND:g}\u202fs"
    if snapshot.begin:
        span = f"{snapshot.begin / SECOND:g} to {span}"
    violations = sum(stream.violations for stream in snapshot.streams)
    counts = f"{len(snapshot.processes)} processes · {len(snapshot.streams)} streams"
    work = f" · {snapshot.seconds:.3g}\u202fs of processor time" if snapshot.seconds else ""
    facts = f"{span} · {counts}{work}"
    yield _text("title", _MARGIN, _MARGIN + 14, title)
    x, y = _MARGIN, _MARGIN + 32
    complaint = f' <tspan class="bad">· {amount_text(violations, "violation")}</tspan>'
    told = complaint if violations else ""
    yield f'<text class="small" x="{x:.1f}" y="{y:.1f}">{escape(facts)}{told}</text>'
    present = {_CLASS_BY_KIND.get(process.kind, "other") for process in snapshot.processes}
    x = _MARGIN + _text_width(title, 17.0) + 28
    for kind, meaning in _LEGEND:
        if kind in present:
            yield _rect(kind, x, _MARGIN + 5, 10, 10, 2)
            yield _text("small", x + 15, _MARGIN + 14, meaning)
            x += 15 + _text_width(meaning, _SMALL_SIZE) + 16


def _arrow(stream: StreamFigures, route: tuple[tuple[float, float], ...]) -> Iterable[str]:
    x, y = route[-1]
    bad = " bad" if stream.violations else ""
    idle = " idle" if not stream.samples else ""
    yield "<g>"
    yield f"<title>{escape(stream_text(stream))}</title>"
    width = 1.2 + min(2.0, (stream.rate or 0.0) / 25)
    yield f'<path class="arrow{bad}{idle}" stroke-width="{width:.1f}" d="{_curve(route)}"/>'
    tip = f"M{x:.1f} {y:.1f} l-8 -3.6 v7.2 z"
    yield f'<path class="{"bad" if bad else "tip"}" d="{tip}"/>'
    yield "</g>"


def _curve(route: tuple[tuple[float, float], ...]) -> str:
    """Return the path through the points of a route: bends in the gaps, straight in columns."""
    (x, y), *rest = route
    parts = [f"M{x:.1f} {y:.1f}"]
    for number, (next_x, next_y) in enumerate(rest):
        if number % 2:
            parts.append(f"L{next_x:.1f} {next_y:.1f}")
        else:
            half = (next_x - x) * 0.45
            bend = f"{x + half:.1f} {y:.1f} {next_x - 2 * half:.1f} {next_y:.1f}"
            parts.append(f"C{bend} {next_x:.1f} {next_y:.1f}")
        x, y = next_x, next_y
    return " ".join(parts)


def _figures(stream: StreamFigures, x: float, y: float) -> Iterable[str]:
    yield _text("figure halo", x - 12, y - 5, pulse_text(stream), "end")
    if stream.violations:
        complaint = f"{count_text(stream.violations)} violated"
        yield _text("figure bad halo", x - 12, y + 13, complaint, "end")
    elif stream.policy:
        yield _text(
            "policy halo", x - 12, y + 12, _short(stream.policy, _GAP - 16, _POLICY_SIZE), "end"
        )


def _rect(kind: str, x: float, y: float, width: float, height: float, radius: float) -> str:
    place = f'x="{x:.1f}" y="{y:.1f}" width="{width:.1f}" height="{height:.1f}"'
    return f'<rect class="{kind}" {place} rx="{radius:g}"/>'


def _text(kind: str, x: float, y: float, text: str, anchor: str = "start") -> str:
    place = f'x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}"'
    return f'<text class="{kind}" {place}>{escape(text)}</text>'


def _short(text: str, width: float = _LONGEST_LABEL, size: float = _LABEL_SIZE) -> str:
    """Return *text*, or as much of its beginning as fits into *width*."""
    if _text_width(text, size) <= width:
        return text
    while text and _text_width(f"{text}…", size) > width:
        text = text[:-1]
    return f"{text.rstrip()}…"


def _text_width(text: str, size: float) -> float:
    """Return about how wide *text* is in the usual fonts without serifs, rather too wide."""
    return size * sum(0.32 if c in _NARROW else 0.9 if c in _WIDE else 0.57 for c in text)

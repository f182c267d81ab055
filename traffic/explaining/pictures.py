"""The picture of an explanation: a film strip of its moments above the time line."""

from collections.abc import Mapping
from io import BytesIO
from textwrap import fill

from matplotlib import style
from matplotlib.figure import Figure

from traffic.errors import ExplanationError, SimulatorError
from traffic.explaining.drawing import FAINT, INK, PAPER, STYLE, colours_of
from traffic.explaining.explanation import Explanation, RecognitionExplanation
from traffic.explaining.film_strip import Look, draw_image, draw_map, windows_of
from traffic.explaining.images import Image, images_again
from traffic.explaining.story import Story, story_of
from traffic.explaining.time_line import draw_time_line, earlier_text
from traffic.explaining.walking import Walker
from traffic.watching import OnProgress

__all__ = ["draw", "picture_of"]

_WIDTH = 15.0
_SIDE = 0.35
_NAMES = 3.1
_HEAD = 0.95
_FOOT = 0.62
_ROW = 0.42
_GAP = 0.78
_DOTS_PER_INCH = 130
_VERDICTS = {True: "the truth agrees", False: "the truth does not agree", None: ""}


def picture_of(walker: Walker, explanation: Explanation, on_progress: OnProgress) -> bytes:
    """Return the picture of an explanation as a PNG file.

    Raises:
        ExplanationError: There is nothing to be seen.
    """
    file = BytesIO()
    with style.context(STYLE):
        figure = draw(walker, explanation, on_progress)
        figure.savefig(file, dpi=_DOTS_PER_INCH, metadata={"Software": None})
    return file.getvalue()


def draw(walker: Walker, explanation: Explanation, on_progress: OnProgress) -> Figure:
    """Draw the picture of an explanation."""
    told = explanation.recognition
    story = story_of(walker, told)
    if not story.frames:
        raise ExplanationError(f"no object of recognition {told.number} was seen; nothing to draw")
    images, remark = _images(walker, story, on_progress)
    n, rows = len(story.frames), len(story.bands)
    frame_width = (_WIDTH - 2 * _SIDE - 0.12 * (n - 1)) / n
    frame_height = min(frame_width / (4 / 3), 4.2)
    height = _HEAD + 0.3 + frame_height + _GAP + rows * _ROW + 0.3 + _FOOT
    figure = Figure(figsize=(_WIDTH, height), facecolor=PAPER)
    symbols = dict.fromkeys(each.symbol for each in told.objects)
    symbols |= dict.fromkeys(seen.symbol for frame in story.frames for seen in frame.seen)
    look = Look(
        objects=walker.objects,
        colours=colours_of(list(symbols)),
        road_map=walker.road_map,
        camera=walker.camera if images else None,
    )
    top = height - _HEAD - 0.3 - frame_height
    for at, (frame, window) in enumerate(
        zip(story.frames, windows_of(story.frames, look.camera), strict=True)
    ):
        left = _SIDE + at * (frame_width + 0.12)
        place = (left / _WIDTH, top / height, frame_width / _WIDTH, frame_height / height)
        axes = figure.add_axes(place)
        if images:
            draw_image(axes, frame, images[frame.time], window, look)
        else:
            draw_map(axes, frame, window, look)
    low = _FOOT + 0.3
    span = (_WIDTH - _SIDE - _NAMES) / _WIDTH
    if rows:
        axes = figure.add_axes((_NAMES / _WIDTH, low / height, span, rows * _ROW / height))
        draw_time_line(axes, story, look.colours)
    _write(figure, explanation, story, remark)
    return figure


def _images(
    walker: Walker, story: Story, on_progress: OnProgress
) -> tuple[Mapping[float, Image], str]:
    """Return the images of the frames by their times, and what is said of them."""
    streams = [label for label in walker.run.roles.images if walker.run.images.size]
    if not streams or walker.camera is None:
        return {}, "Map view: this run was made without cameras. + marks the percepts."
    stream = streams[0]
    numbers = {frame.time: frame.images[stream] for frame in story.frames if frame.images}
    scene = walker.road_map, walker.camera
    try:
        found = images_again(walker.run, stream, set(numbers.values()), scene, on_progress)
    except (SimulatorError, ExplanationError) as error:
        return {}, f"Map view, because {error}."
    seed = walker.run.origin.request["seed"]
    remark = (
        f"Images of '{stream}' {', '.join(map(str, numbers.values()))}: not stored, rendered "
        f"again from the scenario '{walker.run.result.scenario}' and seed {seed}."
    )
    return {time: found[number] for time, number in numbers.items()}, remark


def _write(figure: Figure, explanation: Explanation, story: Story, remark: str) -> None:
    """Write title and caption."""
    told = explanation.recognition
    width, height = figure.get_size_inches()
    x = _SIDE / width
    figure.text(
        x, 1 - 0.42 / height, _title(told), fontsize=17, fontweight="bold", color=INK, va="center"
    )
    figure.text(
        x, 1 - 0.76 / height, _subtitle(explanation), fontsize=10, color=FAINT, va="center"
    )
    notes = [remark]
    if story.earlier:
        notes.append(f"Before this: {earlier_text(story.earlier)}.")
    if story.constants:
        notes.append(f"Unchanged: {'; '.join(story.constants)}.")
    notes.append(
        "▲ frame; ◇ event of the chronicle; thin bar below: the value before it was filtered; "
        "green: counted; red: no event may be."
    )
    caption = fill(" ".join(notes), 215)
    figure.text(x, 0.12 / height, caption, fontsize=8, color=FAINT, va="bottom")


def _title(told: RecognitionExplanation) -> str:
    listed = ", ".join(each.symbol for each in told.objects)
    return f"{told.chronicle.replace('_', ' ')}   {listed}"


def _subtitle(explanation: Explanation) -> str:
    told = explanation.recognition
    number = "" if told.number is None else f"recognition {told.number} of "
    span = (
        f"{told.begin / 1000:.1f} s to {told.end / 1000:.1f} s, "
        f"recognised at {told.recognised_at / 1000:.1f} s"
    )
    values = ", ".join(f"{name} = {value}" for name, value in told.values.items())
    parts = [
        values,
        f"{number}{explanation.run}",
        f"{explanation.scenario}, view {explanation.settings.get('view')}",
        span,
        _VERDICTS[told.agrees],
    ]
    return "   ·   ".join(part for part in parts if part)

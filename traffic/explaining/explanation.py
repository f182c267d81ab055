"""What an explanation says, as values; the JSON of `traffic explain` is these.

Times are milliseconds since the beginning of the run, places metres in the world, speeds metres
per second, headings degrees counter-clockwise from east, and pixels those of the image, the first
one at (0, 0).
"""

from typing import Any

from pydantic import BaseModel, ConfigDict

__all__ = [
    "Change",
    "Constraint",
    "Counted",
    "EventExplanation",
    "Explanation",
    "FactEvent",
    "Frame",
    "Gap",
    "LinkStep",
    "ListedRecognition",
    "ObjectExplanation",
    "Provenance",
    "RecognitionExplanation",
    "Seen",
    "State",
    "Term",
    "ValueChange",
]


class _Value(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True)


class Provenance(_Value):
    """The sample in which something was told.

    Attributes:
        stream: Label of the stream generator.
        process: What made it, as the specification writes it.
        valid_time: When it held.
        available_time: When it was told.
    """

    stream: str
    process: str
    valid_time: float
    available_time: float


class ValueChange(_Value):
    """One change of a column of one stream of tables.

    Attributes:
        stream: Label of the stream generator.
        process: What made it.
        column: Name of the column.
        valid_time: When the new value held.
        available_time: When it was told.
        before: The value before; None if there was none.
        after: The value; None if there is none any more.
        quantities: The numbers that the stream told of the object at that time.
    """

    stream: str
    process: str
    column: str
    valid_time: float
    available_time: float
    before: str | None
    after: str | None
    quantities: dict[str, float] = {}


class Change(_Value):
    """How an attribute changed.

    Attributes:
        filtered: The change that the event tells of.
        raw: The change in the stream that `filtered` is made of; None if it had none.
        held_ms: For how long the value had held when it was let through.
    """

    filtered: ValueChange
    raw: ValueChange | None
    held_ms: float


class FactEvent(_Value):
    """An event, as short as can be.

    Attributes:
        time: When it happened.
        attribute: Name of the attribute or message.
        arguments: What it is about.
        before: Value before the change.
        after: Value after it.
    """

    time: float
    attribute: str
    arguments: list[str]
    before: str | None
    after: str | None


class EventExplanation(_Value):
    """An event that made a recognition.

    Attributes:
        event: What happened.
        predicates: Which `event` predicates of the chronicle it met, with its values put in.
        instants: The instants of the chronicle at which it happened.
        sample: Where it was told; None if it was not kept.
        change: How the attribute came to change, if it is a column of a stream of tables.
        objects: Those of its arguments that are objects.
        near: Other events of the same attribute and arguments, shortly before and after.
        recognition: If it is itself a recognition, what explains that.
    """

    event: FactEvent
    predicates: list[str]
    instants: list[str]
    sample: Provenance | None
    change: Change | None
    objects: list[str]
    near: list[FactEvent]
    recognition: "RecognitionExplanation | None" = None


class Term(_Value):
    """A length of time that a constraint bounds.

    Attributes:
        text: Such as `t2 − t1`.
        ms: What it was.
        least: The least that is allowed; None without limit.
        most: The most that is allowed; None without limit.
    """

    text: str
    ms: float
    least: float | None
    most: float | None


class Constraint(_Value):
    """A constraint of the chronicle, and what it came to.

    Attributes:
        text: As the chronicle says it.
        terms: The lengths of time that it bounds; none for one about values.
        values: The variables that it is about.
        holds: Whether it holds.
    """

    text: str
    terms: list[Term]
    values: dict[str, str]
    holds: bool


class Counted(_Value):
    """A predicate that counts events.

    Attributes:
        text: As the chronicle says it, with the values put in.
        attribute: Whose events it counts.
        arguments: What they are about; None if that may differ from one to the next.
        begin: From when on it counts.
        end: When it no longer counts.
        least: The least number that is allowed.
        most: The largest; None without limit.
        count: How many there were.
        holds: Whether that is as many as it asks for.
        events: They; the first twenty.
    """

    text: str
    attribute: str
    arguments: list[str] | None
    begin: float
    end: float
    least: int
    most: int | None
    count: int
    holds: bool
    events: list[FactEvent]


class State(_Value):
    """The state of an object at one time.

    Attributes:
        time: When.
        instants: The instants of the chronicle at that time.
        position: x and y.
        heading: Of travel.
        speed: Along it.
        observed: Whether it was seen then, or predicted.
        observed_at: When it was last seen.
        place: Names of `lane`, `link` and `crossing`, as far as it was in one, and `s` and `d`.
        structure: The object, what it was linked to, and so on down to the percept.
        pixel: Where it was in the image, (u, v); None if there is none, or out of view.
    """

    time: float
    instants: list[str]
    position: tuple[float, float]
    heading: float | None
    speed: float | None
    observed: bool
    observed_at: float | None
    place: dict[str, str | float]
    structure: list[str]
    pixel: tuple[float, float] | None


class LinkStep(_Value):
    """A link between two objects.

    Attributes:
        stream: Of the upper object.
        upper: The more specific object.
        lower: What its state was computed from.
        begin: When it was made.
        made_by: `establish` or `reestablish`.
        condition: That condition, as the specification writes it.
        end: When it was removed; None if it stood at the end of the run.
        ended_by: Why: `vanished`, `violated` or `given up`; None while it stands.
        end_condition: Of a link that was violated, its maintain condition.
    """

    stream: str
    upper: str
    lower: str
    begin: float
    made_by: str
    condition: str
    end: float | None
    ended_by: str | None
    end_condition: str | None


class Gap(_Value):
    """A stretch of time in which an object was predicted, not observed."""

    begin: float
    end: float


class ObjectExplanation(_Value):
    """An object that takes part.

    Attributes:
        symbol: Its name.
        variables: The variables of the chronicle that it is the value of.
        stream: The stream of its states.
        first_seen: The time of its first state.
        links: All links below it up to the recognition, by level from the top, in order of time.
        states: At the instants of the events that it takes part in, and at those of the report.
        gaps: In which it was predicted between the first and the last event.
    """

    symbol: str
    variables: list[str]
    stream: str
    first_seen: float
    links: list[LinkStep]
    states: list[State]
    gaps: list[Gap]


class Seen(_Value):
    """An object in a frame.

    Attributes:
        symbol: The object.
        percept: The percept that it rested on; None if it was predicted.
        position: Of the percept, or else where the object was expected.
        size: Length and width of it.
        pixel: Where that is in the image; None without a camera.
        box: The corners of its outline there; None without a camera.
        in_view: Whether the pixel is in the image.
    """

    symbol: str
    percept: str | None
    position: tuple[float, float]
    size: tuple[float, float]
    pixel: tuple[float, float] | None
    box: list[tuple[float, float]] | None
    in_view: bool


class Frame(_Value):
    """The percepts that were the newest ones at an event, and the images that they were seen in.

    Attributes:
        time: Of the images, or without a camera of the percepts.
        instants: The instants of the chronicle that it shows.
        percepts: The stream of percepts.
        images: The number of the image in each stream of images, counted from 0; without a
            camera there are none.
        seen: The objects that take part.
    """

    time: float
    instants: list[str]
    percepts: str
    images: dict[str, int]
    seen: list[Seen]


class RecognitionExplanation(_Value):
    """Why a chronicle was recognised.

    Attributes:
        number: Of the recognition in the run; None if the run did not report it.
        chronicle: Name of the model.
        file: The file that says what it is.
        values: The value of each variable, also of those that the recognition does not tell.
        instants: When each instant was.
        begin: Of what a person would count.
        end: Of it.
        recognised_at: From when on nothing could take it back.
        sample: Where it was told.
        truth: The simulator's id of each vehicle; None if that is not known.
        agrees: Whether the truth agrees, as in the result of the run.
        events: The events that made it.
        constraints: On times and values.
        counted: `occurs` and `noevent`.
        objects: That take part.
        frames: At the events.
    """

    number: int | None
    chronicle: str
    file: str
    values: dict[str, str]
    instants: dict[str, float]
    begin: float
    end: float
    recognised_at: float
    sample: Provenance | None
    truth: dict[str, str] | None
    agrees: bool | None
    events: list[EventExplanation]
    constraints: list[Constraint]
    counted: list[Counted]
    objects: list[ObjectExplanation]
    frames: list[Frame]


class ListedRecognition(_Value):
    """A recognition that can be explained.

    Attributes:
        number: To ask for it.
        chronicle: Name of the model.
        arguments: Value of each of its parameters.
        begin: Of what a person would count.
        end: Of it.
    """

    number: int
    chronicle: str
    arguments: dict[str, str]
    begin: float
    end: float


class Explanation(_Value):
    """The document of `traffic explain --json`.

    Attributes:
        format: `traffic explanation`.
        version: Of this form.
        run: The folder of the run.
        scenario: Its scenario.
        settings: What was asked for.
        recognition: What was recognised, and why.
    """

    format: str = "traffic explanation"
    version: int = 1
    run: str
    scenario: str
    settings: dict[str, Any]
    recognition: RecognitionExplanation

"""What a user asks of an explanation: which recognition, and where a picture and files go."""

from collections.abc import Callable, Mapping
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path

from dyknow.source_text import did_you_mean, nearest_name
from traffic.errors import ExplanationError, RequestError
from traffic.explaining.explanation import Explanation, ListedRecognition
from traffic.explaining.kept import KeptRun, open_kept_run
from traffic.explaining.pictures import picture_of
from traffic.explaining.walking import Walker
from traffic.inspecting import check_picture
from traffic.results import run_folder
from traffic.watching import OnProgress

__all__ = ["ExplanationRequest", "explain_run", "number_of", "recognitions_of"]

_JSON = "explanation.json"
_TEXT = "explanation.txt"
_PICTURE = "explanation.png"


@dataclass(frozen=True, slots=True)
class ExplanationRequest:
    """What a user asks of an explanation.

    Attributes:
        run: The folder of the run.
        recognition: Its number or its name, as it was written; None for a list of them.
        picture: The file for a picture, if wanted.
        out: The folder for text, JSON and picture, if wanted.
    """

    run: Path
    recognition: str | None
    picture: Path | None = None
    out: Path | None = None

    @classmethod
    def from_texts(
        cls,
        *,
        run: Path,
        recognition: str | None,
        picture: Path | None = None,
        out: Path | None = None,
    ) -> "ExplanationRequest":
        """Read what a user wrote on the command line.

        Raises:
            RequestError: An option is impossible, or has no meaning without a recognition.
        """
        check_picture(picture, "--picture", ".png")
        given: Mapping[str, object] = {"--picture": picture, "--out": out}
        for option, value in given.items():
            if recognition is None and value is not None:
                fault = "nothing, because it only has a meaning with a recognition"
                raise RequestError(option, fault, value)
        return cls(run, recognition, picture, out)


def explain_run(
    request: ExplanationRequest,
    as_text: Callable[[Explanation], str],
    on_progress: OnProgress,
) -> Explanation:
    """Do what is asked; return the explanation.

    Args:
        request: What is asked; it names a recognition.
        as_text: Returns what the text in the folder says.
        on_progress: Told the seconds simulated again so far, and those in all.

    Raises:
        ExplanationError: The run cannot be explained, or there is nothing to draw.
        ResultError: There is no finished run, or the folder cannot be written.
        NetworkError: The network cannot be read.
        ReplayError: It is not what it was.
    """
    run = open_kept_run(request.run)
    walker = Walker(run)
    number = number_of(run, request.recognition or "")
    with ExitStack() as stack:
        folder = None if request.out is None else stack.enter_context(run_folder(request.out))
        explanation = walker.explanation(number)
        if request.picture is not None or folder is not None:
            picture = picture_of(walker, explanation, on_progress)
            for path in (request.picture, None if folder is None else folder / _PICTURE):
                if path is not None:
                    path.write_bytes(picture)
        if folder is not None:
            document = explanation.model_dump_json(indent=1)
            (folder / _JSON).write_text(f"{document}\n", encoding="utf-8")
            (folder / _TEXT).write_text(as_text(explanation), encoding="utf-8")
    return explanation


def recognitions_of(folder: Path) -> list[ListedRecognition]:
    """Return what can be explained of the run in *folder*.

    Raises:
        ExplanationError: It keeps nothing to be explained by.
        ResultError: There is no finished run.
    """
    return [
        ListedRecognition(
            number=number,
            chronicle=each.chronicle,
            arguments=each.arguments,
            begin=each.begin,
            end=each.end,
        )
        for number, each in enumerate(open_kept_run(folder).result.recognitions, start=1)
    ]


def number_of(run: KeptRun, text: str) -> int:
    """Return the number of a recognition that is asked for as *text*: its number, or its name.

    Raises:
        ExplanationError: It is neither, or more than one has this name.
    """
    if text.isdecimal():
        return int(text)
    names = [each.chronicle for each in run.result.recognitions]
    if names.count(text) == 1:
        return names.index(text) + 1
    if text in names:
        numbers = ", ".join(str(at) for at, name in enumerate(names, start=1) if name == text)
        raise ExplanationError(
            f"'{text}' was recognised more than once in '{run.folder}'; expected one of the "
            f"numbers {numbers}"
        )
    hint = did_you_mean(nearest_name(text, names))
    raise ExplanationError(
        f"expected the number of a recognition, as 'traffic explain {run.folder}' lists them, "
        f"found '{text}'{hint}"
    )

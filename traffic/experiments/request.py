"""What a user asks of an experiment, read from the command line and checked."""

import os
from dataclasses import dataclass
from pathlib import Path

from traffic.errors import RequestError
from traffic.experiments.reading import find_design

__all__ = ["ExperimentRequest"]

_MOST_WORKERS = 8
"""For each processor; more would only be in each other's way."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ExperimentRequest:
    """What a user asks of an experiment.

    Attributes:
        design: The file.
        workers: How many processes of this machine, if there is no cluster.
        cluster: Address of a cluster.
        folder: Where it is written.
        resume: Whether to go on with what is in the folder.
        yes: Whether a very large design is meant.
    """

    design: Path
    workers: int
    cluster: str | None
    folder: Path
    resume: bool
    yes: bool

    @classmethod
    def from_options(
        cls,
        *,
        design: str,
        workers: int | None = None,
        cluster: str | None = None,
        out: Path | None = None,
        resume: bool = False,
        yes: bool = False,
    ) -> "ExperimentRequest":
        """Read what a user wrote on the command line.

        Raises:
            RequestError: An option is impossible.
            ExperimentError: There is no such design.
        """
        if workers is not None and cluster is not None:
            fault = "nothing, because a cluster has the workers that it has"
            raise RequestError("--workers", fault, workers)
        processors = len(os.sched_getaffinity(0))
        most = _MOST_WORKERS * processors
        if workers is not None and not 1 <= workers <= most:
            expected = f"a number from 1 to {most}, as there are {processors} processors here"
            raise RequestError("--workers", expected, workers)
        path = find_design(design)
        return cls(
            design=path,
            workers=workers or processors,
            cluster=cluster,
            folder=out or Path("experiments") / path.stem,
            resume=resume,
            yes=yes,
        )

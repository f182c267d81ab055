"""What a worker process of this machine does before it does runs; the engine loads it there."""

import logging
import signal

__all__ = ["dask_setup", "silence"]


def dask_setup(_worker: object) -> None:
    """Leave it to the program that began the experiment to stop, and to tell what went wrong.

    Ctrl-C reaches all processes of a terminal at once.
    """
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    silence()


def silence() -> None:
    """Keep the engine's own reports from the screen; parts of it have levels of their own."""
    for logger in logging.root.manager.loggerDict.values():
        if isinstance(logger, logging.Logger) and logger.name.split(".")[0] == "distributed":
            logger.setLevel(logging.CRITICAL)

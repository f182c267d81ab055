"""The command line: collects the commands and turns errors into messages.

Exit status: 0 done, 1 a bug or what the help of a command says, 2 the user's input is at fault,
130 interrupted, 143 terminated.
"""

import signal
import sys
from types import FrameType

import typer

from traffic.commands import (
    benchmark,
    check,
    chronicles,
    compare,
    experiment,
    explain,
    inspect,
    judge,
    monitor,
    network,
    recognise,
    recover,
    regress,
    replay,
    report,
    run,
    scenarios,
)
from traffic.commands.complaining import complaint_about

__all__ = ["app", "main"]

app = typer.Typer(
    name="traffic",
    help="Watch simulated traffic through overhead cameras and report what the vehicles do.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
)
app.command("run")(run.run)
app.command("replay")(replay.replay)
app.command("recover")(recover.recover)
app.command("report")(report.report)
app.command("compare")(compare.compare)
app.command("experiment")(experiment.experiment)
app.command("regress")(regress.regress)
app.command("explain")(explain.explain)
app.command("inspect")(inspect.inspect)
app.command("judge")(judge.judge)
app.command("monitor")(monitor.monitor)
app.command("recognise")(recognise.recognise)
app.command("chronicles")(chronicles.chronicles)
app.command("check")(check.check)
app.add_typer(network.app, name="network")
app.command("scenarios")(scenarios.scenarios)
app.command("benchmark")(benchmark.benchmark)

_STOPS = {signal.SIGINT: "interrupted", signal.SIGTERM: "terminated"}


class _StopError(SystemExit):
    """Someone wants the program to stop; what is half done is cleaned up on the way out."""

    def __init__(self, number: signal.Signals) -> None:
        super().__init__(128 + number)
        self.reason = _STOPS[number]


def main() -> None:
    """Run the command line; the console script `traffic`."""
    for number in _STOPS:
        if signal.getsignal(number) is not signal.SIG_IGN:
            signal.signal(number, _stop)
    try:
        app()
    except _StopError as stop:
        sys.stderr.write(f"traffic: {stop.reason}\n")
        raise
    except Exception as error:
        complaint = complaint_about(error)
        if complaint is None:
            raise
        sys.stderr.write(f"{complaint}\n")
        sys.exit(2)


def _stop(number: int, _frame: FrameType | None) -> None:
    raise _StopError(signal.Signals(number))


if __name__ == "__main__":
    main()

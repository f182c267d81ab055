"""The command line: collects the commands and turns errors into messages.

Exit status: 0 done, 1 a bug, 2 the user's input is at fault, 130 interrupted.
"""

import sys

import typer

from dyknow.errors import DyKnowError, SpecificationError, SpecificationErrors
from networks.errors import NetworkError
from perception.errors import PerceptionError
from traffic.commands import check, network, report, run, scenarios
from traffic.errors import TrafficError

__all__ = ["app", "main"]

app = typer.Typer(
    name="traffic",
    help="Watch simulated traffic through overhead cameras and report what the vehicles do.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
)
app.command("run")(run.run)
app.command("report")(report.report)
app.command("check")(check.check)
app.add_typer(network.app, name="network")
app.command("scenarios")(scenarios.scenarios)

_USER_ERRORS = (DyKnowError, NetworkError, PerceptionError, TrafficError)


def main() -> None:
    """Run the command line; the console script `traffic`."""
    try:
        app()
    except SpecificationErrors as errors:
        for error in errors.exceptions:
            _complain(error)
        sys.exit(2)
    except _USER_ERRORS as error:
        _complain(error)
        sys.exit(2)
    except KeyboardInterrupt:
        sys.stderr.write("interrupted\n")
        sys.exit(130)


def _complain(error: Exception) -> None:
    text = error.report() if isinstance(error, SpecificationError) else f"traffic: {error}"
    sys.stderr.write(text + "\n")


if __name__ == "__main__":
    main()

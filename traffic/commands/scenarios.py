"""`traffic scenarios`: what comes with the program."""

__all__ = ["scenarios"]


def scenarios() -> None:
    """List the bundled scenarios."""
    from rich.console import Console
    from rich.markup import escape
    from rich.table import Table

    from traffic.scenarios import bundled_scenarios

    table = Table("scenario", "duration", "what happens there", box=None)
    for scenario in bundled_scenarios():
        table.add_row(
            scenario.name, f"{scenario.duration / 1e9:g} s", escape(scenario.description)
        )
    Console().print(table)

"""The commands `run`, `report`, `check`, `network` and `scenarios`; the only place that prints.

One module each, `showing` for the tables and progress bars that they share, and `complaining`
for what an error says to the user. What they do stands in functions that a script can call as
well: `traffic.running.run_scenario`, `traffic.results.read_result`,
`traffic.checking.faults_of_file`.
"""

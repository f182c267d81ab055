"""The commands, one module each; the only place that prints.

What they do stands in functions that a script can call as well: `traffic.running.run_scenario`,
`traffic.results.read_result`, `traffic.checking.faults_of_file`.
"""

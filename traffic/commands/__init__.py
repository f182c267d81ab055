"""The commands, one module each; the only place that prints.

`run`, `replay`, `recover`, `report`, `explain`, `inspect`, `judge`, `regress`, `experiment`,
`compare`, `monitor`, `recognise`, `chronicles`, `check`, `network`, `scenarios` and `benchmark`.
`showing` has what they print in common; `showing_reports`, `showing_explanations`,
`showing_networks`, `showing_judgements`, `showing_regressions`, `showing_experiments`,
`showing_comparisons`, `showing_monitors`, `showing_recognitions`, `showing_chronicles` and
`showing_benchmarks` have their tables and progress bars, and `complaining` what an error says to
the user. What they do stands in functions that a script can call as well:
`traffic.running.run_scenario`, `traffic.replaying.replay`,
`traffic.explaining.asking.explain_run`, `traffic.judging.judge_recording`,
`traffic.regression.regressing.regress`, `traffic.experiments.running.run_experiment`,
`traffic.monitoring.following.follow`, `traffic.recognising.following.recognise`,
`traffic.results.read_result`, `traffic.checking.faults_of_file`.
"""

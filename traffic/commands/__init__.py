"""The commands, one module each; the only place that prints.

`run`, `replay`, `recover`, `report`, `explain`, `inspect`, `judge`, `monitor`, `recognise`,
`chronicles`, `check`, `network`, `scenarios` and `benchmark`; `showing`, `showing_explanations`,
`showing_networks`, `showing_judgements`, `showing_monitors`, `showing_recognitions`,
`showing_chronicles` and `showing_benchmarks` for their tables and progress bars, and
`complaining` for what an error says to the user. What they do stands in functions that a script
can call as well: `traffic.running.run_scenario`, `traffic.replaying.replay`,
`traffic.explaining.asking.explain_run`, `traffic.judging.judge_recording`,
`traffic.monitoring.following.follow`, `traffic.recognising.following.recognise`,
`traffic.results.read_result`,
`traffic.checking.faults_of_file`.
"""

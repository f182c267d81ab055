"""The application: simulated traffic is watched, understood, and scored against the truth.

Read in this order:

- `running`: one run from begin to end; `request`: what a user asks of it; `settings`: what can be
  changed without writing files; `watching`: the system at work; `system`: what the names in the
  specification stand for; `world`: what surrounds it; `sorts`: what its values are
- `features`: what cars do, and where they are to each other
- `scenarios` and `sumo`: what drives where; `truth` and `scoring`: what really happened, and how
  well that was recognised
- `results`: a run as a value and a folder; `totals`: of several; `origin`: what it was made from
- `recording`: every stream of a run in a file; `replaying`: the same from that file again;
  `judging`: whether it satisfies a specification; `regression`: recorded scenarios, replayed
- `explaining`: from a recognition down to the images
- `experiments`: batches of runs; `reporting`: web pages of runs and experiments
- `monitoring`: a formula over recorded states; `recognising`: chronicles over recorded events, and
  the library of chronicles; `reading`: what was recorded line by line
- `inspecting`: what the network of a run looked like; `overlaying`: a film of what is believed;
  `maps`: what a map says, in short; `checking`: faults of files; `benchmarks`: how fast it all is
- `bundled`: where data lie; `errors`; `commands`: what a user types
"""

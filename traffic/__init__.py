"""The application: simulated traffic is watched, understood, and scored against the truth.

Read in this order: `running` (one run from begin to end), `request` (what a user asks of it),
`watching` (the system at work), `system` (what the names in the specification stand for), `world`
(what surrounds it), `features` (what cars do, and where they are to each other), `scenarios` and
`sumo` (what drives where), `truth` and `scoring` (what really happened, and how well that was
recognised), `results` (as a value and a folder), `totals` (of several runs), `origin` (what a run
was made from), `recording` (every stream of a run in a file), `replaying` (the same from that
file again), `explaining` (from a recognition down to the images), `judging` (whether it satisfies
a specification), `monitoring` (a formula over
recorded states), `recognising` (chronicles over recorded events, and the library of chronicles),
`reading` (what was recorded line by line), `sorts` (what its values are), `maps` (what a map says, in short), `overlaying`
(a film of what is believed), `checking` (faults of files), `inspecting` (what the network of a
run looked like), `benchmarks` (how fast it all is), `bundled` (where data lie), `errors`;
`commands` is what a user types.
"""

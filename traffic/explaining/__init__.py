"""Why something was recognised: from a recognition down to the frames.

Read in this order: `format` (what a run keeps), `changing`, `columns` and `arrays` (tables of a
run as columns of files), `roles` (which streams matter, found in the network's description),
`keeping` (written while a run goes on); `kept` (read again), `symbols`, `explanation` (what is
said, as values), `constraining` and `matching` (events beside their chronicle), `attributes`
(samples behind events), `objects` (links, states, gaps), `frames` (percepts and images),
`walking` (puts these together), `wording`; `images` (made again), `story` (what a picture shows),
`drawing`, `time_line`, `film_strip`, `pictures`; `asking` (what a user asks for).
"""

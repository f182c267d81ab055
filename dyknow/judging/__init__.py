"""Judging whether a finished execution satisfies a specification.

The meaning of a specification is that of Heintz (2009), *DyKnow: A Stream-Based Knowledge
Processing Middleware Framework*, section 4.5: an interpretation of its symbols is a model if every
declaration holds.

Read in this order:

- `execution`: what must be known of an execution; `declared`: what must be known of a
  specification; `sorts`: what its sorts contain
- `judgement`: what comes out
- `wording`: how values and differences are told
- `streams`: the recorded streams; `wellformed`: what each of them must be
- `terms`: whether a stream is one that its policy allows
- `recomputing`: what a process makes of recorded streams; `comparing`: where that differs
- `published`: whether the right violations were published
- `comings`: what comes and goes while a network runs
- `judge`: all of it together
- `specified`: what is declared, from a network, and `changing`, what changes by itself there;
  `recorded`: the execution, from a recording
"""

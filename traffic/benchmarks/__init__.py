"""Benchmarks: how fast and how small things are, beside published figures and other libraries.

A benchmark measures and never judges. Read in this order:

- `results`: what a benchmark finds out, as values and as a file
- `measuring`: repeating a measurement, and how a benchmark is asked for
- `machine`: what it ran on
- `workloads`: the networks that are measured
- `streams`, `tables`, `synchronisation`, `recordings`, `memory`: the benchmarks; `peers`: the
  same work done by other libraries, if they are installed
- `sequences`: the formulas and states of `progression`, a benchmark; `monitor_peers`: other
  libraries for monitoring
- `chronicles_events`: the overtake pattern, and what is to be found; `chronicles`, a benchmark;
  `chronicles_peers`: other engines
- `registry`: all benchmarks by name; to add one, write a module and name it there
- `pictures`: results as pictures
"""

"""Fluent streams: samples in order of available time, and what is asked of them.

Read in this order:

- `sample`: one element of a stream; `table`: the states of many objects as one value;
  `values`: when two values are the same
- `stream`: the questions that can be asked of a stream (thesis section 4.3)
- `process`: what sources and computational units are
- `policy`: what a receiver requires of a stream; `conformance`: whether a stream keeps it;
  `refusal`: why a process cannot serve it
- `adapter`, `ordering`, `sampling`: what makes a stream that keeps it, online
- `selecting`: fields picked out of values; `merging`: several streams into one that has all
- `state_policy`: how states are made from several streams; `synchronisation`: the unit that makes
  them
"""

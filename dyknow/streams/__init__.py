"""Fluent streams: samples in order of available time, and what is asked of them.

Read in this order:

- `sample`: one element of a stream; `table`: the states of many objects as one value;
  `values`: when two values are the same
- `stream`: the questions that can be asked of a stream (thesis section 4.3); `history`: many
  questions about one stream; `domain`: what counts as a value, a sample, a stream
- `process`: what sources and computational units are
- `policy`: what a receiver requires of a stream; `refusal`: why a process cannot serve it
- `adapter`, `ordering`, `sampling`, `most_recent`, with `grid`: what makes a stream that keeps it,
  online
- `conformance`: whether a finished stream keeps it; `approximation`, `maximality`, `content`: what
  such a stream may have, and what it must have
- `selecting`: fields picked out of values; `viewing`: one object out of tables; `merging`: several
  streams into one that has all
- `state_policy`: how states are made from several streams; `synchronisation`: the unit that makes
  them, with `state_times`: when there are states, `state_buffers`: what is known of each input,
  `state_waiting`: what a state waits for, `interpolation`: values between two samples, and
  `state_reports`: what went wrong; `joining`: states of whatever is there
"""

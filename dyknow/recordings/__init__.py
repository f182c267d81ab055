"""Recordings of what flows in a network, as MCAP files.

Read in this order:

- `codecs`: values of an application as plain ones; `columns`: numpy arrays as bytes
- `layout`: what the values of a stream look like; `wire`, `places`: where they stand in a message
- `encoding`, `decoding`, `schemas`: values to bytes, and back, and what tells viewers the same
- `formats`, `channels`: what a file and a channel say about themselves; `errors`
- `writing`: a file; `topics`: its channels; `origins`: samples that others refer to
- `violations`: violations as samples; `taps`: what takes the samples of a stream
- `attaching`: taps for a whole network; `recorder`: what users write with
- `container`: the records of a file, whole or not; `index`: what is where; `reading`: a file
- `messages`: what a message says; `recording`: what users read with
- `comparing`: whether two recordings have the same streams; `recovery`: of damaged files
"""

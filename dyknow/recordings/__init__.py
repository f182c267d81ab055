"""Recordings of what flows in a network, as MCAP files.

Read in this order: `codecs` (values of an application, plain), `columns` (arrays as bytes),
`layout` (what values look like), `wire` and `places` (where they stand in a message), `encoding`,
`decoding`, `schemas` (for viewers), `formats`, `channels`, `errors`, `writing` (a file),
`topics` (its channels), `violations`, `origins`, `taps` (what takes samples), `recorder`,
`container` (records, whole or not), `index` (what is where), `reading` (a file), `messages`,
`recording`.
"""

"""Every stream of a run in one MCAP file, and the system of a run made again from it.

Read in this order: `codecs` (what flows, as fields), `views` (what viewers show),
`comparing` (whether two recordings are the same).
"""

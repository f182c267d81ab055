"""Every stream of a run in one MCAP file, and the system of a run made again from it.

Read in this order: `codecs` (what flows, as fields), `periods` (what stood back under load),
`describing` (what else is said of a run), `writing` (while it goes on), `views` (what viewers
show), `finding` (where the recording of a run is), `rebuilding` (the system again, from the file),
`changes` (what is not as it was).
"""

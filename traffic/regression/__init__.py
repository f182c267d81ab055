"""The regression suite: small recordings, and what is to be recognised in each.

Read in this order: `suite` (the recordings and where they lie), `cutting` (a piece of a recording,
as a recording of its own), `expectations` (what was recognised, as text), `regressing` (replay
all, and tell what differs), `request` (what a user asks).
"""

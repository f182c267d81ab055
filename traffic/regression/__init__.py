"""Regression suites: small recordings, and what is to be recognised in each.

Read in this order: `suite` (the recordings and where they lie), `cutting` (a piece of a
recording, as a recording of its own), `expectations` (what was recognised, as text), `regressing`
(replay all, and tell what differs), `manifest` (what each shows and how it was made), `making`
(add one, or make all anew), `listing` (what there is), `request` (what a user asks).
"""

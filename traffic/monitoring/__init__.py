"""Monitoring recorded states: a formula, a file of states, and the verdict with its reasons.

Read in this order:

- `questions`: the formula that is asked about, its domains, and the features that it needs
- `states`: what a reader of states does, and everything that can be wrong with a state
- `json_states`, `csv_states`: the two formats; `opening` tells them apart
- `following`: the formula followed along the states, up to its verdict
- `past`: the states that the verdict can depend on; `reasons`: which of them bring it about
"""

"""How well what was recognised agrees with the truth.

The only package that may import `traffic.truth`. Read in this order: `association` (which
vehicle a car symbol stands for), `claims` (what a recognition says, in the words of the truth),
`matching` (which recognition a true manoeuvre explains), `score` (counts, precision and recall of
a run).
"""

"""Reports as web pages: each one self-contained file, which opens without a network.

Read in this order: `pages` (templates, style and scripts put together), `scores` (shares with
their intervals), `experiments` (one or several side by side: measures as heat maps, curves and
tables); of a run `items` (what was recognised and what was missed), `tracks`, `drawn_maps`,
`films`, `bands` (attributes over time), `misses` (what was believed of what was not recognised)
and `reasons` (explanations in words), put together by `runs`; and `reports` (what a user asks
about, runs or experiments, in every form). What a browser runs is in `templates`.
"""

"""Reports as web pages: each one self-contained file, which opens without a network.

Read in this order: `pages` (templates, style and scripts put together), `experiments` (an
experiment: its measures as table, heat map and curves), `reports` (what a user asks about, runs or
an experiment, in every form). What a browser runs is in `templates`.
"""

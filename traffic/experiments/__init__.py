"""Experiments: the same run again and again with other settings, on many processes.

Read in this order: `designs` (which runs an experiment consists of), `reading` (from TOML files,
with every fault), `trials` (which of its cells are tried to find these), `cases` (one run of an
experiment: from settings to counts), `journal` (finished runs, durable one by one), `folders`
(where an experiment is written), `preparing` (what a process of this machine does first), `engine`
(who does the runs: processes of this machine or a cluster), `conducting` (an experiment from its
beginning, or where it was cut off, to its end), `estimating` (how long it will take), `measures`
(what is asked of the runs of a cell), `intervals` (how sure a share is), `tables` (all runs, and
the measures of all cells), `request` (what a user asks), `running` (an experiment as a user asks
for it). Then what is done with results: `levels` (equal ones, numbers by size), `cell_files`
(tables that others made), `findings` (what an experiment, a run or a table tells), `beside`
(several side by side), `comparing` (two of them), `documents` (for other programs), `repeating`
(which runs to look at, and how to do one again).
"""

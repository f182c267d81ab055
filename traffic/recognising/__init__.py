"""Recognising chronicles in recorded events, and the library of chronicles.

Read in this order:

- `library`: the chronicles that come with the program; `questions`: those that are asked for
- `json_events`, `csv_events`: the two formats of events; `opening` tells them apart
- `screening`: which events are fit to be taken in; `ordering`: late ones put in order
- `following`: the chronicles recognised along the events
- `documents`: recognitions and what is left at the end, as plain data
"""

"""Reading what was recorded line by line, in bounded memory, with the place of every fault.

Read in this order:

- `lines`: the lines of a file or of standard input, one by one
- `times`: times and values as they stand in lines
- `formats`: which of the two formats it is; `json_lines`, `csv_lines`: what can be said of a line
  of each
"""

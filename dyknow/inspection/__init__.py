"""Looking at a network: what runs, who feeds whom, at what rate and delay, and what goes wrong.

Read in this order:

- `snapshot`: a network at one time as plain data, its JSON form, and the difference of two
- `taking`: taking a snapshot of a network, also while it runs
- `wording`: how figures are written for people
- `dot`: the network as text for Graphviz
- `layout`: where the boxes of a picture go; `drawing`: the picture, as SVG
"""

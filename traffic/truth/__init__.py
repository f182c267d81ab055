"""What really happened, as the simulator knows it. Only `traffic.scoring` may import this.

Read in this order: `ground_truth` (all of it together), `turns`, `overtakes` (the definitions),
`places` (where vehicles are on the road map), `visibility` (who was in view, and how long).
"""

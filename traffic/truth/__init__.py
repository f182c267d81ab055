"""What really happened, as the simulator knows it. Only `traffic.scoring` may import this.

Read in this order: `manoeuvres` (what vehicles did, and what finds it), `ground_truth` (all of it
together), `watchers` (which kinds there are), `turns`, `overtakes`, `aborted_overtakes`,
`facing_traffic`, `following`, `weaving`, `parking`, `near_collisions`, `red_lights`, `standing`,
`wrong_way` (the definitions), `stretches` (since when something is the case), `places` (where
vehicles are on the road map), `visibility` (who was in view, and when).
"""

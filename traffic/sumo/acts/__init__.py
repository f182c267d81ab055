"""Acts performed in SUMO: drivers who do on purpose what a scenario says.

Read in this order: `performance` (one act done once, step by step), `stage` (the simulator as
performances see it), `native_driver` (in SUMO's hands), `paths` (smooth curves), `path_driver`
(along a curve, in place of SUMO), `drawing` (what is random), then the families: `driving`,
`steering` (what all with a path driver do), `weaving`, `following`, `parking`, `danger`, `signals`
(what a light shows) and `crossings`, `wrong_way`, `overtaking`; `registry` (which performance
belongs to which act), `director` (when each begins).
"""

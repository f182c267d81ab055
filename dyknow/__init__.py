"""Stream-based knowledge processing: streams, policies, logic over streams, and KPL.

Read in this order: `time`, `source_text`, `errors`, `streams`, `mtl`, `runtime`, `kpl`. On top of
them stand `monitoring` (formulas over the streams of a network), `service` (the middleware as a
service), `recordings` (what has flowed, in files), `inspection` (what runs, at what rates and
delays) and `judging` (whether a run kept to its specification).
"""

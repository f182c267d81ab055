"""Stream-based knowledge processing: streams, policies, logic over streams, and KPL.

Read in this order: `time`, `source_text`, `errors`, `streams`, `mtl`, `runtime`, `kpl`; then
`inspection` (what runs, at what rates and delays), `recordings` (what has flowed, in files),
`service` (the middleware as a service) and `judging` (whether a run kept to its specification).
"""

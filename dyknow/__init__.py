"""Stream-based knowledge processing: streams, policies, logic over streams, and KPL.

Read in this order: `time`, `source_text`, `errors`, `streams`, `mtl`, `runtime`, `kpl`; then
`inspection` (what runs, at what rates and delays).
"""

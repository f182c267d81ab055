"""Computational units of the traffic domain: what cars do, and where they are to each other.

Read in this order: `carrying` (state that follows objects from frame to frame), `moving`,
`stability`, `decisions` (truths that turn when there is enough evidence), `travelling`, `pairs`,
`relations`, `oncoming`, `headways` and `following` (who is next behind whom), `swaying`,
`parking` (where cars stand), `danger` (who is about to collide), `standing`, `stop_lines`,
`sides`, `changes` (from columns to events), `link_turns` (what the map says, as events),
`positions` (percepts without a camera), `unfiltered` and `angular` (cars and their relations
without filters, to compare with), `reckless` (who was a reckless driver, from when until when).
"""

"""The traffic simulator SUMO behind a small protocol, and replays that keep the same protocol.

Read in this order: `simulation` (the protocol and what a step yields), `recorded` (replay of
recorded poses), `replayed` (replay of the frames of an earlier run), `simulator` (SUMO in this
process), `signals` (what traffic lights show), `bodies` (which way they point), `acts` (drivers
who do things on purpose), `opening` (from a scenario to a running simulator), `feeding` (vehicles
and signals as sources), `topology` (which roads follow which), `demand` (the traffic of a
scenario), `vehicle_types` (what one vehicle is like), `colours` (of vehicles), `configuration`
(SUMO's files, so that nothing is written beside the user's), `building` (networks from plain
XML), `libraries` (what SUMO needs from the system), `output` (what SUMO prints).

Only this package talks to the simulator.
"""

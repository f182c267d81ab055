"""Running a network of knowledge processes, in virtual time or beside a wall clock.

Read in this order:

- `statistics`: figures about a stream; `accounts`: what a process costs and gives
- `names`: what generators and streams are called
- `cache`: the last samples of a stream and the questions that can be asked of them
- `agenda`: what is to happen when; `changes`: when the network may be changed
- `generators`: where the samples of a process come out
- `beginnings`: how a stream begins; `adaptation`: a stream on its way, adapted to a policy
- `subscriptions`: who receives which stream under which policy
- `failures`: what happens when a process fails; `processes`: sources and units at work
- `clock`: how fast a run goes
- `kernel`: the network and the only loop
"""

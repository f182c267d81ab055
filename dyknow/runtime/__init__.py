"""Running a network of knowledge processes in virtual time.

Read in this order:

- `generators`: where the samples of a process come out; `accounts`: what a process costs
- `agenda`: what is to happen when
- `processes`: sources and computational units at work
- `subscriptions`: a stream on its way, adapted to its receiver's policy
- `kernel`: the network and the only loop
"""

"""What the network of a finished run looked like, from its folder or from its recording.

Read in this order: `runs` (where networks and pictures of them are kept) and `recorded` (what a
recording tells of the network that was recorded).
"""

from traffic.inspecting.runs import check_picture, read_network, write_dot, write_svg

__all__ = ["check_picture", "read_network", "write_dot", "write_svg"]

"""Symbols tied to sensor data: objects linked level by level, under temporal conditions.

Read in this order: `links` (what declares a link, and what its unit must be able to do),
`processes` (the link process), `conditions` and `candidates` (what it evaluates, and for which
pairs), `structures` (what was linked to what, over time); then the units of the hierarchy percept,
world object, on-road object, car: `motion` (Kalman filters over columns), `world_objects`,
`branches` and `on_road_objects` (along the roads), `cars`, `reckless_drivers`; `rows` is a tool
of all.
"""

from anchoring.branches import BranchSettings
from anchoring.cars import Car
from anchoring.links import Link, LinkSettings, LinkUnit
from anchoring.on_road_objects import OnRoadObject
from anchoring.processes import LinkProcess
from anchoring.reckless_drivers import RecklessDriver
from anchoring.structures import ObjectLinkageStructure, ObjectLinkageStructures
from anchoring.world_objects import WorldObject

__all__ = [
    "BranchSettings",
    "Car",
    "Link",
    "LinkProcess",
    "LinkSettings",
    "LinkUnit",
    "ObjectLinkageStructure",
    "ObjectLinkageStructures",
    "OnRoadObject",
    "RecklessDriver",
    "WorldObject",
]

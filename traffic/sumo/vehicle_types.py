"""What vehicles are like, in SUMO's words: each one draws its own size, colour and driver."""

from collections.abc import Iterable, Mapping
from xml.sax.saxutils import quoteattr

import numpy as np

from traffic.scenarios.fields import Range
from traffic.scenarios.model import VehicleType
from traffic.sumo.colours import random_colours

__all__ = ["base_name", "base_types_document", "drawn_type", "element", "text_of"]


def drawn_type(
    name: str, vehicle_type: VehicleType, generator: np.random.Generator
) -> dict[str, str]:
    """Return the attributes of the SUMO type *name* of one vehicle of *vehicle_type*."""

    def draw(span: Range) -> str:
        return f"{generator.uniform(*span):.3f}"

    red, green, blue = random_colours(generator, 1)[0]
    return {
        "id": name,
        "vClass": vehicle_type.vehicle_class,
        "length": draw(vehicle_type.length),
        "width": draw(vehicle_type.width),
        "height": draw(vehicle_type.height),
        "maxSpeed": draw(vehicle_type.max_speed),
        "speedFactor": draw(vehicle_type.speed_factor),
        "speedDev": "0",
        "color": f"{red},{green},{blue}",
        **_further(vehicle_type),
    }


def base_name(vehicle_type: str) -> str:
    """Return the name of the SUMO type that vehicles which come on stage are copied from."""
    return f"{vehicle_type}.base"


def base_types_document(vehicle_types: Iterable[VehicleType]) -> str:
    """Return an additional file of SUMO with the type that each of *vehicle_types* begins as.

    While the simulator runs, some attributes of types can only be copied, not set.
    """
    lines = ['<?xml version="1.0" encoding="UTF-8"?>', "<additional>"]
    for each in vehicle_types:
        head = {"id": base_name(each.name), "vClass": each.vehicle_class}
        lines.append(element("vType", head | _further(each)))
    lines.append("</additional>\n")
    return "\n".join(lines)


def element(tag: str, attributes: Mapping[str, str]) -> str:
    """Return one line of XML."""
    written = " ".join(f"{key}={quoteattr(value)}" for key, value in attributes.items())
    return f"    <{tag} {written}/>"


def text_of(value: str | float) -> str:
    """Return *value* as SUMO writes it."""
    return str(value).lower() if isinstance(value, bool) else str(value)


def _further(vehicle_type: VehicleType) -> dict[str, str]:
    return {key: text_of(value) for key, value in vehicle_type.sumo.items()}

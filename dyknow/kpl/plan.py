"""From a KPL specification to a network that runs."""

from collections.abc import Collection, Iterator, Mapping

from dyknow.errors import SpecificationError, UnknownNameError
from dyknow.kpl.check import raise_faults
from dyknow.kpl.implementations import Implementations, LinkFactory
from dyknow.kpl.names import Declarations
from dyknow.kpl.network import Network
from dyknow.kpl.parser import value_from
from dyknow.kpl.syntax import Specification, Value
from dyknow.source_text import MADE_IN_PYTHON, nearest_name

__all__ = ["Implementations", "LinkFactory", "Network", "build_network"]


def build_network(
    specification: Specification,
    implementations: Implementations,
    parameters: Mapping[str, object] | None = None,
    outputs: Collection[str] | None = None,
) -> Network:
    """Return a network of what the wanted *outputs* need; of all outputs when None.

    *parameters* gives values to `parameter` declarations, in place of their defaults: numbers
    as KPL writes them (a bare one is milliseconds where a time is meant), True, False, or
    strings (`"truth"`, `"100 ms"`). A source is made once for each generator that is made of it.

    Raises:
        SpecificationErrors: Every fault of the specification, of the parameters, and of the
            settings and implementations of what is built.
    """
    values = {name: value_from(given) for name, given in (parameters or {}).items()}
    raise_faults(list(_unknown_parameters(specification, values)))
    network = Network(implementations, values)
    network.add(specification, outputs)
    return network


def _unknown_parameters(
    specification: Specification, values: Mapping[str, Value]
) -> Iterator[SpecificationError]:
    known = Declarations(specification).parameters
    for name in values:
        if name not in known:
            nearest = nearest_name(name, known)
            yield UnknownNameError("parameter", name, MADE_IN_PYTHON, nearest)

"""Contacts that are given by the parameters of a physics engine."""

from collections.abc import Mapping
from typing import Any, NamedTuple

from bouncing_ball.calculator.case import Table
from bouncing_ball.calculator.contact_data import LOSSY, STIFF
from bouncing_ball.calculator.units import Unit, number
from bouncing_ball.contacts.contact_law import ContactLaw
from bouncing_ball.engines import engine_named
from bouncing_ball.engines.engine import Engine
from bouncing_ball.errors import ParameterError


class Source(NamedTuple):
    """An engine and the given parameters of its contact."""

    engine: Engine
    parameters: dict[str, Any]

    def law(self, table: Table) -> ContactLaw | None:
        """The law of this contact, dimensionless on a table; None if it is a spring and damper."""
        return self.engine.law(self.parameters, table.time, table.length)

    def remarks(self) -> tuple[str, ...]:
        """Sentences on how the contact differs from a spring and a damper."""
        return self.engine.remarks(self.parameters)


def read_engine(said: Mapping[str, Any]) -> tuple[Source | None, dict[str, Any]]:
    """The engine whose parameters are given, and the arguments with these as k and c.

    Without such an engine, None and the arguments unchanged.
    """
    names, name = ("solref", "solimp"), said.get("from_engine")
    values = {**{x: said.get(x) for x in names}, **(said.get("parameters") or {})}
    values = {x: value for x, value in values.items() if value is not None}
    if name is None:
        if values:
            first = next(iter(values))
            what = f"{{{first}}}" if first in names else f"{{parameters}} {first}"
            raise ParameterError(f"{what} needs {{from_engine}}, the name of the engine")
        return None, dict(said)
    source = Source(engine_named(name), values)
    for other in (*STIFF, *LOSSY, "law"):
        if said.get(other) is not None:
            raise ParameterError(f"{{{other}}} is not allowed with {{from_engine}}")
    mass, rule = said.get("mass"), said.get("release")
    mass = None if mass is None else number("mass", mass, Unit("kg", "20 g"))
    contact = source.engine.contact(values, mass)
    # If the contact is written for another engine, that engine determines the release.
    rule = rule if said.get("engine") else str(source.engine.release(rule))
    return source, {**said, **contact._asdict(), "mass": mass, "release": rule}

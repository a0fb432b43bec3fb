"""Contacts that are given by the parameters of a physics engine."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any, NamedTuple

from bouncing_ball.calculator.case import Case
from bouncing_ball.calculator.contact_data import LOSSY, STIFF, with_law
from bouncing_ball.calculator.units import Unit, number
from bouncing_ball.contacts.release import Release
from bouncing_ball.engines import engine_named
from bouncing_ball.engines.engine import Engine, Physical
from bouncing_ball.errors import ParameterError


class Source(NamedTuple):
    """An engine, the given parameters of its contact, and the spring and damper of these."""

    engine: Engine
    parameters: dict[str, Any]
    contact: Physical

    def case(self, case: Case, asked: Sequence[int], written: bool) -> Case:
        """The case with the law of this contact, or with its linear contact if this is written."""
        law = self.engine.law(self.parameters, case.mass, case.table.time, case.table.length)
        if law is not None and self.engine.needs_speed:
            case = with_law(case, law, asked)
        return replace(case, law=None if written else law)

    def remarks(self, written: str | None, release: Release) -> tuple[str, ...]:
        """Sentences on how the contact differs from a spring and a damper, and on how r changes if
        it is written for the engine with this name and release.
        """
        found, ends = self.engine.remarks(self.parameters), (self.engine.release(), release)
        if written is None or ends[0] is ends[1] or not 0 < self.contact.damping_ratio < 1:
            return found
        before, after = (f"{self.contact.restitution(rule):.4f}" for rule in ends)
        why = f"contacts end by {ends[0]} in {self.engine.name}, and by {release} in {written}"
        return (*found, f"r changes from {before} to {after}, because {why}")


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
    engine = engine_named(name).reader(values)
    for other in (*STIFF, *LOSSY, "law"):
        if said.get(other) is not None:
            raise ParameterError(f"{{{other}}} is not allowed with {{from_engine}}")
    mass, rule = said.get("mass"), said.get("release")
    mass = None if mass is None else number("mass", mass, Unit("kg", "20 g"))
    source = Source(engine, values, engine.contact(values, mass))
    # Written for another engine, the contact ends as there; otherwise as here, or as a law's.
    rule = rule if said.get("engine") or engine.needs_speed else str(engine.release(rule))
    return source, {**said, **source.contact._asdict(), "mass": mass, "release": rule}

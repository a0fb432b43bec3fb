"""The contact that the parameters of a physics engine give, and that which an engine is given.

An engine computes with a stiffness k and a damping c, which are found from its parameters. Written
for another engine, a contact ends as there.
"""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any, NamedTuple

from bouncing_ball.contacts.case import PhysicalCase
from bouncing_ball.contacts.contact_data import (
    LOSSY,
    STIFF,
    require_own_release,
    rule_of,
    with_law,
)
from bouncing_ball.contacts.engines.choice import engine_named
from bouncing_ball.contacts.engines.engine import Engine
from bouncing_ball.contacts.engines.physical import Physical
from bouncing_ball.contacts.given import Contact
from bouncing_ball.errors import ParameterError
from bouncing_ball.models.damping import Release

# Parameters of MuJoCo that are lists; each of them is a separate argument.
_OF_MUJOCO = ("solref", "solimp")


class Source(NamedTuple):
    """An engine, the given parameters of its contact, and the spring and damper of these."""

    engine: Engine
    parameters: dict[str, Any]
    contact: Physical

    def case(self, case: PhysicalCase, asked: Sequence[int], written: bool) -> PhysicalCase:
        """The case with the law of this contact, or with its linear contact if this is written."""
        law = self.engine.law(self.parameters, case.mass, case.table.time, case.table.length)
        if law is not None and self.engine.needs_speed:
            case = with_law(case, law, asked)
        return replace(case, law=None if written else law)

    def remarks(self, written: str | None, release: Release) -> tuple[str, ...]:
        """Sentences on how the contact differs from a spring and a damper, and on how r changes if
        it is written for the engine with this name and release.
        """
        found = self.engine.remarks(self.parameters)
        own_release = self.engine.release()
        same = written is None or own_release is release
        if same or not 0 < self.contact.damping_ratio < 1:
            return found
        before = f"{self.contact.restitution(own_release):.4f}"
        after = f"{self.contact.restitution(release):.4f}"
        why = f"contacts end by {own_release} in {self.engine.name}, and by {release} in {written}"
        return (*found, f"r changes from {before} to {after}, because {why}")


class Ready(NamedTuple):
    """A contact by other parameters than those of an engine, with what is said about it.

    ``source`` is the engine whose parameters were given, and ``written`` the name of the engine for
    which the contact is written; both may be None.
    """

    contact: Contact
    source: Source | None
    written: str | None
    remarks: tuple[str, ...]

    @property
    def needs_speed(self) -> bool:
        """Whether r depends on the impact speed, because an engine's damper does."""
        return self.source is not None and self.source.engine.needs_speed

    @property
    def engine(self) -> str:
        """Name of the engine whose parameters were given; empty if there is none."""
        return "" if self.source is None else self.source.engine.name

    def case(self, case: PhysicalCase, families: Sequence[int]) -> PhysicalCase:
        """The case with the law of the engine whose parameters were given, if it has one."""
        if self.source is None:
            return case
        # For another engine the spring and damper is written in place of the law.
        return self.source.case(case, families, self.written is not None)


def ready(contact: Contact, written: str | None = None) -> Ready:
    """A contact as it ends in the engine for which it is written, in its own engine, or by itself.

    Raises
    ------
    ModelError
        If a parameter is missing or not allowed, or an engine has no such contact.

    Examples
    --------
    >>> solref = Contact(mass=0.5, from_engine="mujoco", solref="-200 -4", solimp="1e-4 1e-4")
    >>> found = ready(solref).contact
    >>> found.stiffness, found.damping, found.release
    (100.0, 2.0, 'force')
    """
    require_own_release(contact)
    values = _engine_values(contact)
    if contact.from_engine is None:
        if values:
            first = next(iter(values))
            what = f"{{{first}}}" if first in _OF_MUJOCO else f"{{parameters}} {first}"
            raise ParameterError(f"{what} needs {{from_engine}}, the name of the engine")
        plain = contact if written is None else contact.in_engine(written)
        return Ready(plain, None, written, ())
    engine = engine_named(contact.from_engine).reader(values)
    for other in (*STIFF, *LOSSY, "law"):
        if getattr(contact, other) is not None:
            raise ParameterError(f"{{{other}}} is not allowed with {{from_engine}}")
    source = Source(engine, values, engine.contact(values, contact.mass))
    mass, stiffness, damping = source.contact
    plain = Contact(mass=mass, stiffness=stiffness, damping=damping, release=contact.release)
    # Written for another engine, the contact ends as there; otherwise as here, or as a law's.
    if written is not None:
        plain = plain.in_engine(written)
    elif not engine.needs_speed:
        plain = replace(plain, release=str(engine.release(contact.release)))
    return Ready(plain, source, written, source.remarks(written, rule_of(plain)))


def _engine_values(contact: Contact) -> dict[str, Any]:
    """The parameters of an engine that are given, by name."""
    values = {name: getattr(contact, name) for name in _OF_MUJOCO}
    values |= contact.parameters or {}
    return {name: value for name, value in values.items() if value is not None}

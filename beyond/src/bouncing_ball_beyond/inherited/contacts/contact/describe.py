"""A contact without a table: its numbers."""

from dataclasses import dataclass
from typing import Annotated, ClassVar

from bouncing_ball_beyond.inherited.contacts.contact.contact import Contact
from bouncing_ball_beyond.inherited.contacts.contact.drops import deep
from bouncing_ball_beyond.inherited.contacts.contact.numbers_of_contact import NumbersOfContact
from bouncing_ball_beyond.inherited.contacts.contact.quantities import (
    Gravity,
    Speed,
    check_kinds,
    quantities,
)
from bouncing_ball_beyond.inherited.contacts.contact.remarks import force_formula, remarks
from bouncing_ball_beyond.inherited.contacts.contact.resolve import needs_table, resolve
from bouncing_ball_beyond.inherited.contacts.contact.resolved import ResolvedContact
from bouncing_ball_beyond.inherited.contacts.contact.rows import Listed
from bouncing_ball_beyond.inherited.contacts.contact.table import TableMotion
from bouncing_ball_beyond.inherited.contacts.contact.texts import shown
from bouncing_ball_beyond.inherited.contacts.contact.units import in_si
from bouncing_ball_beyond.inherited.errors import ModelError, suggesting

LONGEST = 1000.0
"""The longest contact in s that is taken for one: no simulation has a longer one."""


@dataclass(frozen=True, repr=False)
class Description(NumbersOfContact):
    """A contact without a table, in SI units.

    What depends on the impact speed is None if that is not known. The r and the contact time of a
    law are those of one impact speed, and stiffness, damping and ζ those of the linear contact with
    the same two and the same ``release``.
    """

    KEYS: ClassVar[tuple[str, ...]] = (
        "mass", "stiffness", "damping", "damping_ratio", "natural_frequency", "contact_time",
        "release", "measured_restitution", "slowed_speed", "static_deflection", "law", "notes",
    )  # fmt: skip

    # Its units are those of a table at rest, which nobody gave.
    case: ResolvedContact

    def __repr__(self) -> str:
        """The numbers of the contact, without the sentences on it."""
        shown = (
            "mass", "stiffness", "natural_frequency", "release", "damping", "damping_ratio",
            "contact_time", "measured_restitution", "slowed_speed", "static_deflection", "law",
        )  # fmt: skip
        return f"Description({', '.join(f'{name}={getattr(self, name)!r}' for name in shown)})"

    @property
    def natural_frequency(self) -> Annotated[float, Listed("natural frequency ω", "rad/s")]:
        """ω = √(k/m) in rad/s: on a table that moves with Ω it gives ϖ = ω/Ω."""
        return self.case.omega

    @property
    def damping(self) -> Annotated[float | None, Listed("damping", "N s/m")]:
        """c in N s/m."""
        return None if self.case.lacks_speed else self.case.damping

    @property
    def damping_ratio(self) -> Annotated[float | None, Listed("damping ratio ζ")]:
        """ζ = c/(2√(km))."""
        return None if self.case.lacks_speed else float(self.case.equivalent.damping_ratio)

    @property
    def contact_time(self) -> Annotated[float | None, Listed("contact time", "s")]:
        """Duration of a free impact in s."""
        return None if self.case.lacks_speed or self.case.holds else self.case.contact_time

    @property
    def measured_restitution(
        self,
    ) -> Annotated[float | None, Listed("restitution of a free impact")]:
        """r of a free impact."""
        return None if self.case.lacks_speed else self.case.restitution

    @property
    def static_deflection(self) -> Annotated[float, Listed("depth at rest", "m")]:
        """How deep the ball lies at rest, in m."""
        return self.case.static_deflection

    @property
    def notes(self) -> tuple[str, ...]:
        """Sentences on how the contact was read."""
        sunk = deep(self.static_deflection, self.case.given.radius, "at rest")
        return remarks(self.case) + force_formula(self.case) + sunk


@suggesting
def describe_contact(contact: Contact, gravity: Gravity = None, speed: Speed = None) -> Description:
    """The numbers of a contact without a table.

    Parameters
    ----------
    contact : Contact
        With its stiffness and its loss, or the parameters of a physics engine.
    gravity
        Acceleration of gravity, by default 9.80665 m/s².
    speed
        Speed of a free impact, for a Hertz contact or another law, whose contact time or r depends
        on it.

    Raises
    ------
    ModelError
        If a parameter is missing, out of range or contradicts another.

    Examples
    --------
    >>> found = describe_contact(Contact(mass=0.5, from_engine="mujoco", solref="0.02 0.3"))
    >>> round(found.stiffness, 6), round(found.damping, 6), round(found.measured_restitution, 4)
    (13888.888889, 50.0, 0.451)
    """
    check_kinds("describe_contact", contact=(contact, Contact))
    kinds = quantities(describe_contact)
    if gravity is not None:
        gravity = in_si("gravity", gravity, kinds["gravity"])
    if speed is not None:
        speed = in_si("speed", speed, kinds["speed"])
    return description_of(resolve(contact, TableMotion.at_rest(gravity), speed=speed))


def description_of(case: ResolvedContact) -> Description:
    """The numbers of a contact on a table at rest.

    Raises
    ------
    ModelError
        If the contact is longer than any that is simulated, or is to be written for an engine
        whereas its r depends on the speed.
    """
    if case.holds:
        return Description(case)
    if not case.lacks_speed:
        require_short(case.contact_time)
    elif case.written is not None:
        raise needs_table(f"{{from_engine}} {case.given.from_engine}", "r")
    return Description(case)


def require_short(contact_time: float) -> None:
    """Refuse a contact that is too long for any simulation.

    Raises
    ------
    ModelError
        The message gives the contact time and the longest one.
    """
    if contact_time > LONGEST:
        raise ModelError(
            f"a contact of {shown(contact_time, 's')} is longer than any that is simulated, up to "
            f"{LONGEST:g} s: check the mass, the stiffness and their units"
        )

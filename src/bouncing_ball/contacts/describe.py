"""A contact without a table: its numbers."""

from dataclasses import dataclass, field, replace
from typing import Annotated, Any, ClassVar

from bouncing_ball.contacts.contact import Contact
from bouncing_ball.contacts.drops import deep
from bouncing_ball.contacts.notes import force_formula, remarks
from bouncing_ball.contacts.quantities import Gravity, Speed, check_kinds, quantities
from bouncing_ball.contacts.resolve import needs_table, resolve
from bouncing_ball.contacts.resolved import ResolvedContact
from bouncing_ball.contacts.rows import Listed
from bouncing_ball.contacts.table import TableMotion
from bouncing_ball.contacts.texts import shown
from bouncing_ball.contacts.units import in_si
from bouncing_ball.errors import ModelError, suggesting

LONGEST = 1000.0
"""The longest contact in s that is taken for one: no simulation has a longer one."""


@dataclass(frozen=True)
class Description:
    """A contact without a table, in SI units.

    ``natural_frequency`` is ω = √(k/m) in rad/s: on a table that moves with Ω it gives ϖ = ω/Ω.
    What depends on the impact speed is None. The r of a free impact holds at speeds above
    ``slowed_speed``: there, on a table at rest, gravity lowers √(h′/h) by 1 %, and at slower
    impacts by more. It is None without damping. At rest the ball lies ``static_deflection`` below
    the level at which it meets the table. ``law`` has the ``name`` of a contact law and its
    parameters, whose units are powers of kg, m and s; its r and contact time are those of one
    impact speed, and stiffness, damping and ζ those of the linear contact with the same two and
    the same ``release``.
    """

    KEYS: ClassVar[tuple[str, ...]] = (
        "mass", "stiffness", "damping", "damping_ratio", "natural_frequency", "contact_time",
        "release", "measured_restitution", "slowed_speed", "static_deflection", "law", "notes",
    )  # fmt: skip

    mass: Annotated[float, Listed("mass in kg")]
    stiffness: Annotated[float, Listed("stiffness", "N/m")]
    natural_frequency: Annotated[float, Listed("natural frequency ω", "rad/s")]
    release: str
    # Its units are those of a table at rest, which nobody gave.
    case: ResolvedContact = field(repr=False)
    damping: Annotated[float | None, Listed("damping", "N s/m")] = None
    damping_ratio: Annotated[float | None, Listed("damping ratio ζ")] = None
    contact_time: Annotated[float | None, Listed("contact time", "s")] = None
    measured_restitution: Annotated[float | None, Listed("restitution of a free impact")] = None
    slowed_speed: Annotated[float | None, Listed("gravity lowers r by 1 % at", "m/s")] = None
    static_deflection: Annotated[float | None, Listed("depth at rest", "m")] = None
    law: dict[str, Any] | None = None

    @property
    def notes(self) -> tuple[str, ...]:
        """Sentences on how the contact was read."""
        depth = self.static_deflection
        sunk = () if depth is None else deep(depth, self.case.given.radius, "at rest")
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
    release = case.equivalent.release
    found = Description(
        mass=case.mass,
        stiffness=case.stiffness,
        natural_frequency=case.omega,
        release=str(release),
        case=case,
    )
    if case.lacks_speed:
        if case.written is not None:
            raise needs_table(f"{{from_engine}} {case.given.from_engine}", "r")
        return replace(found, static_deflection=case.static_deflection)
    time = case.contact_time
    restitution = float(case.equivalent.restitution)
    if not case.is_linear and case.impact_speed is not None:
        impact = case.law.signature(case.impact_speed * case.table.time / case.table.length)
        time = float(impact.duration) * case.table.time
        restitution = float(impact.restitution)
    require_short(time)
    return replace(
        found,
        damping=case.damping,
        damping_ratio=float(case.equivalent.damping_ratio),
        contact_time=time,
        measured_restitution=restitution,
        slowed_speed=case.slowed_speed,
        static_deflection=case.static_deflection,
        law=case.law_in_si,
    )


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

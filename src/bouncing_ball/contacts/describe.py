"""A contact without a table: its numbers, and drops on a table at rest."""

import math
from dataclasses import dataclass, replace
from typing import Annotated, ClassVar

from bouncing_ball.contacts.contact import Contact
from bouncing_ball.contacts.drop_test import rebound
from bouncing_ball.contacts.notes import remarks
from bouncing_ball.contacts.quantities import Gravity, Speed, check_kind, quantities
from bouncing_ball.contacts.resolve import needs_table, resolve
from bouncing_ball.contacts.resolved import ResolvedContact
from bouncing_ball.contacts.rows import Listed
from bouncing_ball.contacts.table import TableMotion
from bouncing_ball.contacts.texts import shown
from bouncing_ball.contacts.units import in_si
from bouncing_ball.errors import ModelError, ParameterError

LONGEST = 1000.0
"""The longest contact in s that is taken for one: no simulation has a longer one."""


@dataclass(frozen=True)
class Description:
    """A contact without a table, in SI units.

    ``natural_frequency`` is ω = √(k/m) in rad/s: on a table that moves with Ω it gives ϖ = ω/Ω.
    What depends on the impact speed is None. The r of a free impact holds at speeds above
    ``slowed_speed``: there, on a table at rest, gravity lowers √(h′/h) by 1 %, and at slower
    impacts by more. It is None without damping.
    """

    KEYS: ClassVar[tuple[str, ...]] = (
        "mass", "stiffness", "damping", "damping_ratio", "natural_frequency", "contact_time",
        "release", "measured_restitution", "slowed_speed", "notes",
    )  # fmt: skip

    mass: Annotated[float, Listed("mass in kg")]
    stiffness: Annotated[float, Listed("stiffness", "N/m")]
    natural_frequency: Annotated[float, Listed("natural frequency ω = ϖΩ", "rad/s")]
    release: str
    case: ResolvedContact
    damping: Annotated[float | None, Listed("damping", "N s/m")] = None
    damping_ratio: Annotated[float | None, Listed("damping ratio ζ")] = None
    contact_time: Annotated[float | None, Listed("contact time", "s")] = None
    measured_restitution: Annotated[float | None, Listed("restitution of a free impact")] = None
    slowed_speed: Annotated[float | None, Listed("gravity lowers r by 1 % at", "m/s")] = None

    @property
    def notes(self) -> tuple[str, ...]:
        """Sentences on how the contact was read."""
        return remarks(self.case)


@dataclass(frozen=True)
class Dropped:
    """A ball that is dropped onto a table at rest, in SI units.

    ``restitution`` is √(h′/h), the square root of the height of the rebound over that of the drop.
    It is smaller than the r of a free impact, because gravity acts in the contact. A ball that does
    not rebound has 0.
    """

    speed: Annotated[float, Listed("impact speed of a drop", "m/s")]
    drop_height: Annotated[float, Listed("  dropped from", "m")]
    rebound_height: Annotated[float, Listed("  rises to", "m")]
    restitution: Annotated[float, Listed("  restitution √(h′/h) with gravity")]
    at_half: Annotated[float, Listed("  the same at half the speed")]
    at_tenth: Annotated[float, Listed("  the same at a tenth of the speed")]


def describe_contact(contact: Contact, gravity: Gravity = None) -> Description:
    """The numbers of a contact without a table.

    Parameters
    ----------
    contact : Contact
        With its stiffness and its loss, or the parameters of a physics engine.
    gravity
        Acceleration of gravity, by default 9.80665 m/s².

    Raises
    ------
    ModelError
        If a parameter is missing, out of range or contradicts another, or r depends on the impact
        speed.

    Examples
    --------
    >>> found = describe_contact(Contact(mass=0.5, from_engine="mujoco", solref="0.02 0.3"))
    >>> round(found.stiffness, 6), round(found.damping, 6), round(found.measured_restitution, 4)
    (13888.888889, 50.0, 0.451)
    """
    check_kind("contact", contact, Contact)
    if gravity is not None:
        gravity = in_si("gravity", gravity, quantities(describe_contact)["gravity"])
    return describe(resolve(contact, TableMotion.at_rest(gravity)))


def describe(case: ResolvedContact) -> Description:
    """The numbers of a contact on a table at rest.

    Raises
    ------
    ModelError
        If the contact is longer than any that is simulated, or is to be written for an engine
        whereas its r depends on the speed.
    """
    release = case.contact.release
    found = Description(
        mass=case.mass,
        stiffness=case.stiffness,
        natural_frequency=case.omega,
        release=str(release),
        case=case,
    )
    if case.needs_speed:
        if case.written is not None:
            raise needs_table(f"{{from_engine}} {case.given.from_engine}", "r")
        return found
    time = case.physical.contact_time(release)
    require_short(time)
    return replace(
        found,
        damping=case.damping,
        damping_ratio=float(case.contact.damping_ratio),
        contact_time=time,
        measured_restitution=case.physical.restitution(release),
        slowed_speed=case.slowed_speed,
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


def drop_at_rest(case: ResolvedContact, speed: Speed) -> Dropped:
    """A drop onto a table at rest.

    Parameters
    ----------
    case : ResolvedContact
        A spring and a damper.
    speed
        Speed of an impact on a table at rest: the answer then has the heights of this drop and its
        restitution with gravity, also at half and at a tenth of the speed.

    Raises
    ------
    ModelError
        If the contact is another law, or if ζ ≥ 1: such a contact is not computed with gravity.

    Examples
    --------
    >>> case = resolve(Contact(mass=0.02, stiffness=1e4, damping=4.0, release="force"),
    ...                TableMotion.at_rest(9.81))
    >>> found = drop_at_rest(case, 2.0)
    >>> round(found.drop_height, 4), round(found.restitution, 4), round(found.at_tenth, 4)
    (0.2039, 0.6615, 0.6297)
    """
    if case.law is not None or (case.table.is_at_rest and case.needs_speed):
        raise ParameterError("{speed} needs a spring and a damper: this r depends on the law")
    contact = case.physical
    zeta = contact.damping_ratio
    if zeta >= 1:
        raise ParameterError(f"{{speed}} needs a damping ratio below 1, and this is {zeta:.4g}")
    gravity = case.table.gravity

    def rise(velocity: float) -> float:
        height = velocity**2 / (2 * gravity)
        found = rebound(contact.angular_frequency, zeta, height, gravity, case.contact.release)
        return max(found or 0.0, 0.0)

    def ratio(velocity: float) -> float:
        return math.sqrt(2 * gravity * rise(velocity)) / velocity

    return Dropped(
        speed=speed,
        drop_height=speed**2 / (2 * gravity),
        rebound_height=rise(speed),
        restitution=ratio(speed),
        at_half=ratio(speed / 2),
        at_tenth=ratio(speed / 10),
    )

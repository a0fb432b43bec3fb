"""A contact without a table: its numbers, the drop tests on it, and the longest one allowed."""

import math

from bouncing_ball.contacts.case import PhysicalCase, TableMotion
from bouncing_ball.contacts.contact_data import case_of
from bouncing_ball.contacts.drop_test import rebound, slowed_speed
from bouncing_ball.contacts.engine_data import Ready
from bouncing_ball.contacts.engines.physical import Physical
from bouncing_ball.contacts.given import STANDARD_GRAVITY, Contact
from bouncing_ball.contacts.results import Dropped, LoneContact
from bouncing_ball.contacts.units import shown
from bouncing_ball.errors import ModelError, ParameterError
from bouncing_ball.models.damping import Release

LONGEST = 1000.0
"""The longest contact in s that is taken for one: no simulation has a longer one."""


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


def lone_contact(ready: Ready, gravity: float | None) -> LoneContact:
    """The numbers of a contact without a table, by which there is no impact speed.

    Raises
    ------
    ModelError
        If parameters are missing, or r depends on the impact speed.
    """
    contact = ready.contact
    # With a table of 1 rad/s the frequency ratio is the frequency of the contact.
    case = case_of(contact, TableMotion(1.0, 1.0, gravity or STANDARD_GRAVITY), [1])
    needs_speed = ready.needs_speed or case.law is not None
    if needs_speed and (contact.law or ready.written):
        what = "{law}" if contact.law else f"{{from_engine}} {ready.engine}"
        needs = "a table, such as {frequency} and {acceleration}"
        raise ParameterError(f"{what} needs {needs}: r depends on the speed")
    release = case.contact.release
    zeta = float(case.contact.damping_ratio)
    omega = float(case.contact.frequency_ratio)
    stiffness = contact.stiffness or case.mass * omega**2
    damping = 2 * zeta * case.mass * omega if contact.damping is None else contact.damping
    physical = Physical(case.mass, stiffness, damping)
    if needs_speed:
        return LoneContact(
            mass=physical.mass,
            stiffness=stiffness,
            damping=None,
            damping_ratio=None,
            natural_frequency=omega,
            contact_time=None,
            release=str(release),
            measured_restitution=None,
            slowed_speed=None,
            notes=ready.remarks,
        )
    require_short(physical.contact_time(release))
    return LoneContact(
        mass=physical.mass,
        stiffness=stiffness,
        damping=damping,
        damping_ratio=zeta,
        natural_frequency=omega,
        contact_time=physical.contact_time(release),
        release=str(release),
        measured_restitution=physical.restitution(release),
        slowed_speed=slowed(case),
        notes=ready.remarks + drop_remarks(case, contact),
    )


def physical(found: LoneContact) -> Physical:
    """The mass, stiffness and damping of a contact whose damping is known."""
    # A contact whose damping depends on the speed has none in slow impacts.
    return Physical(found.mass, found.stiffness, found.damping or 0.0)


def slowed(case: PhysicalCase) -> float | None:
    """The impact speed in m/s at which gravity lowers the r of a linear contact by 1 %."""
    contact = case.contact
    if case.law is not None or contact.damping_ratio >= 1:
        return None
    omega = float(contact.frequency_ratio) * case.table.angular_frequency
    zeta = float(contact.damping_ratio)
    r = float(contact.restitution)
    return slowed_speed(omega, zeta, r, case.table.gravity, contact.release)


def drop_remarks(case: PhysicalCase, given: Contact) -> tuple[str, ...]:
    """A sentence on the drop test that was given, if one was, and on its restitution."""
    drop = given.drop_height
    height = given.rebound_height
    if drop is None or height is None:
        return ()
    r = math.sqrt(height / drop)
    if case.law is not None:
        return (f"the drop test is read without gravity, as r = √(h′/h) = {r:.4g}, for this law",)
    arrives = shown(math.sqrt(2 * case.table.gravity * drop), "m/s")
    free = float(case.contact.restitution)
    return (
        f"dropped from {shown(drop, 'm')} onto a table at rest, at {arrives}, the ball rises to "
        f"{shown(height, 'm')}: √(h′/h) = {r:.4g}, and r = {free:.4g} without gravity",
    )


def dropped(contact: Physical, release: Release, gravity: float | None, speed: float) -> Dropped:
    """A drop onto a table at rest with an impact speed in m/s.

    Raises
    ------
    ModelError
        If ζ ≥ 1: such a contact is not computed with gravity.

    Examples
    --------
    >>> ball = Physical(0.02, 1e4, 4.0)
    >>> found = dropped(ball, Release.FORCE, 9.81, 2.0)
    >>> round(found.drop_height, 4), round(found.restitution, 4), round(found.at_tenth, 4)
    (0.2039, 0.6615, 0.6297)
    """
    if contact.damping_ratio >= 1:
        zeta = contact.damping_ratio
        raise ParameterError(f"{{speed}} needs a damping ratio below 1, and this is {zeta:.4g}")
    pull = gravity or STANDARD_GRAVITY
    omega = contact.angular_frequency
    zeta = contact.damping_ratio

    def rise(velocity: float) -> float:
        height = velocity**2 / (2 * pull)
        return max(rebound(omega, zeta, height, pull, release) or 0.0, 0.0)

    def ratio(velocity: float) -> float:
        return math.sqrt(2 * pull * rise(velocity)) / velocity

    return Dropped(
        speed=speed,
        drop_height=speed**2 / (2 * pull),
        rebound_height=rise(speed),
        restitution=ratio(speed),
        at_half=ratio(speed / 2),
        at_tenth=ratio(speed / 10),
    )

"""A ball that is dropped onto a table at rest: its rises, its depth, and the force on it."""

import math
from dataclasses import dataclass, replace
from typing import Annotated

import numpy as np

from bouncing_ball_beyond.inherited.contacts.contact.quantities import Speed
from bouncing_ball_beyond.inherited.contacts.contact.rebounds import SLOWED, compression, rises
from bouncing_ball_beyond.inherited.contacts.contact.resolved import ResolvedContact
from bouncing_ball_beyond.inherited.contacts.contact.rows import Listed
from bouncing_ball_beyond.inherited.contacts.contact.texts import shown

# The share of the radius up to which a sphere is hardly deformed.
_SHALLOW = 0.1
# The depth in m above which a ball of any size sinks in too far.
_DEEPEST = 0.1


@dataclass(frozen=True)
class Dropped:
    """A ball that is dropped onto a table at rest, in SI units.

    ``restitution`` is √(h′/h), the square root of the height of the rebound over that of the drop.
    It is smaller than the r of a free impact, because gravity acts in the contact. A ball that does
    not rebound has 0. ``greatest_compression`` is how far the ball sinks in below the level at
    which it meets the table, and ``peak_force`` the greatest force on it. ``second_rise`` and
    ``third_rise`` are those of the next two bounces.
    """

    speed: Annotated[float, Listed("impact speed of a drop", "m/s")]
    drop_height: Annotated[float, Listed("  dropped from", "m")]
    rebound_height: Annotated[float, Listed("  rises to", "m")]
    second_rise: Annotated[float, Listed("  then to", "m")]
    third_rise: Annotated[float, Listed("  and to", "m")]
    restitution: Annotated[float, Listed("  restitution √(h′/h) with gravity")]
    at_half: Annotated[float, Listed("  the same at half the speed")]
    at_tenth: Annotated[float, Listed("  the same at a tenth of the speed")]
    greatest_compression: Annotated[float, Listed("  greatest compression", "m")]
    peak_force: Annotated[float, Listed("  peak force", "N")]
    remarks: tuple[str, ...] = ()


def drop_at_rest(case: ResolvedContact, speed: Speed) -> Dropped:
    """A drop onto a table at rest.

    Parameters
    ----------
    case : ResolvedContact
    speed
        Speed of an impact on a table at rest: the answer then has the heights of this drop and its
        restitution with gravity, also at half and at a tenth of the speed, how deep the ball sinks
        in, and the peak force. A contact law without a table is that of an impact with this speed.

    Examples
    --------
    >>> from bouncing_ball_beyond.inherited.contacts.contact.contact import Contact
    >>> from bouncing_ball_beyond.inherited.contacts.contact.resolve import resolve
    >>> from bouncing_ball_beyond.inherited.contacts.contact.table import TableMotion
    >>> case = resolve(Contact(mass=0.02, stiffness=1e4, damping=4.0, release="force"),
    ...                TableMotion.at_rest(9.81))
    >>> found = drop_at_rest(case, 2.0)
    >>> round(found.drop_height, 4), round(found.restitution, 4), round(found.at_tenth, 4)
    (0.2039, 0.6615, 0.6297)
    """
    law = case.law
    unit = case.unit_speed
    length = case.table.length
    first, half, tenth = rises(law, np.array([1.0, 0.5, 0.1]) * speed / unit)
    # Each bounce arrives with the speed of its rise.
    second = rises(law, np.array([math.sqrt(2 * first)]))[0] if first > 0 else 0.0
    third = rises(law, np.array([math.sqrt(2 * second)]))[0] if second > 0 else 0.0
    depth, force = compression(law, speed / unit)
    of = speed / unit
    found = Dropped(
        speed=speed,
        drop_height=speed**2 / (2 * case.table.gravity),
        rebound_height=float(first) * length,
        second_rise=float(second) * length,
        third_rise=float(third) * length,
        restitution=math.sqrt(2 * first) / of,
        at_half=math.sqrt(2 * half) / (of / 2),
        at_tenth=math.sqrt(2 * tenth) / (of / 10),
        greatest_compression=depth * length,
        peak_force=force * case.mass * case.table.gravity,
    )
    return replace(found, remarks=_remarks(case, found))


def deep(depth: float, radius: float | None, when: str) -> tuple[str, ...]:
    """A sentence on a compression that is not small against the radius, or if that is not known
    deeper than any that is meant.

    Examples
    --------
    >>> deep(49.03, None, "at rest")
    ('at rest the ball sinks in by 49.03 m: check the stiffness, the mass and their units',)
    """
    if radius is None:
        if depth <= _DEEPEST:
            return ()
        check = "check the stiffness, the mass and their units"
        return (f"{when} the ball sinks in by {shown(depth, 'm')}: {check}",)
    if depth <= _SHALLOW * radius:
        return ()
    share = (
        f"{when} the ball sinks in by {shown(depth, 'm')}, {shown(depth / radius, '%')} of its "
        "radius"
    )
    if depth < radius:
        return (f"{share}: this contact is too compliant for a sphere",)
    return (f"{share}: its centre passes the table, where engines lose it: take a stiffer contact",)


def _remarks(case: ResolvedContact, found: Dropped) -> tuple[str, ...]:
    """What a user should know of a drop: gravity rules it, or the ball sinks in deeply."""
    said = deep(found.greatest_compression, case.given.radius, "in this drop")
    resting = shown(case.static_deflection, "m")
    # The damper is the reason, which another sentence gives.
    if case.holds:
        return said
    if found.restitution == 0:
        return (
            *said,
            f"gravity rules this contact: the ball does not rebound, it rests {resting} deep",
        )
    free = float(case.law.signature(found.speed / case.table.length * case.table.time).restitution)
    if found.restitution < (1 - 10 * SLOWED) * free:
        less = shown(1 - found.restitution / free, "%")
        why = f"√(h′/h) is {less} below the r of a free impact, {free:.4g}"
        return (*said, f"gravity rules this contact: {why}, and the ball rests {resting} deep")
    return said

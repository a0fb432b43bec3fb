"""A bounce: a body that falls on a surface."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from itertools import combinations
from typing import Any

from bouncing_ball_contacts.units import (
    DENSITIES,
    STANDARD_GRAVITY,
    Refused,
    density_of,
    holding,
    in_si,
    positive,
    refuse,
    show,
    step_in_si,
    within,
)

Quantity = Any
"""A number in SI units, or a text with a unit."""

_QUANTITIES: Mapping[str, tuple[str, Callable[[str, Quantity, str], float]]] = {
    "mass": ("kg", positive),
    "restitution": ("", lambda name, value, _: within(name, value, 0, 1)),
    "drop_height": ("m", positive),
    "speed": ("m/s", positive),
    "radius": ("m", positive),
    "density": ("kg/m^3", lambda _, value, __: density_of(value)),
    "penetration": ("m", positive),
    "stiffness": ("N/m", positive),
    "contact_time": ("s", positive),
    "points": ("", lambda _, value, __: value),
    "friction": ("", lambda name, value, _: within(name, value, 0, math.inf)),
    "gravity": ("m/s^2", in_si),
}
"""The unit of each quantity of a bounce, and how it is read."""
_CONTACT = ("penetration", "stiffness", "contact_time")
_EITHER = (("drop_height", "speed"), *combinations(_CONTACT, 2))
"""Pairs of quantities of which at most one is given."""
_FOAM = 25.0
"""Density in kg/m³ below which a number without a unit may be one in g/cm³, up to osmium's 22.6."""


def _is_bare(typed: Quantity) -> bool:
    """Whether a text is a number without a unit."""
    try:
        return isinstance(typed, str) and math.isfinite(float(typed))
    except ValueError:
        return False


@dataclass(frozen=True)
class Bounce:
    """Bounce that is wanted: a body falls on a surface.

    Give quantities as numbers in SI units, or as texts with units. The attributes are numbers in SI
    units.

    Parameters
    ----------
    mass, restitution : Quantity
        The restitution coefficient is √(h′/h) of the drop, 0 to 1.
    drop_height, speed : Quantity, optional
        One of both; by default a drop from 1 m.
    radius, density : Quantity, optional
        Radius and density of the body; both replace the mass. The density may be the name of
        a material. By default the body is a solid ball of steel.
    penetration, stiffness, contact_time : Quantity, optional
        At most one of them: the depth that must not be exceeded, or the contact itself. By default
        the penetration is at most a tenth of the radius and a fifth of the drop height.
    points : int
        The number of contact points that share the force, 4 for the face of a box. Without a radius
        a body with several points is a cube.
    friction : Quantity, optional
        The coefficient of friction, for the snippet and a word of warning; r is computed without.
    gravity : Quantity
        0 for an impact without gravity, as on a vertical wall; it needs the speed.

    Raises
    ------
    Refused
        If a quantity cannot be read, is out of its range, or contradicts another one.
    """

    mass: Quantity = None
    restitution: Quantity = None
    drop_height: Quantity = None
    speed: Quantity = None
    radius: Quantity = None
    density: Quantity = None
    penetration: Quantity = None
    stiffness: Quantity = None
    contact_time: Quantity = None
    points: int = 1
    friction: Quantity = None
    gravity: Quantity = STANDARD_GRAVITY
    given: Mapping[str, str] = field(init=False, repr=False, compare=False)
    """Quantities that were given, as text."""

    def __post_init__(self) -> None:
        refuse(
            [
                (
                    None not in (self.mass, self.radius, self.density),
                    "give two of mass, radius and density, not all of them",
                ),
                (
                    not isinstance(self.points, int) or not 1 <= self.points <= 1000,
                    f"points = {self.points!r} is no whole number from 1 to 1000",
                ),
            ]
        )
        density = self.density
        given = {}
        for name, (unit, read) in _QUANTITIES.items():
            default = getattr(Bounce, name)
            value = getattr(self, name)
            if value is not None or default is not None:
                words = name.replace("_", " ")
                number = read(words, value, unit)
                object.__setattr__(self, name, number)
                if number != default:
                    given[words] = show(number, unit, 6)
        object.__setattr__(self, "given", given)
        refuse(
            [
                (
                    _is_bare(density) and (self.density or math.inf) < _FOAM,
                    f"is the density of {density} in g/cm^3, or in kg/m^3? "
                    f"write the unit: --density '{density} g/cm^3'",
                ),
            ]
        )
        if self.mass is None and None not in (self.radius, self.density):
            object.__setattr__(self, "mass", self.density * self.solid * self.radius**3)
            object.__setattr__(self, "density", None)
        both = [
            f"give either the {one} or the {other}, not both".replace("_", " ")
            for one, other in _EITHER
            if None not in (getattr(self, one), getattr(self, other))
        ]
        refuse(
            [
                *((True, text) for text in both),
                (
                    self.gravity < 0 or (self.gravity == 0 and self.speed is None),
                    f"gravity = {show(self.gravity, 'm/s^2')} is not positive"
                    + (
                        "; without any, give the speed, --speed '2 m/s'"
                        if self.speed is None
                        else ""
                    ),
                ),
                (
                    self.penetration is not None and self.penetration > self.size,
                    f"the penetration of {show(self.penetration or 0, 'm')} is deeper than the "
                    f"{self.size_name} of {show(self.size, 'm')}",
                ),
            ]
        )

    @property
    def impact_speed(self) -> float:
        """Speed of the impact in m/s."""
        return self.speed or math.sqrt(2 * self.gravity * (self.drop_height or 1.0))

    def step(self, typed: Quantity) -> float:
        """Return a time step in s, and refuse one in which the body moves farther than 1 km."""
        step = step_in_si(typed)
        way = self.impact_speed * step
        if way > 1e3:
            raise Refused(
                f"a body with {show(self.impact_speed, 'm/s')} moves {show(way, 'm')} in a step of "
                f"{show(step, 's')}: up to 1 km is computed"
            )
        return step

    @property
    def size_name(self) -> str:
        """How messages call the size: "radius" or "half height"."""
        return "half height" if self.points > 1 else "radius"

    @property
    def solid(self) -> float:
        """Volume of the body divided by the cube of its size."""
        return 8 if self.points > 1 else 4 / 3 * math.pi

    @property
    def size(self) -> float:
        """Radius of the body in m, or half the height of a box; by its density if not given.

        Without a mass it is 0.1 m: a restitution by number hardly depends on it.
        """
        if self.radius or self.mass is None:
            return self.radius or 0.1
        return (self.mass / (self.density or DENSITIES["steel"]) / self.solid) ** (1 / 3)

    @property
    def limit(self) -> float:
        """Maximum penetration in m."""
        fifth = self.impact_speed**2 / (10 * self.gravity) if self.gravity else math.inf
        return self.penetration or min(self.size / 10, fifth)

    @property
    def gives_contact(self) -> bool:
        """Whether a depth or a contact was given."""
        return any(getattr(self, name) is not None for name in _CONTACT)

    @property
    def assumed(self) -> list[str]:
        """Assumptions on the drop and the body, as text."""
        solid = "a solid cube" if self.points > 1 else "a solid ball"
        of = "this density" if self.density else "steel (give its size or density)"
        return holding(
            [
                (
                    self.drop_height is self.speed is None,
                    "a drop from 1 m (--drop-height or --speed)",
                ),
                (
                    self.radius is None and self.mass is not None,
                    f"{solid} of {of}, {self.size_name} {show(self.size, 'm')}",
                ),
                (
                    self.radius is self.mass is None,
                    f"a {self.size_name} of {show(self.size, 'm')}, as none is given",
                ),
            ]
        )

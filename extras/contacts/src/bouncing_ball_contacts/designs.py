"""From the bounce that is wanted to the numbers of an engine.

A contact is known by its undamped depth δ, to which it sinks without damping and gravity, and by a
ratio of damping (:mod:`.schemes`). Without damping it lasts T ∝ δ/v, and a step h makes n = T/h
steps of it. Of δ, h and n two are given in each question, and the third follows:

* *What you want* has the δ that keeps a permitted depth, or that of a given stiffness or contact
  time; n is the least number of steps with which r is within half of the tolerance.
* *Your step* has the same δ and your h. If r leaves the tolerance there, it has your h and the
  least n, which is the stiffest contact, with which r does not.

The ratio of damping is always the one with which the mean r is the wanted one. It is read from a
scan: the engine's own scheme is stepped for many ratios at once, over all instants of the impact
within a step. Implicit steps, gravity and strong damping therefore need no formulas of their own.
"""

import functools
import math
import re
from bisect import bisect_left
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import combinations
from typing import Any, NamedTuple

import numpy as np

from bouncing_ball_contacts.engines import (
    Engine,
    Parameters,
    Setting,
    engine_named,
    filled,
    snippet_of,
)
from bouncing_ball_contacts.schemes import (
    Array,
    Drops,
    Impedance,
    Implicit,
    Law,
    OfSolver,
    Solved,
    Trials,
    drop,
    nearby,
)
from bouncing_ball_contacts.units import (
    DENSITIES,
    LONGEST_STEP,
    STANDARD_GRAVITY,
    Refused,
    density_of,
    holding,
    in_si,
    positive,
    refuse,
    show,
    span,
    step_in_si,
    within,
)

Quantity = Any
"""A number in SI units, or a text with a unit."""

TOLERANCE = 0.02
"""Largest deviation of r."""
LEAST_RESTITUTION = 0.01
"""Below it a damping, and what it makes of a depth, hardly depend on r."""

WANTED = "what you want"
YOURS = "your step"
IMPULSE = "impulse"

STEP_ONLY = "The numbers take back what this time step damps, and hold for it only"
VAGUE = "the depth at rest is less than the engine resolves: its positions have single precision"

# Steps in a contact: of those that choose the step, and of those that choose the stiffness.
_COUNTS = (2.5, 4, 6, 8, 10, 13, 17, 20, 25, 32, 40, 50, 65, 85, 120, 170, 250, 400, 600)
_FINE_COUNTS = tuple(2.5 * 40 ** (np.arange(117) / 78))
_SEARCH = nearby(2, 15)
_ALL = nearby(9, 201)
SETTLED = 1.1
"""Thresholds over the least with which a body comes to rest: near it, that takes many bounces."""
# A permitted depth is aimed at from below: it is found to within half a percent.
_AIM = 0.995


def aligned(table: Sequence[Sequence[str]]) -> list[str]:
    """Return the lines of a table with columns of equal width."""
    widths = [max(map(len, column)) for column in zip(*table, strict=True)]
    return [
        "  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip()
        for row in table
    ]


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
    "other_mass": ("kg", positive),
    "friction": ("", lambda name, value, _: within(name, value, 0, math.inf)),
    "gravity": ("m/s^2", in_si),
}
"""The unit of each quantity of a bounce, and how it is read."""
_CONTACT = ("penetration", "stiffness", "contact_time")
_EITHER = (("drop_height", "speed"), *combinations(_CONTACT, 2))
"""Quantities of which one at most is given."""


@dataclass(frozen=True)
class Bounce:
    """A bounce that is wanted: a body falls on a surface, or meets another free body.

    Quantities are numbers in SI units or texts with units; they are numbers in SI units afterwards.

    Parameters
    ----------
    mass, restitution : Quantity
        The restitution coefficient is √(h′/h) of the drop, 0 to 1.
    drop_height, speed : Quantity, optional
        One of both; by default a drop from 1 m.
    radius, density : Quantity, optional
        Of the body, both in place of its mass; the density may be the name of a material. By
        default a solid ball of steel.
    penetration, stiffness, contact_time : Quantity, optional
        At most one of them: the depth that must not be exceeded, or the contact itself. By default
        the penetration is at most a tenth of the radius and a fifth of the drop height.
    points : int
        The number of contact points that share the force, 4 for the face of a box. Without a radius
        a body with several points is a cube.
    other_mass : Quantity, optional
        Of a second free body, in an impact without gravity.
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
    other_mass: Quantity = None
    friction: Quantity = None
    gravity: Quantity = STANDARD_GRAVITY
    given: Mapping[str, str] = field(init=False, repr=False, compare=False)
    """What was given, in words."""

    def __post_init__(self) -> None:
        refuse(
            [
                (
                    self.mass is None and None in (self.radius, self.density),
                    "the mass is missing: --mass '50 g' or mass='50 g', or radius and density",
                ),
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
        if self.mass is None:
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
                    f"gravity = {show(self.gravity, 'm/s^2')} is not positive; without any, give "
                    "the speed, --speed '2 m/s'",
                ),
                (
                    self.other_mass is not None and self.speed is None,
                    "two free bodies need the speed at which they approach each other: "
                    "--speed '2 m/s'",
                ),
                (
                    self.penetration is not None and self.penetration > self.size,
                    f"the penetration of {show(self.penetration or 0, 'm')} is deeper than the "
                    f"{self.size_name} of {show(self.size, 'm')}",
                ),
            ]
        )

    @property
    def reduced_mass(self) -> float:
        """m, or m M/(m + M) of two free bodies, in kg."""
        return self.mass if self.other_mass is None else 1 / (1 / self.mass + 1 / self.other_mass)

    @property
    def load(self) -> float:
        """The gravity that acts during the contact in m/s², which is none between free bodies."""
        return self.gravity if self.other_mass is None else 0.0

    @property
    def impact_speed(self) -> float:
        """In m/s."""
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
        """What the size is."""
        return "half height" if self.points > 1 else "radius"

    @property
    def solid(self) -> float:
        """The volume of the body over the cube of its size."""
        return 8 if self.points > 1 else 4 / 3 * math.pi

    @property
    def size(self) -> float:
        """The radius of the body in m, or half the height of a box; by its density if not given."""
        volume = self.mass / (self.density or DENSITIES["steel"])
        return self.radius or (volume / self.solid) ** (1 / 3)

    @property
    def other_size(self) -> float:
        """The size of a second free body of the same density in m, infinite of the ground."""
        return self.size * ((self.other_mass or math.inf) / self.mass) ** (1 / 3)

    @property
    def reduced_radius(self) -> float:
        """R of a contact of spheres in m."""
        return 1 / (1 / self.size + 1 / self.other_size)

    @property
    def limit(self) -> float:
        """The penetration in m that must not be exceeded."""
        fifth = self.impact_speed**2 / (10 * self.load) if self.load else math.inf
        return self.penetration or min(self.size / 10, fifth)

    @property
    def gives_contact(self) -> bool:
        """Whether a depth or a contact was given."""
        return any(getattr(self, name) is not None for name in _CONTACT)

    @property
    def assumed(self) -> list[str]:
        """What was not given of the drop and of the body, in words."""
        solid = "a solid cube" if self.points > 1 else "a solid ball"
        of = "this density" if self.density else "steel (give its size or --density)"
        return holding(
            [
                (
                    self.drop_height is self.speed is None,
                    "a drop from 1 m (--drop-height or --speed)",
                ),
                (
                    self.radius is None,
                    f"{solid} of {of}, {self.size_name} {show(self.size, 'm')}",
                ),
                (
                    self.radius is not None and "radius" not in self.given,
                    f"a radius of {show(self.size, 'm')} (--radius)",
                ),
            ]
        )


class Range(NamedTuple):
    """The least, the mean and the greatest r of a contact."""

    low: float
    mean: float
    high: float

    @classmethod
    def of(cls, restitutions: Array) -> "Range":
        """Return those of drops."""
        return cls(*(float(f(restitutions)) for f in (np.min, np.mean, np.max)))

    def deviation(self, wanted: float) -> float:
        """Return the largest distance from the r that is wanted."""
        return max(wanted - self.low, self.high - wanted)

    def __str__(self) -> str:
        """Return mean ± largest distance, or the ends if that reaches 0."""
        error = self.deviation(self.mean)
        is_wide = 0 < self.mean <= error
        return span(self.low, self.high) if is_wide else f"{self.mean:.3f} ± {error:.3f}"


@dataclass(frozen=True)
class Outcome:
    """What a contact does in the steps of an engine, over all instants of the impact.

    ``depth`` and ``rest``, the depth at rest, are in m, and ``force`` is in N; pairs are least and
    greatest values. ``rest`` is NaN if the body never rests, or lies less deep than the engine
    resolves.
    """

    depth: tuple[float, float]
    rest: float
    force: tuple[float, float]
    restitution: Range


@dataclass(frozen=True)
class Row:
    """A contact at a time step.

    ``stiffness`` is k of all points together in N/m (of a Hertz contact in N/m^1.5, NaN of an
    impulse), ``parameters`` are those that are written, and ``step`` is in s.
    """

    step: float
    stiffness: float
    outcome: Outcome
    parameters: dict[str, Any]


class Candidate(NamedTuple):
    """A contact at a step in s, and what it does before its numbers are written."""

    law: Law
    step: float
    outcome: Outcome


def _written(value: Any) -> Any:
    """Return a number, or several, as snippets write them."""
    if isinstance(value, tuple):
        return tuple(map(_written, value))
    return float(f"{value:.6g}")


@dataclass(frozen=True)
class Problem:
    """A bounce in an engine with the largest deviation of r, for which contacts are tried."""

    bounce: Bounce
    engine: Engine
    tolerance: float = TOLERANCE

    @property
    def usable_depth(self) -> float:
        """The largest depth in m with which a contact works in a scene.

        A ball that sinks by more than its radius may leave a table on its other side, and two free
        bodies that overlap by more than a quarter of one slide past each other.
        """
        share = 1 if self.bounce.other_mass is None else 4
        return min(self.bounce.size, self.bounce.other_size) / share

    @property
    def deepest(self) -> float:
        """The depth in m from which on the engine loses the body, or two bodies change places."""
        size = self.bounce.size
        return min(self.engine.deepest * size, size + self.bounce.other_size)

    @property
    def lost(self) -> str:
        """What happens beyond the deepest depth."""
        if self.bounce.other_mass is None:
            return f"{self.engine.name} loses a body that sinks more than {show(self.deepest, 'm')}"
        return f"bodies that sink more than {show(self.deepest, 'm')} pass through each other"

    def setting(self, step: float) -> Setting:
        """Return where a contact is used at a time step in s."""
        return Setting(
            mass=self.bounce.reduced_mass,
            step=step,
            points=self.bounce.points,
            radius=self.bounce.reduced_radius,
            both_free=self.bounce.other_mass is not None,
        )

    def law(self, depth: Any, ratio: Any) -> Law:
        """Return contacts by their undamped depths in m and ratios of damping."""
        return self.engine.of_depth(depth, ratio, self.bounce.impact_speed)

    def law_of(self, parameters: Parameters, step: float) -> Law:
        """Return the contact of parameters that both bodies have, at a time step in s."""
        body = {**self.engine.defaults, **parameters}
        return self.engine.read(self.engine.combined(body, body), self.setting(step))

    def drops(self, law: Law, step: float, trials: Trials = _ALL) -> Drops:
        """Return the drops of contacts at a time step in s."""
        scheme = OfSolver() if isinstance(law, Solved) else self.engine.scheme
        return drop(law, scheme, step, self.bounce.impact_speed, self.bounce.load, trials)

    def outcome(self, law: Law, step: float, trials: Trials = _ALL) -> Outcome:
        """Return what one contact does at a time step in s."""
        found = self.drops(law, step, trials)
        force = found.peak * self.bounce.reduced_mass
        rest = float(np.max(law.rest(self.bounce.load))) if self.bounce.load else 0.0
        # A contact of MuJoCo hardly feels gravity: the body hops by what this moves it in a step.
        hop = self.bounce.load * step**2 if isinstance(law, Impedance) else 0.0
        is_resolved = rest == 0 or rest >= max(self.engine.resolution * self.bounce.size, hop)
        return Outcome(
            # A body that creeps is not followed until it is at rest.
            depth=(float(found.depth.min()), max(float(found.depth.max()), rest)),
            rest=rest if is_resolved else math.nan,
            force=(float(force.min()), float(force.max())),
            restitution=Range.of(found.restitution),
        )

    def hops(self, law: Law, step: float, found: Outcome) -> str:
        """Return why a body never lies still, and by how much it hops; empty if it does.

        A rebound leaves r of a speed, and a step of gravity, which is thrown back by a number and
        by MuJoCo's contact, adds g h to it: the body leaves with about g h/(1 - r).
        """
        fall = self.bounce.load * step
        speed = 0.0
        if isinstance(law, Impedance):
            speed = fall / max(1 - found.restitution.mean, LEAST_RESTITUTION)
        elif isinstance(law, Solved) and math.isnan(found.rest):
            speed = min(float(np.max(law.settling(fall))), self.bounce.impact_speed)
        height = speed**2 / (2 * self.bounce.load) if speed else 0.0
        # All bodies hop a little in MuJoCo.
        is_seen = height > (self.bounce.size / 100 if isinstance(law, Impedance) else 0.0)
        return is_seen * (
            f"it never lies still, but hops by up to about {show(height, 'm', 2)}, because each "
            "step of gravity is thrown back: a shorter one less"
        )

    def slides(self, law: Law, step: float) -> str:
        """Return how weakly friction acts in MuJoCo, where it is a damper as that of the contact.

        A body at rest leaves the contact for one or two steps each time, in which it is not held on
        a slope.
        """
        share = float(law.damping) / math.sqrt(float(law.stiffness))
        if not share:
            return "friction acts as a damper: nothing of a sliding speed is taken"
        creeps = 2e3 * self.bounce.load * math.sin(math.radians(10)) * step / (math.pi * share)
        return (
            f"friction acts as a damper: a bounce leaves {100 * math.exp(-math.pi * share):.2g} % "
            "of a sliding speed that Coulomb's friction would take"
            f"{f', and a body at rest on 10° creeps at up to {creeps:.2g} mm/s' if creeps else ''}"
        )

    @property
    def duration(self) -> float:
        """T/δ in s/m: how long an undamped contact lasts."""
        return float(self.law(1.0, 0.0).duration(self.bounce.impact_speed))

    @property
    def given_depth(self) -> float | None:
        """δ in m of a contact that was given."""
        time = self.bounce.contact_time
        if self.bounce.stiffness is not None:
            time = math.pi * math.sqrt(self.bounce.reduced_mass / self.bounce.stiffness)
        return None if time is None else time / self.duration

    def ratio(self, depth: float, step: float) -> float:
        """Return the ratio of damping with which the mean r is the wanted one.

        It is interpolated where r falls below. If r may be 0 within the tolerance, or does not
        fall so far, it is the middle of those with the least error: a contact that no body leaves
        does not depend on where in a step it begins, and too much damping throws the body away.
        """
        wanted = self.bounce.restitution
        # No law needs more than 1/r, to which that of Hunt and Crossley tends.
        most = 1 / max(wanted, LEAST_RESTITUTION)
        ratios = np.concatenate([[0.0], np.geomspace(1e-3, most, 31)])
        for _ in range(2):
            found = self.drops(self.law(depth, ratios), step, _SEARCH)
            falling = np.minimum.accumulate(found.mean)
            ratio = float(np.interp(-wanted, -falling, ratios))
            if wanted <= self.tolerance or wanted < falling[-1]:
                errors = found.error(wanted)
                # r is printed with three digits.
                ratio = float(np.median(ratios[errors <= errors.min() + 1e-3]))
            # Its neighbours in the first scan are not farther off.
            ratios = ratio * np.linspace(0.65, 1.5, 17)
        return ratio

    def candidate(self, depth: float, ratio: float, step: float) -> Candidate:
        """Return a contact with what it does."""
        law = self.law(depth, ratio)
        return Candidate(law, step, self.outcome(law, step))

    def at(self, depth: float, step: float) -> Candidate:
        """Return the contact of an undamped depth in m at a time step in s."""
        return self.candidate(depth, self.ratio(depth, step), step)

    @property
    def permitted(self) -> float:
        """The depth in m that must not be exceeded, infinite of a contact that was given."""
        return self.bounce.limit if self.given_depth is None else math.inf

    def keeps(self, found: Outcome, depth: float) -> bool:
        """Return whether r is within the tolerance, and the body sinks by a depth at most."""
        deviation = found.restitution.deviation(self.bounce.restitution)
        return deviation <= self.tolerance and found.depth[1] <= depth

    def step_of(self, count: float) -> Callable[[float], float]:
        """Return the step of an undamped depth with which a contact has so many steps."""
        return lambda depth: _written(min(self.duration * depth / count, LONGEST_STEP))

    def keeping(self, step_of: Callable[[float], float]) -> Candidate:
        """Return the contact that keeps what is given, at the step of its undamped depth."""
        if self.given_depth is not None:
            return self.at(self.given_depth, step_of(self.given_depth))
        # A contact that is stopped by its damper sinks about √r times its undamped depth.
        depth = self.bounce.limit / math.sqrt(max(self.bounce.restitution, LEAST_RESTITUTION))
        for _ in range(8):
            ratio = self.ratio(depth, step_of(depth))
            contact = self.candidate(depth, ratio, step_of(depth))
            sunk = max(contact.outcome.depth[1], self.bounce.limit / 100)
            change = _AIM * self.bounce.limit / sunk
            # Between δ, of a fast body, and δ², of one that its weight presses in.
            depth *= change**0.75
            if abs(change - 1) < 0.01:
                break
        return self.candidate(depth, ratio, step_of(depth))

    def wanted(self) -> Candidate:
        """Return the contact that keeps what is given, with the longest step in the tolerance.

        If there is none, it is the one with the nearest r.
        """
        tried = []
        for count in _COUNTS:
            contact = self.keeping(self.step_of(count))
            if self.keeps(contact.outcome, self.permitted):
                return contact
            tried.append(contact)
        return min(
            tried,
            key=lambda each: (
                each.outcome.depth[1] > self.permitted,
                each.outcome.restitution.deviation(self.bounce.restitution),
            ),
        )

    def stiffest(self, step: float) -> Candidate:
        """Return the stiffest contact at a time step in s with which r is within the tolerance.

        It is found by halving, because r misses less the more steps there are. If there is none,
        it is the most compliant one.
        """

        @functools.cache
        def contact(count: float) -> Candidate:
            return self.at(count * step / self.duration, step)

        place = bisect_left(
            _FINE_COUNTS, True, key=lambda count: self.keeps(contact(count).outcome, math.inf)
        )
        return contact(_FINE_COUNTS[min(place, len(_FINE_COUNTS) - 1)])

    def row(self, contact: Candidate) -> Row:
        """Return a contact with the parameters as they are written, and what these do."""
        law, step, _ = contact
        combined = {**self.engine.write(law, self.setting(step)), **self.engine.beside}
        parameters = {n: _written(value) for n, value in self.engine.of_each(combined).items()}
        stiffness = float(law.deep.stiffness) * self.bounce.reduced_mass
        return Row(step, stiffness, self.outcome(self.law_of(parameters, step), step), parameters)

    def promised(self, found: Outcome, speed: float | None = None) -> tuple[float, float]:
        """Return the least and the greatest r of bodies that slide up to a speed.

        It is in that of the fall, and by default the least for which the engine has a range.
        """
        low, _, high = found.restitution
        sliding = self.engine.sliding
        if self.bounce.friction == 0 or not sliding.speeds:
            return low, high
        more = sliding.adds(self.bounce.restitution, speed or sliding.speeds[0])
        return max(low - sliding.takes, 0.0), high + more

    @property
    def short_step(self) -> float:
        """A step in s in which a body by number moves by less than the permitted depth.

        Nor does gravity add more than the share of the tolerance to its speed.
        """
        speed = self.bounce.impact_speed
        slow = self.tolerance * speed / self.bounce.load if self.bounce.load else math.inf
        return _written(min(0.9 * self.bounce.limit / speed, slow, LONGEST_STEP))

    def impulse(self, step: float) -> Row:
        """Return the restitution by number that has the wanted mean r, without a spring.

        The number and r differ by little, so that it is corrected by their difference. The
        threshold lets the body come to rest, unless it would not bounce at all.
        """
        engine = self.engine
        fall = self.bounce.gravity * step
        number = self.bounce.restitution
        tried = []
        for _ in range(12):
            alike = _written(engine.rules[engine.number].alike(number))
            parameters = {engine.number: alike, **engine.undisturbed, engine.threshold: 0.0}
            law: Any = self.law_of(parameters, step)
            settling = SETTLED * float(law.settling(fall))
            is_low = settling < self.bounce.impact_speed
            parameters[engine.threshold] = _written(settling if is_low else 2 * fall)
            outcome = self.outcome(self.law_of(parameters, step), step)
            tried.append(Row(step, math.nan, outcome, parameters))
            # Half of it, because r may depend on the number by jumps.
            short = (self.bounce.restitution - outcome.restitution.mean) / 2
            number = float(np.clip(number + short, 0, 1))
        return min(
            tried, key=lambda row: row.outcome.restitution.deviation(self.bounce.restitution)
        )

    def best(self, rows: Mapping[str, Row], keeps: bool) -> str:
        """Return the name of the row that is written if none is picked.

        If a depth or a contact was given, it is the row that keeps it. Otherwise it is one at the
        given step that works in a scene, or the row of a short step if there is none.
        """
        if self.bounce.gives_contact:
            return YOURS if keeps else WANTED
        # The impulse also keeps r of boxes and of bodies that slide, which implicit springs of
        # several points do not; if nothing is to rebound, a spring stops the body more softly.
        order = (IMPULSE, YOURS) if self.bounce.restitution > 0 else (YOURS, IMPULSE)
        usable = (
            name
            for name in order
            if name in rows and self.keeps(rows[name].outcome, self.usable_depth)
        )
        return next(usable, WANTED)


def design(
    bounce: Bounce,
    engine: str | Engine = "generic",
    time_step: Quantity = None,
    *,
    pick: str | None = None,
) -> "Design":
    """Return the contacts of an engine with which a body bounces as wanted, and what they do.

    Parameters
    ----------
    bounce : Bounce
    engine : str or Engine
        One of :data:`.ENGINES`, or its name.
    time_step : Quantity, optional
        Of the engine. The second row is the contact that is wanted at this step; if its r is not
        within the tolerance, it is the stiffest contact whose r is.
    pick : str, optional
        The row that is written, by default the one that keeps what was given.

    Raises
    ------
    Refused
        If there is no such contact.
    """
    if not isinstance(bounce, Bounce):
        raise Refused("give a bounce: design(Bounce(mass='50 g', restitution=0.8), 'mujoco')")
    problem = Problem(bounce, engine_named(engine))
    known = problem.engine
    refuse(
        [
            (
                bounce.restitution is None,
                "the restitution is missing: --restitution 0.8 or restitution=0.8",
            ),
            (
                bounce.stiffness is not None and known.unit != "N/m",
                f"{known.name} has no stiffness in N/m: give the penetration",
            ),
        ]
    )
    step = None if time_step is None else _written(bounce.step(time_step))
    # Half of the tolerance is left for what is known of the body.
    strict = replace(problem, tolerance=problem.tolerance / 2)
    rows = {WANTED: problem.row(strict.wanted())}
    keeps = False
    if step is not None:
        contact = problem.keeping(lambda _: step)
        keeps = problem.keeps(contact.outcome, problem.permitted)
        if not keeps:
            contact = problem.stiffest(step)
        # Beyond these the engine loses the body, or the ground swallows it.
        is_held = not contact.outcome.rest >= bounce.size
        if keeps or (is_held and problem.keeps(contact.outcome, problem.deepest)):
            rows[YOURS] = problem.row(contact)
    if known.number and (step or bounce.restitution):
        rows[IMPULSE] = problem.impulse(step or problem.short_step)
        is_usable = problem.keeps(rows[IMPULSE].outcome, problem.usable_depth)
        if not (is_usable or bounce.gives_contact):
            rows[IMPULSE] = problem.impulse(min(step or math.inf, problem.short_step))
    chosen = problem.best(rows, keeps) if pick is None else pick.strip().lower()
    names = ", ".join(map(repr, rows))
    refuse([(chosen not in rows, f"row {pick!r} is not one that is written here: {names}")])
    found = Design(
        bounce=bounce,
        engine=known.name,
        source=known,
        time_step=step,
        rows=rows,
        chosen=chosen,
        notes=(),
    )
    return replace(found, notes=tuple(_notes(found, problem, keeps)))


def _notes(found: "Design", problem: Problem, keeps: bool) -> list[str]:
    """Return what a user has to know of the row that is written, and of the one that is not."""
    bounce = problem.bounce
    row = found.row
    outcome = row.outcome
    r = outcome.restitution
    law = problem.law_of(row.parameters, row.step)
    hops = problem.hops(law, row.step, outcome)
    # The threshold is of the speed with that of a step of gravity.
    slowest = 0.0
    if bounce.load and law.is_number and not hops:
        slowest = row.parameters[problem.engine.threshold] - bounce.load * row.step
    lowest = slowest**2 / (2 * bounce.load) if slowest else 0.0
    slower = replace(bounce, drop_height=None, speed=bounce.impact_speed / 3)
    slow = replace(problem, bounce=slower).outcome(law, row.step).restitution
    is_undamped = not law.is_number and float(law.damping) == 0 and r.mean < bounce.restitution
    wanted = found.rows[WANTED]
    step = found.time_step or wanted.step
    is_none = found.time_step is not None and YOURS not in found.rows
    depth = found.rows.get(YOURS, wanted).outcome.depth[1]
    is_deeper = depth > 1.01 * wanted.outcome.depth[1] and not keeps and found.chosen != IMPULSE
    is_unusable = depth > problem.usable_depth and found.chosen == WANTED
    size = f"{bounce.size_name} of {show(bounce.size, 'm')}"
    at_yours = show(step, "s", 4)
    low, high = problem.promised(outcome)
    ranges = [
        f"{span(*problem.promised(outcome, speed))} up to {speed:g} times the speed of its fall"
        for speed in problem.engine.sliding.speeds
    ]
    slides = (
        f"r is that of a body that does not slide; of one that slides it is {', '.join(ranges)}"
    )
    friction = [slides] * bool(ranges) + [problem.engine.friction] * bool(bounce.friction)
    moves = f"it moves {show(bounce.impact_speed * step, 'm')} in a step"
    instead = f"at {show(wanted.step, 's')} it sinks {show(wanted.outcome.depth[1], 'm')}"
    no_deeper = (
        f"sinks less than {show(problem.deepest, 'm')}"
        if math.isfinite(problem.deepest)
        else f"lies less deep than the {size}"
    )
    unusable = (
        f"; more than {'' if bounce.other_mass is None else 'a quarter of '}the {bounce.size_name} "
        f"is too deep for a scene, and the row for {show(wanted.step, 's')} is written (--pick "
        f"{YOURS!r} for the other one)"
    )
    return holding(
        [
            (outcome.depth[1] > problem.deepest, problem.lost),
            (r.high >= 1.0005, f"r is up to {r.high:.3f}: at some instants the body gains energy"),
            (
                found.chosen == IMPULSE and row.step < step and found.time_step,
                f"the impulse is for {show(row.step, 's')}: at {at_yours} {moves}, or r leaves its "
                "tolerance",
            ),
            (
                is_none and found.chosen == WANTED,
                f"at {at_yours} no spring works in {found.engine}: none keeps r within "
                f"{problem.tolerance:g} and {no_deeper}, because {moves}; {instead}",
            ),
            (
                is_none and 0 < bounce.restitution < 0.1,
                "bodies that hardly bounce rest at once at longer steps: try --restitution 0",
            ),
            (
                is_deeper,
                f"at your step it sinks {show(depth, 'm')}, {100 * depth / bounce.size:.3g} % of "
                f"its {bounce.size_name}, because {moves}; {instead}"
                f"{unusable if is_unusable and not bounce.gives_contact else ''}",
            ),
            (
                YOURS in found.rows and bounce.gives_contact and not keeps,
                f"your step of {at_yours} cannot keep what you gave: the row for "
                f"{show(row.step, 's')} is written (--pick "
                f"{(WANTED if found.chosen == YOURS else YOURS)!r} for the other one)",
            ),
            (
                outcome.depth[1] > bounce.size and not (found.chosen == YOURS and is_deeper),
                f"it sinks deeper than its {size}",
            ),
            (
                found.chosen == WANTED
                and problem.given_depth is None
                and outcome.depth[1] > bounce.limit,
                f"no contact was found that sinks less than {show(bounce.limit, 'm')}",
            ),
            (hops, hops),
            (math.isnan(outcome.rest) and not isinstance(law, Impedance | Solved), VAGUE),
            (
                10 * slowest > bounce.impact_speed,
                f"drops from less than {show(lowest, 'm')} do not bounce: at a lower threshold "
                "than this one the body would not come to rest",
            ),
            (
                is_undamped,
                f"this contact has no damping, and r is still {r.mean:.3f} at most, because the "
                "steps damp by themselves: a shorter step has more",
            ),
            (
                r.deviation(bounce.restitution) > problem.tolerance and not is_undamped,
                f"r is {span(r.low, r.high)}: no contact that is nearer was found",
            ),
            (
                abs(slow.mean - r.mean) > TOLERANCE / 2 and 3 * slowest < bounce.impact_speed,
                f"at a third of the speed r is {slow}",
            ),
            (
                bounce.friction or max(r.low - low, high - r.high) > TOLERANCE,
                "; ".join(filter(None, friction)),
            ),
            (bounce.friction and isinstance(law, Impedance), problem.slides(law, row.step)),
            (
                bounce.friction and not re.search("@friction@|@rubs@", found.template),
                f"a friction of {bounce.friction or 0:g} is not in what is pasted",
            ),
        ]
    )


@dataclass(frozen=True, repr=False)
class Design:
    """The contacts that answer a question, by the names of their rows, and the one written.

    Its ``repr`` is the table with its notes; printed it also has the snippet and what was assumed.
    """

    bounce: Bounce
    engine: str
    source: Engine
    time_step: float | None
    rows: dict[str, Row]
    chosen: str
    notes: tuple[str, ...]

    @property
    def row(self) -> Row:
        """The row that is written."""
        return self.rows[self.chosen]

    @property
    def parameters(self) -> dict[str, Any]:
        """The parameters that are written, by their names in the engine."""
        return self.row.parameters

    @property
    def template(self) -> str:
        """What is pasted, with places for the numbers."""
        bodies = "ground" if self.bounce.other_mass is None else "pair"
        kind = IMPULSE if self.chosen == IMPULSE else bodies
        return snippet_of(f"{self.engine}-{kind}") or snippet_of(self.engine)

    @property
    def snippet(self) -> str:
        """What is pasted into the engine; the parameters of one that is not known here."""
        if not self.template:
            return "\n".join(f"{name} = {value}" for name, value in self.parameters.items())
        mu = self.bounce.friction or 0.0
        values = {
            "step": self.row.step,
            "friction": mu,
            "rubs": self.source.rubs[bool(mu)].format(mu=mu, root=math.sqrt(mu)),
            "condim": 1 if self.bounce.friction == 0 else 3,
        }
        return filled(self.template, values | self.parameters).rstrip()

    @property
    def table(self) -> list[list[str]]:
        """The cells of the table, the headings first."""
        engine = self.source
        return [
            ["", "step", "k", "sinks", "at rest", "force", "r"],
            *(
                [
                    f"{name} *" if name == self.chosen else name,
                    show(row.step, "s"),
                    show(row.stiffness, engine.unit),
                    show(row.outcome.depth[1], "m"),
                    show(row.outcome.rest, "m") if self.bounce.load else "–",
                    show(row.outcome.force[1], "N"),
                    str(row.outcome.restitution),
                ]
                for name, row in self.rows.items()
            ),
        ]

    @property
    def remarks(self) -> list[str]:
        """The lines below the snippet: what was given and assumed, and what the engine needs."""
        bounce = self.bounce
        engine = self.source
        given = [f"{name} {value}" for name, value in bounce.given.items()]
        if self.time_step is not None:
            given.append(f"time step {show(self.time_step, 's', 4)}")
        is_tenth = bounce.limit == bounce.size / 10
        share = f"a tenth of the {bounce.size_name}" if is_tenth else "a fifth of the drop height"
        depth = f"it may sink {show(bounce.limit, 'm')}, {share} (--penetration)"
        assumed = bounce.assumed + holding([(not bounce.gives_contact, depth)])
        is_impulse = self.chosen == IMPULSE
        said = [
            (True, f"Given: {', '.join(given)}"),
            (assumed, f"Assumed: {'; '.join(assumed)}"),
            (
                bounce.other_mass,
                f"Two free bodies act as one of {show(bounce.reduced_mass, 'kg', 4)}, their "
                "reduced mass",
            ),
            (
                IMPULSE in self.rows and not is_impulse,
                f"The row of the impulse is a restitution by number: --pick {IMPULSE} writes it",
            ),
            (not engine.ran, f"The row of {self.engine} was never run in its engine"),
            *((True, note) for note in engine.notes),
            (isinstance(engine.scheme, Implicit) and not is_impulse, STEP_ONLY),
            (bounce.points > 1 and engine.box, engine.box),
            (
                bounce.points > 1,
                "A box that falls some degrees off flat hits twice, and friction turns one that "
                "slides fast: no contact keeps r then",
            ),
            (
                bounce.other_mass,
                "r is along the line of their centres, which turns while they slide past each "
                "other: no contact keeps r then",
            ),
        ]
        return [f"{text}." for text in holding(said)]

    def __repr__(self) -> str:
        return "\n".join([*aligned(self.table), *(f"! {note}" for note in self.notes)])

    def __str__(self) -> str:
        return "\n\n".join([repr(self), self.snippet, "\n".join(self.remarks)])

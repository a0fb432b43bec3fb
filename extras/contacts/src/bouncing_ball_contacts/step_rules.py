"""One step of engines whose restitution is a number, for a ball over a surface.

Such an engine reverses the velocity of a body within one step. Engines differ in three points:
which velocity is reversed, whether it includes the gravity of the step, and where the body is at
the end of the step. Each rule yields the height z and the velocity v, both upwards, after each step
from a given z and v on. The rules were found in the source of the engines and by dropping balls in
them: ``tests/engine_drops.csv`` has the drops, and ``tests/test_rebounds.py`` compares them.
"""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any


@dataclass(frozen=True)
class Fall:
    """Ball on its way down, in SI units.

    Attributes
    ----------
    number
        Combined restitution coefficient of both bodies.
    step, gravity, radius, mass
        Time step, gravity, and the ball.
    threshold
        Speed below which an impact has no restitution.
    keeps
        Share of a velocity that a linear damping leaves in a step.
    settings
        Other parameters by their names in the engine.
    """

    number: float
    step: float
    gravity: float
    threshold: float
    radius: float
    keeps: float = 1.0
    mass: float = 1.0
    settings: Mapping[str, float] = field(default_factory=dict)

    @property
    def added(self) -> float:
        """Speed that gravity adds in a step."""
        return self.gravity * self.step


Steps = Iterator[tuple[float, float]]
"""Height and velocity after each step, without an end."""


def jolt(at: Fall, z: float, v: float) -> Steps:
    """Contacts are found 20 mm ahead; the velocity before the step's gravity is reversed.

    What is deeper than 20 mm is taken back by a fifth, twice in a step.
    """
    while True:
        u = at.keeps * (v - at.added)
        deepest = math.inf
        if z <= 0.02:
            deepest = 0.02
            touches = u < -max(z, 0.0) / at.step
            before = u + at.added
            u = max(
                u, -at.number * before if touches and u < -at.threshold else -max(z, 0.0) / at.step
            )
        z += at.step * u
        for _ in range(2):
            z += 0.2 * max(-z - deepest, 0.0)
        v = u
        yield z, v


def physx(at: Fall, z: float, v: float, ahead: float) -> Steps:
    """Within both contact offsets, the velocity with the step's gravity is reversed.

    A body that is too slow for that is stopped at the surface, or put out of it by 0.8 of its depth
    in a step.
    """
    while True:
        v -= at.added
        touches = z < ahead and z + at.step * v < 0
        if touches and v < -at.threshold:
            v *= -at.number
            z += at.step * v
        elif touches and z > 0:
            v = -z / at.step
            z = 0.0
        elif touches:
            z = max(z + at.step * v, 0.2 * z)
            v = max(v, 0.0)
        else:
            z += at.step * v
        yield z, v


# Rapier and Box2D 3 make a step of four substeps, and a contact with a fixed body is a spring of
# 60 Hz with a damping ratio of 10 that pushes a body out with at most 3 m/s.
SUBSTEPS = 4
_DAMPING_RATIO = 10.0
_PUSH = 3.0
_PREDICTION = 0.02
_SLOP = 0.005


def _fly(at: Fall, z: float, v: float) -> tuple[float, float]:
    """Return height and velocity after a step of free flight."""
    z += at.step * (v - at.added * (SUBSTEPS + 1) / (2 * SUBSTEPS))
    return z, v - at.added


def _soft_contact(
    at: Fall, z: float, v: float, impulse: float, frequency: float
) -> tuple[float, float, float, bool]:
    """Return height, velocity and impulse after a step, and whether the contact pushed at all.

    Impulses are per unit of mass. Each substep solves the contact twice: with the spring that takes
    back a penetration, and then without.
    """
    h = at.step / SUBSTEPS
    omega = 2 * math.pi * frequency
    softness = omega * h * (2 * _DAMPING_RATIO + omega * h)
    share = softness / (1 + softness)
    pushed = False
    for _ in range(SUBSTEPS):
        v += impulse - at.gravity * h
        bias = z / h if z > 0 else max(omega * z / (2 * _DAMPING_RATIO + omega * h), -_PUSH)
        soft = max(impulse - v - bias, 0.0) * (1 if z > 0 else share)
        v += soft - impulse
        z += v * h
        impulse = max(soft - v - max(z, 0.0) / h, 0.0)
        v += impulse - soft
        pushed |= max(soft, impulse) > 0
    return z, v, impulse, pushed


def _rebounding(at: Fall, before: float, v: float, impulse: float) -> tuple[float, float]:
    """Return velocity and impulse after a step at whose end v is r times that before it."""
    kick = max(impulse - v - at.number * before, 0.0)
    return v + kick - impulse, kick


def box2d(at: Fall, z: float, v: float) -> Steps:
    """The velocity before the step is reversed at its end."""
    impulse = 0.0
    # At low rates the spring is made softer.
    frequency = 2 * min(30.0, SUBSTEPS / at.step / 8)
    while True:
        if z < _PREDICTION:
            before = v
            z, v, impulse, pushed = _soft_contact(at, z, v, impulse, frequency)
            if before < -at.threshold and pushed:
                v, impulse = _rebounding(at, before, v, impulse)
        else:
            impulse = 0.0
            z, v = _fly(at, z, v)
            # A ball that is faster than half a radius per step is held where it is 5 mm deep.
            z = max(z, -_SLOP) if abs(v) * at.step > at.radius / 2 else z
        yield z, v


def rapier(at: Fall, z: float, v: float) -> Steps:
    """As Box2D, but a contact is looked for again only after a way of 20 mm, or 50 mm in contact.

    Before, the ball has to be near: it has a box in a tree, which is made anew with a margin of
    40 mm when the ball leaves it. A contact that pushed in the step before does not bounce.
    """
    impulse = 0.0
    in_contact = False
    box = z
    margin = 0.0
    looked = math.inf
    while True:
        if abs(z - box) > margin:
            box = z
            margin = 0.04
        if box - margin > 0.02:
            in_contact = False
            looked = math.inf
        elif abs(z - looked) > (0.05 if in_contact else _PREDICTION):
            looked = z
            in_contact = z < _PREDICTION
        if in_contact:
            before = v
            is_new = impulse == 0
            z, v, impulse, pushed = _soft_contact(at, z, v, impulse, 60.0)
            if before < 0 and pushed and at.number > 0 and (is_new or at.number >= 1):
                v, impulse = _rebounding(at, before, v, impulse)
        else:
            impulse = 0.0
            above = z
            z, v = _fly(at, z, v)
            z = max(z, -_SLOP) if above - z > at.radius / 2 else z
        yield z, v


SKIN = 2 * _SLOP
"""Thickness in m of the skin that Box2D 2 and planck have around polygons."""
# The time of an impact is found to a quarter of the slop.
_FOUND = _SLOP / 4


def _out(at: Fall, z: float) -> float:
    """Return the height of a ball after the iterations at the time of its impact.

    From 5 mm below the surface the second iteration ends at its limit: rounding decides whether a
    third one follows.
    """
    for _ in range(20):
        apart = z - SKIN
        z += min(max(-0.75 * (apart + _SLOP), 0.0), 0.2)
        if apart >= -1.5 * _SLOP + at.settings["rounding"]:
            break
    return z


def box2d_2(at: Fall, z: float, v: float) -> Steps:
    """The velocity with the step's gravity is reversed, in the step that begins in the skin.

    A ball that would be deeper than 6 mm is stopped where it is 5 mm deep, and moves on from there.
    It is stopped in the middle of the step, if it is so deep there to about 1 mm.
    """
    touches = False
    while True:
        u = v - at.added
        v = u if u > 0 else -at.number * u * (u < -at.threshold)
        if touches and z + _SLOP < _FOUND and v > 0:
            z = _out(at, z) + at.step * v
        elif touches:
            z += at.step * v
            for _ in range(3):
                apart = z - SKIN
                z += min(max(-0.2 * (apart + _SLOP), 0.0), 0.2)
                if apart >= -3 * _SLOP:
                    break
        elif z + at.step * u < -_SLOP - _FOUND:
            middle = z + at.step * u / 2
            stop = middle if abs(middle + _SLOP) < _FOUND else -_SLOP
            rest = 1 + (z - stop) / (at.step * u)
            z = _out(at, stop) + rest * at.step * v
        else:
            v = u
            z += at.step * v
        touches = z < SKIN
        yield z, v


def chipmunk(at: Fall, z: float, v: float) -> Steps:
    """The body moves first; below the surface the velocity before the step's gravity counts."""
    while True:
        z += at.step * v
        u = v - at.added
        v = max(u, -at.number * v) if z < 0 and v < 0 else u
        yield z, v


def dart(at: Fall, z: float, v: float) -> Steps:
    """A body below the surface is reversed, if it then leaves faster than the threshold."""
    while True:
        v -= at.added
        if z < 0 and v < 0:
            back = min(-0.01 * z / at.step, 1e-3)
            v = -at.number * v if -at.number * v > at.threshold else back
        z += at.step * v
        yield z, v


def bullet_flight(at: Fall, v: Any) -> Any:
    """Return the velocity after a step of free flight with Bullet's linear damping."""
    return v - at.added - at.step * at.settings["linearDamping"] * v * (1 + abs(v))


def pybullet(at: Fall, z: float, v: float) -> Steps:
    """Below `ahead` the velocity with the step's gravity is reversed.

    A body that is too slow for that is stopped at the surface, and put out of it by a share of its
    depth in a step, `contactERP`. The linear damping D decelerates it by D v (1 + |v|/(1 m/s)).
    """
    slop = at.settings["contactSlop"]
    ahead = at.settings["ahead"]
    while True:
        u = bullet_flight(at, v)
        v = u
        if z < 0 or z < ahead:
            gap = z + slop
            out = gap * (1.0 if gap > 0 else at.settings["contactERP"]) / at.step
            v = max(u, -at.number * u * (u < -at.threshold) - out)
        z += at.step * v
        yield z, v


def _joint(
    at: Fall, z: float, v: float, erp: float, cfm: float, fastest: float = math.inf
) -> Steps:
    """The velocity before the step's gravity is reversed, or a share of the depth taken back.

    `cfm` softens both. `fastest` caps the velocity, but the position moves as without it.
    """
    held = at.step / (cfm * at.mass)
    while True:
        u = v - at.added
        moves = u
        if z < 0:
            aim = max(-at.number * v * (v < -at.threshold), -erp * z / at.step)
            capped = min(aim, fastest)
            moves = max(u, aim + (u - aim) / (1 + held))
            u = max(u, capped + (u - capped) / (1 + held))
        v = u
        z += at.step * moves
        yield z, v


def ode(at: Fall, z: float, v: float) -> Steps:
    """Contacts of ODE with its own numbers."""
    return _joint(at, z, v, at.settings["soft_erp"], at.settings["soft_cfm"])


def gazebo(at: Fall, z: float, v: float) -> Steps:
    """Contacts of ODE with the numbers that Gazebo Classic makes of both bodies."""
    pull = at.step * at.settings["kp"] / 2
    both = pull + 2 * at.settings["kd"]
    fastest = min(at.settings["max_vel"], at.settings["contact_max_correcting_vel"])
    return _joint(at, z, v, pull / both, 1 / both, fastest)


def xpbd(at: Fall, z: float, v: float) -> Steps:
    """Two iterations that take back 0.8 of the penetration each; then v is reversed."""
    while True:
        v -= at.added
        z += at.step * v
        if z < 0 and v < 0:
            z *= 0.04
            v *= -at.number
        yield z, v


def _corners(at: Fall) -> tuple[list[float], float, float]:
    """Return the lowest corners of a circle of matter-js, which is a polygon.

    They are the places along the ground of the lowest corner and of its lower neighbour, the height
    in m of the neighbour above it, and the squared radius of gyration, four times that of a disc.
    """
    pixels = round(at.radius * at.settings["pixels"], 6)
    sides = math.ceil(max(10.0, min(25.0, pixels)))
    sides += sides % 2
    half = math.pi / sides
    angle = half * at.settings["turn"]
    places = [at.radius * math.sin(angle), at.radius * math.sin(angle - 2 * half)]
    apart = at.radius * (math.cos(angle) - math.cos(angle - 2 * half))
    return places, apart, 2 * at.radius**2 * (1 - 2 / 3 * math.sin(half) ** 2)


def matter(at: Fall, z: float, v: float) -> Steps:
    """Six iterations put the body out, and four reverse the velocity of its lowest corners.

    The height is that of the lowest corner. With one corner below the surface a quarter of the
    depth is left. A corner beside the centre turns the body and takes less of its velocity. While
    the body rises, 0.8 of what put it out is repeated in the next step.
    """
    corners, apart, gyration = _corners(at)
    slop = 0.05 / at.settings["pixels"] * min(60 * at.step, 1.0)
    pushes = [0.0, 0.0]
    out = 0.0
    while True:
        v = at.keeps * v - at.added
        z += at.step * v
        places = corners if z < -apart else corners[: z < 0]
        for _ in range(6 * bool(places)):
            out -= 1.8 / len(places) * (z + out + slop)
        z += out
        out *= 0.8 * (out * v >= 0)
        if places:
            spin = sum(x * push for x, push in zip(places, pushes, strict=False)) / gyration
            v += sum(pushes[: len(places)])
            for _ in range(4):
                speeds = [v + spin * x for x in places]
                for i, (x, speed) in enumerate(zip(places, speeds, strict=True)):
                    push = -(1 + at.number) * speed / len(places) / (1 + x * x / gyration)
                    if speed < -at.threshold:
                        pushes[i] = 0.0
                    else:
                        pushes[i], push = (
                            max(pushes[i] + push, 0.0),
                            max(push, -pushes[i]),
                        )
                    v += push
                    spin += x * push / gyration
        else:
            pushes = [0.0, 0.0]
        yield z, v


def cannon(at: Fall, z: float, v: float) -> Steps:
    """A spring that is relaxed over d steps, with (1 + r) v beside it; heavy bodies sink deeper."""
    four = 4 * at.settings["contactEquationRelaxation"]
    a = 4 / (at.step * (1 + four))
    b = four / (1 + four)
    stiffness = at.settings["contactEquationStiffness"]
    softness = 4 * at.mass / (at.step**2 * stiffness * (1 + four))
    while True:
        impulse = 0.0
        if z < 0:
            impulse = max((at.added - z * a - (1 + at.number) * v * b) / (1 + softness), 0.0)
        v = at.keeps * (v + impulse) - at.added
        z += at.step * v
        yield z, v

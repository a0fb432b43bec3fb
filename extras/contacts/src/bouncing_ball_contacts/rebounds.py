"""Engines whose restitution is a number, and the bounce that they make of it.

Such an engine reverses the velocity of a body within one step, by a rule of its own
(:mod:`.step_rules`), and so r = √(h′/h) is not the number.

r depends on where in a step the ball meets the surface, by about g h/v, the speed that a step h of
gravity adds over that of the impact. It is given as its least, mean and greatest value over all
instants.
"""

import difflib
import math
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import partial
from itertools import islice
from typing import Any

import numpy as np

from bouncing_ball_contacts import step_rules
from bouncing_ball_contacts.designs import SETTLED, TOLERANCE, Bounce, Page, Quantity
from bouncing_ball_contacts.engines import LARGER, LEAST, MEAN, PAIR, PRODUCT, Rule
from bouncing_ball_contacts.schemes import Array
from bouncing_ball_contacts.step_rules import Fall, Steps
from bouncing_ball_contacts.units import Refused, in_si, show, span, step_in_si, within

_CLAMPED_SUM = Rule(
    "added, and at most 1", lambda a, b: min(a + b, 1.0), lambda x: x / 2, lambda x, other: x
)
COMBINED = {"average": MEAN, "minimum": LEAST, "multiply": PRODUCT, "maximum": LARGER}
"""The modes of PhysX materials."""
INSTANTS = 24
"""Of the impact within a step; a sixth of them in short steps, where r hardly depends on them."""
# Where a body flies freely: no engine finds its contact farther away, in m.
_REACH = 0.06


@dataclass(frozen=True)
class ByNumber:
    """An engine whose restitution is a number.

    ``parameter`` is its name, ``pair`` how the engine combines those of two bodies, ``default`` the
    one of a body that has none. Impacts slower than ``threshold`` have no restitution, or, if it
    ``is_of_rebound``, bodies that would leave more slowly; ``set_by`` is its setting, empty if
    there is none that can be changed. ``sinks`` is by how many times g h² a body falls farther in a
    step than with the velocity before it, and ``remembers`` how many steps before an impact matter.
    ``springs`` is the row of the same engine in :data:`.ENGINES`, if it takes a stiffness as well.
    ``written`` is the line to paste, and ``lowered`` the one of another threshold. If it
    ``is_physx``, materials say how their numbers are combined, and a threshold above g h/(1 - r)
    lets a body come to rest. ``damped_by`` is
    the linear damping of a body with its default ``damping``, and ``kept`` the share of a velocity
    that it leaves in a step.
    """

    name: str
    rule: Callable[[Fall, float, float], Steps]
    ran: str
    written: str
    parameter: str = "restitution"
    pair: Rule = MEAN
    default: float = 0.0
    threshold: float = 0.0
    is_of_rebound: bool = False
    set_by: str = ""
    sinks: float = 1.0
    remembers: int = 2
    springs: str = ""
    lowered: str = ""
    is_physx: bool = False
    damped_by: str = ""
    damping: float = 0.0
    kept: Callable[[float, float], float] = lambda damping, step: 1.0
    notes: tuple[str, ...] = ()

    @property
    def names(self) -> dict[str, str]:
        """What the names that may be typed stand for, in small letters."""
        known = {"restitution": "number", self.parameter.lower(): "number"}
        if self.set_by:
            last = re.split(r"[.:/]", self.set_by.lower())[-1]
            known |= {"threshold": "threshold", last: "threshold"}
        if self.is_physx:
            known |= dict.fromkeys(
                ("combine", "bouncecombine", "restitutioncombinemode"), "combine"
            )
        if self.damped_by:
            known |= {self.damped_by.lower(): "damping"}
        return known

    def fall(self, number: float, bounce: Bounce, step: float, threshold: float) -> Fall:
        """Return how a ball falls, with the number of both bodies together."""
        keeps = self.kept(self.damping, step)
        return Fall(number, step, bounce.load, threshold, bounce.size, keeps)


_JOLT = ByNumber(
    name="jolt",
    rule=step_rules.jolt,
    ran="Jolt 5 (jolt-physics 1.1.0 for JavaScript)",
    written="bodySettings.mRestitution = {number}f;  // of both bodies",
    parameter="mRestitution",
    pair=LARGER,
    threshold=1.0,
    set_by="PhysicsSettings::mMinVelocityForRestitution",
    lowered="physicsSettings.mMinVelocityForRestitution = {threshold}f;",
    damped_by="mLinearDamping",
    damping=0.05,
    kept=lambda damping, step: max(1 - damping * step, 0.0),
)
_PHYSX = ByNumber(
    name="physx",
    rule=partial(step_rules.physx, ahead=0.04),
    ran="PhysX 5.6.1 (physx-js-webidl 2.7.3)",
    written="material->setRestitution({number}f);  // of both shapes",
    threshold=2.0,
    set_by="bounceThresholdVelocity",
    springs="physx",
    is_physx=True,
    lowered="sceneDesc.bounceThresholdVelocity = {threshold}f;",
)
_BOX2D_2 = ByNumber(
    name="box2d-2",
    rule=step_rules.box2d_2,
    ran="Box2D 2.3.10 of Python",
    written="fixtureDef.restitution = {number}f;  // of one of both fixtures",
    pair=LARGER,
    threshold=1.0,
    notes=("The threshold is a constant of the library, b2_velocityThreshold",),
)
_DART = ByNumber(
    name="dart",
    rule=step_rules.dart,
    ran="DART 6.20 (dartpy)",
    written="dynamicsAspect->setRestitutionCoeff({number});  // of both bodies",
    pair=PRODUCT,
    threshold=0.1,
    is_of_rebound=True,
)
_RAPIER = ByNumber(
    name="rapier",
    rule=step_rules.rapier,
    ran="Rapier 0.36 (Python) and 0.21 (JavaScript)",
    written="ColliderBuilder::ball(radius).restitution({number})  // and the ground",
    sinks=(step_rules.SUBSTEPS + 1) / (2 * step_rules.SUBSTEPS),
    remembers=2000,
    notes=("Before 0.35 Rapier had another rule",),
)
BY_NUMBER = {
    each.name: each
    for each in (
        _JOLT,
        replace(
            _JOLT,
            name="godot-jolt",
            written="physics_material.bounce = {number}  # of both bodies",
            parameter="bounce",
            pair=_CLAMPED_SUM,
            set_by="physics/jolt_physics_3d/simulation/bounce_velocity_threshold",
            lowered="physics/jolt_physics_3d/simulation/bounce_velocity_threshold={threshold}"
            "  # project setting",
            damped_by="default_linear_damp",
            damping=0.1,
            notes=("Godot was not run: its source hands these numbers to Jolt",),
        ),
        _PHYSX,
        replace(
            _PHYSX,
            name="unity",
            rule=partial(step_rules.physx, ahead=0.02),
            written="material.bounciness = {number}f;  // of both colliders",
            parameter="bounciness",
            set_by="Physics.bounceThreshold",
            springs="",
            lowered="Physics.bounceThreshold = {threshold}f;",
            notes=("Unity was not run: it has PhysX 4.1 with a contact offset of 10 mm",),
        ),
        replace(
            _PHYSX,
            name="isaac-lab",
            written="RigidBodyMaterialCfg(restitution={number})  # of both bodies",
            rule=partial(step_rules.physx, ahead=math.inf),
            threshold=0.5,
            set_by="PhysxCfg.bounce_threshold_velocity",
            lowered="PhysxCfg(bounce_threshold_velocity={threshold})  # of SimulationCfg(physx=…)",
            notes=(
                "Isaac Lab was not run: it has PhysX 5. The contact offset is taken as longer than "
                "the way of the body in a step",
            ),
        ),
        replace(
            _PHYSX,
            name="isaac-sim",
            written="PhysicsMaterial(restitution={number})  # of both bodies",
            rule=partial(step_rules.physx, ahead=math.inf),
            threshold=0.0,
            set_by="physxScene:bounceThreshold",
            lowered="float physxScene:bounceThreshold = {threshold}",
            notes=(
                "Isaac Sim was not run: it has PhysX 5, and by its USD schema no threshold. The "
                "contact offset is taken as longer than the way of the body in a step",
            ),
        ),
        _RAPIER,
        ByNumber(
            name="box2d",
            rule=step_rules.box2d,
            ran="Box2D 3 (box2d3-wasm 5.2.0)",
            written="shapeDef.material.restitution = {number}f;  // of one of both shapes",
            pair=LARGER,
            threshold=1.0,
            set_by="b2WorldDef.restitutionThreshold",
            lowered="worldDef.restitutionThreshold = {threshold}f;",
            sinks=_RAPIER.sinks,
            notes=("Box2D 2 has another rule: --engine box2d-2",),
        ),
        _BOX2D_2,
        replace(
            _BOX2D_2,
            name="planck",
            ran="planck 1.4.2",
            written="body.createFixture({{shape, restitution: {number}}})  // one of both",
            set_by="Settings.velocityThreshold",
            lowered="Settings.velocityThreshold = {threshold};",
            notes=(),
        ),
        ByNumber(
            name="chipmunk",
            rule=step_rules.chipmunk,
            ran="Chipmunk 7 (pymunk 7.3.1)",
            written="shape.elasticity = {number}  # of both shapes",
            parameter="elasticity",
            pair=PRODUCT,
            sinks=0.0,
        ),
        _DART,
        replace(
            _DART,
            name="gazebo-sim",
            written="<bounce><restitution_coefficient>{number}</restitution_coefficient></bounce>"
            "  <!-- of both collisions -->",
            parameter="restitution_coefficient",
            ran="Gazebo's physics with DART (Ignition Physics 5.1.0 of Debian)",
            notes=(
                "With its default engine Gazebo hands this number to DART, and the threshold of "
                "the same element is not read",
            ),
        ),
        ByNumber(
            name="matter-js",
            rule=step_rules.matter,
            ran="matter-js 0.20.0",
            written="Bodies.circle(x, y, radius, {{restitution: {number}}})  // one of both",
            pair=LARGER,
            notes=(
                "A circle is a polygon there: one of a radius of 20 pixels has 20 sides, and an r "
                "that is lower by 0.02",
                "Of gravity and lengths in pixels give those in metres at the same ratio",
            ),
            damped_by="frictionAir",
            damping=0.01,
            kept=lambda damping, step: max(1 - damping * step * 60, 0.0),
        ),
        ByNumber(
            name="newton-xpbd",
            rule=step_rules.xpbd,
            ran="Newton 1.8.0",
            written="ShapeConfig(restitution={number})  # SolverXPBD(model, "
            "enable_restitution=True)",
        ),
        ByNumber(
            name="cannon-es",
            rule=step_rules.cannon,
            ran="cannon-es 0.20.0",
            written="new ContactMaterial(a, b, {{restitution: {number}}})",
            pair=PAIR,
            notes=(
                "With contactEquationRelaxation = 3 and contactEquationStiffness = 1e7, the "
                "defaults; r depends on where in a step the impact is",
            ),
            damped_by="linearDamping",
            damping=0.01,
            kept=lambda damping, step: (1 - min(damping, 1.0)) ** step,
        ),
    )
}
"""The engines, and products on top of one, by their names."""
_OTHER_NAMES = {
    "box2d3": "box2d",
    "cannon": "cannon-es",
    "chipmunk2d": "chipmunk",
    "dartpy": "dart",
    "dartsim": "dart",
    "gazeboharmonic": "gazebo-sim",
    "gz": "gazebo-sim",
    "gzsim": "gazebo-sim",
    "ignition": "gazebo-sim",
    "ignitiongazebo": "gazebo-sim",
    "isaac": "isaac-sim",
    "matter": "matter-js",
    "nvidiaphysx": "physx",
    "pybox2d": "box2d-2",
    "pymunk": "chipmunk",
    "rapier2d": "rapier",
    "rapier3d": "rapier",
    "ue": "unreal",
    "unity3d": "unity",
    "xpbd": "newton-xpbd",
}
WITHOUT_ANSWER = {
    "ammo": "ammo.js is Bullet, and was not run; for the Bullet of Python take pybullet",
    "adams": "Adams was not run, and its source cannot be read",
    "bepu": "BepuPhysics 2 has no restitution: a contact is a spring with a frequency and a "
    "damping ratio, which was not run",
    "blender": "Blender has Bullet, and was not run; for the Bullet of Python take pybullet",
    "brax": "Brax has four pipelines, of which none was run; for the one of MJX take mujoco",
    "coppeliasim": "CoppeliaSim has several engines: take the one that is chosen there, such as "
    "pybullet, ode or mujoco",
    "godot": "Godot has two engines: take godot-jolt for Jolt Physics; Godot Physics was not run",
    "havok": "Havok was not run, and its source cannot be read",
    "isaac-gym": "Isaac Gym has a PhysX of its own, and was not run; for PhysX 5 take physx",
    "physx-3": "PhysX 3 was not run; unity and physx have the rule of PhysX 4 and 5",
    "sapien": "SAPIEN has PhysX, and was not run; for PhysX 5 take physx",
    "simscape": "Simscape was not run, and its source cannot be read",
    "three": "three.js has no physics: take the engine beside it, such as cannon-es or rapier",
    "unreal": "Unreal 5 has Chaos, which was not run, and Unreal 4 has PhysX 3.4",
    "warp": "Warp has no contacts of its own: take mujoco-warp, or newton",
    "webots": "Webots has an ODE of its own, which was not run; for ODE take ode",
}
"""Names that people type, and why there is no answer."""


def engine_by_number(name: str) -> ByNumber | None:
    """Return the engine of this name whose restitution is a number; None if it has another row.

    Raises
    ------
    Refused
        If the name is known, but nothing is known of its bounce.
    """
    known = {re.sub(r"\W", "", each): each for each in (*BY_NUMBER, *WITHOUT_ANSWER)} | _OTHER_NAMES
    plain = re.sub(r"[\W_]", "", name.lower())
    # A version at the end, and words such as "engine", belong to no name.
    bare = re.sub(r"(physics|engine|js)*(v?\d+)?$", "", plain)
    found = known.get(plain) or known.get(bare)
    if found in WITHOUT_ANSWER:
        raise Refused(f"{name}: {WITHOUT_ANSWER[found]}")
    near = difflib.get_close_matches(plain, known, 1, 0.85)
    if found is None and near:
        raise Refused(f"engine {name!r} is not known; did you mean {known[near[0]]}?")
    return BY_NUMBER.get(found or "")


def _damped(engine: ByNumber, at: Fall, z: float, v: float) -> tuple[Array, Array]:
    """Return heights and velocities of a free flight with a linear damping, until it is low."""
    # A step far above the surface.
    pull = -next(engine.rule(at, 1e6, 0.0))[1]
    time = (v + math.sqrt(v * v + 2 * at.gravity * z)) / at.gravity
    n = np.arange(1, math.ceil(2 * time / at.step) + 10)
    left = at.keeps**n
    speeds = left * v - pull * (1 - left) / (1 - at.keeps)
    return z + at.step * np.cumsum(speeds), speeds


def _first_rebound(engine: ByNumber, at: Fall, height: float, speed: float) -> float:
    """Return r of a ball that is dropped from a height, or without gravity arrives with a speed."""
    z = height
    v = 0.0 if at.gravity else -speed
    near = _REACH + 4 * speed * at.step
    drop = at.added * at.step
    if at.keeps < 1 and drop:
        heights, speeds = _damped(engine, at, z, v)
        n = max(int(np.argmax(heights < near)) - engine.remembers, 0)
        if n:
            z = float(heights[n - 1])
            v = float(speeds[n - 1])
    elif drop:
        # Down to where a contact may be found the ball flies n steps freely.
        n = math.floor(math.sqrt(2 * max(z - near, 0.0) / drop))
        n = max(n - engine.remembers, 0)
        z -= drop * (n * (n - 1) / 2 + engine.sinks * n)
        v -= at.added * n
    rises = False
    most = 2000 + math.ceil(6 * near / (speed * at.step))
    steps = engine.rule(at, z, v)
    for z_next, v in islice(steps, most):
        if rises and z_next < z:
            return math.sqrt(max(z, 0.0) / height)
        rises |= z_next > z
        z = z_next
        if v > 0 and z > _REACH and rises:
            if not drop:
                return v / speed
            # And so it flies up to its top.
            if at.keeps < 1:
                return math.sqrt(max(z, float(_damped(engine, at, z, v)[0].max())) / height)
            n = max(math.floor(v / at.added - engine.sinks) + 1, 0)
            z += n * at.step * v - drop * (n * (n - 1) / 2 + engine.sinks * n)
            return math.sqrt(z / height)
    # It lies still, or is pushed out slowly.
    return 0.0


def restitutions(engine: ByNumber, at: Fall, speed: float, instants: int | None = None) -> Array:
    """Return √(h′/h) of impacts with a speed in m/s, at instants within a step.

    Without gravity it is the ratio of the speeds.

    >>> at = Fall(number=0.8, step=1 / 60, gravity=9.81, threshold=1.0, radius=0.1)
    >>> round(float(restitutions(BY_NUMBER["jolt"], at, speed=1.4).mean()), 2)
    0.83
    """
    way = speed * at.step
    if not 1e-7 < way < 1e3:
        raise Refused(
            f"a ball with {show(speed, 'm/s')} moves {show(way, 'm')} in a step of "
            f"{show(at.step, 's')}: between 0.1 µm and 1 km are computed"
        )
    # Of 0.1 mm.
    instants = instants or (INSTANTS if way > 1e-4 else INSTANTS // 6)
    fraction = np.arange(instants) / instants - 0.5
    height = speed**2 / (2 * at.gravity) if at.gravity else _REACH + speed * at.step
    heights = height + speed * at.step * fraction
    if heights[0] <= 0:
        raise Refused(
            f"a step of {show(at.step, 's')} is longer than the fall: give a shorter one, or a "
            "greater height"
        )
    return np.array([_first_rebound(engine, at, float(h), speed) for h in heights])


# Of a body that is not given: no rule depends on the mass, and on the radius for fast bodies only.
_BODY: Mapping[str, Quantity] = {"mass": 1.0, "radius": 0.1}


def falling(**quantities: Quantity) -> Bounce:
    """Return the bounce of a ball, which has a radius of 0.1 m if neither mass nor size is given.

    Raises
    ------
    Refused
        If a quantity cannot be read, or has no place here.
    """
    given = {name: value for name, value in quantities.items() if value is not None}
    for name in ("penetration", "stiffness", "contact_time", "other_mass"):
        if name in given:
            option = name.replace("_", "-")
            raise Refused(f"--{option} has no place where the restitution is a number")
    if given.get("points", 1) != 1:
        raise Refused("--points has no place where the restitution is a number: a ball is dropped")
    body = {} if given.keys() & {"mass", "radius", "density"} else _BODY
    return Bounce(**({"mass": 1.0} | dict(body) | given))


@dataclass(frozen=True, repr=False)
class Rebound(Page):
    """What a restitution number does in an engine.

    ``written`` is the number of a body: of both alike, or of one if ``other`` has that of the other
    one. ``number`` is that of both together, ``threshold`` in m/s, and ``restitution`` has the
    least, the mean and the greatest r; ``slower`` has those at a third of the speed. ``change``
    is the same with r nearest to the wanted one, and ``shorter`` that at the longest step at which
    r is within the tolerance; they are None if this one is.
    """

    engine: str
    bounce: Bounce
    time_step: float
    written: float
    other: float | None
    number: float
    threshold: float
    restitution: tuple[float, float, float]
    slower: tuple[float, float, float]
    damping: float = 0.0
    combine: str = ""
    change: "Rebound | None" = None
    shorter: "Rebound | None" = None
    is_beyond: bool = False
    """Whether no number keeps r at this step."""

    @property
    def deviation(self) -> float:
        """The largest distance of r from the wanted one."""
        low, _, high = self.restitution
        return max(self.bounce.restitution - low, high - self.bounce.restitution)

    @property
    def snippet(self) -> str:
        """What is pasted into the engine."""
        row = BY_NUMBER[self.engine]
        line = row.written.format(number=f"{self.written:.4g}")
        lowered = row.lowered.format(threshold=f"{self.threshold:.2g}")
        return line if self.threshold == row.threshold else f"{line}\n{lowered}"

    @property
    def notes(self) -> tuple[str, ...]:
        """What a user has to know, the severest first."""
        row = BY_NUMBER[self.engine]
        speed = self.bounce.impact_speed
        mean = self.restitution[1]
        limit = f"{show(self.threshold, 'm/s')}" + (f", {row.set_by}" if row.set_by else "")
        slowest = self.threshold / (max(self.number, 1e-9) if row.is_of_rebound else 1.0)
        is_slow = self.number > 0 and 0 < speed <= slowest
        lowest = slowest**2 / (2 * self.bounce.gravity) if self.bounce.gravity else 0.0
        way = speed * self.time_step
        settling = self.bounce.load * self.time_step / max(1 - self.number, 1e-9)
        hops = row.is_physx and 0 < self.number < 1 and self.threshold < settling
        said = {
            f"nothing bounces: the other body has 0, and the numbers are {self.combine}": (
                self.number == 0 < self.written
            ),
            f"it does not bounce: {show(speed, 'm/s')} is not above the threshold of {limit}": (
                is_slow and mean < 0.1
            ),
            f"at some instants it does not bounce: {show(speed, 'm/s')} is near the threshold of "
            f"{limit}": self.restitution[0] == 0 < mean and slowest < speed < 2 * slowest,
            f"r is up to {self.restitution[2]:.3f}: at some instants the ball gains energy": (
                self.restitution[2] >= 1.0005
            ),
            f"at a third of the speed r is {_around(self.slower)}": speed / 3 > slowest
            and abs(self.slower[1] - mean) > TOLERANCE / 2,
            f"drops from less than {show(lowest, 'm')} do not bounce: the threshold is {limit}": (
                not is_slow and lowest > 0 and self.number > 0
            ),
            f"it may hop for ever: above a threshold of {show(settling, 'm/s')} it comes to rest": (
                hops
            ),
            f"no number keeps r within {TOLERANCE:g} at this step": self.is_beyond,
            f"it moves {show(way, 'm')} in a step, farther than its radius: it may pass a thin "
            "table": way > self.bounce.size,
        }
        return tuple(text for text, holds in said.items() if holds)

    @property
    def gives(self) -> str:
        """What the number does, in words."""
        row = BY_NUMBER[self.engine]
        lowered = "" if self.threshold == row.threshold else f" and {row.set_by} = "
        lowered += f"{self.threshold:.2g}" if lowered else ""
        number = f"{row.parameter} = {self.written:.4g}{lowered}"
        return f"{number} gives r = {_around(self.restitution)}"

    def __repr__(self) -> str:
        wanted = self.bounce.restitution
        goal = "" if wanted is None else f"; {wanted:g} is wanted"
        head = f"{self.engine} at a step of {show(self.time_step, 's')}: {self.gives}{goal}"
        return "\n".join([head, *(f"! {note}" for note in self.notes)])

    def __str__(self) -> str:
        row = BY_NUMBER[self.engine]
        other = "alike" if self.other is None else f"and {self.other:g} of the other body"
        given = dict(self.bounce.given)
        for name, value in _BODY.items():
            if getattr(self.bounce, name) == value:
                given.pop(name, None)
        step = f"time step {show(self.time_step, 's', 4)}"
        lines = [repr(self)]
        if self.change is not None:
            of_both = (
                " (of both bodies)" if self.other is not None and self.change.other is None else ""
            )
            lines.append(f"Least change: {self.change.gives}{of_both}.")
        if self.shorter is not None:
            step_of = show(self.shorter.time_step, "s", 4)
            lines.append(f"At a step of {step_of} {self.shorter.gives}.")
        elif self.is_beyond:
            lines.append("Nor does one at a half, a quarter, … a 128th of the step.")
        lines += [
            "",
            (self.change or self).snippet,
            "",
            f"Given: {', '.join([*(f'{name} {value}' for name, value in given.items()), step])}.",
            f"The numbers of both bodies, {other}: {self.combine}; together {self.number:.4g}.",
            f"r is √(h′/h) over all instants within a step, by the rule of {row.ran}.",
            *(f"{note}." for note in row.notes),
        ]
        if row.damped_by:
            default = ", the default" if self.damping == row.damping else ""
            lines.append(
                f"The flights are damped by {row.damped_by} = {self.damping:g}{default}, which "
                "lowers r: it holds for this height only."
            )
        if self.bounce.friction is not None:
            lines.append("Friction acts along the surface only: r is computed without it.")
        if self.bounce.drop_height is self.bounce.speed is None:
            lines.append("Assumed: a drop from 1 m (--drop-height or --speed).")
        return "\n".join(lines)


def _around(restitution: tuple[float, float, float]) -> str:
    low, mean, high = restitution
    error = max(mean - low, high - mean)
    return span(low, high) if 0 < mean <= error else f"{mean:.3f} ± {error:.3f}"


def _rebound(
    engine: ByNumber,
    bounce: Bounce,
    step: float,
    threshold: float,
    written: float,
    other: float | None = None,
) -> Rebound:
    """Return what a number does."""
    number = engine.pair.of(written, written if other is None else other)
    at = engine.fall(number, bounce, step, threshold)
    speed = bounce.impact_speed
    found = restitutions(engine, at, speed)
    try:
        slower = restitutions(engine, at, speed / 3)
    except Refused:
        slower = found
    return Rebound(
        engine=engine.name,
        bounce=bounce,
        time_step=step,
        written=written,
        other=other,
        number=number,
        threshold=threshold,
        restitution=(float(found.min()), float(found.mean()), float(found.max())),
        slower=(float(slower.min()), float(slower.mean()), float(slower.max())),
        damping=engine.damping,
        combine=engine.pair.text,
    )


def _nearest(
    engine: ByNumber, bounce: Bounce, step: float, threshold: float, other: float | None
) -> Rebound:
    """Return the rebound whose mean r is the wanted one, or the nearest to it, by bisection."""
    speed = bounce.impact_speed
    low = 0.0
    high = 1.0
    while high - low > 1e-4:
        written = (low + high) / 2
        number = engine.pair.of(written, written if other is None else other)
        at = engine.fall(number, bounce, step, threshold)
        if restitutions(engine, at, speed).mean() < bounce.restitution:
            low = written
        else:
            high = written
    written = float(f"{high:.4f}")
    return _rebound(engine, bounce, step, threshold, written, other)


def _wanted(
    engine: ByNumber, bounce: Bounce, step: float, threshold: float, other: float | None
) -> Rebound:
    """Return the nearest rebound, with a lower threshold if this one is in the way.

    It is lowered to a quarter of the speed, or to what lets the ball come to rest.
    """
    found = _nearest(engine, bounce, step, threshold, other)
    if found.deviation > TOLERANCE and engine.set_by and bounce.impact_speed < 1.5 * threshold:
        settling = SETTLED * bounce.load * step / max(1 - bounce.restitution, 1e-9)
        settles = engine.is_physx and settling < 0.9 * bounce.impact_speed
        least = max(bounce.impact_speed / 4, settling * settles)
        lowered = float(f"{least:.2g}")
        lower = _nearest(engine, bounce, step, lowered, other)
        return min(found, lower, key=lambda each: each.deviation)
    return found


def _shorter(found: Rebound, engine: ByNumber) -> Rebound | None:
    """Return the rebound at a half, a quarter, … of the step, where r is within the tolerance."""
    if found.deviation <= TOLERANCE:
        return None
    steps = [found.time_step / 2**n for n in range(1, 8)]
    tried = (_wanted(engine, found.bounce, h, found.threshold, found.other) for h in steps)
    return next((each for each in tried if each.deviation <= TOLERANCE), None)


def number_for(bounce: Bounce, engine: ByNumber, time_step: Quantity) -> Rebound:
    """Return the restitution number with which a ball bounces as wanted, for both bodies alike.

    Raises
    ------
    Refused
        If the restitution or the step is missing.
    """
    if bounce.restitution is None:
        raise Refused("the restitution is missing: --restitution 0.8 or restitution=0.8")
    found = _wanted(engine, bounce, _step(time_step), engine.threshold, None)
    is_beyond = found.deviation > TOLERANCE
    return replace(found, shorter=_shorter(found, engine), is_beyond=is_beyond)


def rebound(
    bounce: Bounce,
    engine: ByNumber,
    parameters: Mapping[str, Any],
    time_step: Quantity,
    other: Mapping[str, Any] | None = None,
) -> Rebound:
    """Return the bounce that a restitution number gives, and the number for the one wanted.

    Parameters
    ----------
    bounce : Bounce
        Its restitution is the one that is wanted, and may be left out.
    engine : ByNumber
    parameters : mapping
        The number by its name in the engine or as "restitution", and the threshold by its name or
        as "threshold", if it can be set.
    time_step : Quantity
    other : mapping, optional
        The number of the other body, by default that of the engine; without it both are alike.

    Raises
    ------
    Refused
        If a parameter or the step is missing, unknown or out of its range.
    """
    given = _given(engine, parameters)
    step = _step(time_step)
    if "number" not in given:
        raise Refused(f"{engine.parameter} is missing: give {engine.parameter}=0.8")
    engine = replace(
        engine,
        damping=given.get("damping", engine.damping),
        pair=given.get("combine", engine.pair),
    )
    beside = None
    if other is not None:
        beside = _given(engine, other).get("number", engine.default)
    threshold = given.get("threshold", engine.threshold)
    found = _rebound(engine, bounce, step, threshold, given["number"], beside)
    if bounce.restitution is None or found.deviation <= TOLERANCE:
        return found
    change = _wanted(engine, bounce, step, threshold, beside)
    if beside is not None and change.deviation > TOLERANCE:
        # The number of one body may not be enough.
        alike = _wanted(engine, bounce, step, threshold, None)
        change = min(change, alike, key=lambda each: each.deviation)
    return replace(
        found,
        change=change,
        shorter=_shorter(change, engine),
        is_beyond=change.deviation > TOLERANCE,
    )


def _step(time_step: Quantity) -> float:
    if time_step is None:
        raise Refused("the time step is missing: --time-step 1/60 or time_step='2 ms'")
    return step_in_si(time_step)


def _given(engine: ByNumber, typed: Mapping[str, Any]) -> dict[str, Any]:
    """Return the number, the threshold, the damping and how two numbers are combined, as typed."""
    found: dict[str, Any] = {}
    for name, value in typed.items():
        meant = engine.names.get(name.lower())
        if meant == "number":
            found[meant] = within(name, value, 0, 1)
        elif meant == "threshold":
            found[meant] = within(name, in_si(name, value, "m/s"), 0, math.inf)
        elif meant == "damping":
            found[meant] = within(name, value, 0, math.inf)
        elif meant == "combine":
            modes = [mode for mode in COMBINED if mode.startswith(str(value).lower()[:3])]
            if len(str(value)) < 3 or not modes:
                raise Refused(f"{name} = {value} is none of {', '.join(COMBINED)}")
            found[meant] = COMBINED[modes[0]]
        else:
            combine = "combine" if "combine" in engine.names else ""
            known = [engine.parameter, engine.set_by, engine.damped_by, combine]
            has = " and ".join(filter(None, known))
            raise Refused(f"{engine.name} does not use {name!r}: it has {has}")
    return found

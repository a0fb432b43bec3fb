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
from bisect import bisect_left
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import partial
from itertools import islice
from typing import Any, NamedTuple

import numpy as np

from bouncing_ball_contacts import step_rules
from bouncing_ball_contacts.designs import (
    SETTLED,
    TOLERANCE,
    Bounce,
    Quantity,
    Range,
)
from bouncing_ball_contacts.engines import (
    LARGER,
    MEAN,
    MODES,
    PAIR,
    PRODUCT,
    Rule,
    as_compared,
    one_of,
    parameters_of,
)
from bouncing_ball_contacts.schemes import Array
from bouncing_ball_contacts.step_rules import Fall, Steps
from bouncing_ball_contacts.units import (
    STANDARD_GRAVITY,
    Refused,
    holding,
    in_si,
    positive,
    refuse,
    show,
    step_in_si,
    within,
)

_CLAMPED_SUM = Rule("added, and at most 1", lambda a, b: min(a + b, 1.0), lambda x: x / 2)
INSTANTS = 24
"""Of the impact within a step; a sixth of them in short steps, where r hardly depends on them."""
# Where a body flies freely: no engine finds its contact farther away, in m.
_REACH = 0.06


@dataclass(frozen=True)
class ByNumber:
    """An engine whose restitution is a number.

    ``parameter`` is its name, ``pair`` how the engine combines those of two bodies, ``default`` the
    one of a body that has none. Impacts slower than ``threshold`` have no restitution, or, if it
    ``is_of_rebound``, bodies that would leave more slowly; ``set_by`` is its name, if it has one.
    ``sinks`` is by how many times g h² a body falls farther in a
    step than with the velocity before it, and ``remembers`` how many steps before an impact matter.
    ``springs`` is the row of the same engine in :data:`.ENGINES`, if it takes a stiffness as well.
    ``written`` is the line to paste, and ``lowered`` the one of another threshold, empty if that is
    a constant. If it ``is_physx``, materials say how their numbers are combined. If it
    ``is_restless``, each step of gravity is thrown back, and a threshold above g h/(1 - r) lets a
    body come to rest. ``damped_by`` is the linear damping of a body with its default ``damping``,
    and ``kept`` the share of a velocity that it leaves in a step. ``pixels`` is how many of them
    are a metre, of an engine whose lengths are pixels. ``relaxation`` is that of contacts of
    cannon-es. ``others`` are rows of the engine with another ``setting``, of which the best one is
    taken where no number keeps r.
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
    is_restless: bool = False
    pixels: float = 0.0
    damped_by: str = ""
    damping: float = 0.0
    kept: Callable[[float, float], float] = lambda damping, step: 1.0
    relaxation: float = 0.0
    setting: str = ""
    others: tuple["ByNumber", ...] = ()
    notes: tuple[str, ...] = ()

    @property
    def names(self) -> dict[str, str]:
        """What the names that may be typed stand for, as they are compared."""
        modes = ("combine", "bounceCombine", "restitutionCombineMode")
        typed = {
            "number": ("restitution", self.parameter),
            "threshold": ("threshold", "" if self.pixels else self.set_by) if self.set_by else (),
            "threshold in pixels": (self.set_by,) if self.pixels else (),
            "combine": modes if self.is_physx else (),
            "damping": (self.damped_by,) if self.damped_by else (),
            "pixels": ("pixels",) if self.pixels else (),
            "relaxation": ("contactEquationRelaxation",) if self.relaxation else (),
        }
        return {as_compared(name): what for what, names in typed.items() for name in names}

    @property
    def unit(self) -> float:
        """The unit of the threshold as it is set in m/s; in pixels it is one in 1/60 s."""
        return 60 / self.pixels if self.pixels else 1.0

    @property
    def limit(self) -> str:
        """The threshold with its name."""
        pixels = f"{self.threshold / self.unit:.3g} pixels in 1/60 s" if self.pixels else ""
        return ", ".join(filter(None, [show(self.threshold, "m/s"), pixels, self.set_by]))

    def scaled(self, gravity: float, pixels: float | None = None) -> "ByNumber":
        """Return the engine with so many pixels a metre, by default those of its own gravity."""
        if not self.pixels:
            return self
        scale = pixels or _PIXELS / (gravity or STANDARD_GRAVITY)
        return replace(self, pixels=scale, threshold=self.threshold * self.pixels / scale)


def _undamped(engine: ByNumber, written: str) -> ByNumber:
    """Return the engine with a row of its own for bodies without linear damping."""
    setting = f"{engine.damped_by} = 0"
    undamped = replace(engine, damping=0.0, setting=setting, written=written)
    return replace(engine, others=(*engine.others, undamped))


# In 1/s², the default gravity of matter-js.
_PIXELS = 1000.0
_JOLT = ByNumber(
    name="jolt",
    rule=step_rules.jolt,
    ran="Jolt 5 (jolt-physics 1.1.0 for JavaScript)",
    written="bodySettings.mRestitution = {number}f;  // of {bodies}",
    parameter="mRestitution",
    pair=LARGER,
    threshold=1.0,
    set_by="PhysicsSettings::mMinVelocityForRestitution",
    lowered="physicsSettings.mMinVelocityForRestitution = {threshold}f;",
    damped_by="mLinearDamping",
    damping=0.05,
    kept=lambda damping, step: max(1 - damping * step, 0.0),
    notes=("Before 5.3 (November 2024) Jolt had another rule, by which 1 gave 1.017 from 5 m",),
)
_PHYSX = ByNumber(
    name="physx",
    rule=partial(step_rules.physx, ahead=0.04),
    ran="PhysX 5.6.1 (physx-js-webidl 2.7.3)",
    written="material->setRestitution({number}f);  // of {bodies}",
    threshold=2.0,
    set_by="bounceThresholdVelocity",
    springs="physx",
    is_physx=True,
    is_restless=True,
    lowered="sceneDesc.bounceThresholdVelocity = {threshold}f;",
)
_BOX2D_2 = ByNumber(
    name="box2d-2",
    rule=step_rules.box2d_2,
    ran="Box2D 2.3.10 of Python",
    written="fixtureDef.restitution = {number}f;  // of {bodies}",
    pair=LARGER,
    threshold=1.0,
    is_restless=True,
    set_by="b2_velocityThreshold",
    notes=("The threshold is a constant of the library",),
)
_DART = ByNumber(
    name="dart",
    rule=step_rules.dart,
    ran="DART 6.20 (dartpy)",
    written="dynamicsAspect->setRestitutionCoeff({number});  // of {bodies}",
    pair=PRODUCT,
    threshold=0.1,
    is_of_rebound=True,
    is_restless=True,
    notes=("The threshold is a constant of the library",),
)
_GODOT = "physics_material.bounce = {number}  # of {bodies}"
_CANNON = ByNumber(
    name="cannon-es",
    rule=step_rules.cannon,
    ran="cannon-es 0.20.0",
    written="new ContactMaterial(a, b, {{restitution: {number}}})",
    pair=PAIR,
    notes=("The contactEquationStiffness is taken as 1e7, the default",),
    relaxation=3.0,
    damped_by="linearDamping",
    damping=0.01,
    kept=lambda damping, step: (1 - min(damping, 1.0)) ** step,
)


def _relaxed(engine: ByNumber, steps: float) -> ByNumber:
    """Return cannon-es with contacts that relax in so many steps."""
    setting = f"contactEquationRelaxation = {steps:g}"
    options = f"{{{{restitution: {{number}}, {setting.replace(' =', ':')}}}}}"
    written = f"new ContactMaterial(a, b, {options})"
    return replace(engine, relaxation=steps, setting=setting, written=written)


_MATTER = ByNumber(
    name="matter-js",
    rule=step_rules.matter,
    ran="matter-js 0.20.0",
    written="Bodies.circle(x, y, radius, {{restitution: {number}}})  // of {bodies}",
    pair=LARGER,
    notes=(
        "A circle is a polygon there: one of a radius of 20 pixels has 20 sides, and an r that is "
        "lower by 0.02",
        "Below the threshold a ball with a number above 0.98 may also leave faster than it came",
    ),
    threshold=2 * 60 * STANDARD_GRAVITY / _PIXELS,
    set_by="Resolver._restingThresh",
    lowered="Matter.Resolver._restingThresh = {threshold};",
    pixels=_PIXELS / STANDARD_GRAVITY,
    damped_by="frictionAir",
    damping=0.01,
    kept=lambda damping, step: max(1 - damping * step * 60, 0.0),
)
_RAPIER = ByNumber(
    name="rapier",
    rule=step_rules.rapier,
    ran="Rapier 0.36 (Python) and 0.21 (JavaScript)",
    written="ColliderBuilder::ball(radius).restitution({number})  // of {bodies}",
    sinks=(step_rules.SUBSTEPS + 1) / (2 * step_rules.SUBSTEPS),
    remembers=2000,
    notes=("Before 0.35 Rapier had another rule",),
)
BY_NUMBER = {
    each.name: each
    for each in (
        _undamped(_JOLT, f"{_JOLT.written}\nbodySettings.mLinearDamping = 0.0f;"),
        _undamped(
            replace(
                _JOLT,
                name="godot-jolt",
                written=_GODOT,
                parameter="bounce",
                pair=_CLAMPED_SUM,
                set_by="physics/jolt_physics_3d/simulation/bounce_velocity_threshold",
                lowered="physics/jolt_physics_3d/simulation/bounce_velocity_threshold={threshold}"
                "  # project setting",
                damped_by="default_linear_damp",
                damping=0.1,
                notes=(*_JOLT.notes, "Godot was not run: its source hands these numbers to Jolt"),
            ),
            f"{_GODOT}\nphysics/3d/default_linear_damp=0.0  # project setting",
        ),
        _PHYSX,
        replace(
            _PHYSX,
            name="unity",
            rule=partial(step_rules.physx, ahead=0.02),
            written="material.bounciness = {number}f;  // of {bodies}",
            parameter="bounciness",
            set_by="Physics.bounceThreshold",
            springs="",
            lowered="Physics.bounceThreshold = {threshold}f;",
            notes=("Unity was not run: it has PhysX 4.1 with a contact offset of 10 mm",),
        ),
        replace(
            _PHYSX,
            name="isaac-lab",
            written="RigidBodyMaterialCfg(restitution={number})  # of {bodies}",
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
            written="PhysicsMaterial(restitution={number})  # of {bodies}",
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
            written="shapeDef.material.restitution = {number}f;  // of {bodies}",
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
            written="body.createFixture({{shape, restitution: {number}}})  // of {bodies}",
            set_by="Settings.velocityThreshold",
            lowered="Settings.velocityThreshold = {threshold};",
            notes=(),
        ),
        ByNumber(
            name="chipmunk",
            rule=step_rules.chipmunk,
            ran="Chipmunk 7 (pymunk 7.3.1)",
            written="shape.elasticity = {number}  # of {bodies}",
            parameter="elasticity",
            pair=PRODUCT,
            sinks=0.0,
        ),
        _DART,
        replace(
            _DART,
            name="gazebo-sim",
            written="<bounce><restitution_coefficient>{number}</restitution_coefficient></bounce>"
            "  <!-- of {bodies} -->",
            parameter="restitution_coefficient",
            ran="Gazebo's physics with DART (Ignition Physics 5.1.0 of Debian)",
            notes=(
                "With its default engine Gazebo hands this number to DART, and the threshold of "
                "the same element is not read",
            ),
        ),
        _undamped(
            _MATTER,
            "Bodies.circle(x, y, radius, {{restitution: {number}, frictionAir: 0}})"
            "  // of {bodies}",
        ),
        ByNumber(
            name="newton-xpbd",
            rule=step_rules.xpbd,
            ran="Newton 1.8.0",
            written="ShapeConfig(restitution={number})  # SolverXPBD(model, "
            "enable_restitution=True)",
        ),
        replace(_CANNON, others=(_relaxed(_CANNON, 10.0), _relaxed(_CANNON, 50.0))),
    )
}
"""The engines, and products on top of one, by their names."""
_OTHER_NAMES = {
    "bevyrapier": "rapier",
    "box2d3": "box2d",
    "cannon": "cannon-es",
    "dartpy": "dart",
    "dartsim": "dart",
    "gazeboharmonic": "gazebo-sim",
    "gz": "gazebo-sim",
    "gzsim": "gazebo-sim",
    "ignition": "gazebo-sim",
    "ignitiongazebo": "gazebo-sim",
    "isaac": "isaac-sim",
    "libgdx": "box2d-2",
    "matter": "matter-js",
    "nvidiaphysx": "physx",
    "p5play": "planck",
    "pybox2d": "box2d-2",
    "pymunk": "chipmunk",
    "bevyxpbd": "avian",
    "chaos": "unreal",
    "ue": "unreal",
    "xpbd": "newton-xpbd",
}
WITHOUT_ANSWER = {
    "ammo": "ammo.js is Bullet, and was not run; for the Bullet of Python take pybullet",
    "avian": "Avian has a solver of its own, which was not run",
    "adams": "Adams was not run, and its source cannot be read",
    "bepu": "BepuPhysics 2 has no restitution: a contact is a spring with a frequency and a "
    "damping ratio, which was not run",
    "blender": "Blender has Bullet, and was not run; for the Bullet of Python take pybullet",
    "brax": "Brax has four pipelines, of which none was run; for the one of MJX take mujoco",
    "construct": "Construct has Box2D, of a version that was not run: take box2d-2, or box2d for "
    "Box2D 3",
    "coppeliasim": "CoppeliaSim has several engines: take the one that is chosen there, such as "
    "pybullet, ode or mujoco",
    "gdevelop": "GDevelop has Box2D in two dimensions, of a version that was not run: take box2d-2",
    "godot": "Godot has two engines: take godot-jolt for Jolt Physics; Godot Physics was not run",
    "havok": "Havok was not run, and its source cannot be read",
    "isaac-gym": "Isaac Gym has a PhysX of its own, and was not run; for PhysX 5 take physx",
    "phaser": "Phaser has two engines: for Matter take matter-js; Arcade Physics was not run",
    "physx-3": "PhysX 3 was not run; unity and physx have the rule of PhysX 4 and 5",
    "sapien": "SAPIEN has PhysX, and was not run; for PhysX 5 take physx",
    "simscape": "Simscape was not run, and its source cannot be read",
    "three": "three.js has no physics: take the engine beside it, such as cannon-es or rapier",
    "unity-2d": "Unity has a Box2D in 2D, which was not run: take box2d-2, or box2d for Box2D 3",
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
    bare = re.sub(r"(physics|engine|js)*(v?\d+d?)?$", "", plain)
    found = known.get(plain) or known.get(bare)
    if found in WITHOUT_ANSWER:
        raise Refused(f"{name}: {WITHOUT_ANSWER[found]}")
    near = difflib.get_close_matches(plain, known, 1, 0.85)
    if found is None and near:
        raise Refused(f"engine {name!r} is not known; did you mean {known[near[0]]}?")
    return BY_NUMBER.get(found or "")


def _flight(engine: ByNumber, at: Fall, v: Array, steps: float) -> tuple[Array, Array]:
    """Return the ways upwards and the velocities before and after the steps of free flights."""
    # A step far above the surface.
    pull = -next(engine.rule(at, 1e6, 0.0))[1]
    n = np.arange(math.ceil(steps) + 10)
    left = at.keeps**n
    speeds = left * v - pull * (n if at.keeps == 1 else (1 - left) / (1 - at.keeps))
    moves = speeds + (1 - engine.sinks) * at.added
    return at.step * (np.cumsum(moves, axis=-1) - moves[..., :1]), speeds


def _after(steps: Steps, z: float) -> tuple[float, float]:
    """Return height and velocity of a ball from z that flies up again, both 0 if it does not."""
    rises = False
    for z_next, v in steps:
        if rises and z_next < z:
            return z, 0.0
        rises |= z_next > z
        z = z_next
        if v > 0 and z > _REACH and rises:
            return z, v
    # It lies still, or is pushed out slowly.
    return 0.0, 0.0


def restitutions(engine: ByNumber, at: Fall, speed: float, instants: int | None = None) -> Array:
    """Return √(h′/h) of impacts with a speed in m/s, at instants within a step.

    Without gravity it is the ratio of the speeds.

    >>> at = Fall(number=0.8, step=1 / 60, gravity=9.81, threshold=1.0, radius=0.1)
    >>> round(float(restitutions(BY_NUMBER["jolt"], at, speed=1.4).mean()), 2)
    0.83
    """
    way = speed * at.step
    # Of 0.1 mm.
    instants = instants or (INSTANTS if way > 1e-4 else INSTANTS // 6)
    height = speed**2 / (2 * at.gravity) if at.gravity else _REACH + way
    refuse(
        [
            (
                not 1e-6 < way < 1e3,
                f"a ball with {show(speed, 'm/s')} moves {show(way, 'm')} in a step of "
                f"{show(at.step, 's')}: between 1 µm and 1 km are computed",
            ),
            (
                height <= way / 2,
                f"a step of {show(at.step, 's')} is longer than the fall: give a shorter one, or a "
                "greater height",
            ),
        ]
    )
    heights = height + way * (np.arange(instants) / instants - 0.5)
    z = heights
    v = np.full(instants, -speed)
    near = _REACH + 4 * way
    if at.gravity:
        # Down to where a contact may be found the ball flies freely, longer if it is damped.
        longest = 2 * math.sqrt(2 * height / at.gravity) / at.step
        ways, speeds = _flight(engine, at, np.zeros(1), longest)
        n = np.argmax(ways < near - heights[:, None], axis=1) - 1 - engine.remembers
        n = np.maximum(n, 0)
        z = heights + ways[n]
        v = speeds[n]
    most = 2000 + math.ceil(6 * near / way)
    after = [
        _after(islice(engine.rule(at, *start), most), start[0])
        for start in zip(z.tolist(), v.tolist(), strict=True)
    ]
    z, v = np.array(after).T
    if not at.gravity:
        return v / speed
    # And so it flies up to its top.
    ways, _ = _flight(engine, at, v[:, None], v.max() / at.added)
    return np.sqrt(np.maximum(z + ways.max(axis=1), 0.0) / heights)


def falling(**quantities: Quantity) -> Bounce:
    """Return the bounce of a ball, which has a radius of 0.1 m if neither mass nor size is given.

    Raises
    ------
    Refused
        If a quantity cannot be read, or has no place here.
    """
    given = {name: value for name, value in quantities.items() if value not in (None, "")}
    place = "has no place where the restitution is a number"
    springs = ("penetration", "stiffness", "contact_time", "other_mass")
    refuse(
        [
            *((name in given, f"--{name.replace('_', '-')} {place}") for name in springs),
            (given.get("points", 1) != 1, f"--points {place}: a ball is dropped"),
        ]
    )
    # No rule depends on the mass, and on the radius for fast bodies only.
    size = {} if given.keys() & {"mass", "radius"} else {"radius": 0.1}
    mass = {} if "density" in given else {"mass": 1.0}
    found = Bounce(**mass | size | given)
    typed = {name: text for name, text in found.given.items() if name.replace(" ", "_") in given}
    object.__setattr__(found, "given", typed)
    return found


@dataclass(frozen=True, repr=False)
class Rebound:
    """What a restitution number does in an engine.

    ``written`` is the number of a body: of both alike, or of one if ``other`` has that of the other
    one. ``number`` is that of both together, ``threshold`` in m/s, and ``slower`` is r at a third
    of the speed. ``change`` is the same with r nearest to the wanted one, and ``shorter`` that at
    the longest step at which r is within the tolerance; they are None if this one is.
    """

    engine: str
    source: ByNumber
    bounce: Bounce
    time_step: float
    written: float
    other: float | None
    number: float
    threshold: float
    restitution: Range
    slower: Range
    change: "Rebound | None" = None
    shorter: "Rebound | None" = None
    is_beyond: bool = False
    """Whether no number keeps r at this step."""

    @property
    def deviation(self) -> float:
        """The largest distance of r from the wanted one."""
        return self.restitution.deviation(self.bounce.restitution)

    @property
    def snippet(self) -> str:
        """What is pasted into the engine."""
        row = self.source
        alike = "one of both bodies" if row.pair is LARGER else "both bodies"
        one = f"one body, with {self.other or 0:g} of the other one"
        bodies = alike if self.other is None else one
        # Also a whole number has a decimal point, which C++ wants before an f.
        line = row.written.format(number=float(f"{self.written:.4g}"), bodies=bodies)
        lowered = row.lowered.format(threshold=float(f"{self.threshold / row.unit:.2g}"))
        return line if self.threshold == row.threshold else f"{line}\n{lowered}"

    @property
    def notes(self) -> tuple[str, ...]:
        """What a user has to know, the severest first."""
        row = replace(self.source, threshold=self.threshold)
        speed = self.bounce.impact_speed
        r = self.restitution
        slowest = self.threshold / (max(self.number, 1e-9) if row.is_of_rebound else 1.0)
        is_slow = 0 < speed <= slowest
        lowest = slowest**2 / (2 * self.bounce.gravity) if self.bounce.gravity else 0.0
        way = speed * self.time_step
        settling = self.bounce.load * self.time_step / max(1 - self.number, 1e-9)
        hops = row.is_restless and 0 < self.number < 1 and slowest < settling
        height = settling**2 / (2 * self.bounce.load) if hops else 0.0
        shorter = self.time_step * slowest / max(settling, 1e-9)
        rests = (
            f"above a threshold of {show(settling, 'm/s')}"
            if row.lowered
            else f"below a step of {show(shorter, 's')}"
        )
        said = [
            (
                self.number == 0 < self.written,
                f"nothing bounces: the other body has 0, and the numbers are {row.pair.text}",
            ),
            (
                self.number > 0 and is_slow and r.high < 0.1,
                f"it does not bounce: {show(speed, 'm/s')} is not above the threshold of "
                f"{row.limit}{'' if row.lowered else '; it is a constant: no number helps'}",
            ),
            (
                r.low < 0.1 <= r.high and r.low < r.mean / 2 and speed < 2 * slowest,
                f"at some instants it does not bounce: {show(speed, 'm/s')} is near the threshold "
                f"of {row.limit}",
            ),
            (
                r.high >= 1.0005,
                f"r is up to {r.high:.3f}: at some instants the ball gains energy",
            ),
            (
                speed / 3 > slowest and abs(self.slower.mean - r.mean) > TOLERANCE / 2,
                f"at a third of the speed r is {self.slower}",
            ),
            (
                self.number > 0 and not is_slow and lowest > 0,
                f"drops from less than {show(lowest, 'm')} do not bounce: the threshold is "
                f"{row.limit}",
            ),
            (
                hops,
                f"it may hop for ever, by some {show(height, 'm', 2)}: {rests} it comes to rest",
            ),
            (self.is_beyond, f"no number keeps r within {TOLERANCE:g} at this step"),
            (
                way > self.bounce.size,
                f"it moves {show(way, 'm')} in a step, farther than its radius: it may pass a thin "
                "table",
            ),
        ]
        return tuple(holding(said))

    @property
    def gives(self) -> str:
        """What the number does, in words."""
        row = self.source
        lowered = f" and {row.set_by} = {self.threshold / row.unit:.2g}"
        also = "" if self.threshold == row.threshold else lowered
        also += f" and {row.setting}" if row.setting else ""
        return f"{row.parameter} = {self.written:.4g}{also} gives r = {self.restitution}"

    def __repr__(self) -> str:
        wanted = self.bounce.restitution
        goal = "" if wanted is None else f"; {wanted:g} is wanted"
        head = f"{self.engine} at a step of {show(self.time_step, 's')}: {self.gives}{goal}"
        return "\n".join([head, *(f"! {note}" for note in self.notes)])

    def __str__(self) -> str:
        row = self.source
        change = self.change
        bounce = self.bounce
        given = [f"{name} {value}" for name, value in bounce.given.items()]
        given.append(f"time step {show(self.time_step, 's', 4)}")
        of_both = " (of both bodies)" if change and change.other is None is not self.other else ""
        is_default = row.damping == BY_NUMBER[self.engine].damping
        pixels = f"a metre of {row.pixels:.3g} pixels (pixels=… in a diagnosis)"
        assumed = bounce.assumed + holding([(row.pixels, pixels)])
        lines = [
            (True, repr(self)),
            (change, f"Least change: {change.gives if change else ''}{of_both}."),
            (
                self.shorter,
                f"At a step of {show(self.shorter.time_step, 's', 4)} {self.shorter.gives}."
                if self.shorter
                else "",
            ),
            (
                self.is_beyond and not self.shorter,
                "Nor does one at a half, a quarter, … a 128th of the step.",
            ),
            (True, f"\n{(change or self).snippet}\n"),
            (True, f"Given: {', '.join(given)}."),
            (
                True,
                "The numbers of both bodies, "
                + ("alike" if self.other is None else f"and {self.other:g} of the other body")
                + f": {row.pair.text}; together {self.number:.4g}.",
            ),
            (True, f"r is √(h′/h) over all instants within a step, by the rule of {row.ran}."),
            *((True, f"{note}.") for note in row.notes),
            (
                row.relaxation and not row.setting,
                f"With contactEquationRelaxation = {row.relaxation:g}, the default, r depends on "
                "where in a step the impact is.",
            ),
            (
                row.damping and bounce.gravity,
                f"The flights are damped by {row.damped_by} = {row.damping:g}"
                f"{', the default' if is_default else ''}, which lowers r: it holds for this "
                "height only.",
            ),
            (
                bounce.friction is not None,
                "Friction acts along the surface only: r is computed without it.",
            ),
            (assumed, f"Assumed: {'; '.join(assumed)}."),
        ]
        return "\n".join(holding(lines))


class Case(NamedTuple):
    """A ball in an engine at a step in s, with the number of the other body if it is not alike."""

    engine: ByNumber
    bounce: Bounce
    step: float
    threshold: float
    other: float | None = None

    @property
    def never_bounces(self) -> bool:
        """Whether no number helps, because the threshold is a constant."""
        fastest = self.bounce.impact_speed + self.bounce.load * self.step
        return fastest <= self.threshold and not self.engine.lowered

    def number(self, written: float) -> float:
        """Return the number of both bodies together."""
        return self.engine.pair.of(written, written if self.other is None else self.other)

    def restitutions(self, written: float, speed: float) -> Array:
        """Return r of impacts with a speed in m/s, at instants within a step."""
        keeps = self.engine.kept(self.engine.damping, self.step)
        load = self.bounce.load
        number = self.number(written)
        relaxation = self.engine.relaxation
        at = Fall(number, self.step, load, self.threshold, self.bounce.size, keeps, relaxation)
        return restitutions(self.engine, at, speed)

    def rebound(self, written: float) -> Rebound:
        """Return what a number does."""
        speed = self.bounce.impact_speed
        found = self.restitutions(written, speed)
        try:
            slower = self.restitutions(written, speed / 3)
        except Refused:
            slower = found
        return Rebound(
            engine=self.engine.name,
            source=self.engine,
            bounce=self.bounce,
            time_step=self.step,
            written=written,
            other=self.other,
            number=self.number(written),
            threshold=self.threshold,
            restitution=Range.of(found),
            slower=Range.of(slower),
        )

    def nearest(self) -> Rebound:
        """Return the rebound whose mean r is the wanted one, or the nearest to it, by bisection."""
        speed = self.bounce.impact_speed
        place = bisect_left(
            range(10_000),
            self.bounce.restitution,
            key=lambda place: self.restitutions(place / 10_000, speed).mean(),
        )
        return self.rebound(place / 10_000)

    def wanted(self) -> Rebound:
        """Return the nearest rebound, with another setting if r is not kept without it."""
        found = self.with_threshold()
        if found.deviation <= TOLERANCE:
            return found
        cases = (
            self._replace(engine=each.scaled(self.bounce.gravity, self.engine.pixels))
            for each in self.engine.others
        )
        others = [case.with_threshold() for case in cases]
        return min([found, *others], key=lambda each: each.deviation)

    def with_threshold(self) -> Rebound:
        """Return the nearest rebound, with a lower threshold if this one is in the way.

        It is lowered to a quarter of the speed, or to what lets the ball come to rest.
        """
        found = self.nearest()
        speed = self.bounce.impact_speed
        if found.deviation <= TOLERANCE or not self.engine.lowered or speed >= 1.5 * self.threshold:
            return found
        lower = self._replace(threshold=float(f"{speed / 4:.2g}")).nearest()
        settling = SETTLED * self.bounce.load * self.step / max(1 - lower.number, 1e-9)
        if self.engine.is_restless and speed / 4 < settling < 0.9 * speed:
            lower = self._replace(threshold=float(f"{settling:.2g}")).nearest()
        return min(found, lower, key=lambda each: each.deviation)

    def at_shorter_steps(self, found: Rebound) -> Rebound:
        """Return a rebound with the one at a half, a quarter, … of the step which keeps r."""
        if found.deviation <= TOLERANCE:
            return found
        steps = (self.step / 2**n for n in range(1, 8))
        case = self._replace(threshold=found.threshold, other=found.other)
        tried = (case._replace(step=step).wanted() for step in steps)
        shorter = next((each for each in tried if each.deviation <= TOLERANCE), None)
        return replace(found, shorter=shorter, is_beyond=True)


def number_for(bounce: Bounce, engine: ByNumber, time_step: Quantity) -> Rebound:
    """Return the restitution number with which a ball bounces as wanted, for both bodies alike.

    Raises
    ------
    Refused
        If the restitution or the step is missing.
    """
    if bounce.restitution is None:
        raise Refused("the restitution is missing: --restitution 0.8 or restitution=0.8")
    engine = engine.scaled(bounce.gravity)
    case = Case(engine, bounce, _step(time_step), engine.threshold)
    if case.never_bounces:
        raise Refused(
            f"no number bounces in {engine.name} at {show(bounce.impact_speed, 'm/s')}: it has a "
            f"threshold of {engine.limit}, a constant"
        )
    return case.at_shorter_steps(case.wanted())


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
        engine.scaled(bounce.gravity, given.get("pixels")),
        damping=given.get("damping", engine.damping),
        pair=given.get("combine", engine.pair),
    )
    if "relaxation" in given:
        engine = _relaxed(engine, given["relaxation"])
    if "threshold in pixels" in given:
        given["threshold"] = engine.unit * given["threshold in pixels"]
    case = Case(
        engine=engine,
        bounce=bounce,
        step=step,
        threshold=given.get("threshold", engine.threshold),
        other=None if other is None else _given(engine, other).get("number", engine.default),
    )
    found = case.rebound(given["number"])
    if bounce.restitution is None or found.deviation <= TOLERANCE or case.never_bounces:
        return found
    change = case.wanted()
    if other is not None and change.deviation > TOLERANCE:
        # The number of one body may not be enough.
        alike = case._replace(other=None).wanted()
        change = min(change, alike, key=lambda each: each.deviation)
    further = case.at_shorter_steps(change)
    return replace(found, change=change, shorter=further.shorter, is_beyond=further.is_beyond)


def _step(time_step: Quantity) -> float:
    if time_step is None:
        raise Refused("the time step is missing: --time-step 1/60 or time_step='2 ms'")
    return step_in_si(time_step)


_READ: Mapping[str, Callable[[str, Any], Any]] = {
    "number": lambda name, value: within(name, value, 0, 1),
    "threshold": lambda name, value: within(name, in_si(name, value, "m/s"), 0, math.inf),
    "threshold in pixels": lambda name, value: within(name, value, 0, math.inf),
    "damping": lambda name, value: within(name, value, 0, math.inf),
    "pixels": lambda name, value: positive(name, value, ""),
    "relaxation": lambda name, value: positive(name, value, ""),
    "combine": lambda name, value: MODES[one_of(name, value, MODES)],
}


def _given(engine: ByNumber, typed: Mapping[str, Any]) -> dict[str, Any]:
    """Return the number, the threshold, the damping and how two numbers are combined, as typed."""
    combine = "combine" if engine.is_physx else ""
    relaxation = "contactEquationRelaxation" if engine.relaxation else ""
    names = filter(None, [engine.parameter, engine.set_by, engine.damped_by, combine, relaxation])
    found = parameters_of(engine.name, engine.names, list(names), typed)
    return {what: _READ[what](what, value) for what, value in found.items()}

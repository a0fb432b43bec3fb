"""Rows of engines, by their names: ENGINES with a stiffness, and BY_NUMBER with a restitution."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np

from bouncing_ball_contacts import step_rules
from bouncing_ball_contacts.engines import (
    LARGER,
    LEAST,
    MEAN,
    MODES,
    PAIR,
    PIXELS,
    PRODUCT,
    SERIES,
    SUM,
    ByNumber,
    Engine,
    Parameters,
    Rule,
    Setting,
    Sliding,
)
from bouncing_ball_contacts.schemes import (
    Array,
    Bullet,
    Capped,
    Hertz,
    HuntCrossley,
    Impedance,
    Implicit,
    Law,
    Linear,
    SemiImplicit,
)
from bouncing_ball_contacts.units import STANDARD_GRAVITY, Refused

IMPEDANCE = 0.999
"""MuJoCo's of a design, at every depth.

Near 1 the reference acceleration of a contact is followed whatever else acts on the body: r depends
neither on the load and the number of points, nor on the friction, its cone and condim. The edges of
a friction pyramid turn an impedance d into d/(d + (1 - d) μ² (1 + μ²)/2).
"""
_LEAST_IMPEDANCE = 1e-4
_LEAST_FRICTION = 1e-5
CONES = ("pyramidal", "elliptic")
"""Of friction in MuJoCo, the default first."""


@dataclass(frozen=True)
class DrakeDissipation(Engine):
    """Drake averages dissipations, weighted by the share of each body in the penetration."""

    def combined(self, one: Parameters, other: Parameters) -> dict[str, Any]:
        stiffness, dissipation = self.names
        k1 = one[stiffness]
        k2 = other[stiffness]
        mean = (k2 * one[dissipation] + k1 * other[dissipation]) / (k1 + k2)
        return {stiffness: SERIES.of(k1, k2), dissipation: mean}


@dataclass(frozen=True)
class PhysX(Engine):
    """PhysX combines stiffnesses and dampings by the later mode of the restitutions.

    A stiffness is a negative restitution there, so that "min" takes the larger one. Of a compliant
    and a rigid material the stiffness is that of the former, and the damping the larger one.
    """

    def combined(self, one: Parameters, other: Parameters) -> dict[str, Any]:
        combined = super().combined(one, other)
        of_mode = MODES[combined["restitutionCombineMode"]].of
        stiffness, damping = self.names
        if min(one[stiffness], other[stiffness]) > 0:
            return combined | {stiffness: abs(of_mode(-one[stiffness], -other[stiffness]))}
        return combined | {name: max(one[name], other[name]) for name in (stiffness, damping)}


@dataclass(frozen=True)
class NewtonMujoco(Engine):
    """Newton's MuJoCo solver averages time constants and damping ratios, instead of ke and kd."""

    def combined(self, one: Parameters, other: Parameters) -> dict[str, Any]:
        a, b = (np.array(_solref(body["ke"], body["kd"])) for body in (one, other))
        time, ratio = (a + b) / 2
        return super().combined(one, other) | {"ke": 1 / (time * ratio) ** 2, "kd": 2 / time}


def _forces(names: tuple[str, str], per_mass: bool = False) -> dict[str, Any]:
    """Return `names`, `units`, `write` and `read` of a stiffness and a damping, both as forces."""

    def write(law: Law, at: Setting) -> dict[str, Any]:
        c = float(law.damping) * (1 if per_mass else at.mass)
        return {names[0]: float(law.stiffness) * at.mass / at.points, names[1]: c / at.points}

    def read(p: Parameters, at: Setting) -> Law:
        c = p[names[1]] * at.points / (1 if per_mass else at.mass)
        return Linear(np.asarray(p[names[0]] * at.points / at.mass), np.asarray(c))

    units = dict(zip(names, ("N/m", "1/s" if per_mass else "N s/m"), strict=True))
    return {"names": names, "units": units, "write": write, "read": read}


def _impedance_of_depth(depth: Array, ratio: Array, speed: float) -> Impedance:
    """Return the contact of an undamped depth in MuJoCo, whose k is K d² and whose c is b d."""
    d = IMPEDANCE
    spring = Linear.of_depth(depth, ratio, speed)
    return Impedance(spring.stiffness / d**2, spring.damping / d, low=d, high=d)


def _write_mujoco(law: Law, at: Setting) -> dict[str, Any]:
    return {"solref": (-float(law.deep.stiffness), -float(law.deep.damping))}


def _solimp(values: Any) -> tuple[float, ...]:
    given = [float(value) for value in np.atleast_1d(values)]
    low, high, width, middle, power = given + [0.9, 0.95, 0.001, 0.5, 2.0][len(given) :]

    # MuJoCo keeps impedances and the middle within these bounds.
    low, high, middle = np.clip([low, high, middle], _LEAST_IMPEDANCE, 1 - _LEAST_IMPEDANCE)
    return float(low), float(high), max(width, 1e-15), float(middle), max(power, 1.0)


def _read_mujoco(p: Parameters, at: Setting, least: float = 1e-15) -> Law:
    """Return the law; raise a product of times below `least` to it."""
    first, second = p["solref"]
    low, high, width, middle, power = _solimp(p["solimp"])
    if first > 0:
        time = max(first, 2 * at.step) if p.get("refsafe", 1) else first
        k = 1 / max((high * time * second) ** 2, least)
        b = 2 / (high * time)
    else:
        k = -first / high**2
        b = abs(second) / high
    friction = max(p.get("friction", 1.0), _LEAST_FRICTION)
    is_pyramid = p.get("cone", CONES[0]) == CONES[0] and p.get("condim", 3) > 1
    return Impedance(
        stiffness=np.asarray(k),
        damping=np.asarray(b),
        points=at.points,
        low=low,
        high=high,
        width=width,
        middle=middle,
        power=power,
        edges=friction**2 * (1 + friction**2) / (p.get("condim", 3) - 1) if is_pyramid else 1.0,
    )


def _mix_solref(one: Any, other: Any) -> tuple[float, ...]:
    a = np.asarray(one, float)
    b = np.asarray(other, float)
    return tuple((a + b) / 2 if min(a[0], b[0]) > 0 else np.minimum(a, b))


def _mix_solimp(one: Any, other: Any) -> tuple[float, ...]:
    return tuple((np.asarray(_solimp(one)) + np.asarray(_solimp(other))) / 2)


_BY_TIMES = replace(MEAN, text="by averaged times and ratios")
_SOLIMP = Rule("averaged", _mix_solimp, lambda x: x)
_DEFAULT_SOLIMP = (0.9, 0.95, 0.001)
_DESIGNED_SOLIMP = (IMPEDANCE, IMPEDANCE, 0.001)
_MUJOCO_RULES = {
    "solref": Rule("least of both", _mix_solref, lambda x: x),
    "solimp": _SOLIMP,
    "refsafe": PAIR,
    "friction": LARGER,
    "condim": LARGER,
    "cone": PAIR,
}


def _write_genesis(law: Law, at: Setting) -> dict[str, Any]:
    c = float(law.deep.damping)
    if c <= 0:
        raise Refused("genesis has no contact without damping: its time constant is 2 m/c")
    return {"timeconst": 2 / c, "dampratio": c / (2 * math.sqrt(law.deep.stiffness))}


def _read_genesis(p: Parameters, at: Setting) -> Law:
    # Genesis has MuJoCo's formula, but not its least product.
    return _read_mujoco({**p, "solref": (p["timeconst"], p["dampratio"])}, at, 0.0)


def _solref(ke: float, kd: float) -> tuple[float, float]:
    """Return the time constant and the damping ratio that Newton makes of ke and kd."""
    return (2 / kd, kd / (2 * math.sqrt(ke))) if min(ke, kd) > 0 else (0.02, 1.0)


def _write_newton_mujoco(law: Law, at: Setting) -> dict[str, Any]:
    if float(law.damping) <= 0:
        raise Refused("newton-mujoco has no contact without damping: kd = 0 stands for a default")
    return {"ke": float(law.deep.stiffness), "kd": float(law.deep.damping)}


def _read_newton_mujoco(p: Parameters, at: Setting) -> Law:
    return _read_mujoco({"solref": _solref(p["ke"], p["kd"]), "solimp": p["solimp"]}, at)


_BULLET_SPRING = _forces(("contactStiffness", "contactDamping"))
_BULLET_BESIDE = {
    "linearDamping": 0.04,
    "contactSlop": 1e-5,
    "contactProcessingThreshold": 1e18,
    "contactBreakingThreshold": 0.02,
}


def _read_pybullet(p: Parameters, at: Setting) -> Law:
    spring = _BULLET_SPRING["read"](p, at)
    return Bullet(
        stiffness=spring.stiffness,
        damping=spring.damping,
        slop=p["contactSlop"],
        ahead=_found_ahead(p, at.radius, at.points),
        drag=p["linearDamping"],
    )


def _found_ahead(p: Parameters, radius: float, points: int) -> float:
    """Return the height in m below which PyBullet finds a contact.

    A ball is found within a share of half the diagonal of the box around it, 2 % by default; two
    boxes when they touch.
    """
    share = 0.0 if points > 1 else p["contactBreakingThreshold"]
    return float(min(share * math.sqrt(3) * radius, p["contactProcessingThreshold"]))


def _write_drake(law: Law, at: Setting) -> dict[str, Any]:
    return {
        "point_contact_stiffness": float(law.stiffness) * at.mass,
        "relaxation_time": float(law.damping / law.stiffness),
    }


def _read_drake(p: Parameters, at: Setting) -> Law:
    k = p["point_contact_stiffness"] / at.mass
    return Linear(np.asarray(k), np.asarray(p["relaxation_time"] * k))


def _write_dissipation(law: Law, at: Setting) -> dict[str, Any]:
    return {
        "point_contact_stiffness": float(law.stiffness) * at.mass,
        "hunt_crossley_dissipation": float(law.damping),
    }


def _read_dissipation(p: Parameters, at: Setting) -> Law:
    k = p["point_contact_stiffness"] / at.mass
    return HuntCrossley(np.asarray(k), np.asarray(p["hunt_crossley_dissipation"]))


def _damping_ratio(e: float) -> float:
    """Return Tsuji's β of a restitution coefficient; LAMMPS divides by the logarithm of it."""
    log = math.log(max(e, 1e-12))
    return -log / math.hypot(math.pi, log)


def _write_hertz(law: Law, at: Setting) -> dict[str, Any]:
    beta = float(law.damping)
    return {
        "kn": float(law.stiffness) * at.mass / at.points / math.sqrt(at.radius),
        "e": math.exp(-math.pi * beta / math.sqrt(1 - beta**2)),
    }


def _read_hertz(p: Parameters, at: Setting) -> Law:
    k = p["kn"] * math.sqrt(at.radius) * at.points / at.mass
    return Hertz(np.asarray(k), np.asarray(_damping_ratio(p["e"])))


def _hertz_of_depth(depth: Array, ratio: Array, speed: float) -> Hertz:
    return Hertz.of_depth(depth, np.minimum(ratio, _damping_ratio(0.0)), speed)


def _write_ode(law: Law, at: Setting) -> dict[str, Any]:
    kp, kd = _GAZEBO["write"](law, at).values()
    both = at.step * kp + kd
    return {"soft_cfm": 1 / both, "soft_erp": at.step * kp / both}


def _read_ode(p: Parameters, at: Setting) -> Law:
    kp = p["soft_erp"] / (p["soft_cfm"] * at.step)
    return _GAZEBO["read"]({"kp": kp, "kd": (1 - p["soft_erp"]) / p["soft_cfm"]}, at)


_GAZEBO = _forces(("kp", "kd"))
_UNCAPPED = {"max_vel": 1e9, "contact_max_correcting_vel": 1e9}


def _read_gazebo(p: Parameters, at: Setting) -> Law:
    linear = _GAZEBO["read"](p, at)
    fastest = min(p["max_vel"], p["contact_max_correcting_vel"])
    return Capped(linear.stiffness, linear.damping, fastest, at.step)


_PHYSX_SPRING = _forces(("compliantContactStiffness", "compliantContactDamping"))


_WEIGHTLESS = (
    "These contacts feel 0.1 % of gravity: a load does not press them in by its weight over k"
)
# In MuJoCo the damper acts along the surface as well.
_PUSHED_UP = Sliding(
    adds=lambda r, speed: 0.006 + 0.1 * speed**1.3 * (1 - r) ** 2, speeds=(2.0, 4.0)
)
_EVERY_FRICTION = "without sliding it holds at every friction, cone and condim"
_DRAKE_BOX = (
    "A pair of shapes has one contact: r is that of a box which falls flat on a HalfSpace and does "
    "not slide; on a Box, on an edge or sliding it had 0.77 to 0.84 for 0.80"
)
_VERLET = SemiImplicit(pulls=True)
# A depth is the difference of two rounded numbers: below ten of their spacings no digit is certain.
_SINGLE = 10 * float(np.finfo(np.float32).eps)
# Drops in MuJoCo 4.0.0 at 1 and 2 ms: the last of three balls that touch left with 0.63 for 0.90;
# on cells of a tenth of the radius r was 0.70, on those of a twentieth 0.65 and 1.00; of capsules
# and cylinders at 20° and 45° 0.55 to 0.73; at twice the step 0.77 to 0.85, for 0.80.
# On a free plate of 0.5 times its mass a ball had 0.86 to 0.88, and 0.81 to 0.83 on one of 5 times,
# at 1 ms. The lowest point of a sphere's hull had 0.46 to 0.78 with 12 vertices, 0.69 to 0.81 with
# 42, 0.76 to 0.81 with 162 and 0.78 to 0.81 with 642, where 0.78 to 0.82 was designed.
# With a ball's spring at each of its points a box had 0.36 to 0.43 and a capsule 0.48 to 0.52 for
# 0.60, in ODE, PhysX and Newton.
_SPRING_OF_ONE_POINT = ("boxes or lying capsules (--points 4 or 2)",)
_NOT_MUJOCO = (
    "three touching bodies",
    "free plates",
    "hulls under 600 vertices",
    "heightfield cells under radius/5",
    "tilted capsules or cylinders",
)
ON_BOXES = "boxes on boxes"
"""In single precision MuJoCo loses their contacts for a step: at 3 of 31 instants a box on a table
of 2 cm had 0.74 to 0.88 where 0.784 to 0.819 was designed."""
_MUJOCO = Engine(
    name="mujoco",
    names=("solref", "solref"),
    scheme=SemiImplicit(),
    write=_write_mujoco,
    beside={"solimp": _DESIGNED_SOLIMP},
    read=_read_mujoco,
    meaning="solref = -k/m -c/m, solimp = 0.999 0.999 0.001",
    rules=_MUJOCO_RULES,
    of_depth=_impedance_of_depth,
    defaults={
        "solref": (0.02, 1.0),
        "solimp": _DEFAULT_SOLIMP,
        "refsafe": 1.0,
        "friction": 1.0,
        "condim": 3.0,
        "cone": CONES[0],
    },
    ran="MuJoCo 4.0.0",
    notes=(
        "The numbers of solref are per unit of mass: they hold for every mass",
        "Give both geoms the class, because MuJoCo averages their solimp",
        _WEIGHTLESS,
    ),
    friction=f"{_EVERY_FRICTION}; it acts as a damper, so a bounce leaves exp(-π b/ω) of a sliding "
    "speed that Coulomb's friction would take, with b = -solref[1] and ω² = -solref[0], and a body "
    "at rest creeps on a slope; a pair of geoms with a solreffriction of its own grips more",
    rubs=' friction="{mu:g} 0.005 0.0001"',
    sliding=_PUSHED_UP,
    not_for=_NOT_MUJOCO,
)
_LATER = Rule("the later of both", lambda a, b: max(a, b, key=list(MODES).index), lambda x: x)
_BY_MODE = replace(MEAN, text="averaged, or by the mode")
_COMPLIANT = PhysX(
    name="physx",
    scheme=Implicit(ahead=True),
    names=_PHYSX_SPRING["names"],
    write=_PHYSX_SPRING["write"],
    read=_PHYSX_SPRING["read"],
    units=_PHYSX_SPRING["units"],
    rubs="\nmaterial->setStaticFriction({mu:g});\nmaterial->setDynamicFriction({mu:g});",
    meaning="compliantContactStiffness = k, compliantContactDamping = c",
    ran="PhysX 5.12 (ovphysx 0.7.0)",
    rules={
        "compliantContactStiffness": _BY_MODE,
        "compliantContactDamping": _BY_MODE,
        "restitutionCombineMode": _LATER,
    },
    defaults={
        "compliantContactStiffness": 0.0,
        "compliantContactDamping": 0.0,
        "restitutionCombineMode": "average",
    },
    resolution=_SINGLE,
    notes=(
        "Use the solver PGS",
        "The contactOffset has to be longer than the way of the body in a step",
    ),
    box="r is that of a box which falls flat on a plane and does not slide; on springs, "
    "whose points are those of a face, it had 0.84 to 0.87 for 0.79 on an edge or sliding",
    not_of_one_point=_SPRING_OF_ONE_POINT,
)
ENGINES: Mapping[str, Engine] = {
    engine.name: engine
    for engine in (
        _MUJOCO,
        replace(
            _MUJOCO,
            name="mujoco-warp",
            ran="MuJoCo Warp 4.0.0",
            resolution=_SINGLE,
            notes=(*_MUJOCO.notes, "Without friction it needs condim = 1, or there are no numbers"),
            not_for=(*_NOT_MUJOCO, ON_BOXES),
        ),
        Engine(
            name="pybullet",
            scheme=Implicit(),
            names=_BULLET_SPRING["names"],
            write=_BULLET_SPRING["write"],
            beside={
                "linearDamping": 0.0,
                "contactSlop": 0.0,
                "contactProcessingThreshold": 0.0,
                "contactBreakingThreshold": 0.2,
            },
            read=_read_pybullet,
            units=_BULLET_SPRING["units"]
            | {"linearDamping": "1/s", "contactSlop": "m", "contactProcessingThreshold": "m"},
            meaning="contactStiffness = 2 k, contactDamping = c/2",
            rules={
                "contactStiffness": SERIES,
                "contactDamping": SUM,
                **dict.fromkeys(_BULLET_BESIDE, PAIR),
            },
            # A body for which no spring is set.
            defaults={"contactStiffness": 1e18, "contactDamping": 0.1, **_BULLET_BESIDE},
            ran="PyBullet 3.2.7",
            box="A box has its four points at once on a box; on GEOM_PLANE it has one or two, and "
            "r is wrong (0.20 to 0.79 for 0.80); on springs a box that slides gains energy",
            friction="a spring keeps r as long as the body slides less than a third of its radius "
            "in a step, and a box that slides on springs may gain energy",
            rubs=", lateralFriction={root:.6g}",
            # On a plate of 1 to 5 times its mass a ball had 0.60 to 0.78 for 0.80; a box with a
            # ball's spring at each of its points had 0.39 to 0.42 for 0.60.
            not_for=("free plates",),
            not_of_one_point=("boxes (--points 4)",),
        ),
        Engine(
            name="drake-sap",
            rubs=", CoulombFriction({mu:g}, {mu:g})",
            names=("point_contact_stiffness", "relaxation_time"),
            scheme=Implicit(),
            write=_write_drake,
            read=_read_drake,
            meaning="point_contact_stiffness = 2 k, relaxation_time = c/(2 k)",
            units={"point_contact_stiffness": "N/m", "relaxation_time": "s"},
            rules={"point_contact_stiffness": SERIES, "relaxation_time": SUM},
            defaults={"point_contact_stiffness": 1e6, "relaxation_time": 0.1},
            ran="Drake 1.51.1",
            box=_DRAKE_BOX,
            notes=(
                'The discrete_contact_approximation is "sap"; with the default, "lagged", Drake '
                "ignores relaxation_time: the row drake, which keeps r of bodies that slide",
                "sap_near_rigid_threshold is 0: by its default of 1 Drake makes strongly damped "
                "contacts softer",
            ),
            friction="",
            sliding=Sliding(takes=0.08, adds=lambda r, speed: 0.07 * (r <= 0.5), speeds=(1.4,)),
        ),
        DrakeDissipation(
            name="drake",
            rubs=", CoulombFriction({mu:g}, {mu:g})",
            names=("point_contact_stiffness", "hunt_crossley_dissipation"),
            scheme=Implicit(),
            write=_write_dissipation,
            read=_read_dissipation,
            meaning="point_contact_stiffness = 2 k, hunt_crossley_dissipation = d in k p (1 + d w)",
            units={"point_contact_stiffness": "N/m", "hunt_crossley_dissipation": "s/m"},
            rules={
                "point_contact_stiffness": SERIES,
                "hunt_crossley_dissipation": replace(MEAN, text="averaged by depth"),
            },
            defaults={"point_contact_stiffness": 1e6, "hunt_crossley_dissipation": 50.0},
            of_depth=HuntCrossley.of_depth,
            ran="Drake 1.51.1",
            notes=(
                "r falls with the speed: it is as wanted at this speed only",
                "With twelve balls in one world r was lower by up to 0.003",
            ),
            box=_DRAKE_BOX,
        ),
        Engine(
            name="lammps",
            scheme=_VERLET,
            **_forces(("kn", "gamma_n"), per_mass=True),
            meaning="kn = k, gamma_n = c/m",
            rules={"kn": PAIR, "gamma_n": PAIR},
            deepest=1.0,
            ran="LAMMPS 2025.7.22",
            notes=("The damping is per unit of the mass, and holds for this one only",),
        ),
        Engine(
            name="lammps-limit-damping",
            scheme=SemiImplicit(),
            **_forces(("kn", "gamma_n"), per_mass=True),
            meaning="kn = k, gamma_n = c/m, with limit_damping",
            rules={"kn": PAIR, "gamma_n": PAIR},
            deepest=1.0,
            ran="LAMMPS 2025.7.22",
            notes=("The damping is per unit of the mass, and holds for this one only",),
        ),
        Engine(
            name="lammps-hertz",
            scheme=_VERLET,
            names=("kn", "e"),
            write=_write_hertz,
            read=_read_hertz,
            of_depth=_hertz_of_depth,
            units={"kn": "Pa"},
            meaning="kn = (4/3) E* in Pa, e = r",
            rules={"kn": PAIR, "e": PAIR},
            deepest=1.0,
            ran="LAMMPS 2025.7.22",
            notes=("The modulus kn is for this radius; e is the same at every speed",),
        ),
        Engine(
            name="newton",
            scheme=SemiImplicit(approach=True),
            **_forces(("ke", "kd")),
            meaning="ke = k, kd = c, in SolverSemiImplicit and SolverFeatherstone",
            rules={"ke": MEAN, "kd": MEAN},
            defaults={"ke": 2500.0, "kd": 100.0},
            resolution=_SINGLE,
            ran="Newton 1.8.0",
            notes=("The damper acts while the bodies approach only",),
            rubs=", mu={mu:g}",
            box="The points are those of a face: r is that of a box which falls flat on a plane "
            "and does not slide; on a box, on an edge or sliding it had 0.78 to 0.91 for 0.80",
            not_of_one_point=_SPRING_OF_ONE_POINT,
        ),
        NewtonMujoco(
            name="newton-mujoco",
            names=("ke", "kd"),
            scheme=SemiImplicit(),
            write=_write_newton_mujoco,
            read=_read_newton_mujoco,
            beside={"solimp": _DESIGNED_SOLIMP},
            meaning="ke = k/m, kd = c/m, solimp = 0.999 0.999 0.001, in SolverMuJoCo",
            units={"ke": "1/s^2", "kd": "1/s"},
            rules={"ke": _BY_TIMES, "kd": _BY_TIMES, "solimp": _SOLIMP},
            of_depth=_impedance_of_depth,
            defaults={"ke": 2500.0, "kd": 100.0, "solimp": _DEFAULT_SOLIMP},
            resolution=_SINGLE,
            ran="Newton 1.8.0",
            notes=("Without friction it needs condim = 1, or there are no numbers", _WEIGHTLESS),
            rubs=", mu={mu:g}",
            friction=_EVERY_FRICTION,
            sliding=_PUSHED_UP,
            not_for=(ON_BOXES,),
        ),
        Engine(
            name="genesis",
            names=("timeconst", "dampratio"),
            scheme=SemiImplicit(),
            write=_write_genesis,
            beside={"solimp": _DESIGNED_SOLIMP},
            read=_read_genesis,
            of_depth=_impedance_of_depth,
            meaning="timeconst = 2 m/c, dampratio = c/√(4 k m), solimp = 0.999 0.999 0.001",
            ran="Genesis 1.4.5",
            units={"timeconst": "s"},
            rules={"timeconst": MEAN, "dampratio": MEAN, "solimp": _SOLIMP},
            defaults={"solimp": _DEFAULT_SOLIMP},
            notes=("The numbers hold for every mass", _WEIGHTLESS),
            friction=_EVERY_FRICTION,
            sliding=_PUSHED_UP,
        ),
        _COMPLIANT,
        replace(
            _COMPLIANT,
            name="isaac-lab",
            borrows="physx",
            rubs="static_friction={mu:g}, dynamic_friction={mu:g}, ",
        ),
        Engine(
            name="ode",
            names=("soft_cfm", "soft_erp"),
            spring=("kp", "kd"),
            scheme=Implicit(),
            write=_write_ode,
            read=_read_ode,
            rubs="\ncontact.surface.mu = {mu:g};",
            meaning="soft_erp = h k/(h k + c), soft_cfm = 1/(h k + c)",
            ran="ODE 0.16.2",
            units={"soft_cfm": "m/N/s", "kp": "N/m", "kd": "N s/m"},
            rules=dict.fromkeys(("soft_cfm", "soft_erp"), PAIR),
            defaults={"soft_cfm": 1e-10, "soft_erp": 0.2},
            not_of_one_point=_SPRING_OF_ONE_POINT,
            notes=("These are numbers of a contact joint",),
            box="dCollide has to be asked for at least 4 contacts: with 1, 2 or 3 a box on a plane "
            "tilts, and r is wrong (0.89, 0.85 and 0.83 for 0.80); on springs a box on an edge or "
            "sliding had 0.84 to 1.10 for 0.80",
        ),
        Engine(
            name="gazebo",
            scheme=Implicit(),
            names=_GAZEBO["names"],
            write=_GAZEBO["write"],
            beside=_UNCAPPED,
            read=_read_gazebo,
            units=_GAZEBO["units"] | dict.fromkeys(_UNCAPPED, "m/s") | {"min_depth": "m"},
            meaning="kp = 2 k, kd = c/2, in Gazebo Classic with ODE",
            ran="the ODE of Gazebo 11.10.2",
            rules={
                "kp": SERIES,
                "kd": SUM,
                **dict.fromkeys((*_UNCAPPED, "min_depth"), PAIR),
            },
            defaults={
                "kp": 1e12,
                "kd": 1.0,
                "max_vel": 0.01,
                "contact_max_correcting_vel": 100.0,
                "min_depth": 0.0,
            },
            not_of_one_point=_SPRING_OF_ONE_POINT,
            notes=(
                "The snippet lifts max_vel, which caps every rebound, at 0.01 m/s by default, and "
                "contact_max_correcting_vel of the world, which caps stiff contacts at short steps",
            ),
            box="max_contacts has to be at least 4, as by default: with 1, 2 or 3 a box on a plane "
            "tilts, and r is wrong (0.91, 0.85 and 0.82 for 0.80)",
        ),
        Engine(
            name="generic",
            scheme=SemiImplicit(),
            **_forces(("stiffness", "damping")),
            meaning="stiffness = k, damping = c; semi-implicit Euler, a contact that never pulls",
            rules={"stiffness": PAIR, "damping": PAIR},
            ran="a script of NumPy",
        ),
    )
}
"""The engines by name."""
_CONSTANT = "The threshold is a constant of the library"
_JOLT = ByNumber(
    name="jolt",
    rule=step_rules.jolt,
    ran="Jolt 5 (jolt-physics 1.1.0 for JavaScript)",
    parameter="mRestitution",
    pair=LARGER,
    lowest=-1.0,
    threshold=1.0,
    set_by="PhysicsSettings::mMinVelocityForRestitution",
    lines={
        "mRestitution": "bodySettings.mRestitution = {value}f;  // of {bodies}",
        "PhysicsSettings::mMinVelocityForRestitution": "physicsSettings.mMinVelocityForRestitution "
        "= {value}f;",
        "mLinearDamping": "bodySettings.mLinearDamping = {value}f;",
        "step": "physicsSystem.Update({value}f, 1, &allocator, &jobs);",
    },
    settings={"mLinearDamping": 0.05},
    designed=({"mLinearDamping": 0.0},),
    damped_by="mLinearDamping",
    kept=lambda damping, step: max(1 - damping * step, 0.0),
    notes=("Before 5.3 (November 2024) Jolt had another rule, by which 1 gave 1.017 from 5 m",),
)
_GODOT = "physics/jolt_physics_3d/simulation/bounce_velocity_threshold"
_PHYSX = ByNumber(
    name="physx",
    rule=partial(step_rules.physx, ahead=0.04),
    ran="PhysX 5.6.1 (physx-js-webidl 2.7.3)",
    own_step=1 / 60,
    threshold=2.0,
    set_by="bounceThresholdVelocity",
    lines={
        "restitution": "material->setRestitution({value}f);  // of {bodies}",
        "bounceThresholdVelocity": "sceneDesc.bounceThresholdVelocity = {value}f;",
        "step": "scene->simulate({value}f);",
    },
    springs="physx",
    is_physx=True,
    is_restless=True,
)
_NEWTON = "the Newton backend with its MuJoCo solver (--engine newton-mujoco)"
_AHEAD = "The contact offset is taken as longer than the way of the body in a step"
# Drops from 1 m at 1/60 s in PhysX 5.12: 0.34 to 0.66 for 0.70; slow balls did not bounce at all.
_PGS = "The solver is PGS: with TGS, the default there, balls had 0.34 to 0.66 for 0.70, or stayed"
_BOX2D_2 = ByNumber(
    name="box2d-2",
    rule=step_rules.box2d_2,
    ran="Box2D 2.4.1 (box2d-wasm 7.0.0)",
    lines={
        "restitution": "fixtureDef.restitution = {value}f;  // of {bodies}",
        "restitutionThreshold": "fixtureDef.restitutionThreshold = {value}f;",
        "step": "world.Step({value}f, 8, 3);",
    },
    pair=LARGER,
    threshold=1.0,
    is_restless=True,
    set_by="restitutionThreshold",
    skin=step_rules.SKIN,
    reach=step_rules.SKIN,
    either=({"rounding": 1e-9}, {"rounding": -1e-9}),
    notes=("Before 2.4.1 the threshold is a constant: --engine box2d-2.3",),
)
_BOX2D_2_3 = replace(
    _BOX2D_2,
    name="box2d-2.3",
    ran="Box2D 2.3.10 of Python",
    set_by="b2_velocityThreshold",
    lines={name: _BOX2D_2.lines[name] for name in ("restitution", "step")},
    notes=(_CONSTANT,),
)
_DART = ByNumber(
    name="dart",
    rule=step_rules.dart,
    ran="DART 6.20 (dartpy)",
    own_step=1e-3,
    lines={
        "restitution": "dynamicsAspect->setRestitutionCoeff({value});  // of {bodies}",
        "step": "world->setTimeStep({value});",
    },
    pair=PRODUCT,
    threshold=0.1,
    is_of_rebound=True,
    is_restless=True,
    reach=0.0,
    notes=(_CONSTANT,),
    not_for=("lying capsules",),
)
_RAPIER = ByNumber(
    name="rapier",
    rule=step_rules.rapier,
    ran="Rapier 0.36 (Python) and 0.21 (JavaScript)",
    own_step=1 / 60,
    lines={
        "restitution": "ColliderBuilder::ball(radius).restitution({value})  // of {bodies}",
        "step": "integration_parameters.dt = {value};",
    },
    sinks=(step_rules.SUBSTEPS + 1) / (2 * step_rules.SUBSTEPS),
    remembers=2000,
    notes=("Before 0.35 Rapier had another rule",),
    # In Rapier and Box2D 3 a ball of 0.18 m with 30 rad/s had 0.656 to 0.710 where 0.667 to 0.691
    # was designed, from 0.32 m at 1/50 s.
    not_for=("flat boxes", "lying capsules", "spinning balls"),
)
_BULLET = "    pybullet.changeDynamics(body, -1, {name}={value})"
_OF_BULLET = "pybullet.setPhysicsEngineParameter({name}={value})"
# Elements with their places, because each one stands once in a world of SDF.
_OF_GAZEBO = "<{name}>{value}</{name}>  <!-- in <surface><contact><ode> -->"
_OF_GAZEBO_BODIES = "<{name}>{value}</{name}>  <!-- in <surface><bounce> of {bodies} -->"
_OF_GAZEBO_STEP = "<max_step_size>{value}</max_step_size>  <!-- in <physics> -->"
BY_NUMBER = {
    row.name: row
    for row in (
        _JOLT,
        replace(
            _JOLT,
            name="godot-jolt",
            own_step=1 / 60,
            parameter="bounce",
            # A material that is absorbent has a negative number.
            pair=Rule(
                "added, and kept from 0 to 1",
                lambda a, b: min(max(a + b, 0.0), 1.0),
                lambda x: x / 2,
            ),
            set_by=_GODOT,
            lines={
                "bounce": "physics_material.bounce = {value}  # of {bodies}",
                _GODOT: f"{_GODOT}={{value}}  # project setting",
                "default_linear_damp": "physics/3d/default_linear_damp={value}  # project setting",
                "step": "physics/common/physics_ticks_per_second={rate}  # project setting",
            },
            settings={"default_linear_damp": 0.1},
            designed=({"default_linear_damp": 0.0},),
            damped_by="default_linear_damp",
            borrows="jolt",
        ),
        _PHYSX,
        replace(
            _PHYSX,
            name="unity",
            own_step=0.02,
            rule=partial(step_rules.physx, ahead=0.02),
            parameter="bounciness",
            set_by="Physics.bounceThreshold",
            lines={
                "bounciness": "material.bounciness = {value}f;  // of {bodies}",
                "Physics.bounceThreshold": "Physics.bounceThreshold = {value}f;",
                "step": "Time.fixedDeltaTime = {value}f;",
            },
            springs="",
            borrows="physx",
            notes=("The contact offset is its default, 10 mm",),
        ),
        replace(
            _PHYSX,
            name="isaac-lab",
            rule=partial(step_rules.physx, ahead=math.inf),
            threshold=0.5,
            set_by="PhysxCfg.bounce_threshold_velocity",
            lines={
                "restitution": "# Isaac Lab 3: isaaclab_physx.sim.spawners.materials and .physics\n"
                "material = PhysxRigidBodyMaterialCfg(restitution={value})  # of {bodies}\n"
                "physics = PhysxCfg(solver_type=0)  # PGS",
                "PhysxCfg.bounce_threshold_velocity": "physics.bounce_threshold_velocity = {value}",
                "step": "simulation = SimulationCfg(dt={value}, physics=physics)",
            },
            springs="isaac-lab",
            borrows="physx",
            ignored_by=_NEWTON,
            notes=(_AHEAD, _PGS),
        ),
        replace(
            _PHYSX,
            name="isaac-sim",
            rule=partial(step_rules.physx, ahead=math.inf),
            threshold=0.0,
            set_by="physxScene:bounceThreshold",
            lines={
                "restitution": "float physics:restitution = {value}  # of {bodies}\n"
                'uniform token physxScene:solverType = "PGS"',
                "physxScene:bounceThreshold": "float physxScene:bounceThreshold = {value}",
                "step": "uint physxScene:timeStepsPerSecond = {rate}",
            },
            springs="",
            borrows="physx",
            ignored_by=_NEWTON,
            notes=("By its USD schema there is no threshold", _AHEAD, _PGS),
        ),
        _RAPIER,
        ByNumber(
            name="box2d-3.1",
            rule=step_rules.box2d,
            ran="Box2D after 3.1.1 (box2d3-wasm 5.2.0)",
            pair=LARGER,
            threshold=1.0,
            set_by="b2WorldDef.restitutionThreshold",
            lines={
                "restitution": "shapeDef.material.restitution = {value}f;  // of {bodies}",
                "b2WorldDef.restitutionThreshold": "worldDef.restitutionThreshold = {value}f;",
                "step": f"b2World_Step(world, {{value}}f, {step_rules.SUBSTEPS});",
            },
            sinks=_RAPIER.sinks,
            reach=0.02,
            notes=("Since August 2026 Box2D has another rule, released in 3.2",),
            not_for=_RAPIER.not_for,
        ),
        _BOX2D_2,
        _BOX2D_2_3,
        replace(
            _BOX2D_2_3,
            name="libgdx",
            set_by="World.setVelocityThreshold",
            lines={
                "restitution": _BOX2D_2.lines["restitution"],
                "World.setVelocityThreshold": "World.setVelocityThreshold({value}f);",
                "step": "world.step({value}f, 8, 3);",
            },
            borrows="box2d-2.3",
            notes=(),
        ),
        replace(
            _BOX2D_2,
            name="planck",
            ran="planck 1.4.2",
            set_by="Settings.velocityThreshold",
            lines={
                "restitution": "body.createFixture({{shape, restitution: {value}}})"
                "  // of {bodies}",
                "Settings.velocityThreshold": "Settings.velocityThreshold = {value};",
                "step": "world.step({value});",
            },
            notes=(),
            # The last of three balls that touch left with 0.63 for 0.90 in planck 1.4.2.
            not_for=("three touching bodies",),
        ),
        ByNumber(
            name="chipmunk",
            rule=step_rules.chipmunk,
            ran="Chipmunk 7 (pymunk 7.3.1)",
            parameter="elasticity",
            lines={
                "elasticity": "shape.elasticity = {value}  # of {bodies}",
                "step": "space.step({value})",
            },
            pair=PRODUCT,
            sinks=0.0,
            reach=0.0,
        ),
        _DART,
        replace(
            _DART,
            name="gazebo-sim",
            parameter="restitution_coefficient",
            lines={
                "restitution_coefficient": _OF_GAZEBO_BODIES,
                "step": _OF_GAZEBO_STEP,
            },
            ran="Gazebo's physics with DART (Ignition Physics 5.1.0 of Debian)",
            notes=(
                "With its default engine Gazebo passes this number to DART, and ignores the "
                "threshold of the same element",
            ),
        ),
        ByNumber(
            name="matter-js",
            own_step=1 / 60,
            rule=step_rules.matter,
            ran="matter-js 0.20.0",
            pair=LARGER,
            threshold=2 * 60 * STANDARD_GRAVITY / PIXELS,
            set_by="Resolver._restingThresh",
            lines={
                "restitution": "const body = Bodies.circle(x, y, radius, "
                "{{restitution: {value}}});  // of {bodies}",
                "Resolver._restingThresh": "Matter.Resolver._restingThresh = {value};",
                "frictionAir": "body.frictionAir = {value};",
                "gravity": "engine.gravity.scale = {value};",
                "step": "Matter.Engine.update(engine, 1000 / {rate});",
            },
            pixels=PIXELS / STANDARD_GRAVITY,
            either=tuple({"turn": turn} for turn in (0.0, 0.5, 1.0)),
            reach=0.03,
            settings={"frictionAir": 0.01},
            designed=({"frictionAir": 0.0},),
            damped_by="frictionAir",
            kept=lambda damping, step: max(1 - damping * step * 60, 0.0),
            notes=(
                "A circle is a polygon there, of 10 to 26 sides: r is over all ways to turn it, "
                "which matter below a radius of 20 pixels. With inertia: Infinity it cannot turn, "
                "and has the r of a large circle",
                "Below the threshold a ball with a number above 0.98 may also leave faster than "
                "it came",
            ),
            not_for=("boxes", "spinning circles"),
        ),
        ByNumber(
            name="pybullet",
            own_step=1 / 240,
            rule=step_rules.pybullet,
            ran=ENGINES["pybullet"].ran,
            pair=PRODUCT,
            threshold=0.2,
            set_by="restitutionVelocityThreshold",
            lines={
                "restitution": "for body in (one, other):  # {bodies}\n"
                "    pybullet.changeDynamics(body, -1, restitution={value})",
                "linearDamping": _BULLET,
                "contactProcessingThreshold": _BULLET,
                "contactERP": _OF_BULLET,
                "contactSlop": _OF_BULLET,
                "restitutionVelocityThreshold": _OF_BULLET,
                "step": "pybullet.setPhysicsEngineParameter(fixedTimeStep={value}, numSubSteps=1)",
            },
            settings={"contactERP": 0.08, **_BULLET_BESIDE},
            designed=(
                dict.fromkeys(
                    ("linearDamping", "contactProcessingThreshold", "contactERP", "contactSlop"),
                    0.0,
                ),
            ),
            free=step_rules.bullet_flight,
            ahead=_found_ahead,
            springs="pybullet",
            is_restless=True,
            calmed_by="contactProcessingThreshold",
            notes=("Bullet's own bodies, as in C++ and ammo.js, have no linearDamping of 0.04",),
            # The last of three balls that touch left with 0.63 for 0.90 in PyBullet 3.2.7; a box on
            # a GEOM_PLANE had 0.61 to 0.65 and a capsule at 20° 0.76, for 0.80.
            not_for=(
                "three touching bodies",
                "boxes or lying capsules on GEOM_PLANE",
                "tilted capsules",
            ),
        ),
        ByNumber(
            name="ode",
            rule=step_rules.ode,
            ran=ENGINES["ode"].ran,
            parameter="bounce",
            pair=PAIR,
            set_by="bounce_vel",
            has_defaults=False,
            lines={
                "bounce": "contact.surface.mode = dContactBounce | dContactApprox1;\n"
                "contact.surface.bounce = {value};",
                "bounce_vel": "contact.surface.bounce_vel = {value};",
                "soft_cfm": "contact.surface.soft_cfm = {value};",
                "step": "dWorldStep(world, {value});",
            },
            settings=ENGINES["ode"].defaults,
            designed=({"soft_cfm": 1e-10},),
            reach=0.0,
            springs="ode",
            depends_on_mass=True,
            notes=("These are numbers of a contact joint",),
        ),
        ByNumber(
            name="gazebo",
            own_step=1e-3,
            rule=step_rules.gazebo,
            ran=ENGINES["gazebo"].ran,
            parameter="restitution_coefficient",
            pair=LEAST,
            threshold=1e5,
            set_by="threshold",
            lines={
                "restitution_coefficient": _OF_GAZEBO_BODIES,
                "threshold": _OF_GAZEBO_BODIES,
                "max_vel": _OF_GAZEBO,
                "kd": _OF_GAZEBO,
                "contact_max_correcting_vel": "<{name}>{value}</{name}>  "
                "<!-- in <physics><ode><constraints> -->",
                "step": _OF_GAZEBO_STEP,
            },
            settings={
                name: ENGINES["gazebo"].defaults[name]
                for name in ("kp", "kd", "max_vel", "contact_max_correcting_vel")
            },
            # With such a damper the default spring takes nothing of the penetration back.
            designed=({"max_vel": 1e9, "contact_max_correcting_vel": 1e9, "kd": 1e12},),
            springs="gazebo",
            reach=0.0,
            depends_on_mass=True,
            notes=("Gazebo Classic, with ODE",),
        ),
        ByNumber(
            name="newton-xpbd",
            rule=step_rules.xpbd,
            ran="Newton 1.8.0",
            lines={
                "restitution": "ShapeConfig(restitution={value})  # SolverXPBD(model, "
                "enable_restitution=True)",
                "step": "solver.step(state, following, control, contacts, {value})",
            },
            reach=0.0,
            not_for=("flat boxes", "lying capsules", "spinning balls"),
        ),
        ByNumber(
            name="cannon-es",
            own_step=1 / 60,
            rule=step_rules.cannon,
            ran="cannon-es 0.20.0",
            pair=PAIR,
            lines={
                "restitution": "const contact = new ContactMaterial(a, b, {{restitution: "
                "{value}}});",
                "contactEquationRelaxation": "contact.contactEquationRelaxation = {value};",
                "contactEquationStiffness": "contact.contactEquationStiffness = {value};",
                "linearDamping": "body.linearDamping = {value};",
                "step": "world.step({value});",
            },
            settings={
                "contactEquationRelaxation": 3.0,
                "contactEquationStiffness": 1e7,
                "linearDamping": 0.01,
            },
            # With such a stiffness r does not depend on the mass.
            designed=tuple(
                {"contactEquationRelaxation": steps, "contactEquationStiffness": 1e15}
                for steps in (10.0, 50.0)
            ),
            damped_by="linearDamping",
            kept=lambda damping, step: (1 - min(damping, 1.0)) ** step,
            reach=0.0,
            depends_on_mass=True,
        ),
    )
}
"""Engines whose restitution is a number, and products on top of one, by their names."""
NAMES = {
    "bevyrapier": "rapier",
    "box2d": "box2d-3.1",
    "box2d24": "box2d-2",
    "box2d241": "box2d-2",
    "box2d242": "box2d-2",
    "bullet": "pybullet",
    "bullet3": "pybullet",
    "cannon": "cannon-es",
    "dartpy": "dart",
    "dmcontrol": "mujoco",
    "dartsim": "dart",
    "drakelagged": "drake",
    "gazeboclassic": "gazebo",
    "gazeboharmonic": "gazebo-sim",
    "genesisworld": "genesis",
    "gz": "gazebo-sim",
    "gzsim": "gazebo-sim",
    "ignition": "gazebo-sim",
    "ignitiongazebo": "gazebo-sim",
    "isaac": "isaac-sim",
    "jbox2d": "box2d-2.3",
    "matter": "matter-js",
    "mjlab": "mujoco-warp",
    "mjwarp": "mujoco-warp",
    "mjx": "mujoco",
    "mujocomjx": "mujoco",
    "mujocoplayground": "mujoco",
    "robosuite": "mujoco",
    "newtonsemiimplicit": "newton",
    "newtonfeatherstone": "newton",
    "nvidiaphysx": "physx",
    "omniverse": "isaac-sim",
    "ovphysx": "physx",
    "p5play": "planck",
    "pybox2d": "box2d-2.3",
    "pymunk": "chipmunk",
    "xpbd": "newton-xpbd",
    "adams": "",
    "aframe": "has several engines: take cannon-es for its Cannon",
    "avian": "",
    "bepu": "",
    "bevy": "has several engines: take rapier for bevy_rapier",
    "bevyxpbd": "",
    "blender": "has Bullet: take pybullet",
    "box2d32": "has another rule than box2d-3.1",
    "box3d": "",
    "ammo": "is Bullet: take pybullet with linearDamping=0",
    "babylon": "has several engines: take cannon-es for its Cannon",
    "brax": "",
    "chaos": "",
    "chrono": "",
    "construct": "has Box2D: take box2d-2.3, or box2d-3.1 for Box2D 3",
    "coppeliasim": "has several engines: take pybullet, ode or mujoco",
    "gdevelop": "has Box2D: take box2d-2.3",
    "godot": "has two engines: take godot-jolt for Jolt Physics",
    "dojo": "",
    "dyn4j": "",
    "gymnasium": "has no engine of its own: take mujoco, or box2d-2.3",
    "havok": "",
    "haxball": "",
    "isaacgym": "has PhysX with the solver TGS, for which there is no row",
    "liggghts": "",
    "maniskill": "has PhysX with the solver TGS, for which there is no row",
    "mercurydpm": "",
    "oimo": "",
    "p2": "",
    "p2es": "",
    "phaserbox2d": "has Box2D 3: take box2d-3.1",
    "phaser": "has two engines: take matter-js for Matter",
    "physac": "",
    "physijs": "is Bullet: take pybullet with linearDamping=0",
    "playcanvas": "has Bullet: take pybullet with linearDamping=0",
    "physx3": "",
    "reactphysics3d": "",
    "reactthreecannon": "has cannon-es: take cannon-es",
    "reactthreerapier": "has Rapier: take rapier",
    "rigidipc": "",
    "sapien": "has PhysX with the solver TGS, for which there is no row",
    "simscape": "",
    "siconos": "",
    "three": "has no physics: take the engine beside it, such as cannon-es or rapier",
    "unity2d": "has Box2D: take box2d-2, or box2d-3.1 for Box2D 3",
    "unreal": "",
    "ue": "",
    "warp": "has no contacts of its own: take mujoco-warp or newton",
    "webots": "has an ODE of its own: take ode",
    "yade": "",
}
"""Other names of rows; and products that were not run, with what may stand for them."""

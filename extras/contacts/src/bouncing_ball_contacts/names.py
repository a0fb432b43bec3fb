"""Names that people type: of engines, of products on top of one, and of parameters."""

import difflib
import re
from collections.abc import Mapping, Sequence
from typing import Any

from bouncing_ball_contacts.engines import ByNumber, Engine, Parameters, as_compared
from bouncing_ball_contacts.number_rows import BY_NUMBER
from bouncing_ball_contacts.spring_rows import ENGINES
from bouncing_ball_contacts.units import Refused, refuse

_SAME = {
    **dict.fromkeys(("e", "cor", "bounciness", "bounce", "elasticity"), "restitution"),
    "k": "stiffness",
    "c": "damping",
}
"""What other engines and papers call a parameter, as names are compared."""
_TIME_STEPS = ("timestep", "dt", "fixedtimestep", "fixeddeltatime", "maxstepsize", "stepsize")
"""What engines call the time step, as names are compared."""


def parameters_of(
    engine: str, known: Mapping[str, str], names: Sequence[str], typed: Parameters
) -> dict[str, Any]:
    """Return typed values by their names in the engine.

    ``known`` maps names as they are compared to names of the engine; ``names`` are listed in
    messages.

    Raises
    ------
    Refused
        If a name is unknown, or given twice.
    """
    found: dict[str, Any] = {}
    for each, value in typed.items():
        name = known.get(as_compared(str(each)))
        if name is None:
            near = [f"; did you mean {one}?" for one in difflib.get_close_matches(each, names, 1)]
            others = [f"; {row.name} has it" for row in ENGINES.values() if each in row.rules]
            step = ["; the time step is --time-step, or time_step= in Python"]
            steps = step * (as_compared(str(each)) in _TIME_STEPS)
            same = _SAME.get(as_compared(str(each)), "")
            meant = [f"; did you mean {same}?"] * (same in known)
            hint = "".join(steps or meant or near or others)
            known_here = ", ".join(names)
            raise Refused(
                f"{engine}: {each!r} is not computed here; computed are {known_here}{hint}"
            )
        if name in found:
            raise Refused(f"{each!r} gives {name} twice")
        found[name] = value
    return found


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
    "mjwarp": "mujoco-warp",
    "mjx": "mujoco",
    "mujocomjx": "mujoco",
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
    "isaacgym": "has another PhysX: take physx for PhysX 5",
    "liggghts": "",
    "maniskill": "has PhysX: take physx for PhysX 5",
    "mercurydpm": "",
    "p2": "",
    "phaser": "has two engines: take matter-js for Matter",
    "physac": "",
    "physijs": "is Bullet: take pybullet with linearDamping=0",
    "playcanvas": "has Bullet: take pybullet with linearDamping=0",
    "physx3": "",
    "reactphysics3d": "",
    "rigidipc": "",
    "sapien": "has PhysX: take physx for PhysX 5",
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


def rows_of(name: str) -> tuple[Engine | None, ByNumber | None]:
    """Return the row of an engine for springs, and the row for a restitution by number.

    Raises
    ------
    Refused
        If there is none; the message has the nearest name.
    """
    rows = {re.sub(r"\W", "", each): each for each in (*ENGINES, *BY_NUMBER)}
    known = rows | NAMES
    plain = re.sub(r"[\W_]", "", str(name).lower())
    # A version at the end, and words such as "engine", belong to no name.
    bare = re.sub(r"(physics|engine|js)*(v?\d+d?)?$", "", plain)
    key = next((each for each in (plain, bare) if each in known), "")
    found = known.get(key, "")
    near = difflib.get_close_matches(plain, known, 1, 0.85)
    meant = f"did you mean {known[near[0]] or near[0]}? " if near else ""
    refuse(
        [
            (not key, f"engine {name!r} is not known; {meant}'bounce engines' lists the engines"),
            (found not in rows.values(), f"{name} was not run{f', but {found}' * bool(found)}"),
        ]
    )
    row = BY_NUMBER.get(found)
    return ENGINES.get(row.springs if row else found), row

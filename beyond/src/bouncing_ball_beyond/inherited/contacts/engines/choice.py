"""The physics engines that a user can name: the table of them.

* *generic*: any script with a spring, a damper and a rule that ends the contact, here with
  semi-implicit Euler steps as in a simple script.
* *PyBullet*, ``changeDynamics`` of both bodies, whose springs are in series and whose dampings are
  added. If ball and table have the same parameters, these are 2k in N/m and c/2 in N s/m. By
  default, Bullet also has contacts of bodies that do not touch yet, at distances that depend on
  their sizes: the damper then acts from the surface on, so that r is ``exp(-ζωh)`` times the value
  without such contacts. The text to paste allows none, and no slop.

  ``restitution`` is another kind of contact: an instant with the product r of both bodies' values,
  of the speed that a ball inside has after gravity: in a step Δt it rebounds with ``r (v + gΔt)``,
  so that slow impacts bounce too high. With contacts ahead the ball is stopped at the surface
  instead, so that r is 0; below ``restitutionVelocityThreshold`` it is 0 as well; and
  ``contactERP`` adds up to its own value to r, as it pushes the ball out of the table.
* *Newton*, SolverSemiImplicit and SolverFeatherstone: ke = k in N/m and kd = c in N s/m, averaged
  over both shapes; by default, says its documentation, they are 2500 and 100. The damper acts while
  the ball approaches only, and a step is one of semi-implicit Euler. Newton computes with single
  precision.
* *PhysX*, in Isaac Sim and Isaac Lab as well: the compliant contact of a material, with k in N/m
  and c in N s/m. Two materials of the same numbers have these numbers together, and so has one of
  them with a material that is not compliant. A step is one of implicit Euler, and the contact is
  found ahead, both spring and damper, in a step after which the ball would be inside. With the
  solver TGS the contact has the steps of the solver's iterations, so that the text to paste has the
  solver PGS. A contact is found within ``contactOffset``, in PhysX by default 2 cm of each shape: a
  ball that moves farther than that in a step may not be found ahead. Source: the code of PhysX 5.

The other rows are in :mod:`~bouncing_ball_beyond.inherited.contacts.engines.mujoco`,
:mod:`~bouncing_ball_beyond.inherited.contacts.engines.granular` and
:mod:`~bouncing_ball_beyond.inherited.contacts.engines.drake`.
"""

import math
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from bouncing_ball_beyond.inherited.contacts.engines.drake import DRAKE
from bouncing_ball_beyond.inherited.contacts.engines.engine import Engine, proportional
from bouncing_ball_beyond.inherited.contacts.engines.granular import LAMMPS, LIGGGHTS, MERCURYDPM
from bouncing_ball_beyond.inherited.contacts.engines.mujoco import GENESIS, MUJOCO, NEWTON_MUJOCO
from bouncing_ball_beyond.inherited.contacts.engines.scheme import Scheme
from bouncing_ball_beyond.inherited.errors import ModelError, one_of
from bouncing_ball_beyond.models.damping import Release


def _instant_of_pybullet(restitution: float) -> str:
    return (
        f"restitution={math.sqrt(restitution):.6g} of ball and table alike, without a spring, "
        "with contactProcessingThreshold=0, contactERP=0 and restitutionVelocityThreshold=0"
    )


_IN_SERIES = (
    "ball and table are taken to have these numbers alike: their springs are in series, so that k "
    "is half of contactStiffness, and their dampings add up"
)
_ROWS = (
    replace(
        proportional(
            "generic",
            ("stiffness", "damping"),
            (Release.DISPLACEMENT, Release.FORCE),
            Scheme.SEMI_IMPLICIT,
            has_mass=True,
        ),
        parameters=lambda contact, law=None: contact._asdict(),
    ),
    MUJOCO,
    LAMMPS,
    LIGGGHTS,
    proportional(
        "pybullet",
        ("contactStiffness", "contactDamping"),
        (Release.FORCE,),
        Scheme.COMPENSATED,
        lambda mass: (2.0, 0.5),
        instant=_instant_of_pybullet,
        remarks=lambda _: (_IN_SERIES,),
    ),
    DRAKE,
    MERCURYDPM,
    proportional(
        "newton-semi-implicit",
        ("ke", "kd"),
        (Release.APPROACH,),
        Scheme.SEMI_IMPLICIT,
        defaults={"ke": 2500, "kd": 100},
    ),
    NEWTON_MUJOCO,
    GENESIS,
    proportional(
        "physx",
        ("compliantContactStiffness", "compliantContactDamping"),
        (Release.FORCE,),
        Scheme.COMPENSATED_AHEAD,
    ),
)
ENGINES: dict[str, Engine] = {engine.name: engine for engine in _ROWS}
"""The engines by name."""


# Programs that have the contacts of another one.
_ISAAC = ("isaac", "isaac-sim", "isaacsim", "isaac-lab", "isaaclab")
_SAME = dict.fromkeys(("physx", *_ISAAC), "physx")
# What is known of programs for which nothing is written.
_KNOWN = {
    "unity": (
        "no contact is written for unity: its materials have no stiffness, its restitution is a "
        "number (bounciness), and nothing bounces below bounceThreshold, by default 2 m/s, a drop "
        "of 0.2 m: contacts/docs/bounces.md has the bounces of PhysX, which is its engine"
    )
} | {
    name: (
        f"{name} has no time step of its own, and its contact is a law, without an engine: {law}, "
        "which needs a contact time and an impact speed"
    )
    for name, law in (
        ("adams", "adams-impact or adams-impact-linear"),
        ("simscape", "simscape-contact"),
    )
}


def engine_named(name: str) -> Engine:
    """The engine with this name.

    Raises
    ------
    ModelError
        If no engine has this name; the message lists the engines, or has what is known of it.

    Examples
    --------
    >>> engine_named("mujoco").releases
    (<Release.FORCE: 'force'>,)
    >>> engine_named("Isaac-Sim").name
    'physx'
    """
    plain = str(name).casefold()
    if known := _KNOWN.get(plain):
        raise ModelError(f"{known}; contacts are written for {', '.join(ENGINES)}")
    return one_of("engine", _SAME.get(plain, name), ENGINES)


_INSTANTS = {
    "physx": (
        "restitution of physx is an instant, which has no effect below an impact speed of "
        "bounceThresholdVelocity: contacts/docs/bounces.md has what it does; a contact that lasts "
        "has compliantContactStiffness and compliantContactDamping"
    )
}


def engine_of(name: str, parameters: Mapping[str, Any]) -> Engine:
    """The engine with this name, or the row of the law to which these parameters belong.

    Raises
    ------
    ModelError
        If there is no such engine, or the parameters are those of no contact that lasts.
    """
    engine = engine_named(name)
    if engine.instant is not None and "restitution" in parameters:
        both = float(parameters["restitution"]) ** 2
        raise ModelError(
            f"restitution of {name} has no stiffness: if ball and table have it, "
            f"r = {both:.4g} with small steps, and {both:.4g} (1 + gΔt/v) at a step Δt and an "
            "impact speed v, with contactProcessingThreshold=0, contactERP=0 and "
            "restitutionVelocityThreshold=0, and 0 without the first of these"
        )
    if engine.name in _INSTANTS and "restitution" in parameters:
        raise ModelError(_INSTANTS[engine.name])
    # Hertz contacts are written, and not read.
    rows = (row for row in engine.laws.values() if row.needs_speed)
    # The laws of an engine differ in the name of their damping.
    found = next((row for row in rows if row.names[1] in parameters), engine)
    if found is not engine and engine.names[1] in parameters:
        both = f"{engine.names[1]} and {found.names[1]}"
        raise ModelError(f"{both} are the dampings of two contacts of {name}: give one of them")
    return found

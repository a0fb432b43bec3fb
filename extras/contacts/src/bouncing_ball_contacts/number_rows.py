"""Engines whose restitution is a number, by their names."""

import math
from dataclasses import replace
from functools import partial

from bouncing_ball_contacts import step_rules
from bouncing_ball_contacts.engines import (
    LARGER,
    LEAST,
    PAIR,
    PIXELS,
    PRODUCT,
    ByNumber,
    Rule,
)
from bouncing_ball_contacts.spring_rows import BULLET_BESIDE, ENGINES, found_ahead
from bouncing_ball_contacts.units import STANDARD_GRAVITY

_CLAMPED_SUM = Rule("added, and at most 1", lambda a, b: min(a + b, 1.0), lambda x: x / 2)
_OLD_JOLT = "Before 5.3 (November 2024) Jolt had another rule, by which 1 gave 1.017 from 5 m"
_CONSTANT = "The threshold is a constant of the library"
_JOLT = ByNumber(
    name="jolt",
    rule=step_rules.jolt,
    ran="Jolt 5 (jolt-physics 1.1.0 for JavaScript)",
    parameter="mRestitution",
    pair=LARGER,
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
    notes=(_OLD_JOLT,),
)
_GODOT = "physics/jolt_physics_3d/simulation/bounce_velocity_threshold"
_PHYSX = ByNumber(
    name="physx",
    rule=partial(step_rules.physx, ahead=0.04),
    ran="PhysX 5.6.1 (physx-js-webidl 2.7.3)",
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
    each.name: each
    for each in (
        _JOLT,
        replace(
            _JOLT,
            name="godot-jolt",
            parameter="bounce",
            pair=_CLAMPED_SUM,
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
            notes=("It has PhysX 4.1 with a contact offset of 10 mm",),
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
            rule=step_rules.matter,
            ran="matter-js 0.20.0",
            pair=LARGER,
            threshold=2 * 60 * STANDARD_GRAVITY / PIXELS,
            set_by="Resolver._restingThresh",
            lines={
                "restitution": "Bodies.circle(x, y, radius, {{restitution: {value}}})"
                "  // of {bodies}",
                "Resolver._restingThresh": "Matter.Resolver._restingThresh = {value};",
                "frictionAir": "body.frictionAir = {value};",
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
            settings={"contactERP": 0.08, **BULLET_BESIDE},
            designed=(
                dict.fromkeys(
                    ("linearDamping", "contactProcessingThreshold", "contactERP", "contactSlop"),
                    0.0,
                ),
            ),
            free=step_rules.bullet_flight,
            ahead=found_ahead,
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

"""Every engine, with light and heavy, small and large balls: what is written is true.

Four balls cover all pairs of mass, radius and height. What is asked of an answer are truths: r of a
loop over the steps, which is written here from the parameters alone, or r that was recorded in the
engine; and the same r from the parameters that are written. Refusals are listed.
"""

import csv
import math
from pathlib import Path

import pytest

from bouncing_ball_contacts import ENGINES, Bounce, design, diagnose
from bouncing_ball_contacts.rows import BY_NUMBER

G = 9.81
WANTED = 0.6
BALLS = [(1e-3, 1e-3, 0.02), (1e-3, 1.0, 5.0), (1e3, 1e-3, 5.0), (1e3, 1.0, 0.02)]
"""Mass in kg, radius in m and height in m."""
STEP = 2e-3
WITHOUT = {("box2d-2.3", 0.04)}
"""Engines and heights in m for which no number bounces: the threshold is a constant of 1 m/s."""
TURNS = {"matter-js"}
"""Engines whose small balls leave the tolerance, because they are polygons."""


def by_force(force, pulls=False):
    """Return a step in which the force in N acts on the velocity, and then the position moves."""

    def step(p, m, h, z, v):
        acting = force(p, m, z, v) if z < 0 else 0.0
        v += h * ((acting if pulls else max(acting, 0.0)) / m - G)
        return z + h * v, v

    return step


def by_impedance(constants):
    """Return a step of MuJoCo: the acceleration is (1 - d) a₀ + d a_ref, if that pushes."""

    def step(p, m, h, z, v):
        k, b = constants(p)
        d = p["solimp"][0]
        v += h * (max(-G, -(1 - d) * G - d * (b * v + k * z)) if z < 0 else -G)
        return z + h * v, v

    return step


def direct(stiffness, damping, d=0.999):
    """Return k and b in 1/s² and 1/s of a stiffness and a damping."""
    return stiffness / d, damping / d


def of_chipmunk(p, m, h, z, v):
    z += h * v
    return z, -(p["elasticity"] ** 2) * v if z < 0 and v < 0 else v - G * h


def of_dart(p, m, h, z, v):
    r = next(iter(p.values())) ** 2
    v -= G * h
    if z < 0 and v < 0:
        v = -r * v if -r * v > 0.1 else min(-0.01 * z / h, 1e-3)
    return z + h * v, v


def of_xpbd(p, m, h, z, v):
    v -= G * h
    z += h * v
    return (0.04 * z, -p["restitution"] * v) if z < 0 and v < 0 else (z, v)


def of_ode(p, m, h, z, v):
    aim = max(-p["bounce"] * v, -0.2 * z / h)
    v -= G * h
    if z < 0:
        # A constraint force mixing of 1e-10 is soft for heavy bodies.
        v = max(v, aim + (v - aim) / (1 + h / (1e-10 * m)))
    return z + h * v, v


def of_cannon(p, m, h, z, v):
    four = 4 * p["contactEquationRelaxation"]
    soft = 4 / (h * h * p.get("contactEquationStiffness", 1e7) * (1 + four))
    push = G * h - (4 * z / h + (1 + p["restitution"]) * v * four) / (1 + four)
    v += max(push / (1 + soft * m), 0.0) if z < 0 else 0.0
    # The default of linearDamping is 0.01, and gravity acts after it.
    v = 0.99**h * v - G * h
    return z + h * v, v


OWN = {
    "generic": by_force(lambda p, m, z, v: -p["stiffness"] * z - p["damping"] * v),
    "lammps": by_force(lambda p, m, z, v: -p["kn"] * z - p["gamma_n"] * m * v, pulls=True),
    "lammps-limit-damping": by_force(lambda p, m, z, v: -p["kn"] * z - p["gamma_n"] * m * v),
    **dict.fromkeys(
        ("mujoco", "mujoco-warp"),
        by_impedance(lambda p: direct(-p["solref"][0], -p["solref"][1])),
    ),
    "newton-mujoco": by_impedance(lambda p: direct(p["ke"], p["kd"])),
    "genesis": by_impedance(
        lambda p: (1 / (0.999 * (p["timeconst"] * p["dampratio"]) ** 2), 2 / 0.999 / p["timeconst"])
    ),
    "chipmunk": of_chipmunk,
    "dart": of_dart,
    "gazebo-sim": of_dart,
    "newton-xpbd": of_xpbd,
    "ode": of_ode,
    "cannon-es": of_cannon,
}
STANDS_FOR = {
    "gazebo": "ode",
    **{name: row.borrows for name, row in BY_NUMBER.items() if row.borrows},
}
"""Rows that have the rule of another row, and were not run as what is pasted."""


def recorded():
    """Return the engines of which r was recorded with a printed text."""
    folder = Path(__file__).parents[1] / "docs" / "validation"
    for name in ("pasted", "masses"):
        with (folder / f"{name}.csv").open(newline="", encoding="utf-8") as file:
            yield from (row["engine"] for row in csv.DictReader(file) if row["promise"] == "kept")


def dropped(step, p, m, h, height):
    """Return r of a ball of m kg that falls from a height in m in steps of h s."""
    z, v = height, 0.0
    while z >= 0:
        z, v = step(p, m, h, z, v)
    top = z
    while z <= 0 or z >= top:
        top = z
        z, v = step(p, m, h, z, v)
    return math.sqrt(top / height)


@pytest.mark.parametrize("name", {**ENGINES, **BY_NUMBER})
def test_what_is_written_for_a_ball_is_true(name):
    for mass, radius, fall in BALLS:
        # A ball rises to the skin of Box2D 2, however low r is.
        height = fall + 2 * (BY_NUMBER[name].skin if name in BY_NUMBER else 0)
        ball = dict(mass=mass, radius=radius, drop_height=height, gravity=G)
        answer = design(Bounce(**ball, restitution=WANTED), name, STEP)
        if (name, height) in WITHOUT:
            assert not answer.snippet and not answer.also
            continue
        answer = next(candidate for candidate in (answer, *answer.also) if candidate.snippet)
        low, mean, high = answer.outcome.restitution
        assert 0 <= low <= mean <= high <= 1.05
        assert answer.is_kept or (name in TURNS and radius < 0.1)
        assert max(answer.outcome.depth, default=0.0) <= radius
        again = diagnose(Bounce(**ball), name, answer.parameters, answer.time_step)
        assert again.outcome.restitution == pytest.approx((low, mean, high), abs=1e-3)
        if name in OWN:
            way = math.sqrt(2 * G * height) * answer.time_step
            heights = [height + way * (place / 5 - 0.5) for place in range(5)]
            of = answer.parameters, mass, answer.time_step
            restitutions = [dropped(OWN[name], *of, one) for one in heights]
            # r is printed with three digits, and instants are nine for springs.
            assert low - 2e-3 <= min(restitutions) and max(restitutions) <= high + 2e-3, (
                mass,
                radius,
                height,
            )
            # Five instants are a fifth of the range apart.
            assert sum(restitutions) / 5 == pytest.approx(mean, abs=max((high - low) / 5, 1e-3))
        if name in BY_NUMBER and not BY_NUMBER[name].springs:
            other = Bounce(**{**ball, "mass": 1e-3 / mass * 1e3})
            same = diagnose(other, name, answer.parameters, answer.time_step).outcome.restitution
            assert same == pytest.approx(again.outcome.restitution, abs=1e-3)


def test_every_engine_has_a_truth_of_its_own():
    known = {*OWN, *recorded()}
    assert {STANDS_FOR.get(name, name) for name in {**ENGINES, **BY_NUMBER}} <= known
    assert STANDS_FOR.keys() & known <= {"isaac-lab"}

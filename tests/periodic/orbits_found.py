"""Families of balls by name, and orbits with two to five impacts on which simulated balls end."""

from bouncing_ball.periodic.family import Family

from bouncing_ball.errors import FREQUENCY_RATIO, RESTITUTION, Range
from bouncing_ball.models.corrected.model import CorrectedModel
from bouncing_ball.models.laws.hertzian import Tsuji
from bouncing_ball.models.laws.model import LawModel
from bouncing_ball.models.rigid import RestitutionModel
from bouncing_ball.models.spring_damper import SpringDamper
from bouncing_ball.models.spring_damper_model import SpringDamperModel
from bouncing_ball.periodic import n_t
from bouncing_ball.periodic.simulation import simulated

RANGES = {"amplitude": Range(0, 1e8), "restitution": RESTITUTION, "stiffness": Range(0, 1e9)}
RANGES |= {"frequency_ratio": FREQUENCY_RATIO}


def contact_of(given, release="displacement"):
    return SpringDamper.from_restitution(given["restitution"], given["frequency_ratio"], release)


MAKERS = {
    "restitution": lambda given: RestitutionModel(given["restitution"]),
    "spring-damper": lambda given: SpringDamperModel(contact_of(given)),
    "force release": lambda given: SpringDamperModel(contact_of(given, "force")),
    "corrected": lambda given: CorrectedModel.of_contact(contact_of(given)),
    "tsuji": lambda given: LawModel(Tsuji(given["stiffness"], 0.3)),
}


def family(name, amplitude, restitution=0.5, frequency_ratio=10.0, stiffness=500.0):
    values = {"amplitude": amplitude}
    if name == "tsuji":
        values["stiffness"] = stiffness
    else:
        values["restitution"] = restitution
        if name != "restitution":
            values["frequency_ratio"] = frequency_ratio
    return Family(MAKERS[name], values, {each: RANGES[each] for each in values})


def known_orbit(name, amplitude, along, n=1, side="stable"):
    """The n-T orbit of a model in closed form as a point of the problem with one impact."""
    balls = family(name, amplitude)
    orbit = n_t.orbit(balls.make(balls.values), n, amplitude, side)
    dynamics = balls.dynamics({})
    row, start, _ = dynamics.in_a_row([float(orbit.phase)], [float(orbit.relative_impact_velocity)])
    phase, velocity = row.section(row.start(*start))
    return orbit, *simulated(balls, float(phase[0]), float(velocity[0]), 1, along)


# Model, impacts, periods, r, ϖ, Λ, φ and z′ of an impact: found by a random search.
FOUND = [
    ("restitution", 2, 2, 0.6070929748201541, 0.0, 1.345801016989186, 0.6069107, -2.9069377),
    ("restitution", 3, 3, 0.7502188035780316, 0.0, 1.344691248003805, -0.0579069, -3.227982877),
    ("restitution", 4, 6, 0.598327526289511, 0.0, 3.6332684052133457, 2.0583058, -7.0794132),
    ("restitution", 5, 3, 0.32454331850641893, 0.0, 3.1226802706039045, 0.1628955, -3.1406897),
    ("spring-damper", 2, 2, 0.6297562126038357, 3.1412396640847, 1.3648533451410207, -0.1558142,
     -2.3217593),
    ("spring-damper", 3, 3, 0.7319456301052158, 21.650422626202, 1.441055978916333, -2.6539187,
     -4.9555254),
    ("spring-damper", 4, 4, 0.4325814982589202, 7.766471195087, 1.8421629346938342, 0.1428875,
     -2.8036811),
    ("spring-damper", 5, 4, 0.5250881978979851, 4.298642034852, 1.727938175228041, 2.2779742,
     -3.8702319),
    ("force release", 3, 3, 0.5525528367704777, 5.791267653674, 1.9063759534057239, -2.3245249,
     -5.1374771),
    ("force release", 5, 6, 0.4631434570596722, 4.738518776381, 2.9526108083703635, 2.7665261,
     -7.4261748),
    # Here the second impact is a contact that resumes below the level of the table.
    ("force release", 2, 1, 0.4022115861133703, 16.998223047485396, 1.0906220212710724, 2.8356127,
     -1.2384469),
    ("force release", 3, 3, 0.09602571632409, 12.769636365911165, 3.2271275751276765, 0.2606291,
     -3.1411279),
]  # fmt: skip


def found_family(case):
    name, _, _, r, ratio, amplitude, *_ = case
    return family(name, amplitude, r, ratio)

"""Balls by the name of their model, and orbits with several impacts on which balls end."""

from bouncing_ball_beyond.models.contact_model import ContactModel
from bouncing_ball_beyond.models.corrected.model import CorrectedModel
from bouncing_ball_beyond.models.laws.hertzian import Tsuji
from bouncing_ball_beyond.models.rigid import RestitutionModel
from bouncing_ball_beyond.models.spring_damper import SpringDamper
from bouncing_ball_beyond.motions.orbit_of_motion import of_impact
from bouncing_ball_beyond.periodic.one_impact import n_t
from bouncing_ball_beyond.periodic.orbits.balls import Balls
from bouncing_ball_beyond.periodic.orbits.simulation import simulated


def balls(name, amplitude, restitution=0.5, frequency_ratio=10.0, stiffness=500.0):
    if name == "tsuji":
        return Balls(ContactModel(Tsuji(stiffness, 0.3)), amplitude)
    if name == "restitution":
        return Balls(RestitutionModel(restitution), amplitude)
    release = "force" if name == "force release" else "displacement"
    contact = SpringDamper.from_restitution(restitution, frequency_ratio, release)
    if name == "corrected":
        return Balls(CorrectedModel.of_contact(contact), amplitude)
    return Balls(ContactModel(contact), amplitude)


def known_orbit(name, amplitude, along=("amplitude",), n=1, side="stable"):
    """The n-T orbit of a model, and its simulated impact as a point of the equations."""
    ball = balls(name, amplitude)
    orbit = n_t.orbit(ball.model, n, amplitude, side)
    dynamics = ball.dynamics()
    row, start, _ = dynamics.in_a_row([orbit.phase], [orbit.relative_impact_velocity])
    phase, velocity = row.section().state(row.start(*start))
    return orbit, *simulated(ball, float(phase[0]), float(velocity[0]), 1, along)


def first(found, kind):
    """The first special orbit of a kind on a branch."""
    return next(each for each in found.special if each.kind == kind)


def legs_of(orbit):
    """The contacts and flights of an orbit."""
    problem, y = orbit.own_equations
    return problem.legs(y)


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


def found_balls(case):
    name, _, _, r, ratio, amplitude, *_ = case
    return balls(name, amplitude, r, ratio)


def found_orbit(case):
    _, impacts, periods, *_, phase, velocity = case
    orbit = of_impact(found_balls(case), phase, velocity, impacts)
    assert orbit.periods == periods
    return orbit

"""Random branches of all models, and a second code that judges the orbits at their ends.

The second code shares nothing with the package: contacts are integrated by scipy's DOP853, and
flights are parabolas over a sine. It takes an orbit as phases, velocities and durations, and
returns by how much it fails to close.
"""

from typing import NamedTuple

import numpy as np
from scipy.integrate import solve_ivp

import bouncing_ball
from bouncing_ball.errors import NoOrbitError

MODELS = ("rigid", "displacement", "force", "hunt-crossley", "corrected")
EXACT = {"rtol": 1e-12, "atol": 1e-14, "method": "DOP853"}
# The integrator keeps about eleven digits of a contact, and a stiff contact (ϖ = 60) loses two.
CLOSES = 1e-8
# Impacts and releases this slow are grazing: the page on periodic orbits says so.
GRAZES = 1e-5


class Verdict(NamedTuple):
    """The model, k, the parameter, the reason of the end, what the second code says of it
    ("right", "named" or "wrong"), the largest defect that it finds, and the slowest impact.
    """

    model: str
    impacts: int
    along: str
    reason: str
    verdict: str
    defect: float
    slowest: float


def ball_of(name, rng):
    r = rng.uniform(0.3, 0.9)
    if name == "rigid":
        return bouncing_ball.rigid(restitution=r)
    ratio = float(np.exp(rng.uniform(np.log(3.0), np.log(60.0))))
    if name == "hunt-crossley":
        return bouncing_ball.contact_law(name, stiffness=ratio**2.5, damping=(1 - r) / 3)
    release = "force" if name == "force" else "displacement"
    ball = bouncing_ball.spring_damper(restitution=r, frequency_ratio=ratio, release=release)
    return bouncing_ball.corrected(ball) if name == "corrected" else ball


def orbit_of(name, rng):
    """A random orbit with at most six impacts on which a simulated ball ends."""
    while True:
        ball = ball_of(name, rng)
        start = {"phase": rng.uniform(-3, 3), "velocity": -rng.uniform(4.0, 9.0)}
        amplitude = rng.uniform(1.0, 3.0)
        try:
            orbit = bouncing_ball.orbit_of_motion(ball, amplitude=amplitude, impacts=300, **start)
        except NoOrbitError:
            continue
        if orbit.impacts <= 6:
            return orbit


def _force(orbit):
    """δ″ + Λ sin φ-part of a contact: a function of δ and δ′."""
    law = orbit.model.impact_law
    if type(law).__name__ == "SpringDamper":
        ratio, zeta = float(law.frequency_ratio), float(law.damping_ratio)
        return lambda x, v: -(ratio**2) * x - 2 * zeta * ratio * v
    stiffness, damping = float(law.stiffness), float(law.damping)
    return lambda x, v: stiffness * max(-x, 0.0) ** 1.5 * (1 - damping * v)


def _released(orbit, k):
    """δ and δ′ at the release of one impact, and the time of the contact."""
    lam = float(orbit.amplitude)
    phase = float(orbit.phases[k])
    lasts = float(orbit.durations[k])
    closing = float(orbit.velocities[k]) - lam * np.cos(phase)
    if orbit.model.name == "restitution":
        if lasts > 0:
            return 0.0, 0.0, lasts
        return 0.0, -float(orbit.model.impact_law) * closing, 0.0
    force = _force(orbit)
    start = 0.0
    if np.broadcast_to(orbit.resumes, (orbit.impacts,))[k]:
        law = orbit.model.impact_law
        start = -2 * float(law.damping_ratio) / float(law.frequency_ratio) * closing

    def motion(t, y):
        return [y[1], lam * np.sin(phase + t) - 1 + force(y[0], y[1])]

    run = solve_ivp(motion, (0.0, lasts), [start, closing], **EXACT)
    return run.y[0, -1], run.y[1, -1], lasts


def defect_of(orbit):
    """The largest distance of the landings of the second code from the next impacts."""
    lam = float(orbit.amplitude)
    k = orbit.impacts
    turns = np.broadcast_to(orbit.turns, (k,))
    worst = 0.0
    for i in range(k):
        gap, rate, lasts = _released(orbit, i)
        after = (i + 1) % k
        whole = float(orbit.phases[after] - orbit.phases[i]) + 2 * np.pi * int(turns[i])
        leave = float(orbit.phases[i]) + lasts
        if orbit.model.name == "restitution" and lasts > 0:
            worst = max(worst, abs(lam * np.sin(leave) - 1))
        height = gap + lam * np.sin(leave)
        velocity = rate + lam * np.cos(leave)
        t = whole - lasts
        land = leave + t
        here = height + velocity * t - t * t / 2 - lam * np.sin(land)
        closing = float(orbit.velocities[after])
        expected = 0.0
        if np.broadcast_to(orbit.resumes, (k,))[after]:
            law = orbit.model.impact_law
            lag = 2 * float(law.damping_ratio) / float(law.frequency_ratio)
            expected = -lag * (closing - lam * np.cos(land))
        worst = max(worst, abs(here - expected), abs(velocity - t - closing))
    return worst


def _is_right(found, last, reason, slowest):
    """Whether the last orbit is what the reason says, None if there is no test for the reason."""
    along = str(found.attrs["along"])
    if reason.endswith("is reached"):
        value = float(reason.split("=")[1].split()[0])
        return abs(last.parameters[along] - value) <= 1e-5 * abs(value)
    if reason.startswith("grazing of an impact"):
        return slowest <= GRAZES
    if reason.startswith("period halving"):
        half = last.impacts // 2
        return float(np.max(np.abs(last.velocities[:half] - last.velocities[half:]))) < 1e-7
    if reason.startswith("release lost"):
        rates = [_released(last, k)[1] for k in range(last.impacts)]
        return last.model.name != "spring-damper" or min(np.abs(rates)) < 1.0
    return None


def judged(orbit, along, to):
    """The branch of an orbit up to a value, and the verdict on its end."""
    found = bouncing_ball.follow(orbit, along=along, to=to, points=200)
    reason = str(found.end_reason.values[-1])
    special = found.special_states()
    *_, last = found.states()
    if special and reason.startswith(special[-1][0]):
        last = special[-1][1]
    closing = last.velocities - float(last.amplitude) * np.cos(last.phases)
    slowest = float(np.min(np.abs(closing)))
    if orbit.model.name == "corrected":
        right, defect = _is_right(found, last, reason, slowest), float("nan")
        closes = last.defect() < CLOSES
    else:
        right, defect = _is_right(found, last, reason, slowest), defect_of(last)
        closes = defect < CLOSES
    verdict = "named" if right is None and closes else "right" if right and closes else "wrong"
    return Verdict(orbit.model.name, orbit.impacts, along, reason, verdict, defect, slowest)


def sample(count, seed):
    """Verdicts on so many random branches, of all models along each of their parameters."""
    rng = np.random.default_rng(seed)
    verdicts = []
    while len(verdicts) < count:
        name = MODELS[len(verdicts) % len(MODELS)]
        orbit = orbit_of(name, rng)
        for along, value in {**orbit.model.numbers(), "amplitude": orbit.amplitude}.items():
            factor = rng.choice([0.6, 1.5])
            to = (
                min(factor * float(value), 1.0) if along == "restitution" else factor * float(value)
            )
            if along == "damping_ratio":
                continue
            verdicts.append(judged(orbit, along, to))
    return verdicts[:count]

"""Random branches of all models, and a second code that judges the orbits at their ends.

The second code shares nothing with the package: contacts are integrated by scipy's DOP853, and
flights are parabolas over a sine. It takes an orbit as phases, velocities and durations, and
returns by how much it fails to close. The delay, the restitution, the load sensitivity and the
duration of the corrected model are integrals of a contact too.
"""

import itertools
from typing import NamedTuple

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

import bouncing_ball
from bouncing_ball.errors import NoOrbitError

MODELS = ("rigid", "displacement", "force", "hunt-crossley", "corrected")
EXACT = {"rtol": 1e-12, "atol": 1e-14, "method": "DOP853"}
# The integrator keeps about eleven digits of a contact, and a stiff contact (ϖ = 60) loses two.
CLOSES = 1e-8
# Impacts this slow are grazing: the page on periodic orbits says so. Where a branch ends next to
# one, its slowest impact is slower than a ten-thousandth of the others.
GRAZES = 1e-5
NEXT_TO = 1e-4
# The rate of a located release without speed, which is a double zero: half the digits.
LOST = 1e-6
# How near a ball of the corrected model is to leaving, or to staying, where its branch ends: its
# height or its speed above the table, of the numbers of the second code, which keep eleven digits.
LEAVES = 1e-11


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
        ratio = float(law.frequency_ratio)
        zeta = float(law.damping_ratio)
        return lambda x, v: -(ratio**2) * x - 2 * zeta * ratio * v
    stiffness = float(law.stiffness)
    damping = float(law.damping)
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


def _rates_of_release(orbit):
    """The rates at which the release functions δ + κ δ′ of an orbit pass 0; κ is 0 for the release
    by displacement.
    """
    law = orbit.model.impact_law
    lag = 0.0
    if type(law).__name__ == "SpringDamper" and str(law.release) == "force":
        lag = 2 * float(law.damping_ratio) / float(law.frequency_ratio)
    rates = []
    for k in range(orbit.impacts):
        _, rate, lasts = _released(orbit, k)
        load = float(orbit.amplitude) * np.sin(float(orbit.phases[k]) + lasts) - 1
        rates.append(rate + lag * load)
    return np.array(rates)


class Numbers(NamedTuple):
    """The delay t_c, r, the load sensitivity σ and the duration D of a linear contact."""

    delay: float
    restitution: float
    load: float
    duration: float


def numbers_of(ratio, zeta):
    """The numbers of a linear contact, integrated together with its derivative by the load."""

    def force(x, v):
        return -(ratio**2) * x - 2 * zeta * ratio * v

    def motion(t, y):
        return [y[1], force(y[0], y[1]), y[3], force(y[2], y[3]) - 1]

    def opens(t, y):
        return y[0]

    opens.direction = 1
    span = (0.0, 1.5 * np.pi / (ratio * np.sqrt(1 - zeta**2)))

    def run(delay):
        # With a load a the contact starts with the speed 1 - a t_c.
        found = solve_ivp(motion, span, [0.0, -1.0, 0.0, delay], events=opens, **EXACT)
        return found.t_events[0][-1], found.y_events[0][-1]

    duration, (_, after, _, _) = run(0.0)
    delay = duration * after / (1 + after)
    _, (_, _, moved, faster) = run(delay)
    later = -moved / after
    load = faster + force(0.0, after) * later + duration - delay
    return Numbers(delay, after, load, duration)


def corrected_defect(orbit):
    """The largest defect of an orbit of the corrected model, and the smallest distance of its balls
    from the border between leaving and staying: the height to which they rise above the table
    after a contact, or the speed of a rise that begins above it.
    """
    given = orbit.model.numbers()
    log = np.log(float(given["restitution"]))
    numbers = numbers_of(float(given["frequency_ratio"]), -log / np.hypot(np.pi, log))
    lam = float(orbit.amplitude)
    turns = np.broadcast_to(orbit.turns, (orbit.impacts,))
    worst = 0.0
    border = np.inf
    for i in range(orbit.impacts):
        after = (i + 1) % orbit.impacts
        phase = float(orbit.phases[i]) + numbers.delay
        closing = lam * np.cos(phase) - (float(orbit.velocities[i]) - numbers.delay)
        height = lam * np.sin(phase) - closing * numbers.delay
        velocity = lam * np.cos(phase) + numbers.restitution * closing
        velocity += numbers.load * (1 - lam * np.sin(phase))
        border = min(border, _border(lam, phase, height, velocity, numbers))
        if float(orbit.durations[i]) > numbers.duration * (1 + 1e-6):
            phase = float(orbit.phases[i] + orbit.durations[i])
            worst = max(worst, abs(lam * np.sin(phase) - 1))
            height = lam * np.sin(phase)
            velocity = lam * np.cos(phase)
        lands = float(orbit.phases[after]) + 2 * np.pi * int(turns[i]) + numbers.delay
        t = lands - phase
        arrives = velocity - t
        meets = lam * np.cos(lands) - arrives
        gap = height + velocity * t - t * t / 2 - lam * np.sin(lands) + meets * numbers.delay
        expected = float(orbit.velocities[after]) - numbers.delay
        worst = max(worst, abs(gap), abs(arrives - expected))
    return worst, border


def _border(lam, phase, height, velocity, numbers):
    """How far a ball is from the border between leaving and staying after one contact."""
    begins = numbers.duration - numbers.delay

    def rate(t):
        return velocity - t - lam * np.cos(phase + t)

    def gap(t):
        return height + velocity * t - t * t / 2 - lam * np.sin(phase + t)

    if rate(begins) <= 0 or gap(begins) > 0:
        return abs(rate(begins))
    t = begins + np.linspace(0.0, np.pi, 2001)
    falls = int(np.argmax(rate(t) <= 0))
    return abs(gap(brentq(rate, t[falls - 1], t[falls], xtol=1e-15))) if falls else np.inf


class End(NamedTuple):
    """The last orbit of a branch, the parameter, the reason, the slowest impact of the orbit, and
    for the corrected model the distance from the border between leaving and staying.
    """

    last: object
    along: str
    reason: str
    slowest: float
    border: float


def _is_right(end):
    """Whether the last orbit is what the reason says, None if there is no test for the reason."""
    last, along, reason, slowest, border = end
    if reason.endswith("is reached"):
        value = float(reason.split("=")[1].split()[0])
        return abs(last.parameters[along] - value) <= 1e-5 * abs(value)
    if reason.startswith("grazing of an impact"):
        return slowest <= GRAZES
    if reason.startswith("the orbit is next to a grazing of an impact"):
        return slowest <= NEXT_TO
    if reason.startswith("period halving"):
        half = last.impacts // 2
        return float(np.max(np.abs(last.velocities[:half] - last.velocities[half:]))) < 1e-7
    if reason.startswith("release lost") and last.model.name != "corrected":
        return float(np.min(np.abs(_rates_of_release(last)))) < LOST
    if reason.startswith("permanent contact"):
        # Steps along Λ become as short there as the difference by which the equations have slopes.
        return 0 < float(last.amplitude) - 1 < 1e-4
    if reason.startswith("end of sticking") and last.model.name == "corrected":
        return border < LEAVES
    return None


def judged(orbit, along, to):
    """The branch of an orbit up to a value, and the verdict on its end."""
    found = bouncing_ball.follow(orbit, along=along, to=to, points=200)
    reason = str(found.end_reason.values[-1])
    special = found.special_states()
    *_, last = found.states()
    if special and reason.startswith(special[-1][0]):
        last = special[-1][1]
    return verdict_on(last, along, reason)


def verdict_on(last, along, reason):
    """What the second code says of the last orbit of a branch that ends for a reason."""
    border = np.inf
    if last.model.name == "corrected":
        # The speed at the instants, which a grazing impact has lost as well.
        delay = float(last.model.signature(1.0).delay)
        instants = last.phases + delay
        closing = last.velocities - delay - float(last.amplitude) * np.cos(instants)
        defect, border = corrected_defect(last)
    else:
        closing = last.velocities - float(last.amplitude) * np.cos(last.phases)
        defect = defect_of(last)
    slowest = float(np.min(np.abs(closing)))
    # The ball of an orbit that is not admissible moves otherwise, and the page says so.
    closes = defect < CLOSES or not last.is_admissible()
    right = _is_right(End(last, along, reason, slowest, border))
    verdict = "named" if right is None and closes else "right" if right and closes else "wrong"
    return Verdict(
        model=last.model.name,
        impacts=last.impacts,
        along=along,
        reason=reason,
        verdict=verdict,
        defect=defect,
        slowest=slowest,
    )


def sample(count, seed):
    """Verdicts on so many random branches, of all models in turn along each of their parameters."""
    rng = np.random.default_rng(seed)
    verdicts = []
    for name in itertools.cycle(MODELS):
        orbit = orbit_of(name, rng)
        for along, value in {**orbit.model.numbers(), "amplitude": orbit.amplitude}.items():
            factor = rng.choice([0.6, 1.5])
            to = factor * float(value)
            if along == "restitution":
                to = min(to, 1.0)
            if along != "damping_ratio":
                verdicts.append(judged(orbit, along, to))
        if len(verdicts) >= count:
            return verdicts[:count]

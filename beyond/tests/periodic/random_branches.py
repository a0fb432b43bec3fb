"""Random branches of all models, whose ends a second code judges."""

import itertools
from typing import NamedTuple

import numpy as np
from second_code import closing_of, corrected_defect, defect_of, rates_of_release

import bouncing_ball_beyond
from bouncing_ball_beyond.inherited.errors import NoOrbitError

BALLS = ("rigid", "displacement", "force", "hunt-crossley", "corrected")
# The integrator keeps about eleven digits of a contact, and a stiff contact (ϖ = 60) loses two.
CLOSES = 1e-8
# Impacts this slow are grazing: the page on periodic orbits says so. Where a branch ends next to
# one, its slowest impact is slower than a ten-thousandth of the others.
GRAZES = 1e-5
NEXT_TO = 1e-4
# The rate of a located release without speed, which is a double zero: half the digits.
LOST = 1e-6
# The rate of a release, over the speed of its impact, next to the place where it is lost.
NEARLY = 1e-2
# A branch that comes back passes its start within a small part of a step.
CLOSED = 1e-6
# A branch with a rest ends at Λ - 1 = 1e-4 at the latest, where the steps along Λ become as short
# as the difference by which the equations have slopes; an end is located to 1e-12.
HELD = 1e-4 + 1e-9
# How near a ball of the corrected model is to leaving, or to staying, where its branch ends: its
# height or its speed above the table, of the numbers of the second code, which keep eleven digits.
LEAVES = 1e-11


# The multiplier at which an orbit bifurcates, by its kind. Unknowns that are located to 1e-12 leave
# it to 1e-8 for slopes up to 10⁴; next to a grazing impact, where slopes grow without bounds, the
# multipliers themselves are that large.
CRITICAL = {"saddle-node": 1.0, "period doubling": -1.0}
AT_CRITICAL = 1e-8


class Verdict(NamedTuple):
    """The model, k, the parameter, the reason of the end, what the second code says of it ("right",
    "named" or "wrong"), the largest defect that it finds, and the slowest impact.
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
        return bouncing_ball_beyond.rigid(restitution=r)
    ratio = float(np.exp(rng.uniform(np.log(3.0), np.log(60.0))))
    if name == "hunt-crossley":
        given = {"stiffness": ratio**2.5, "damping": (1 - r) / 3}
        return bouncing_ball_beyond.contact_law(name, **given)
    release = "force" if name == "force" else "displacement"
    given = {"restitution": r, "frequency_ratio": ratio, "release": release}
    ball = bouncing_ball_beyond.spring_damper(**given)
    return bouncing_ball_beyond.corrected(ball) if name == "corrected" else ball


def orbit_of(name, rng):
    """A random orbit with at most six impacts on which a simulated ball ends."""
    while True:
        ball = ball_of(name, rng)
        start = {"phase": rng.uniform(-3, 3), "velocity": -rng.uniform(4.0, 9.0)}
        amplitude = rng.uniform(1.0, 3.0)
        try:
            orbit = bouncing_ball_beyond.orbit_of_motion(
                ball, amplitude=amplitude, impacts=300, **start
            )
        except NoOrbitError:
            continue
        if orbit.impacts <= 6:
            return orbit


class End(NamedTuple):
    """The first and the last orbit of a branch, the parameter, the reason, the slowest impact of
    the last one, and for the corrected model the distance from the border between leaving and
    staying.
    """

    first: object
    last: object
    along: str
    reason: str
    slowest: float
    border: float


def _is_right(end):
    """Whether the last orbit is what the reason says, None if there is no test for the reason."""
    first, last, along, reason, slowest, border = end
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
        return float(np.min(np.abs(rates_of_release(last)))) < LOST
    if reason.startswith("the orbit is next to a release without speed"):
        return float(np.min(np.abs(rates_of_release(last) / closing_of(last)))) < NEARLY
    if reason.startswith("the branch is closed"):
        return float(np.max(np.abs(last.velocities - first.velocities))) < CLOSED
    if reason.startswith("the flight vanishes"):
        return slowest <= NEXT_TO and float(last.flight_time) < 0.1
    if reason.startswith(("permanent contact", "the flights vanish")):
        return 0 < float(last.amplitude) - 1 < HELD
    if reason.startswith("end of sticking") and last.model.name == "corrected":
        return border < LEAVES
    return None


def require_critical(special):
    """Each saddle-node and each period doubling has the multiplier that its kind says."""
    for kind, orbit in special:
        if kind in CRITICAL:
            multipliers = orbit.multipliers()
            missed = np.min(np.abs(multipliers - CRITICAL[kind]))
            assert missed < AT_CRITICAL * (1 + np.max(np.abs(multipliers))), (kind, multipliers)


def judged(orbit, along, to):
    """The branch of an orbit up to a value, and the verdict on its end."""
    found = bouncing_ball_beyond.follow(orbit, along=along, to=to, points=200).to_dataset()
    reason = str(found.end_reason.values[-1])
    special = found.special_states()
    require_critical(special)
    *_, last = found.states()
    if special and reason.startswith(special[-1][0]):
        last = special[-1][1]
    return verdict_on(orbit, last, along, reason)


def verdict_on(first, last, along, reason):
    """What the second code says of the last orbit of a branch that ends for a reason."""
    border = np.inf
    if last.model.name == "corrected":
        # The speed at the instants, which a grazing impact has lost as well.
        delay = float(last.model.signature(1.0).delay)
        instants = last.phases + delay
        closing = last.velocities - delay - float(last.amplitude) * np.cos(instants)
        defect, border = corrected_defect(last)
    else:
        closing = closing_of(last)
        defect = defect_of(last)
    slowest = float(np.min(np.abs(closing)))
    closes = defect < CLOSES
    right = _is_right(End(first, last, along, reason, slowest, border))
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


def branches(seed):
    """Verdicts on random branches of all kinds of balls in turn, without end, each orbit followed
    along each of its parameters but ζ, which follows from r.
    """
    rng = np.random.default_rng(seed)
    for name in itertools.cycle(BALLS):
        orbit = orbit_of(name, rng)
        values = {**orbit.model.numbers(), "amplitude": orbit.amplitude}
        for along in values:
            to = rng.choice([0.6, 1.5]) * float(values[along])
            if along == "restitution":
                to = min(to, 1.0)
            if along != "damping_ratio":
                yield judged(orbit, along, to)


def sample(count, seed):
    """Verdicts on so many random branches."""
    return list(itertools.islice(branches(seed), count))

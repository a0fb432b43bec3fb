"""Every number that ``design`` prints for a contact on a table, by a computation of its own.

A design is asked with its family n, which prints all numbers. Each row that is listed must be in
:func:`own_rows`, so that a new row without a comparison fails. What stands there shares no code
with the package: a contact is propagated by the matrix exponential of the oscillator with its
table, a flight ends at the first crossing of a parabola and the table on a grid, an orbit is found
by shooting, a saddle-node as the least Λ over the phase, a period doubling by central differences,
and the coefficients of the error law as limits of the errors of stiff contacts.

Times are in units of 1/Ω and lengths of g/Ω². The tolerances: crossings and releases are found to
1e-12, maxima of samples and central differences to 1e-6, and limits of first order to 1e-3.
"""

import math
from collections import Counter

import numpy as np
import pytest
from asked_contacts import answered
from scipy.linalg import expm
from scipy.optimize import brentq, minimize_scalar

from bouncing_ball_beyond.inherited.contacts.contact import rows
from bouncing_ball_beyond.motions.basins import fastest

G = 9.80665
TURN = 2 * math.pi


class Contact:
    """A ball on a spring and a damper with the frequency ratio ϖ and ζ, which may pull or not."""

    def __init__(self, omega, zeta, pulls):
        self.omega = omega
        self.zeta = zeta
        self.pulls = pulls
        self.step = math.pi / omega / 64

    def flow(self, lam, load, time):
        """The matrix of (p, p′, 1, sin τ, cos τ) over a time."""
        k = self.omega**2
        c = 2 * self.zeta * self.omega
        rates = [
            [0, 1, 0, 0, 0],
            [-k, -c, load, -lam, 0],
            [0] * 5,
            [0, 0, 0, 0, 1],
            [0, 0, 0, -1, 0],
        ]
        return expm(np.array(rates, dtype=float) * time)

    def grip(self, state):
        return state[0] if self.pulls else state[0] + 2 * self.zeta / self.omega * state[1]

    def force(self, state):
        return self.omega**2 * state[0] + 2 * self.zeta * self.omega * state[1]

    def contact(self, phase, speed, lam, load=1.0, longest=math.inf, with_tops=False):
        """Duration, p, p′ at the release and, if asked for, the greatest p and force; None if it
        lasts longer than the longest.
        """
        once = self.flow(lam, load, self.step)
        state = np.array([0.0, speed, 1.0, math.sin(phase), math.cos(phase)])
        states = [state]
        while True:
            later = once @ state
            if self.grip(later) <= 0:
                break
            states.append(later)
            state = later
            if len(states) * self.step > longest:
                return None
        last = (
            brentq(lambda s: self.grip(self.flow(lam, load, s) @ state), 0.0, self.step, xtol=1e-16)
            if self.grip(state) > 0
            else 0.0
        )
        end = self.flow(lam, load, last) @ state
        states.append(end)
        duration = (len(states) - 2) * self.step + last
        if not with_tops:
            return duration, end[0], end[1]
        tops = [self.top(value, states, lam, load) for value in (lambda x: x[0], self.force)]
        return duration, end[0], end[1], *tops

    def top(self, value, states, lam, load):
        """The greatest value over a contact, from the highest sample on both sides."""
        found = np.array([value(each) for each in states])
        k = int(np.argmax(found))
        if k == 0 and value(self.flow(lam, load, 1e-9) @ states[0]) < found[0]:
            return float(found[0])
        start = states[max(k - 1, 0)]
        best = minimize_scalar(
            lambda s: -value(self.flow(lam, load, s) @ start),
            bounds=(0.0, 2 * self.step), method="bounded", options={"xatol": 1e-10},
        )  # fmt: skip
        return (
            max(float(found[k]), -float(best.fun)) if 0 < k < len(states) - 1 else float(found[k])
        )

    def leave(self, phase, velocity, lam):
        """Phase, height and velocity with which the ball leaves; in a contact of any law."""
        duration, p, rate = self.contact(phase, lam * math.cos(phase) - velocity, lam)
        end = phase + duration
        return end, lam * math.sin(end) - p, lam * math.cos(end) - rate


class Instant:
    """An impact at an instant, with the depth t_c times the speed, r and the load σ."""

    def __init__(self, r, delay=0.0, load=0.0):
        self.r = r
        self.delay = delay
        self.load = load

    def leave(self, phase, velocity, lam):
        speed = lam * math.cos(phase) - velocity
        out = self.r * speed + self.load * (1 - lam * math.sin(phase))
        return phase, lam * math.sin(phase) - speed * self.delay, lam * math.cos(phase) + out


def following(model, phase, velocity, lam):
    """Phase and velocity of the next impact."""
    start, level, up = model.leave(phase, velocity, lam)
    delay = getattr(model, "delay", 0.0)

    def gap(s):
        speed = lam * np.cos(start + s) - (up - s)
        return level + up * s - s * s / 2 - lam * np.sin(start + s) + delay * speed

    longest = (
        max(up, 0.0) + math.sqrt(max(up, 0.0) ** 2 + 2 * max(level + lam, 0.0)) + 0.1 + 3 * delay
    )
    grid = np.linspace(0.0, longest, 4000)[1:]
    values = gap(grid)
    # Released below the table, the ball first rises above it.
    above = int(np.argmax(values > 0))
    below = above + int(np.argmax(values[above:] <= 0))
    fall = brentq(gap, grid[below - 1], grid[below], xtol=1e-15, rtol=1e-15)
    return start + fall, up - fall


def shoot(missed, guess):
    """A root of two functions of two unknowns, by Newton's method with central differences."""
    x = np.array(guess, dtype=float)
    for _ in range(30):
        size = 1e-6
        slopes = [
            (missed(*(x + size * e)) - missed(*(x - size * e))) / (2 * size) for e in np.eye(2)
        ]
        step = np.linalg.solve(np.stack(slopes, axis=1), -missed(*x))
        x = x + step / max(1.0, np.abs(step).max() / 0.3)
        if np.abs(step).max() < 1e-11:
            break
    return x


def orbit(model, n, lam, guess):
    """Phase and velocity of the n-T orbit at Λ."""

    def missed(phase, velocity):
        later, arrives = following(model, phase, velocity, lam)
        return np.array([later - phase - TURN * n, arrives - velocity])

    return shoot(missed, guess)


def on_branch(model, n, phase, guess):
    """Velocity and Λ of the n-T orbit whose impact has a phase."""

    def missed(velocity, lam):
        later, arrives = following(model, phase, velocity, lam)
        return np.array([later - phase - TURN * n, arrives - velocity])

    return shoot(missed, guess)


def trace_and_determinant(model, phase, velocity, lam):
    size = 1e-5
    columns = []
    for e in np.eye(2):
        ahead, behind = (
            np.array(following(model, *(np.array([phase, velocity]) + s * size * e), lam))
            for s in (1, -1)
        )
        columns.append((ahead - behind) / (2 * size))
    matrix = np.stack(columns, axis=1)
    return float(np.trace(matrix)), float(np.linalg.det(matrix))


def limits(model, n, phase, velocity, lam):
    """Λ of the saddle-node and of the period doubling of the branch of an orbit."""
    branch = {phase: (velocity, lam)}

    def at(where):
        near = min(branch, key=lambda known: abs(known - where))
        branch[where] = on_branch(model, n, where, branch[near])
        return branch[where]

    def surplus(where):
        trace, determinant = trace_and_determinant(model, where, *at(where))
        return 1 + trace + determinant

    low = phase
    while at(low - 0.05)[1] < branch[low][1]:
        low -= 0.05
    fold = minimize_scalar(
        lambda where: at(where)[1], bounds=(low - 0.05, low + 0.05), method="bounded",
        options={"xatol": 1e-5},
    )  # fmt: skip
    # From the saddle-node up, because the orbit may be beyond its period doubling.
    high = low + 0.05
    at(high)
    while surplus(high + 0.05) > 0:
        high += 0.05
    doubled = brentq(surplus, high, high + 0.05, xtol=1e-8)
    return float(fold.fun), float(at(doubled)[1])


def closed(n, r, lam):
    """Phase and velocity of the n-T orbit of the restitution model."""
    return math.acos(n * math.pi * (1 - r) / (1 + r) / lam), -n * math.pi


def quantities(model, n, lam, guess):
    """Height, velocity at the release, phase at the touch and apparent restitution of an orbit."""
    phase, velocity = orbit(model, n, lam, guess)
    if isinstance(model, Contact):
        end, level, up = model.leave(phase, velocity, lam)
        speed = lam * math.cos(phase) - velocity
        out = up - lam * math.cos(end)
        return np.array([level + up * up / 2, up, phase, out / speed]), (phase, velocity)
    _, level, up = model.leave(phase, velocity, lam)
    # The contact begins t_c before the instant, and lasts for D.
    rest = model.duration - model.delay
    speed = lam * math.cos(phase - model.delay) - (velocity + model.delay)
    out = up - rest - lam * math.cos(phase + rest)
    found = [level + up * up / 2, up - rest, phase - model.delay, out / speed]
    return np.array(found), (phase, velocity)


def seen_from_outside(contact):
    """The instant of a contact: r, t_c and σ from impacts without and with a small load."""
    duration, p, rate = contact.contact(0.0, 1.0, 0.0, load=0.0)
    impulse = 1.0 - rate
    centroid = duration - (duration - p) / impulse

    def impulse_of(load):
        u = 1.0 - load * centroid
        time, _, out = contact.contact(0.0, u, 0.0, load=load)
        return u - out + load * time

    size = 1e-4 * contact.omega
    sensitivity = (impulse_of(size) - impulse_of(-size)) / (2 * size)
    found = Instant(-rate, centroid, sensitivity)
    found.duration = duration
    return found


def rigid(r):
    found = Instant(r)
    found.duration = 0.0
    return found


def threshold(contact):
    """Λ of permanent contact, from the steady oscillation at Λ = 1 without gravity."""
    whole = contact.flow(1.0, 0.0, TURN)
    wave = np.array([0.0, 0.0, 1.0])
    # (p, p′) of the motion that repeats itself.
    first = np.linalg.solve(np.eye(2) - whole[:2, :2], whole[:2, 2:] @ wave)
    state = np.array([*first, *wave])
    step = TURN / 20_000
    once = contact.flow(1.0, 0.0, step)
    least = math.inf
    for _ in range(20_000):
        least = min(least, contact.grip(state))
        state = once @ state
    return 1 / (contact.omega**2 * -least)


def rise(contact, speed):
    """The rise of a ball that falls onto a table at rest."""
    found = contact.contact(0.0, speed, 0.0, longest=1e3)
    return 0.0 if found is None or found[2] >= 0 else found[2] ** 2 / 2 - found[1]


def stiffer(contact, omega):
    return Contact(omega, contact.zeta, contact.pulls)


class Own:
    """All numbers of a design, from m, k, c, the release and the table."""

    def __init__(self, mass, k, c, pulls, frequency, acceleration, n):
        self.mass = mass
        self.omega = TURN * frequency
        self.lam = acceleration / G
        self.n = n
        own = math.sqrt(k / mass)
        self.exact = Contact(own / self.omega, c / (2 * mass * own), pulls)
        self.k = k
        self.c = c
        self.time = 1 / self.omega
        self.length = G / self.omega**2
        self.corrected = seen_from_outside(self.exact)
        self.r = self.corrected.r
        self.rigid = rigid(self.r)
        self.models = {
            "spring-damper": self.exact,
            "restitution": self.rigid,
            "corrected": self.corrected,
        }
        guess = closed(n, self.r, self.lam)
        self.found = {
            name: quantities(model, n, self.lam, guess) for name, model in self.models.items()
        }

        # lim ϖe of the errors of the restitution model, by extrapolation from two stiff contacts.
        one, two = (omega * self.errors(stiffer(self.exact, omega)) for omega in (600.0, 1200.0))
        self.coefficients = 2 * two - one

    def limits(self, name):
        return limits(self.models[name], self.n, *self.found[name][1], self.lam)

    def errors(self, contact):
        """The errors of the restitution model in the four quantities of the orbit."""
        guess = closed(self.n, self.r, self.lam)
        exact, _ = quantities(contact, self.n, self.lam, guess)
        simple, _ = quantities(self.rigid, self.n, self.lam, guess)
        return simple / exact - 1


def near(value, rel=1e-6):
    return pytest.approx(value, rel=rel, abs=1e-9)


def own_rows(own, found):
    """What each listed row should be, by its path."""
    exact, _ = own.found["spring-damper"]
    phase, velocity = own.found["spring-damper"][1]
    speed = own.lam * math.cos(phase) - velocity
    duration, _, _, depth, force = own.exact.contact(phase, speed, own.lam, with_tops=True)
    force = max(force, 0.0)
    free = own.corrected
    slow = found.slowed_speed * own.omega / G
    assert math.sqrt(2 * rise(own.exact, slow)) / slow / own.r == pytest.approx(0.99, abs=1e-6)
    listed = {
        ("frequency_ratio",): near(own.exact.omega),
        ("damping_ratio",): near(own.exact.zeta),
        ("amplitude",): near(own.lam),
        ("stiffness",): near(own.k),
        ("damping",): near(own.c),
        ("contact_time",): near(free.duration * own.time),
        ("time_step", "largest"): near(free.duration * own.time / 50),
        ("static_deflection",): near(own.mass * G / own.k),
        ("measured_restitution",): near(free.r),
        ("slowed_speed",): near(found.slowed_speed),
        ("permanent_contact",): near(threshold(own.exact), 1e-6),
    }
    judged = {
        ("max_height",): near(exact[0] * own.length),
        ("impact_speed",): near(speed * own.length * own.omega),
        ("contact_duration",): near(duration * own.time),
        ("greatest_compression",): near(depth * own.length),
        ("peak_force",): near(force * own.mass * G),
        ("peak_force_over_weight",): near(force),
    }
    return listed, judged


def compare(result, own, seen):
    """All listed rows of a result against their own numbers."""
    for row in rows.rows(result):
        if row.words and row.key[0] not in ("orbits", "needed", "motion"):
            assert row.value == own[row.key], row
            seen.append(row.key)


# ϖ of a contact whose errors of second order are below the tolerances.
STIFF = 1e5

DESIGNS = [
    {"mass": 0.5, "stiffness": 1e6, "restitution": 0.75, "frequency": 20, "acceleration": 0.8},
    {"mass": 0.5, "stiffness": 5e4, "restitution": 0.75, "release": "force", "frequency": 20,
     "acceleration": 0.8},
    {"mass": 0.5, "stiffness": 5e4, "restitution": 0.9, "frequency": 20, "n": 2,
     "acceleration": 0.8},
    {"mass": 0.02, "stiffness": 1e7, "restitution": 0.85, "frequency": 50, "acceleration": 0.8},
    {"mass": 0.02, "contact_time": 1e-3, "restitution": 0.65, "frequency": 50, "acceleration": 0.9},
    {"mass": 0.05, "stiffness": 1e6, "restitution": 0.8, "frequency": 25, "acceleration": 0.9},
    {"mass": 0.1, "stiffness": 2e5, "damping": 20.0, "frequency": 40, "acceleration": 1.0},
    {"mass": 1.0, "stiffness": 3e5, "damping_ratio": 0.05, "release": "force", "frequency": 15,
     "acceleration": 0.7},
    {"mass": 0.004, "stiffness": 2e5, "restitution": 0.6, "frequency": 100, "acceleration": 1.0},
    {"mass": 2.0, "stiffness": 1e5, "restitution": 0.85, "frequency": 8, "n": 3,
     "acceleration": 0.95},
    {"mass": 0.3, "stiffness": 4e5, "restitution": 0.7, "release": "force", "frequency": 30,
     "acceleration": 1.1},
    {"mass": 0.5, "stiffness": 1e6, "measured_restitution": 0.75, "frequency": 20,
     "acceleration": 0.8, "release": "force"},
    {"mass": 0.5, "stiffness": 2e5, "measured_restitution": 0.8, "frequency": 20,
     "acceleration": 0.9},
    {"mass": 0.2, "stiffness": 8e4, "restitution": 0.55, "frequency": 25, "acceleration": 1.2},
    {"mass": 0.2, "stiffness": 8e4, "restitution": 0.95, "release": "force", "frequency": 25,
     "acceleration": 0.5},
]  # fmt: skip


@pytest.mark.long
@pytest.mark.usefixtures("short_runs")
@pytest.mark.parametrize("given", DESIGNS)
def test_every_listed_number(given):
    asked = {"n": 1} | given | {"acceleration": f"{given['acceleration']} g"}
    answer = answered(**asked)
    found = answer.found
    pulls = str(found.case.equivalent.release) == "displacement"
    own = Own(
        mass=asked["mass"],
        k=found.stiffness,
        c=found.damping,
        pulls=pulls,
        frequency=asked["frequency"],
        acceleration=given["acceleration"] * G,
        n=asked["n"],
    )
    # The loss that was asked for: of a free impact, or r of the release at δ = 0 (Eq. 16).
    if "damping" in given:
        assert found.damping == given["damping"]
    elif "damping_ratio" in given:
        assert found.damping_ratio == pytest.approx(given["damping_ratio"], rel=1e-12)
    else:
        is_own = "measured_restitution" in given
        meant = own.r if is_own else found.restitution["displacement"]
        assert meant == near(given["measured_restitution" if is_own else "restitution"])
    listed, judged = own_rows(own, found)
    seen = []
    one = found.judged
    for release, r in found.restitution.items():
        contact = Contact(own.exact.omega, own.exact.zeta, release == "displacement")
        assert r == near(seen_from_outside(contact).r)
    free = own.corrected
    assert found.corrected.delay == near(free.delay * own.time)
    assert found.corrected.restitution == near(free.r)
    assert found.corrected.load == near(free.load * own.time, 1e-5)
    compare(found, listed, seen)
    compare(one, judged, seen)
    assert len(seen) == len(listed) + len(judged)
    of_orbit = ("max_height", "bounce_velocity", "phase", "apparent_restitution")
    exact, simple, corrected = (own.found[name][0] for name in own.models)
    nodes = {}
    for name in own.models:
        standing = one.standing[name]
        node, doubling = nodes[name] = own.limits(name)
        trace, determinant = trace_and_determinant(own.models[name], *own.found[name][1], own.lam)
        stable = abs(trace) < 1 + determinant and determinant < 1
        assert (standing.exists, standing.is_stable) == (True, stable)
        assert standing.saddle_node == near(node, 1e-6)
        assert standing.saddle_node_margin == pytest.approx(1 - node / own.lam, abs=1e-6)
        assert standing.period_doubling == near(doubling, 1e-5)
        assert standing.period_doubling_margin == pytest.approx(doubling / own.lam - 1, abs=2e-5)
    exact_limits, simple_limits, corrected_limits = (np.array(nodes[name]) for name in own.models)
    own_errors = [*(simple / exact - 1), *(simple_limits / exact_limits - 1)]
    own_corrected = [*(corrected / exact - 1), *(corrected_limits / exact_limits - 1)]
    names = [*of_orbit, "saddle_node", "period_doubling"]
    for name, error, better in zip(names, own_errors, own_corrected, strict=True):
        assert one.errors[name] == pytest.approx(error, abs=2e-5), name
        assert one.corrected_errors[name] == pytest.approx(better, abs=2e-5), name
    for model in ("errors", "corrected_errors"):
        error = getattr(one, model)["permanent_contact"]
        assert error == pytest.approx(1 / threshold(own.exact) - 1, abs=1e-6)
    # On a stiff contact the error law has the limits of ϖe. To first order the instant is the
    # contact, so that those of the bifurcations are the limits for an instant with a small delay
    # and load.
    factor = STIFF / own.exact.omega
    stiff = answered(
        **{name: asked[name] for name in ("mass", "frequency", "acceleration", "n")},
        stiffness=own.k * factor**2,
        damping_ratio=own.exact.zeta,
        release="displacement" if pulls else "force",
    ).found.judged.law_errors
    for name, limit in zip(of_orbit, own.coefficients, strict=True):
        assert stiff[name] * STIFF == pytest.approx(limit, rel=2e-3, abs=2e-3), name
    small = []
    for part in (0.02, 0.01):
        weak = Instant(own.r, part * own.corrected.delay, part * own.corrected.load)
        ends = limits(weak, own.n, *own.found["restitution"][1], own.lam)
        small.append((simple_limits / np.array(ends) - 1) / part)
    for name, limit in zip(names[4:], 2 * small[1] - small[0], strict=True):
        assert stiff[name] * factor == pytest.approx(limit, rel=5e-3, abs=2e-5), name
    # That of the permanent contact is of the second order.
    limit = (1 / threshold(stiffer(own.exact, 100.0)) - 1) * 100.0**2
    assert stiff["permanent_contact"] * STIFF**2 == pytest.approx(limit, rel=2e-3)
    needs(own, found.needed)


def needs(own, need):
    """The ϖ from which on the error of the height stays within 1 %."""
    height = 0
    # The error law differs from the first order by about as much as the error itself, 1 %.
    assert abs(own.coefficients[height]) / 0.01 == pytest.approx(need.by_law, rel=0.02)
    if need.frequency_ratio is not None:
        at = own.errors(stiffer(own.exact, need.frequency_ratio))[height]
        assert abs(at) == pytest.approx(0.01, rel=1e-5)
        for factor in (1.2, 3.0, 10.0):
            there = own.errors(stiffer(own.exact, factor * need.frequency_ratio))[height]
            assert abs(there) < 0.01
    if need.corrected is not None:
        contact = stiffer(own.exact, need.corrected)
        guess = closed(own.n, own.r, own.lam)
        true, _ = quantities(contact, own.n, own.lam, guess)
        simple, _ = quantities(seen_from_outside(contact), own.n, own.lam, guess)
        assert abs(simple[height] / true[height] - 1) == pytest.approx(0.01, rel=1e-4)


STARTED = [DESIGNS[k] for k in (0, 3, 8, 13)]


@pytest.mark.long
@pytest.mark.parametrize("given", STARTED)
def test_the_shares_of_the_starts(given):
    """The 144 balls are followed one by one until they stay in contact or repeat themselves."""
    found = answered(**given | {"acceleration": f"{given['acceleration']} g"}).found
    model = Contact(found.frequency_ratio, found.damping_ratio, True)
    lam = given["acceleration"]
    middle = (np.arange(12) + 0.5) / 12
    fast = float(fastest(found.case.models["spring-damper"], lam))
    ends = Counter()
    for phase in TURN * middle - math.pi:
        for speed in fast * middle:
            ends[end(model, phase, lam * math.cos(phase) - speed, lam)] += 1 / 144
    assert dict(ends) == pytest.approx(found.starts, abs=1e-9)


def end(model, phase, velocity, lam):
    """The motion on which a ball ends, with the periods and the impacts after which it repeats."""
    impacts = []
    for _ in range(300):
        speed = lam * math.cos(phase) - velocity
        # A contact of three periods is one that stays, because its transient has decayed.
        found = model.contact(phase, speed, lam, longest=3 * TURN)
        if found is None:
            return "permanent contact"
        for k, (before, arrived) in enumerate(reversed(impacts[-4:]), start=1):
            turns = (phase - before) / TURN
            if abs(arrived - velocity) < 1e-5 and abs(turns - round(turns)) < 1e-6:
                # A ball that sticks oscillates more than once in a contact.
                sticks = found[0] * model.omega * math.sqrt(1 - model.zeta**2) > TURN
                kind = "locked" if sticks else "orbit" if k == 1 else "subharmonic"
                return f"{kind} {round(turns)}/{k}"
            if abs(arrived - velocity) < 1e-2:
                # It may repeat after these impacts, and has not come close enough.
                break
        impacts.append((phase, velocity))
        phase, velocity = following(model, phase, velocity, lam)
    return "no end"

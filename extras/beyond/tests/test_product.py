"""Every question about a ball and a table, asked of each kind of ball on each kind of table.

A question computes its answer by the package, and judges it by `integrated`, which shares nothing
with the package. Questions that are refused are listed in docs/api.md, which this test reads.
"""

import re
from functools import cached_property
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import pytest
from integrated import (
    around,
    flight,
    free_impact,
    heights,
    instant,
    leg,
    touching,
    waveform,
    weakest_grip,
)
from scipy.optimize import brentq

import bouncing_ball_beyond as bb
from bouncing_ball_beyond.tables.table import SINE

CLOSE = 1e-7
"""Largest difference from the integrator.

The integrator's own errors are 1e-12. The difference that gives σ of a corrected ball is 1e-8.
"""

NEAR = 1e-5
"""Largest residual of a condition on multipliers. They are central differences of motions with the
step 1e-4, whose error is of the order of its square."""

PERIOD = 2 * np.pi


def bumper(p, v, stiffness, hardening, damping):
    return stiffness * p * (1 + hardening * p) * (1 + damping * v)


def pulling(p, v, stiffness, damping):
    return stiffness * p + damping * v


def quadratic(p, v, stiffness, damping):
    return stiffness * p * p * (1 + damping * v)


class Kind:
    """A ball, a parameter to follow, and the exponents of its parameters if all lengths and times
    are stretched, and if the frequency of the table changes (from f = F/mg and p = Ω²x/g)."""

    def __init__(self, ball, along, stretched, faster):
        self.ball, self.along, self.stretched, self.faster = ball, along, stretched, faster


SPRING = bb.SpringDamper(20.0, 0.6)
OWN = bb.ForceLaw(
    bumper,
    {"stiffness": 400.0, "hardening": 0.2, "damping": 0.25},
    units={"stiffness": (0, 0, -2), "hardening": (0, -1, 0), "damping": (0, -1, 1)},
)
PULLING = bb.ForceLaw(
    pulling,
    {"stiffness": 400.0, "damping": 8.0},
    release="force",
    units={"stiffness": (0, 0, -2), "damping": (0, 0, -1)},
)
QUADRATIC = bb.ForceLaw(
    quadratic,
    {"stiffness": 3000.0, "damping": 0.25},
    release="force",
    units={"stiffness": (0, -1, -2), "damping": (0, -1, 1)},
)
KINDS = {
    "Rigid": Kind(bb.Rigid(0.6), "restitution", {}, {}),
    "SpringDamper": Kind(
        SPRING, "frequency_ratio", {"frequency_ratio": -1}, {"frequency_ratio": -1}
    ),
    "Corrected": Kind(
        bb.Corrected(SPRING),
        "frequency_ratio",
        {"frequency_ratio": -1},
        {"frequency_ratio": -1},
    ),
    "named law": Kind(
        bb.hunt_crossley(3000.0, 0.25),
        "damping",
        {"stiffness": -2.5},
        {"stiffness": -3, "damping": -1},
    ),
    "own law": Kind(
        OWN,
        "damping",
        {"stiffness": -2, "hardening": -1},
        {"stiffness": -2, "hardening": -2, "damping": -1},
    ),
    'own law with release="force"': Kind(
        PULLING, "damping", {"stiffness": -2, "damping": -1}, {"stiffness": -2, "damping": -1}
    ),
    'own law that begins as p², with release="force"': Kind(
        QUADRATIC, "damping", {"stiffness": -3}, {"stiffness": -4, "damping": -1}
    ),
}

EIGHTHS = PERIOD * np.arange(8) / 8
TABLES = {
    "sine": (SINE, 1.1),
    "two tones": (bb.Table([(1, 1.0, 0.0), (2, 0.08, 0.8)]), 1.0),
    "samples": (bb.Table.of_samples(np.sin(EIGHTHS) + 0.04 * np.sin(2 * EIGHTHS + 1.2)), 1.2),
}
"""Tables with an amplitude at which all balls have a stable 1-T orbit."""


class Pair:
    """A ball on a table, with what several questions start from."""

    def __init__(self, ball, table):
        self.kind, self.place = KINDS[ball], table
        self.ball = self.kind.ball
        self.table, self.amplitude = TABLES[table]
        self.harmonics = tuple(self.table.harmonics)
        self.given = {"amplitude": self.amplitude, "table": self.table}
        # A ball that is thrown down at the phase 1.
        self.thrown = self.given | {"phase": 1.0, "velocity": -np.pi}

    def height(self, tau, order=0):
        return self.amplitude * waveform(self.harmonics, tau, order)

    def leg(self, tau, u):
        return np.array(leg(self.ball, self.amplitude, tau, u, self.harmonics)[:2])

    def flight(self, leaves, gap, speed):
        """The first impact after a release."""
        centroid = 0.0 if self.ball.has_duration else instant(self.ball, 0.0, 0.0, 1.0)[2]
        return flight(self.amplitude, leaves, gap, speed, self.harmonics, centroid)

    @cached_property
    def orbit(self):
        return bb.orbit(self.ball, **self.given)

    @cached_property
    def multiplied(self):
        return trace_and_determinant(self.orbit)

    @cached_property
    def limits(self):
        return bb.limits(self.ball, table=self.table)

    @cached_property
    def wide_limits(self):
        return bb.limits(self.ball, n=2, table=self.table)

    @cached_property
    def cascade(self):
        doubling = self.limits.period_doubling
        return bb.cascade(doubling, to=1.01 * doubling.amplitude, impacts=2)[0]

    @cached_property
    def grazing(self):
        unstable = bb.orbit(self.ball, side="unstable", **self.given)
        return bb.follow(unstable, to=3.5).first("grazing of a flight")

    @cached_property
    def motion(self):
        """Times and closing speeds of the thrown ball, by the integrator."""
        impacts = [np.array([1.0, self.height(1.0, 1) + np.pi])]
        for _ in range(10):
            impacts.append(self.leg(*impacts[-1]))
        return np.array(impacts)

    def free(self, speed):
        """r, D, t_c and σ of a free impact."""
        if self.ball.has_duration:
            return free_impact(self.ball, speed)
        if isinstance(self.ball, bb.Rigid):
            return self.ball.restitution, 0.0, 0.0, 0.0
        return free_impact(self.ball.of, speed)

    def bounced(self, speed):
        """The speed after a free impact."""
        if not self.ball.has_duration:
            return self.free(speed)[0] * speed
        return touching(self.ball, 0.0, 0.0, speed, gravity=0.0)[2]

    @cached_property
    def simple(self):
        """The orbit of the restitution model: speed, r, phase after the steepest rise, height."""
        speed = brentq(lambda v: v + self.bounced(v) - PERIOD, np.pi, PERIOD, xtol=1e-9)
        r = self.free(speed)[0]
        tau = np.linspace(-np.pi, np.pi, 4001)
        steepest = tau[self.height(tau, 1).argmax()]
        line = np.pi * (1 - r) / (1 + r)
        phase = brentq(lambda t: self.height(t, 1) - line, steepest, steepest + np.pi / 2)
        steepest = brentq(lambda t: self.height(t, 2), steepest - 0.1, steepest + 0.1)
        return speed, r, phase - steepest, self.height(phase) + np.pi**2 / 2

    @cached_property
    def ratio(self):
        """ϖ, or the number that replaces it: π/(D + κ)."""
        if isinstance(self.ball, bb.SpringDamper):
            return self.ball.frequency_ratio
        duration, gap, w, _ = touching(self.ball, 0.0, 0.0, self.simple[0], gravity=0.0)
        return np.pi / (duration - gap / w)

    def stretched(self, factor):
        """The ball, with all lengths and times longer by a factor."""
        own, powers = self.ball.parameters, self.kind.stretched
        return self.ball.at(**{name: own[name] * factor ** powers[name] for name in powers})


PAIRS = {(ball, table): Pair(ball, table) for ball in KINDS for table in TABLES}


# Truths


def assert_close(actual, expected, tolerance=CLOSE):
    np.testing.assert_allclose(np.ravel(actual), np.ravel(expected), 0, tolerance)


def closes(orbit):
    """The integrated ball is back after the periods of the orbit, and was as high."""
    back, highest = around(orbit)
    assert_close([*back, highest], [orbit.times[0], orbit.speeds[0], orbit.max_height])


def trace_and_determinant(orbit):
    """Of the derivative of the integrated motion."""
    step = 1e-4
    by = [
        (around(orbit, sign)[0] - around(orbit, -sign)[0]) / (2 * step) for sign in step * np.eye(2)
    ]
    return np.trace(by), np.linalg.det(by)


def is_special(orbit, multiplier):
    closes(orbit)
    trace, determinant = trace_and_determinant(orbit)
    assert_close(1 - multiplier * trace + determinant, 0.0, NEAR)


def ends_close(branch, low, high):
    """The first and the last orbit of a branch are orbits, at the ends of a range."""
    first, *_, last = branch.orbits
    assert_close(sorted([branch.values[0], branch.values[-1]]), [low, high], 1e-9 * high)
    closes(first)
    closes(last)
    return last


# Questions

QUESTIONS = {}


def question(function):
    QUESTIONS[function.__name__] = function
    return function


@question
def signature(pair):
    signature = np.array(np.broadcast_arrays(*pair.ball.signature(3.0)))
    assert_close(signature, pair.free(3.0))


@question
def contact(pair):
    """The first release after an impact of a table that moves."""
    given = {"amplitude": pair.amplitude, "table": pair.table}
    T = pair.ball.first_release(1.0, 2.5, **given)
    impact = pair.ball.contact(1.0, 2.5, T, **given)
    if pair.ball.has_duration:
        end, *state, _ = touching(pair.ball, pair.amplitude, 1.0, 2.5, pair.harmonics)
    else:
        end, state = 1.0, instant(pair.ball, pair.amplitude, 1.0, 2.5, pair.harmonics)[:2]
    assert_close([1.0 + impact.duration, impact.gap, impact.speed], [end, *state])


@question
def orbit(pair):
    closes(pair.orbit)
    trace, determinant = pair.multiplied
    assert_close(pair.orbit.trace_and_determinant, (trace, determinant), NEAR)
    assert pair.orbit.stable == (abs(trace) < 1 + determinant)
    unstable = bb.orbit(pair.ball, side="unstable", **pair.given)
    closes(unstable)
    trace, determinant = trace_and_determinant(unstable)
    assert trace > 1 + determinant and not unstable.stable


@question
def orbits(pair):
    """The restitution model has two orbits: its W′ is large enough once in a period."""
    orbits = bb.orbits(pair.ball, **pair.given)
    # A soft contact has a further orbit, on which the ball lies on the table for most of a period.
    short = [orbit for orbit in orbits if orbit.contact_duration < np.pi]
    assert sorted(orbit.stable for orbit in short) == [False, True]
    for orbit in orbits:
        closes(orbit)


@question
def orbit_over_two_periods(pair):
    amplitude = np.mean([limit.amplitude for limit in pair.wide_limits])
    orbit = bb.orbit(pair.ball, n=2, amplitude=amplitude, table=pair.table)
    assert orbit.periods == 2 and orbit.stable
    closes(orbit)


@question
def limits(pair):
    is_special(pair.limits.saddle_node, 1)
    is_special(pair.limits.period_doubling, -1)
    assert pair.limits.saddle_node.amplitude < pair.amplitude
    assert pair.amplitude < pair.limits.period_doubling.amplitude


@question
def limits_over_two_periods(pair):
    is_special(pair.wide_limits.saddle_node, 1)
    is_special(pair.wide_limits.period_doubling, -1)


@question
def follow(pair):
    low, high = 0.98 * pair.amplitude, 1.02 * pair.amplitude
    ends_close(bb.follow(pair.orbit, to=(low, high)), low, high)
    node = pair.limits.saddle_node
    last = bb.follow(node, to=1.02 * node.amplitude).orbits[-1]
    assert last.stable
    closes(last)


@question
def follow_along_a_parameter(pair):
    name = pair.kind.along
    value = pair.orbit.parameters[name]
    branch = bb.follow(pair.orbit, along=name, to=(0.97 * value, 1.03 * value))
    last = ends_close(branch, 0.97 * value, 1.03 * value)
    assert_close(last.parameters[name], 1.03 * value)


@question
def follow_along_a_harmonic(pair):
    value = pair.table.parameters.get("harmonic_2", 0.0)
    branch = bb.follow(pair.orbit, along="harmonic_2", to=(0.9 * value, 1.1 * value))
    ends_close(branch, 0.9 * value, 1.1 * value)


@question
def follow_along_the_frequency(pair):
    start = np.sqrt(pair.amplitude)
    last = ends_close(
        bb.follow(pair.orbit, along="frequency", to=(start, 1.02 * start)), start, 1.02 * start
    )
    assert_close(last.amplitude, 1.02**2 * pair.amplitude)
    for name, power in pair.kind.faster.items():
        expected = pair.orbit.parameters[name] * 1.02**power
        assert_close(last.parameters[name] / expected, 1.0)


@question
def many_balls(pair):
    """Parameters that are arrays."""
    value = pair.orbit.parameters[pair.kind.along]
    row = pair.ball.at(**{pair.kind.along: np.array([value, 1.03 * value])})
    for branch in bb.follow(bb.orbit(row, **pair.given), to=1.02 * pair.amplitude):
        closes(branch.orbits[-1])


@question
def cascade(pair):
    closes(pair.cascade.orbits[-1])
    assert pair.cascade.impacts == 2
    back = around(pair.limits.period_doubling)[0]
    assert_close(
        back, [pair.limits.period_doubling.times[0], pair.limits.period_doubling.speeds[0]]
    )


@question
def special_curve(pair):
    name = pair.kind.along
    value = pair.orbit.parameters[name]
    ranges = {name: (0.97 * value, 1.03 * value)}
    along = ("amplitude", name)
    curve = bb.special_curve(pair.limits.period_doubling, along=along, ranges=ranges)
    is_special(curve.orbits[-1], -1)
    ends = [orbit.parameters[name] for orbit in (curve.orbits[0], curve.orbits[-1])]
    assert_close(sorted(ends), ranges[name])


@question
def normal_form(pair):
    """On doubled orbits ξ² = rate dΛ/b, and their impacts are 2|ξ| apart."""
    form = bb.normal_form(pair.limits.period_doubling)
    change = 1e-4 * pair.amplitude
    doubling = pair.limits.period_doubling
    orbit = bb.follow(doubling, to=doubling.amplitude + change).orbits[-1]
    closes(orbit)
    (one, other), (u, v) = orbit.times % PERIOD, orbit.speeds
    apart = np.hypot((one - other + np.pi) % PERIOD - np.pi, u - v)
    assert form.opens_upwards and form.supercritical
    assert_close(form.rate * change / form.coefficient / (apart / 2) ** 2, 1.0, 0.02)


@question
def grazing_form(pair):
    """The integrated flight touches the table at the phase of the form."""
    at = pair.grazing
    form = bb.grazing_form(at)
    amplitude = at.amplitude
    leaves, gap, speed = at.times[0], 0.0, at.relative_bounce_velocity
    if pair.ball.has_duration:
        leaves, gap, speed, _ = touching(pair.ball, amplitude, *at.z[:2], pair.harmonics)
    time = (form.phase - leaves) % PERIOD

    def height(t, order=0):
        return amplitude * waveform(pair.harmonics, t, order)

    height_there = gap + height(leaves) + (speed + height(leaves, 1)) * time - time**2 / 2
    assert_close(height_there - height(leaves + time), 0.0, 1e-6)
    bend = -1 - height(form.phase, 2)
    assert_close(form.acceleration, bend, 1e-6)
    r = -1 if pair.ball.has_duration else pair.ball.restitution
    assert_close(form.coefficient, (1 + r) * np.sqrt(2 * bend), 1e-6)


@question
def follow_a_grazing(pair):
    """The orbits with one impact more are on the side that the form has."""
    at = pair.grazing
    upwards = bb.grazing_form(at).opens_upwards
    to = at.amplitude * (1.002 if upwards else 0.998)
    orbit = bb.follow(at, to=to, points=30).orbits[-1]
    assert orbit.impacts == 2
    closes(orbit)


@question
def simulate(pair):
    impacts = bb.simulate(pair.ball, impacts=8, **pair.thrown)
    assert_close(impacts.time + 1.0, pair.motion[:8, 0])
    assert_close(-impacts.relative_impact_velocity, pair.motion[:8, 1])


@question
def history(pair):
    history = bb.history(pair.ball, periods=2.0, samples=9, **pair.thrown)
    start = pair.ball, pair.amplitude, *pair.motion[0]
    assert_close(history.ball, heights(*start, 1.0 + history.time.values, pair.harmonics))


@question
def drop(pair):
    given = {"height": 6.0, "phase": 1.0, "periods": 1.0, "samples": 19}
    history = bb.drop(pair.ball, **given, **pair.given)
    tau, u, _ = pair.flight(1.0, 6.0 - pair.height(1.0), -pair.height(1.0, 1))
    times = 1.0 + history.time.values
    expected = 6.0 - (times - 1.0) ** 2 / 2
    later = times >= tau
    start = pair.ball, pair.amplitude, tau, u
    expected[later] = heights(*start, times[later], pair.harmonics)
    assert_close(history.ball, expected)


def on_its_orbit(pair, phase, velocity, start):
    """An impact at the end of a motion repeats, and the integrated ball comes near to it."""
    u = pair.height(phase, 1) - velocity
    assert_close(pair.leg(phase, u), [phase + PERIOD, u], NEAR)
    assert_close(start[1], u, 0.05)
    assert_close((start[0] - phase + np.pi) % PERIOD - np.pi, 0.0, 0.05)


@question
def motion_of(pair):
    motion = bb.motion_of(pair.ball, **pair.thrown)
    assert (motion.kind, motion.impacts, motion.periods) == ("periodic", 1, 1)
    on_its_orbit(pair, float(motion.end_phase), float(motion.end_velocity), pair.motion[-1])


@question
def permanent_contact(pair):
    """The table never falls faster than a ball."""
    weak = pair.thrown | {"amplitude": 0.3}
    assert bb.motion_of(pair.ball, **weak).kind == "permanent contact"


@question
def threshold_of_permanent_contact(pair):
    """The weakest grip of the steady motion is zero."""
    threshold = bb.permanent_contact(pair.ball, table=pair.table)
    if pair.ball.has_duration:
        assert_close(weakest_grip(pair.ball, threshold, pair.harmonics), 0.0)
    else:
        tau = np.linspace(0, PERIOD, 20_001)
        assert_close(threshold * waveform(pair.harmonics, tau, 2).min(), -1.0)


@question
def basins(pair):
    speed = pair.motion[0, 1]
    basins = bb.basins(pair.ball, starts=1, relative_velocity_max=2 * speed, **pair.given)
    assert basins.kind.values.tolist() == ["periodic"] and basins.share.item() == 1.0
    state = np.array([0.0, speed])
    for _ in range(10):
        state = pair.leg(*state)
    on_its_orbit(pair, float(basins.end_phase[0]), float(basins.end_velocity[0]), state)


@question
def orbit_diagram(pair):
    """The second impact that is recorded follows the first, unless the ball rests in between."""
    amplitude = np.array([pair.amplitude])
    given = {"starts": 1, "samples": 2, "impacts": 25, "table": pair.table}
    diagram = bb.orbit_diagram(pair.ball, amplitude=amplitude, **given).isel(amplitude=0)
    ends = zip(
        diagram.kind.values, diagram.impact_phase.values, diagram.impact_speed.values, strict=True
    )
    for kind, phase, speed in ends:
        if kind == "permanent contact":
            assert np.isnan(phase).all()
        elif kind != "locked" and speed.min() > 0.3:
            tau, u = pair.leg(phase[0], speed[0])
            assert_close([np.sin(tau - phase[1]), u - speed[1]], [0.0, 0.0], NEAR)


@question
def lyapunov(pair):
    motion = bb.lyapunov(pair.ball, **pair.thrown)
    trace, determinant = pair.multiplied
    largest = abs(np.roots([1.0, -trace, determinant])).max()
    assert_close(motion.lyapunov_exponent, np.log(largest), 1e-4)
    assert_close(motion.exponent_sum, np.log(determinant), 1e-4)


# The error of a restitution coefficient


@question
def free_impact_of_an_orbit(pair):
    impact = bb.free_impact(pair.ball)
    assert_close(impact.speed, pair.simple[0])
    values = np.ravel([impact.restitution, impact.duration, impact.centroid, impact.load])
    assert_close(values, pair.free(pair.simple[0]))


@question
def contact_values(pair):
    values = bb.contact_values(pair.ball, **pair.given)
    state = pair.orbit.times[0], pair.orbit.speeds[0]
    _, closing, highest = leg(pair.ball, pair.amplitude, *state, pair.harmonics)
    assert_close(closing, state[1])
    assert_close(values["max_height"], highest)
    assert_close(values["saddle_node"], pair.limits.saddle_node.amplitude)
    assert_close(values["period_doubling"], pair.limits.period_doubling.amplitude)
    if pair.ball.has_duration:
        leaves, _, speed, _ = touching(pair.ball, pair.amplitude, *state, pair.harmonics)
        assert_close(values["bounce_velocity"], speed + pair.height(leaves, 1))
        assert_close(values["apparent_restitution"], speed / state[1])


@question
def exact_errors(pair):
    names = ["max_height", "bounce_velocity", "phase"]
    errors = bb.exact_errors(pair.ball, quantities=names, **pair.given)
    values = bb.contact_values(pair.ball, quantities=names, **pair.given)
    _, _, phase, height = pair.simple
    assert_close(errors["max_height"], pair.orbit.max_height / height - 1)
    assert_close(errors["bounce_velocity"], values["bounce_velocity"] / np.pi - 1)
    assert_close(errors["phase"], (values["phase"] - phase) / (2 * np.pi))


@question
def law_errors(pair):
    """What the law leaves is of second order: 1/64 of the duration leaves about 1/4096."""
    left = []
    for ball in (pair.ball, pair.stretched(1 / 64)):
        law = bb.law_errors(ball, **pair.given)
        exact = bb.exact_errors(ball, **pair.given)
        left.append(np.array([law[name] - exact[name] for name in law]))
    assert np.abs(left[0]).max() < 0.1
    assert np.all(np.abs(left[1]) < np.abs(left[0]).max() / 1000 + 1e-9)


@question
def law_coefficients(pair):
    _, duration, centroid, _ = pair.free(pair.simple[0])
    coefficient = bb.law_coefficients(pair.ball, **pair.given)["bounce_velocity"]
    assert_close(coefficient, -(duration - centroid) / np.pi)


@question
def law_thresholds(pair):
    threshold = bb.law_thresholds(pair.ball, **pair.given)["bounce_velocity"]
    _, duration, centroid, _ = pair.free(pair.simple[0])
    assert_close(threshold * 0.01, pair.ratio * (duration - centroid) / np.pi, 1e-6)


@question
def error_thresholds(pair):
    """The ball of this ratio has an orbit whose height differs by the tolerance."""
    given = {"quantities": ["max_height"], "low": 5.0, "high": 2e3, "samples": 7}
    threshold = bb.error_thresholds(pair.ball, **given, **pair.given)["max_height"]
    assert threshold.status == "found"
    ball = pair.stretched(pair.ratio / float(threshold.ratio))
    one = bb.orbit(ball, **pair.given)
    closes(one)
    assert_close(abs(one.max_height / pair.simple[3] - 1), 0.01, 1e-6)


# Data and pictures


@question
def to_dataset(pair):
    data = bb.to_dataset(pair.orbit).isel(point=0)
    _, _, highest = leg(pair.ball, pair.amplitude, *pair.orbit.z[:2], pair.harmonics)
    assert_close(data["max_height"], highest)
    trace, determinant = pair.multiplied
    multipliers = data["multiplier_real"].values + 1j * data["multiplier_imag"].values
    assert_close(np.abs(multipliers.sum() - trace), 0.0, NEAR)
    assert_close(np.abs(multipliers.prod() - determinant), 0.0, NEAR)


@question
def special_curve_over_the_tables_second_harmonic(pair):
    """A saddle-node that is followed along two parameters is one."""
    ranges = {"amplitude": (0.2, 3.0), "harmonic_2": (0.0, 0.1)}
    along = ("amplitude", "harmonic_2")
    curve = bb.special_curve(pair.limits.saddle_node, along=along, ranges=ranges, points=4)
    is_special(curve.orbits[-1], 1)


@question
def plot(pair):
    plt.switch_backend("agg")
    branch = bb.follow(pair.orbit, to=1.02 * pair.amplitude)
    figure = bb.plot(branch, quantity="max_height")
    last = branch.orbits[-1]
    closes(last)
    drawn = np.concatenate([line.get_xydata() for line in figure.axes[0].lines])
    plt.close(figure)
    assert np.abs(drawn - [last.amplitude, last.max_height]).max(axis=1).min() < CLOSE


# The list of refusals


def refusals():
    """Messages by question, ball and table, from the table of docs/api.md."""
    page = Path(__file__).parents[1] / "docs" / "api.md"
    text = page.read_text(encoding="utf-8").replace("`", "")
    messages = {}
    for row in re.findall(r"^\| (\w.*) \|$", text, re.MULTILINE)[1:]:
        names, balls, tables, message = row.split(" | ")
        for name in names.replace(" ", "_").split(",_"):
            for ball in KINDS if balls == "all" else balls.split(", "):
                for table in TABLES if tables == "all" else tables.split(", "):
                    messages[name, ball, table] = message
    return messages


REFUSED = refusals()


@pytest.mark.parametrize("table", TABLES)
@pytest.mark.parametrize("ball", KINDS)
@pytest.mark.parametrize("name", QUESTIONS)
def test_an_answer_that_is_right_or_a_refusal_that_is_listed(name, ball, table):
    pair = PAIRS[ball, table]
    if message := REFUSED.get((name, ball, table)):
        with pytest.raises(ValueError, match=re.escape(message)):
            QUESTIONS[name](pair)
    else:
        QUESTIONS[name](pair)


def test_every_refusal_is_of_a_question():
    every = {(name, ball, table) for name in QUESTIONS for ball in KINDS for table in TABLES}
    assert REFUSED.keys() <= every

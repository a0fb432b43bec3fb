"""The contract of every contact law: its release, energy, derivatives, and simulation.

A new law is one more line of :data:`LAWS`. The spring-damper as a law without a closed form
(:class:`Spring`) is compared with the closed form everywhere.
"""

import runpy
from dataclasses import dataclass
from pathlib import Path
from typing import ClassVar

import numpy as np
import pytest
import xarray as xr
from loaded_laws import Sharing
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from bouncing_ball_beyond.inherited.errors import ModelError
from bouncing_ball_beyond.inherited.models.model import Status
from bouncing_ball_beyond.models.damping import LINEAR, Release
from bouncing_ball_beyond.models.history import motion_at
from bouncing_ball_beyond.models.laws.collocation import contacts, path
from bouncing_ball_beyond.models.laws.contact_law import ContactLaw
from bouncing_ball_beyond.models.laws.elasto_backlash import ElastoBacklash
from bouncing_ball_beyond.models.laws.force_law import Unit
from bouncing_ball_beyond.models.laws.hertzian import (
    Hertz,
    HuntCrossley,
    KuwabaraKono,
    LinearHuntCrossley,
    Tsuji,
)
from bouncing_ball_beyond.models.laws.law_of_impact import law_of_impact
from bouncing_ball_beyond.models.laws.loaded import under
from bouncing_ball_beyond.models.laws.scales import rest
from bouncing_ball_beyond.models.laws.signature import Signature
from bouncing_ball_beyond.models.laws.start_speed import Flores, LankaraniNikravesh
from bouncing_ball_beyond.models.laws.steady_contact import permanent_contact
from bouncing_ball_beyond.models.laws.stepped import (
    AdamsImpact,
    LinearAdamsImpact,
    SimscapeContact,
)
from bouncing_ball_beyond.models.named_laws import LAWS as NAMED
from bouncing_ball_beyond.models.named_laws import by_name
from bouncing_ball_beyond.models.permanent_contact import permanent_contact_threshold
from bouncing_ball_beyond.models.spring_damper import SpringDamper


@dataclass(frozen=True, repr=False)
class Spring(ContactLaw):
    """The spring-damper as a law with nothing but its force and its release."""

    frequency_ratio: float | np.ndarray
    damping_ratio: float | np.ndarray
    release: Release = Release.DISPLACEMENT

    name: ClassVar[str] = "spring"
    root: ClassVar[int] = 1

    def force(self, penetration, rate):
        """ϖ² p + 2ζϖ p′."""
        omega = self.frequency_ratio
        return omega**2 * penetration + 2 * self.damping_ratio * omega * rate


LAWS = {
    "linear": Spring(10.0, 0.136),
    "linear, force release": Spring(10.0, 0.136, Release.FORCE),
    "undamped": SpringDamper(3.0, 0.0),
    "compliant": SpringDamper(1.5, 0.1),
    "stiff, force release": SpringDamper(2e3, 0.05, "force"),
    "hunt-crossley": HuntCrossley(1e3, 0.08),
    "hunt-crossley, strong": HuntCrossley(1e3, 0.5),
    "tsuji": Tsuji(1e3, 0.3),
    "tsuji, strong": Tsuji(200.0, 1.2),
    "kuwabara-kono": KuwabaraKono(1e3, 0.005),
    "kuwabara-kono, weak": KuwabaraKono(1e3, 2e-4),
    "kuwabara-kono, elastic": KuwabaraKono(1e3, 0.0),
    "elasto-backlash": ElastoBacklash(10.0, 0.136),
    "elasto-backlash, strong": ElastoBacklash(10.0, 0.5),
    "elasto-backlash, elastic": ElastoBacklash(3.0, 0.0),
    "sharing": Sharing(10.0, 0.136),
    "sharing, weak": Sharing(3.0, 0.05, 0.5),
    "sharing, by depth": Sharing(10.0, 0.136, 0.95, 0.5, width=0.2),
    "sharing, by depth and deep": Sharing(10.0, 0.05, share=0.6, at_surface=0.2, width=0.05),
    "adams-impact": AdamsImpact(1e3, 2.0, 0.1),
    "adams-impact, linear": LinearAdamsImpact(100.0, 3.0, 0.1),
    "adams-impact, strong": LinearAdamsImpact(100.0, 12.0, 0.05),
    "simscape-contact": SimscapeContact(100.0, 3.0, 0.1),
    "hardening spring": runpy.run_path(str(Path(__file__).with_name("hardening_spring.py")))["LAW"],
}
# Other parameters of laws that are tried often: weekly.
SELDOM = (
    "tsuji, strong",
    "elasto-backlash, strong",
    "adams-impact, strong",
    "sharing, weak",
    "sharing, by depth and deep",
)
every_law = pytest.mark.parametrize(
    "law",
    [
        pytest.param(law, id=name, marks=[pytest.mark.long] if name in SELDOM else [])
        for name, law in LAWS.items()
    ],
)
every_release = pytest.mark.parametrize("release", LINEAR)
SPEED, PHASE, AMPLITUDE = 3.5, 0.8, 1.2
START = SPEED, PHASE, AMPLITUDE


def load_at(phase, amplitude, time):
    """The acceleration of the ball towards the table without a contact."""
    return 1 - amplitude * np.sin(phase + time)


def integrated(law, speed, phase, amplitude):
    """D, p and p′ at the release, by an explicit integrator of order eight.

    In p and t it loses its order at p = 0; in q = p^{1/m} and ds = dt/(m q^{m-1}) the right sides
    are smooth there. It starts anew at a kink.
    """
    m = law.root

    def rates(_, state):
        q, u, t = state
        lever = m * q ** (m - 1)
        p = np.float64(max(q, 0.0) ** m)
        load = load_at(phase, amplitude, t)
        force = float(under(law, load).force(p, np.float64(u))) if p > 0 or m == 1 else 0.0
        return [u, lever * (load - force), lever]

    def released(_, state):
        q, u, t = state
        p = np.float64(max(q, 0.0) ** m)
        if law.lag is not None and np.all(law.lag == 0):
            return q
        return float(under(law, load_at(phase, amplitude, t)).grip(p, np.float64(u)))

    def surfaced(_, state):
        # Once the ball is down: it starts from p = 0.
        return state[0] if state[1] < 0 else 1.0

    def turned(_, state):
        return float(law.kink(np.float64(max(state[0], 0.0) ** m), np.float64(state[1])))

    events = [released, surfaced]
    if law.has_kink:
        events.append(turned)
    for event in events:
        event.terminal = True
        event.direction = -1
    turned.direction = -np.sign(law.kink(np.float64(0.0), np.float64(speed)))
    state = [0.0, speed, 0.0]
    options = {"method": "DOP853", "rtol": 3e-14, "atol": 1e-16}
    while True:
        found = solve_ivp(rates, (0, 1e3), state, events=events, **options)
        which = next(k for k, times in enumerate(found.t_events) if times.size)
        state = found.y_events[which][0]
        if events[which] is not turned:
            q, u, t = state
            return np.array([t, max(q, 0.0) ** m, u])
        turned.direction *= -1


@dataclass(frozen=True, repr=False)
class Unitless(Hertz):
    """A law whose damping has no declared unit."""

    units: ClassVar[dict[str, Unit]] = {"stiffness": Unit("N/m^1.5", 1, -0.5, -2)}
    name: ClassVar[str] = "unitless"

    def root_force(self, root, rate):
        return self.stiffness * root**3


def test_a_law_without_the_units_of_its_parameters_gets_no_name_and_no_si_numbers(refusal):
    for ask in (lambda: by_name(Unitless), lambda: Unitless(1.0, 0.1).in_si(1.0, 1.0, 1.0)):
        with refusal(ModelError, "unitless declares no unit of its parameter damping"):
            ask()


@pytest.mark.parametrize("name", NAMED)
def test_with_its_units_a_law_has_the_same_force_in_other_units(name):
    law = law_of_impact(NAMED[name], 0.7, 0.1, 3.0)
    length, time = 0.7, 1.3
    other = NAMED[name](**law.in_si(1.0, length, time))
    force = law.force(np.float64(0.02), np.float64(-0.5))
    scaled = other.force(np.float64(0.02 * length), np.float64(-0.5 * length / time))
    assert scaled == pytest.approx(force * length / time**2, rel=1e-13)


@every_law
def test_the_end_of_a_contact_agrees_with_an_independent_integrator(law):
    end = contacts(law, *START)
    # A hundred steps, each of 3e-14 of a speed of 3.5.
    np.testing.assert_allclose(end[:3], integrated(law, *START), rtol=0, atol=1e-11)


@every_law
def test_the_derivatives_of_the_end_agree_with_differences(law):
    start = np.array([PHASE, SPEED, AMPLITUDE, 1.0])
    steps = (-3, -2, -1, 1, 2, 3)
    h = 1e-2
    weights = np.array([-1, 9, -45, 45, -9, 1]) / 60
    exact = contacts(law, *START).jacobian
    for k in range(4):
        x = start[:, np.newaxis] + h * np.outer(np.eye(4)[k], steps)
        ends = contacts(law, x[1], x[0], x[2], x[3])
        # h⁶/140 times a seventh derivative of order one, and 1e-14 over h.
        assert np.abs(np.array(ends[:3]) @ weights / h - exact[:, k]).max() < 1e-11


@every_law
def test_the_contraction_is_that_of_the_flow(law):
    # Areas of the section (φ, v): dp and dp′ at a fixed time, by the ends' derivatives.
    end = contacts(law, *START)
    d_time, d_depth, d_rate = end.jacobian[:, :2]
    rate = end.rate
    load = 1 - AMPLITUDE * np.sin(PHASE + end.duration)
    # Back along the flight after the release, to one time: the start is moved by dφ too.
    moved = d_time + np.array([1.0, 0.0])
    area = np.linalg.det([d_depth - rate * moved, d_rate - load * moved])
    # At the start dp = -v dφ for a contact that starts later.
    assert area == pytest.approx(-SPEED * float(end.contraction), rel=1e-11)


@every_law
def test_the_force_does_the_work_and_the_release_is_the_first(law):
    end = contacts(law, *START)
    duration = float(end.duration)
    depth, rate = path(law, end, [0.0, duration], *START)
    np.testing.assert_allclose(depth, [0.0, end.penetration], rtol=0, atol=1e-14)
    np.testing.assert_allclose(rate, [SPEED, end.rate], rtol=0, atol=1e-12)
    ends = [0.0, duration]
    grid = np.linspace(0.0, duration, 101)
    turns = np.flatnonzero(np.diff(np.sign(law.kink(*path(law, end, grid, *START)))))
    pairs = ((grid[k], grid[k + 1]) for k in turns)
    ends[1:1] = [
        brentq(lambda t: law.kink(*path(law, end, t, *START)), *two, xtol=1e-8) for two in pairs
    ]
    # t = D x²(3 - 2x) undoes the roots at the ends, for the most part. A slope that steps 1e-8
    # beside the end of a part errs by 1e-16.
    x, weight = np.polynomial.legendre.leggauss(200)
    x = (x + 1) / 2
    work = 0.0
    for start, long in zip(ends, np.diff(ends), strict=False):
        time = start + long * x * x * (3 - 2 * x)
        part = 3 * long * weight * x * (1 - x)
        depth, rate = path(law, end, time, *START)
        load = load_at(PHASE, AMPLITUDE, time)
        assert np.all(depth > 0) and np.all(under(law, load).grip(depth, rate) > 0)
        table = AMPLITUDE * np.cos(PHASE + time)
        work += part @ (under(law, load).force(depth, rate) * (table - rate))

    def energy(p, u, t):
        angle = PHASE + t
        return (AMPLITUDE * np.cos(angle) - u) ** 2 / 2 + AMPLITUDE * np.sin(angle) - p

    gained = energy(end.penetration, end.rate, duration) - energy(0.0, SPEED, 0.0)
    assert gained == pytest.approx(work, abs=1e-9)


@every_law
def test_the_delay_and_the_load_are_those_of_the_continued_flights(law):
    # Contacts under small loads ±a, the parabolas before and after continued to where they meet.
    a = 1e-3
    v = 3.0
    speeds = []
    delays = []
    for load in (a, 0.0, -a):
        end = contacts(law, v, weight=load)
        out = -end.rate
        gap_rate = out + load * end.duration + v
        gap = -end.penetration - out * end.duration - load * end.duration**2 / 2
        meet = -gap / gap_rate
        r = law.signature(v + load * meet).restitution
        speeds.append(out + load * (end.duration - meet) - r * (v + load * meet))
        delays.append(meet)
    instant = law.signature(v)
    assert float(instant.delay) == pytest.approx(float(delays[1]), rel=1e-12)
    # The next order in a/v is a² relative to the first, once differenced.
    assert float(instant.load) == pytest.approx(float(speeds[0] - speeds[2]) / (2 * a), abs=1e-7)


@every_law
def test_the_tabulated_signature_is_the_impact_itself(law):
    speed = np.array([1e-4, 0.3, 2.0, 7.9, 8.1, 30.0])
    tabulated = Signature(law)(speed)
    itself = law.signature(speed)
    # A law with kinks whose r depends on the speed is not smooth there.
    error = 1e-12 if law.constant_signature or law.is_smooth_by_speed else 1e-6
    for name in ("delay", "restitution", "duration"):
        np.testing.assert_allclose(getattr(tabulated, name), getattr(itself, name), rtol=error)
    loads = np.array([tabulated.load, itself.load]) / itself.duration
    np.testing.assert_allclose(loads[0], loads[1], atol=error)
    changes = np.array([tabulated.d_restitution, itself.d_restitution]) * speed
    np.testing.assert_allclose(changes[0], changes[1], atol=10 * error)


@every_release
def test_a_spring_known_by_its_force_alone_agrees_with_the_closed_forms(release):
    """Contact, signature, permanent contact, motion and history of the spring-damper."""
    exact = SpringDamper(20.0, 0.13, release)
    law = Spring(20.0, 0.13, release)
    for zeta in (0.0, 0.05, 0.4, 0.8):
        closed = Signature(SpringDamper(20.0, zeta, release))(1.0)
        computed = Signature(Spring(20.0, zeta, release))([0.1, 3.3])
        for name in ("delay", "restitution", "duration"):
            np.testing.assert_allclose(getattr(computed, name), getattr(closed, name), rtol=1e-12)
        np.testing.assert_allclose(computed.load, closed.load, atol=1e-12 * float(closed.duration))
        for name in ("d_delay", "d_restitution", "d_load"):
            np.testing.assert_allclose(getattr(computed, name), 0.0, atol=1e-11)
    for case in ((0.5, 0.02), (1.0, 0.136), (2.0, 0.136), (10.0, 0.136)):
        found = permanent_contact(Spring(*case, release))
        # A tenth of the bound of the residual, which changes its sign within every interval.
        assert found == pytest.approx(float(permanent_contact_threshold(*case, release)), rel=1e-10)
    # Grazing and long contacts, and contacts that resume below the level, included.
    rng = np.random.default_rng(0)
    phase = rng.uniform(-3, 3, 400)
    velocity = -rng.uniform(2, 6, 400)
    one, other = (x.dynamics(1.5).simulate(phase, velocity, 4) for x in (exact, law))
    for name in ("time", "relative_velocity", "contact_duration", "displacement"):
        a = getattr(one, name)
        b = getattr(other, name)
        assert np.array_equal(np.isfinite(a), np.isfinite(b))
        # 1e-13 of the velocity, times what impacts multiply differences by; grazing ones by
        # hundreds.
        assert np.nanmedian(np.abs(a - b)) < 1e-12
        assert np.nanmax(np.abs(a - b)) < 1e-9
    cycles = (x.dynamics(1.5).next_impact(phase[:20], velocity[:20]) for x in (exact, law))
    np.testing.assert_allclose(*cycles, atol=1e-10)
    # The ball chatters at first.
    one, other = (x.dynamics(1.2).simulate(0.4, -1.0, 6) for x in (exact, law))
    time = np.linspace(0, float(one.time[-1]), 4001)
    expected = motion_at(one, time)
    found = motion_at(other, time)
    # Samples next to an event may fall on its other side.
    same = expected.touching == found.touching
    assert np.count_nonzero(~same) <= 2 * one.time.size
    np.testing.assert_allclose(found.gap[same], expected.gap[same], atol=1e-10)


@pytest.fixture
def few_panels(monkeypatch):
    """Of contacts that do not end fewer oscillations are followed, more than orbits have."""
    monkeypatch.setattr("bouncing_ball_beyond.models.laws.motion.MOST_PANELS", 200)


@every_law
def test_an_impact_of_a_simulation_is_the_contact(law, few_panels):
    rng = np.random.default_rng(5)
    speed, phase, amplitude = rng.uniform([[1.5], [-3.0], [0.0]], [[8.0], [3.0], [1.0]], (3, 40))
    sequence = law.dynamics(amplitude).simulate(phase, amplitude * np.cos(phase) - speed, 1)
    end = contacts(law, speed, phase, amplitude)
    found = (
        sequence.contact_duration[0],
        -sequence.release_displacement[0],
        -sequence.relative_bounce_velocity[0],
    )
    # Some last longer than a dozen oscillations.
    known = np.isfinite(end.duration)
    assert known.mean() > 0.8
    np.testing.assert_allclose(np.array(found)[:, known], np.array(end[:3])[:, known], atol=1e-11)


@pytest.mark.parametrize("law", [HuntCrossley(4e3, 0.08), LinearHuntCrossley(100.0, 0.3)])
def test_hunt_and_crossleys_restitution_is_that_of_any_spring(law):
    # u du/(1 + C u) = -K p^ν dp on both ways: the spring's energy is the same.
    r = law.signature(SPEED).restitution
    loss = law.damping * SPEED
    assert loss - np.log1p(loss) == pytest.approx(-loss * r - np.log1p(-loss * r), rel=1e-12)


HERTZ = [HuntCrossley(4e3, 0.08), Tsuji(4e3, 0.3), KuwabaraKono(4e3, 0.005)]
hertz = pytest.mark.parametrize("law", HERTZ, ids=[law.name for law in HERTZ])


def test_a_parameter_may_be_an_array_without_an_axis():
    """As numpy and xarray return numbers."""
    law = HuntCrossley(np.array(100.0), xr.DataArray(0.5))
    assert law.dynamics(0.5).simulate(0.0, -0.3, 10).status == Status.PERMANENT_CONTACT


@hertz
def test_a_ball_on_a_table_at_rest_comes_to_rest(law, few_panels):
    sequence = law.dynamics(0.0).simulate(0.0, -2.0, 200)
    assert sequence.status == Status.PERMANENT_CONTACT
    speed = -sequence.relative_velocity[np.isfinite(sequence.time)]
    assert np.all(np.diff(speed) < 0)


@hertz
def test_a_ball_laid_on_the_table_leaves_it(law):
    # From rest at the table's level it sinks in, and swings back out.
    sequence = law.dynamics(1.5).simulate(0.0, 1.5, 3)
    assert np.all(np.isfinite(sequence.time))
    assert 0 < sequence.release_phase[0] < np.pi


@hertz
def test_a_history_is_continuous_and_obeys_the_law(law):
    sequence = law.dynamics(1.0).simulate(0.7, -3.0, 3)
    release = sequence.time[:2] + sequence.contact_duration[:2]
    for event in (*sequence.time[1:], *release):
        around = motion_at(sequence, event + np.array([-1e-9, 1e-9]))
        # Twice 1e-9 of a speed of 4.
        assert abs(np.diff(around.gap)[0]) < 1e-8
    time = np.linspace(0.1, 0.9, 9) * float(sequence.contact_duration[0])
    h = 1e-5
    now, ahead, behind = (motion_at(sequence, time + shift) for shift in (0, h, -h))
    assert now.touching.all() and np.all(now.gap < 0)
    force = law.force(-now.gap, -(now.velocity - np.cos(0.7 + time)))
    # Differences of second order: h²/6 times a third derivative of some 1e5.
    np.testing.assert_allclose((ahead.velocity - behind.velocity) / (2 * h), force - 1, atol=1e-4)
    flying = motion_at(sequence, 0.5 * (release[0] + sequence.time[1]))
    assert not flying.touching and flying.gap > 0
    # Before the first impact and after the last known release the ball is nowhere.
    outside = motion_at(sequence, [-1.0, sequence.time[-1] + 100.0])
    assert np.all(np.isnan(outside.height)) and np.all(np.isfinite(outside.table))


def test_each_of_many_balls_has_the_law_of_its_own_entry():
    law = HuntCrossley(np.array([1e3, 1e5]), np.array([0.1, 0.02]))
    both = law.dynamics(1.0).simulate(0.4, -3.0, 3)
    for k in range(2):
        np.testing.assert_allclose(
            both.time[:, k], law[k].dynamics(1.0).simulate(0.4, -3.0, 3).time, rtol=1e-12
        )


@pytest.mark.parametrize(
    ("surface", "amplitude", "phase", "speed"),
    [(0.95, 5.0, 0.8, 0.2), (0.9, 4.947126015, 0.807671628, 0.19328047), (0.9, 3.0, 1.5, 0.01)],
)
def test_a_ball_that_the_load_pulls_away_meets_no_force_at_the_surface(
    surface, amplitude, phase, speed
):
    """It sinks or comes back freely until the force pushes, and may be released while it sinks."""
    law = Sharing(20.0, 0.05, 0.95, surface, width=0.1)
    found = law.dynamics(amplitude).simulate(phase, amplitude * np.cos(phase) - speed, 3)
    assert found.status == Status.BOUNCING and found.contact_duration[0] == 0.0

    def force(t, p, u):
        p = np.float64(p)
        load = load_at(phase, amplitude, t)
        return float(under(law, load).force(p, np.float64(u))) if p > 0 else 0.0

    def rates(t, state):
        return [state[1], load_at(phase, amplitude, t) - max(force(t, *state), 0.0)]

    end = float(found.time[1] + found.contact_duration[1])
    options = {"method": "LSODA", "rtol": 1e-9, "atol": 1e-12, "max_step": 2e-2}
    run = solve_ivp(rates, (0.0, end), [0.0, speed], **options)
    # The steps are adapted to the kinks of the force, with errors of some parts of their tolerance.
    assert run.y[0, -1] == pytest.approx(-found.release_displacement[1], abs=1e-7)
    assert run.y[1, -1] == pytest.approx(-found.relative_bounce_velocity[1], abs=1e-6)


CHANGED = {
    **{name: LAWS[name] for name in ("hunt-crossley", "tsuji", "kuwabara-kono")},
    "elasto-backlash": LAWS["elasto-backlash"],
    "hunt-crossley-linear": LinearHuntCrossley(1e3, 0.08),
    "lankarani-nikravesh": LankaraniNikravesh(1e3, 0.8),
    "flores": Flores(1e3, 0.8),
    "adams-impact": LAWS["adams-impact"],
    "adams-impact-linear": LAWS["adams-impact, linear"],
    "simscape-contact": LAWS["simscape-contact"],
    "linear": SpringDamper(10.0, 0.136, "force"),
    "damped on approach": SpringDamper(10.0, 0.136, "approach"),
}


def test_every_named_law_is_changed_here():
    assert {law.name for law in CHANGED.values()} == set(NAMED)


@pytest.mark.parametrize("law", CHANGED.values(), ids=CHANGED)
def test_a_law_of_twice_the_stiffness_pushes_a_ball_at_rest_twice_as_hard(law):
    depth = np.array([0.03, 0.3])
    stiff = law.stiffened(2.0).force(depth, 0 * depth)
    assert stiff == pytest.approx(2 * law.force(depth, 0 * depth), rel=1e-12)


def test_a_law_without_a_stiffness_is_not_made_stiffer():
    with pytest.raises(ModelError, match="spring has no parameter stiffness"):
        Spring(10.0, 0.1).stiffened(2.0)


@pytest.mark.parametrize("width", [1e-9, 1e-5, 0.1])
def test_a_ball_at_rest_on_a_stiff_contact_is_held_by_force_and_load(width):
    law = Sharing(3e4, 0.1, 0.9, 0.2, width=width)
    depth = np.array(rest(law))
    assert float(under(law, 1.0).force(depth, np.array(0.0))) == pytest.approx(1.0, abs=1e-14)

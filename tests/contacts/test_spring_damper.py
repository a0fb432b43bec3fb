"""The contact's flow against other integrators, and its exact Jacobian."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from bouncing_ball.contacts.spring_damper import (
    ARGUMENTS,
    Release,
    SpringDamper,
    check_contact,
    contact_flow,
    contact_force,
)
from bouncing_ball.errors import ModelError

EPS = np.finfo(float).eps

contacts = st.fixed_dictionaries(
    {
        "displacement": st.floats(-1, 1),
        "velocity": st.floats(-5, 5),
        "phase": st.floats(-4, 4),
        "amplitude": st.floats(0, 3),
        "frequency_ratio": st.floats(0.05, 50),
        "damping_ratio": st.one_of(st.just(0.0), st.just(1.0), st.floats(0, 1), st.floats(1, 3)),
    }
)


def size(start, s):
    """Bounds on δ and δ′ reached within a time s, and so the size of errors."""
    push = 1 + start["amplitude"]
    v = abs(start["velocity"]) + start["frequency_ratio"] * abs(start["displacement"]) + push * s
    return np.array([abs(start["displacement"]) + v * min(s, 1 / start["frequency_ratio"]), v])


@given(contacts, st.floats(1e-4, 10))
def test_flow_against_the_matrix_exponential(reference, start, s):
    flow = contact_flow(s, **start)
    expected = reference.contact_state(s, *(start[name] for name in ARGUMENTS[1:]))
    omega, zeta = start["frequency_ratio"], start["damping_ratio"]
    # The exponential loses about the norm of its argument in roundings, here
    # 2(1 + ζ)ϖs, and works in the units of ϖδ and δ′, so that both share one.
    v = size(start, s)[1] + 1 + start["amplitude"]
    allowed = 20 * EPS * (1 + 2 * (1 + zeta) * max(omega, 1) * s) * v
    assert abs(float(flow.displacement) - expected[0]) <= allowed / min(omega, 1)
    assert abs(float(flow.velocity) - expected[1]) <= allowed


@pytest.mark.parametrize(
    ("omega", "zeta", "s"),
    [(1.0, 0.0, 5.0), (1.0, 1.0, 5.0), (0.2, 0.3, 8.0), (30.0, 0.05, 2.0), (8.0, 2.5, 2.0)],
)
def test_flow_against_runge_kutta(omega, zeta, s):
    phase, lam = 0.7, 1.4

    def field(t, y):
        push = -1 + lam * np.sin(t + phase)
        return [y[1], push - 2 * zeta * omega * y[1] - omega**2 * y[0]]

    times = np.linspace(0.0, s, 7)
    run = solve_ivp(
        field, (0, s), [0.1, -2.0], method="DOP853", t_eval=times, rtol=1e-13, atol=1e-14
    )
    flow = contact_flow(times, 0.1, -2.0, phase, lam, omega, zeta)
    # Local errors of 1e-13 over some hundred steps.
    assert flow.displacement == pytest.approx(run.y[0], abs=2e-11)
    assert flow.velocity == pytest.approx(run.y[1], abs=2e-11 * max(omega, 1))


@given(contacts, st.floats(0.01, 4), st.floats(0.01, 4))
def test_flow_is_a_semigroup(start, first, second):
    whole = contact_flow(first + second, **start)
    half = contact_flow(first, **start)
    rest = start | {
        "displacement": half.displacement,
        "velocity": half.velocity,
        "phase": start["phase"] + first,
    }
    end = contact_flow(second, **rest)
    # Roundings of the phase, twice, and of the state between.
    allowed = 30 * EPS * (1 + start["frequency_ratio"] * (first + second))
    sizes = size(start, first + second)
    assert abs(float(end.displacement - whole.displacement)) <= allowed * sizes[0]
    assert abs(float(end.velocity - whole.velocity)) <= allowed * sizes[1]


@pytest.mark.parametrize("s", [3.0, 0.3])
def test_flow_runs_backwards(s):
    # No range is given for the time, and the formulas are entire in it: 3.0
    # takes the quotient, 0.3 the mean over a circle.
    there = contact_flow(s, -0.1, 0.2, 0.4, 1.2, 2.0, 0.1)
    back = contact_flow(-s, there.displacement, there.velocity, 0.4 + s, 1.2, 2.0, 0.1)
    # Numbers of order one; e^{2ζϖs} < 4 amplifies the roundings.
    assert float(back.displacement) == pytest.approx(-0.1, abs=100 * EPS)
    assert float(back.velocity) == pytest.approx(0.2, abs=100 * EPS)


@pytest.mark.parametrize("name", ARGUMENTS)
@pytest.mark.parametrize(
    ("s", "omega", "zeta"),
    [
        (0.4, 1.0, 0.0),  # resonance, on the circle
        (6.0, 1.0, 0.0),
        (0.05, 3.0, 0.1),
        (2.0, 3.0, 0.1),
        (2.0, 3.0, 1.0),
        (2.0, 3.0, 1.7),
        (0.3, 40.0, 0.05),
        (1e-3, 2e3, 0.05),
        (5.0, 0.1, 0.4),
    ],
)
def test_jacobian_against_differences(name, s, omega, zeta):
    values = dict(zip(ARGUMENTS, (s, 0.2, -1.5, 0.8, 1.3, omega, zeta), strict=True))
    column = ARGUMENTS.index(name)
    jacobian = contact_flow(*values.values()).jacobian[:, column]
    # Fourth-order differences, in the oscillator's own units. A ζ of 0 takes
    # them to one side, where the flow is as smooth.
    steps = {"time": max(omega, 1.0), "damping_ratio": max(omega * s, 1.0)}
    h = 2e-3 / steps.get(name, 1.0)
    if name == "damping_ratio" and zeta == 0:
        nodes, weights = np.arange(6), np.array([-137 / 60, 5, -5, 10 / 3, -5 / 4, 1 / 5])
    else:
        nodes, weights = np.array([-2, -1, 1, 2]), np.array([1, -8, 8, -1]) / 12
    states = []
    for node in nodes:
        moved = values | {name: values[name] + node * h}
        flow = contact_flow(*moved.values())
        states.append([float(flow.displacement), float(flow.velocity)])
    difference = weights @ np.array(states) / h
    # h⁴ times the fifth derivative, at most (ϖ or s)⁵ ≲ 1e3 in units of the
    # rows: 1e-8; the roundings, eps/h, are below.
    scale = np.abs(difference).max() + 1
    assert jacobian == pytest.approx(difference, abs=2e-8 * scale)


def test_shapes_broadcast():
    flow = contact_flow(np.ones((3, 1)), 0.0, -1.0, 0.0, 1.0, np.array([2.0, 3.0]), 0.1)
    assert flow.displacement.shape == flow.acceleration.shape == (3, 2)
    assert flow.jacobian.shape == (3, 2, 2, 7)


def test_acceleration_satisfies_the_equation():
    s, phase, lam, omega, zeta = np.linspace(0, 3, 20), 0.3, 1.2, 5.0, 0.2
    flow = contact_flow(s, 0.1, -1.0, phase, lam, omega, zeta)
    force = contact_force(flow.displacement, flow.velocity, omega, zeta)
    balance = force - 1 + lam * np.sin(s + phase)
    assert flow.acceleration == pytest.approx(balance, abs=200 * EPS)
    # And it is the derivative of the velocity: second-order differences.
    h = 1e-5
    up, down = (contact_flow(s + k, 0.1, -1.0, phase, lam, omega, zeta) for k in (h, -h))
    inner = slice(1, None)  # s - h ≥ 0
    rate = (up.velocity - down.velocity) / (2 * h)
    assert flow.acceleration[inner] == pytest.approx(rate[inner], abs=1e-7)


@pytest.mark.parametrize("omega", [0.5, 1.0, 20.0, 1e4])
def test_elastic_contact_conserves_energy(omega):
    # Table at rest, ζ = 0: kinetic, spring and gravity's energy add up.
    s, v0 = np.linspace(0, 3 * np.pi / omega, 50), -2.5
    flow = contact_flow(s, 0.0, v0, 0.0, 0.0, omega, 0.0)
    energy = flow.velocity**2 / 2 + omega**2 * flow.displacement**2 / 2 + flow.displacement
    # The two squares have roundings of their own, and ϖ s ≤ 10 shifts phases.
    scale = v0**2 / 2 + 1 / omega**2
    assert energy == pytest.approx(np.full_like(s, v0**2 / 2), abs=50 * EPS * scale)


def test_damping_takes_the_energy_it_should():
    # dE/ds = -2ζϖ δ′², integrated by Gauss's rule of 40 points.
    omega, zeta, end = 3.0, 0.2, 1.1
    nodes, weights = np.polynomial.legendre.leggauss(40)
    v = contact_flow(end * (nodes + 1) / 2, 0.0, -2.0, 0.0, 0.0, omega, zeta).velocity
    lost = 2 * zeta * omega * np.sum(weights * v**2) * end / 2
    flow = contact_flow(end, 0.0, -2.0, 0.0, 0.0, omega, zeta)
    d, v = float(flow.displacement), float(flow.velocity)
    assert 2.0 - (v**2 / 2 + omega**2 * d**2 / 2 + d) == pytest.approx(lost, abs=100 * EPS)


def test_force_pushes_at_impact_and_pulls_at_the_papers_release():
    omega, zeta = 10.0, 0.2
    assert float(contact_force(0.0, -1.0, omega, zeta)) > 0
    assert float(contact_force(0.0, 1.0, omega, zeta)) < 0
    assert float(contact_force(-0.01, 0.0, omega, zeta)) == 1.0


@pytest.mark.parametrize("omega", [0.0, -1.0, np.nan, np.inf])
def test_frequency_ratio_outside_its_range(omega, one_line):
    for call in (
        lambda: SpringDamper(omega, 0.1),
        lambda: check_contact(omega, 0.1),
        lambda: contact_flow(1.0, 0.0, -1.0, 0.0, 1.0, omega, 0.1),
    ):
        with pytest.raises(ModelError) as error:
            call()
        one_line(error, f"ϖ = {omega}", "positive")


@pytest.mark.parametrize("zeta", [-1e-9, np.nan, np.inf])
def test_damping_ratio_outside_its_range(zeta, one_line):
    for call in (
        lambda: SpringDamper(2.0, zeta),
        lambda: contact_flow(1.0, 0.0, -1.0, 0.0, 1.0, 2.0, zeta),
    ):
        with pytest.raises(ModelError) as error:
            call()
        one_line(error, f"ζ = {zeta}", "≥ 0")


def test_one_bad_contact_among_many_is_reported_on_one_line(one_line):
    with pytest.raises(ModelError) as error:
        SpringDamper(np.linspace(0.0, 10.0, 60), 0.1)
    one_line(error, "positive")


def test_release_names():
    assert Release("displacement") is Release.DISPLACEMENT is SpringDamper(1.0, 0.0).release
    assert Release("force") is Release.FORCE

"""The contact's flow against other integrators, and its exact Jacobian."""

import mpmath
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from bouncing_ball_beyond.inherited.errors import ModelError
from bouncing_ball_beyond.models.contact_model import ContactModel
from bouncing_ball_beyond.models.spring_damper import SpringDamper

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


ARGUMENTS = ("displacement", "velocity", "phase", "amplitude", "frequency_ratio", "damping_ratio")


def flow_of(time, displacement, velocity, phase, amplitude, frequency_ratio, damping_ratio):
    """The flow by its arguments, ϖ and ζ."""
    contact = SpringDamper(frequency_ratio, damping_ratio)
    return contact.flow(time, displacement, velocity, phase, amplitude)


def size(start, s):
    """Bounds of δ and δ′ within a time s, which set the scale of errors."""
    push = 1 + start["amplitude"]
    v = abs(start["velocity"]) + start["frequency_ratio"] * abs(start["displacement"]) + push * s
    return np.array([abs(start["displacement"]) + v * min(s, 1 / start["frequency_ratio"]), v])


@given(contacts, st.floats(1e-4, 10))
def test_the_flow_is_that_of_the_matrix_exponential(reference, start, s):
    flow = flow_of(s, **start)
    expected = reference.contact_state(s, *(start[name] for name in ARGUMENTS))
    omega = start["frequency_ratio"]
    zeta = start["damping_ratio"]
    # The exponential loses about the norm of its argument in roundings, here
    # 2(1 + ζ)ϖs, and works in the units of ϖδ and δ′, so that both share one.
    v = size(start, s)[1] + 1 + start["amplitude"]
    allowed = 20 * EPS * (1 + 2 * (1 + zeta) * max(omega, 1) * s) * v
    assert abs(float(flow.displacement) - expected[0]) <= allowed / min(omega, 1)
    assert abs(float(flow.velocity) - expected[1]) <= allowed


@pytest.mark.parametrize("s", [3.0, 0.3])
def test_the_flow_backwards_in_time_leads_to_the_start(s):
    # No range is given for the time, and the formulas are entire in it: 3.0
    # takes the quotient, 0.3 the mean over a circle.
    there = SpringDamper(2.0, 0.1).flow(s, -0.1, 0.2, 0.4, 1.2)
    back = SpringDamper(2.0, 0.1).flow(-s, there.displacement, there.velocity, 0.4 + s, 1.2)
    # Numbers of order one; e^{2ζϖs} < 4 amplifies the roundings.
    assert float(back.displacement) == pytest.approx(-0.1, abs=100 * EPS)
    assert float(back.velocity) == pytest.approx(0.2, abs=100 * EPS)


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
def test_velocity_and_acceleration_are_derivatives_of_the_flow(s, omega, zeta):
    state = 0.2, -1.5, 0.8, 1.3, omega, zeta
    now = flow_of(s, *state)
    # Fourth-order differences, in the oscillator's own units.
    h = 2e-3 / max(omega, 1.0)
    nodes = np.array([-2, -1, 1, 2])
    weights = np.array([1, -8, 8, -1]) / 12
    states = []
    for node in nodes:
        flow = flow_of(s + node * h, *state)
        states.append([float(flow.displacement), float(flow.velocity)])
    difference = weights @ np.array(states) / h
    # h⁴ times the fifth derivative, at most (ϖ or s)⁵ ≲ 1e3 in units of the
    # rows: 1e-8; the roundings, eps/h, are below.
    scale = np.abs(difference).max() + 1
    derivative = [float(now.velocity), float(now.acceleration)]
    assert derivative == pytest.approx(difference, abs=2e-8 * scale)


def in_many_digits(contact, amplitude, velocity, phase, time):
    """δ of Eq. 12 with 40 digits, for a contact that starts at δ = 0."""
    with mpmath.workdps(40):
        omega, zeta, lam = map(mpmath.mpf, map(float, (*contact_of(contact), amplitude)))
        u, phi, s = map(mpmath.mpf, (velocity, phase, time))
        damped = omega * mpmath.sqrt(1 - zeta**2)
        gamma = (omega**2 - 1) ** 2 + (2 * zeta * omega) ** 2
        in_phase = (omega**2 - 1) / gamma
        quadrature = -2 * zeta * omega / gamma
        x = lam * mpmath.cos(phi)
        y = lam * mpmath.sin(phi)
        sine = in_phase * x - quadrature * y
        cosine = in_phase * y + quadrature * x
        a = 1 / omega**2 - cosine
        b = (u - sine + zeta * omega * a) / damped
        free = a * mpmath.cos(damped * s) + b * mpmath.sin(damped * s)
        steady = sine * mpmath.sin(s) + cosine * mpmath.cos(s)
        return float(mpmath.exp(-zeta * omega * s) * free - 1 / omega**2 + steady)


def contact_of(contact):
    """ϖ and ζ."""
    return contact.frequency_ratio, contact.damping_ratio


@pytest.mark.parametrize("detuning", [1e-6, 1e-4, 0.01, 0.02, 0.1])
@pytest.mark.parametrize("zeta", [0.0, 0.002])
def test_next_to_the_undamped_resonance_a_motion_has_all_its_digits(detuning, zeta):
    """Two parts of the size Λ/√γ, of opposite signs, may only be added where γ is large enough."""
    rng = np.random.default_rng(1)
    contact = SpringDamper(1 + detuning, zeta)
    for _ in range(20):
        lam = rng.uniform(0.3, 3)
        velocity = -rng.uniform(0.1, 3)
        phase = rng.uniform(-3, 3)
        dynamics = ContactModel(contact).dynamics(np.array([lam]))
        impact = dynamics.start(np.array([phase]), np.array([velocity]))
        inside = dynamics.release_function(impact, dynamics.depart(impact))
        time = rng.uniform(0.2, 6.0)
        expected = in_many_digits(contact, lam, velocity, impact.phase[0], time)
        assert inside(np.array([time]))[0] == pytest.approx(expected, abs=1e-13)


def test_the_acceleration_is_that_of_the_equation_of_motion():
    s = np.linspace(0, 3, 20)
    phase, lam = 0.3, 1.2
    contact = SpringDamper(5.0, 0.2)
    flow = contact.flow(s, 0.1, -1.0, phase, lam)
    force = contact.force(-flow.displacement, -flow.velocity)
    balance = force - 1 + lam * np.sin(s + phase)
    assert flow.acceleration == pytest.approx(balance, abs=200 * EPS)


@pytest.mark.parametrize("omega", [0.0, -1.0, np.nan, np.inf])
def test_a_frequency_ratio_outside_its_range_is_refused(omega, refusal):
    with refusal(ModelError, f"ϖ = {omega}", "> 0"):
        SpringDamper(omega, 0.1)


@pytest.mark.parametrize("zeta", [-1e-9, np.nan, np.inf])
def test_a_damping_ratio_outside_its_range_is_refused(zeta, refusal):
    with refusal(ModelError, f"ζ = {zeta}", "≥ 0"):
        SpringDamper(2.0, zeta)


@pytest.mark.parametrize("value", ["x", "2.0", True, None, [True], ["1", "2"], [[1.0], [2.0, 3.0]]])
def test_what_is_no_number_is_refused_where_the_contact_is_made(value, refusal):
    with refusal(ModelError, f"frequency ratio ϖ = {value!r} is not a finite number > 0"):
        SpringDamper(value, 0.1)
    with refusal(ModelError, f"damping ratio ζ = {value!r} is not a finite number ≥ 0"):
        SpringDamper(2.0, value)
    with refusal(ModelError, f"frequency ratio ϖ = {value!r} is not"):
        SpringDamper.from_restitution(0.5, value)
    with refusal(ModelError, f"restitution coefficient r = {value!r} is not in (0, 1]"):
        SpringDamper.from_restitution(value, 2.0)


def test_parameters_whose_shapes_do_not_broadcast_are_refused(refusal):
    parts = "frequency_ratio of shape (2,)", "damping_ratio of shape (3,)", "do not broadcast"
    with refusal(ModelError, *parts):
        SpringDamper([2.0, 3.0], [0.1, 0.2, 0.3])


@pytest.mark.parametrize("release", ["x", True, None, 1, ["force"]])
def test_an_unknown_release_is_refused_with_the_names_that_are_known(release, refusal):
    with refusal(ModelError, f"unknown release {release!r}", "displacement, force"):
        SpringDamper(2.0, 0.1, release)


@pytest.mark.parametrize("zeta", [0.1, 1.5])
@pytest.mark.parametrize("release", ["force", "approach"])
def test_a_contact_of_floats_has_floats(zeta, release):
    contact = SpringDamper(10.0, zeta, release)
    names = "stiffness", "decay_rate", "loss", "detuning", "off_resonance", "release_sine", "lag"
    names += "restitution", "free_duration", "permanent_contact"
    numbers = [getattr(contact, name) for name in names] + list(contact.signature(1.0))
    # The damper that acts on approach only may have no threshold.
    assert [type(x) for x in numbers if not isinstance(x, float | None)] == []

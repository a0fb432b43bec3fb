"""The signature of the linear contact against the contact's own motion."""

import numpy as np
import pytest
from scipy.optimize import brentq

from bouncing_ball.contacts.oscillator import exponential_response, impulse_response
from bouncing_ball.contacts.signature import LinearSignature
from bouncing_ball.contacts.spring_damper import Release, SpringDamper, contact_flow, contact_force
from bouncing_ball.errors import ModelError
from bouncing_ball.motion.contact import simulate

RELEASES = list(Release)
EPS = np.finfo(float).eps
NODES, WEIGHTS = np.polynomial.legendre.leggauss(40)


def constant_load(contact, load, speed):
    """Paths of an impact at ``speed`` under a constant load: δ, δ′ as functions of time."""
    omega, zeta = contact.frequency_ratio, contact.damping_ratio
    a, q = zeta * omega, omega * omega

    def state(time):
        g = impulse_response(time, a, q, q * (1 - zeta) * (1 + zeta))
        weight = exponential_response(0, time, a, q, g)
        return -speed * g.value - load * weight.value, -speed * g.rate - load * weight.rate

    return state


def exact_impact(contact, load, speed):
    """(t_c, r_c, D) of the continued flights of an impact under a constant load.

    ``speed`` is that of the continued flight at the instant; the start of
    contact that leads to it is found by iteration.
    """
    lag = 2 * contact.damping_ratio / contact.frequency_ratio
    lag = lag if contact.release is Release.FORCE else 0.0
    free = LinearSignature(contact)()
    first = speed
    for _ in range(60):
        state = constant_load(contact, load, first)

        def gone(time, state=state):
            displacement, velocity = state(time)
            return displacement + lag * velocity

        end = brentq(gone, 0.5 * free.duration, 1.4 * free.duration, xtol=1e-300, rtol=9e-16)
        displacement, velocity = state(end)
        # δ_out - δ_in grows linearly, at the rate J, and is zero at t_c.
        apart = displacement + first * end + load * end * end / 2
        jump = velocity + first + load * end
        delay = end - apart / jump
        first = speed - load * delay
    return delay, (velocity + load * (end - delay)) / speed, end


@pytest.mark.parametrize("release", RELEASES)
@pytest.mark.parametrize("zeta", [0.0, 0.05, 0.1359, 0.4, 0.9])
@pytest.mark.parametrize("omega", [1.0, 37.0])
def test_the_delay_is_the_centroid_of_the_force_of_a_free_impact(omega, zeta, release):
    instant = LinearSignature(SpringDamper(omega, zeta, release))()
    time = instant.duration * (NODES + 1) / 2
    displacement, velocity = constant_load(SpringDamper(omega, zeta), 0.0, 1.0)(time)
    force = contact_force(displacement, velocity, omega, zeta)
    centroid = np.sum(WEIGHTS * force * time) / np.sum(WEIGHTS * force)
    # Some ten roundings of the two parts of the force, whose sum is small at the end.
    parts = np.abs(2 * zeta * omega * velocity) + np.abs(omega * omega * displacement)
    lost = np.sum(WEIGHTS * parts) / np.sum(WEIGHTS * force)
    assert abs(instant.delay - centroid) < 10 * EPS * lost * instant.duration


@pytest.mark.parametrize("release", RELEASES)
@pytest.mark.parametrize("zeta", [0.0, 0.05, 0.1359, 0.4, 0.9])
def test_a_free_impact_is_its_instant_exactly(zeta, release):
    contact = SpringDamper(3.0, zeta, release)
    instant = LinearSignature(contact)()
    displacement, velocity = constant_load(contact, 0.0, 2.0)(instant.duration)
    after = instant.duration - instant.delay
    thrown = 2.0 * instant.restitution
    np.testing.assert_allclose(velocity, thrown, rtol=1e-14)
    np.testing.assert_allclose(displacement, thrown * after - 2.0 * instant.delay, atol=1e-15)


def test_flights_continued_into_any_contact_meet_at_the_centroid_of_its_force():
    """Exact, whatever the table does meanwhile: the identity that the model is built on."""
    rng = np.random.default_rng(11)
    for release in RELEASES:
        for _ in range(50):
            omega, zeta = 10 ** rng.uniform(0.3, 2), rng.uniform(0, 0.6)
            lam, phase, speed = rng.uniform(0, 3), rng.uniform(-3, 3), rng.uniform(2, 9)
            contact = SpringDamper(omega, zeta, release)
            impact = simulate(contact, lam, phase, lam * np.cos(phase) - speed, 1)
            end, left = float(impact.contact_duration[0]), float(impact.release_displacement[0])
            if not np.isfinite(end):
                continue
            time = end * (NODES + 1) / 2
            flow = contact_flow(time, 0.0, -speed, phase, lam, omega, zeta)
            force = contact_force(flow.displacement, flow.velocity, omega, zeta)
            impulse = np.sum(WEIGHTS * force)
            centroid = np.sum(WEIGHTS * force * time) / impulse
            # Absolute flights: they meet where the distance at release is J (D - t_c).
            start, arrival = lam * np.sin(phase), lam * np.cos(phase) - speed
            apart = left + lam * np.sin(phase + end) - (start + arrival * end - end * end / 2)
            meeting = end - apart / (impulse * end / 2)
            # Relative to the contact: forty nodes integrate its half oscillation to
            # rounding, and the distance loses the digits of its terms, lam + speed D.
            lost = (lam + 1) / (speed * end)
            assert abs(centroid - meeting) < 4e-14 * end * (1 + lost)


@pytest.mark.parametrize("release", RELEASES)
@pytest.mark.parametrize("zeta", [0.0, 0.05, 0.1359, 0.4, 0.8])
def test_the_load_sensitivity_is_the_derivative_of_the_restitution(zeta, release):
    contact = SpringDamper(2.0, zeta, release)
    instant = LinearSignature(contact)()
    # Central differences over a/v = ±h, ±2h: their error is of order (h/r)⁴, as the
    # release moves by a/(r v); rounding is 1e-15/h.
    h, speed = 5e-3 * float(instant.restitution), 1.0
    r = {k: exact_impact(contact, k * h, speed)[1] for k in (-2, -1, 1, 2)}
    slope = (8 * (r[1] - r[-1]) - (r[2] - r[-2])) / (12 * h)
    np.testing.assert_allclose(slope, instant.load, atol=2e-10)


@pytest.mark.parametrize("release", RELEASES)
def test_an_elastic_contact_is_symmetric(release):
    instant = LinearSignature(SpringDamper(np.array([2.0, 50.0]), 0.0, release))()
    np.testing.assert_array_equal(instant.delay, instant.duration / 2)
    np.testing.assert_array_equal(instant.restitution, 1.0)
    np.testing.assert_array_equal(instant.load, 0.0)


@pytest.mark.parametrize("release", RELEASES)
def test_times_are_inversely_proportional_to_the_frequency_ratio(release):
    one = LinearSignature(SpringDamper(1.0, 0.2, release))()
    many = LinearSignature(SpringDamper(np.geomspace(1, 1e4, 9), 0.2, release))()
    for name in ("delay", "load", "duration"):
        product = getattr(many, name) * np.geomspace(1, 1e4, 9)
        np.testing.assert_allclose(product, getattr(one, name), rtol=1e-14)


def test_an_overdamped_contact_has_no_signature(one_line):
    with pytest.raises(ModelError) as error:
        LinearSignature(SpringDamper(10.0, 1.0))
    one_line(error, "damping ratio ζ = 1.0", "below 1")

"""The theorem of docs/impact-as-an-instant.md: its steps, its numbers, and where it fails."""

import numpy as np
import pytest

from bouncing_ball_beyond.inherited.numerics.elementary import reduce_angle
from bouncing_ball_beyond.models.contact_model import ContactModel
from bouncing_ball_beyond.models.corrected.model import CorrectedModel
from bouncing_ball_beyond.models.damping import damping_ratio
from bouncing_ball_beyond.models.laws.collocation import contacts
from bouncing_ball_beyond.models.laws.law_of_impact import law_of_impact
from bouncing_ball_beyond.models.laws.signature import Signature
from bouncing_ball_beyond.models.named_laws import LAWS
from bouncing_ball_beyond.models.spring_damper import SpringDamper
from bouncing_ball_beyond.periodic.one_impact import n_t

R, LAM = 0.7, 1.3
NAMES = ("displacement", "force", "hunt-crossley", "tsuji", "kuwabara-kono")
DURATIONS = (0.04, 0.02, 0.01)


def law(name, duration):
    """The contact with r and D at the speed 4."""
    if name not in ("displacement", "force"):
        return law_of_impact(LAWS[name], R, duration, 4.0)
    unit = SpringDamper(1.0, damping_ratio(R, name), name)
    return SpringDamper(unit.free_duration / duration, unit.damping_ratio, name)


def images(model, amplitude, phase, speed):
    """J, t* - φ, and the phase and the relative velocity of the next contact."""
    motion = model.simulate(amplitude, phase, amplitude * np.cos(phase) - speed, 2)
    arrival = motion.bounce_velocity[0] - amplitude * np.cos(phase) + speed
    time = motion.contact_duration[0]
    impulse = arrival + time
    # The flights from both ends of the contact, at its end.
    end = amplitude * np.sin(phase + time) + motion.release_displacement[0]
    fall = (amplitude * np.cos(phase) - speed - time / 2) * time
    apart = end - amplitude * np.sin(phase) - fall
    return np.array([impulse, time - apart / impulse, motion.phase[1], motion.relative_velocity[1]])


def difference(law, amplitude, phase, speed, step=1e-5):
    """Contact less instant model in C⁰ and C¹, shape (2, 4, ...), and the next closing speed."""
    around = step * np.array([[0, 0], [1, 0], [-1, 0], [0, 1], [0, -1]])[..., np.newaxis]
    both = [images(x, amplitude, phase + around[:, 0], speed + around[:, 1])
            for x in (ContactModel(law), CorrectedModel(Signature(law)))]  # fmt: skip
    apart = both[0] - both[1]
    apart[2] = reduce_angle(apart[2])
    slopes = np.abs(apart[:, 1::2] - apart[:, 2::2]).max(axis=1) / (2 * step)
    return np.array([np.abs(apart[:, 0]), slopes]), -both[0][3, 0]


def load_derivative(law, speed, instant_fixed):
    """∂J/∂a at a = 0 by three loads, at a fixed speed at the instant or at the touch."""
    step = 1e-4
    loads = step * np.array([1.0, 2.0, 3.0])
    touch = np.full(3, speed)
    # The closing speed of the continued flight grows by a until the instant, t* after the touch.
    for _ in range(60):
        end = contacts(law, touch, weight=loads)
        departure = -end.rate
        impulse = touch + departure + loads * end.duration
        drop = -end.penetration + touch * end.duration + loads * end.duration**2 / 2
        delay = end.duration - drop / impulse
        if not instant_fixed:
            break
        touch = speed - loads * delay
    return impulse @ [-5, 8, -3] / (2 * step)


@pytest.mark.parametrize("name", NAMES)
def test_the_load_sensitivity_is_a_derivative_at_a_fixed_speed_at_the_instant(name):
    contact = law(name, 0.1)
    instant = Signature(contact)(np.array([3.0]))
    beside = 3.0 + 1e-4 * np.array([-1.0, 1.0])
    departure = Signature(contact)(beside).restitution * beside
    at_touch = instant.load + instant.delay * (1 + np.diff(departure) / np.diff(beside))
    # Impulses of order one are known to 1e-12, which the step of 1e-4 amplifies to 1e-8.
    np.testing.assert_allclose(load_derivative(contact, 3.0, True), instant.load, atol=1e-7)
    np.testing.assert_allclose(load_derivative(contact, 3.0, False), at_touch, atol=1e-7)


def test_the_two_derivatives_of_the_linear_contact_by_the_load_are_far_apart():
    contact = SpringDamper(1.0, damping_ratio(0.65, "displacement"), "displacement")
    assert load_derivative(contact, 3.0, True).round(4) == 0.6615
    assert load_derivative(contact, 3.0, False).round(4) == 2.7227


@pytest.mark.parametrize("name", NAMES)
def test_the_map_and_its_derivative_are_of_second_order_away_from_grazing(name):
    rng = np.random.default_rng(1)
    start = rng.uniform(-np.pi, np.pi, 40), rng.uniform(2, 7, 40)
    found = [difference(law(name, duration), LAM, *start) for duration in DURATIONS]
    away = found[0][1] > 1.5
    assert away.sum() > 30
    norms = np.array([apart[..., away].max(axis=-1) for apart, _ in found])
    order = np.log2(norms[:-1] / norms[1:])
    # Richardson: without the third order, which halves with the duration.
    np.testing.assert_allclose(2 * order[1] - order[0], 2, atol=0.1)


@pytest.mark.parametrize("name", NAMES[2:])
def test_the_multipliers_need_the_derivatives_of_delay_and_restitution(name):
    """Of second order with d(v t_c)/dv and d(rv + σa)/dv; of first with t_c; of none with r."""
    missed = []
    for duration in DURATIONS:
        contact = law(name, duration)
        orbit = n_t.orbit(ContactModel(contact), 1, 1.0)
        signature = Signature(contact)
        psi = float(orbit.phase)
        for _ in range(30):
            speed = np.pi + np.cos(psi)
            instant = signature(speed)
            # nπ - X = rv + σa for the phase of the instant.
            right = np.pi - instant.restitution * speed - instant.load * (1 - np.sin(psi))
            psi = float(np.arccos(right))
        load = 1 - np.sin(psi)
        x = np.cos(psi)
        y = np.sin(psi)
        tangent = instant.tangent(speed, load)[0]
        found = []
        for e, b in (
            (tangent.delay, tangent.restitution),
            (instant.delay, tangent.restitution),
            (tangent.delay, instant.restitution),
        ):
            w = -(1 + b) * y - instant.load * x
            v = speed - e * load
            time = 2 * np.pi - e
            found.append([1 - b + (time * (w + b) - e) / v, -b + (time * b - e - e * w) / v])
        missed.append(np.array(found) - np.array(orbit.trace_and_determinant()))
    order = np.log2(np.abs(missed[:-1]) / np.abs(missed[1:]))
    # Tsuji's r is the same at every speed.
    known = slice(2 if name == "tsuji" else 3)
    np.testing.assert_allclose((2 * order[1] - order[0])[known, 0], [2, 1, 0][known], atol=0.15)


def test_at_grazing_the_error_grows_by_the_predicted_powers_of_the_speed():
    phase = np.array([-1.1])
    # At a closing speed of 1.5 the landing changes to a later one.
    edge = 3.45
    beyond = 3.6
    contact = law("displacement", 0.01)
    for _ in range(50):
        middle = (edge + beyond) / 2
        slow = -images(ContactModel(contact), 4.0, phase, np.array([middle]))[3, 0] < 1.5
        edge, beyond = (middle, beyond) if slow else (edge, middle)
    found = [difference(contact, 4.0, phase, np.array([edge - eta]), 1e-3 * eta)
             for eta in (0.01, 0.0025)]  # fmt: skip
    first, last = (x[0][:, 2, 0] for x in found)
    speed = [x[1][0] for x in found]
    np.testing.assert_allclose(
        np.log(last / first) / np.log(speed[0] / speed[1]), [1, 3], atol=0.15
    )
    # A slow impact, from the table while it presses: the impulse, by the next order's a²/u.
    found = [difference(contact, 0.5, np.array([-0.8]), np.array([u]), 1e-4 * u)[0][:, 0, 0]
             for u in (0.2, 0.1)]  # fmt: skip
    np.testing.assert_allclose(np.log2(found[1] / found[0]), [1, 2], atol=0.1)

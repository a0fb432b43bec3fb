"""The third order of docs/error-law.md, which the package does not use."""

import numpy as np
import pytest

from bouncing_ball_beyond.models.contact_model import ContactModel
from bouncing_ball_beyond.models.damping import LINEAR
from bouncing_ball_beyond.models.laws.signature import Signature
from bouncing_ball_beyond.models.spring_damper import SpringDamper
from bouncing_ball_beyond.periodic.one_impact import corrected_branch as corrected_branch
from bouncing_ball_beyond.periodic.one_impact import n_t


def constants(contact):
    """τ₁, σ₂, μ and the delay of the release with the load."""
    omega = contact.frequency_ratio
    zeta = contact.damping_ratio
    lag = contact.lag
    instant = Signature(contact)()
    r = instant.restitution
    delay = instant.delay
    duration = instant.duration
    weight = (1 + r) / omega**2
    rho = lag - 2 * zeta * (1 + r) / omega
    still = weight - lag * lag * r
    ramp = (duration - lag * r - 2 * zeta * omega * still) / omega**2 + lag * still
    later = weight / r
    inner = later + duration**2 / 2 - lag * rho
    inner = inner - (duration - lag * r) * (rho + duration) / (1 + r)
    tau = later - inner / (1 + r)
    squared = weight - omega**2 * weight**2 / (2 * r) + later - (1 + r) * tau
    jerk = -(2 * zeta * omega - lag * omega**2) * ramp - still
    jerk = jerk + r * delay**2 / 2 - rho * delay + (duration - delay) ** 2 / 2
    return tau, squared, jerk, later


def shifted(instant, n, squared, jerk, lam):
    """The line with the next order's terms, a²/v by iteration: (ψ, a/v) at Λ, or at the fold."""
    r = instant.restitution
    load = instant.load
    part = 0.0
    for _ in range(60):
        # (1 + r - μ) X - σY = nπ(1 - r) - σ - σ₂ a²/v
        side = n * np.pi * (1 - r) - load - squared * part
        radius = np.hypot(1 + r - jerk, load)
        turned = np.arctan2(load, 1 + r - jerk)
        fold = side / radius
        at = fold if lam is None else lam
        psi = np.arccos(fold / at) - turned
        over = (1 - at * np.sin(psi)) / (n * np.pi + at * np.cos(psi))
        part = over * (1 - at * np.sin(psi))
    return at, psi, over


@pytest.mark.parametrize("release", LINEAR)
@pytest.mark.parametrize(("n", "zeta"), [(1, 0.1359), (2, 0.3), (3, 0.02)])
def test_the_next_order_is_right_to_third_order(n, zeta, release):
    errors = []
    for omega in (80.0, 160.0, 320.0):
        contact = SpringDamper(omega, zeta, release)
        exact = ContactModel(contact)
        instant = Signature(contact)()
        tau, squared, jerk, later = constants(contact)
        low = corrected_branch.saddle_node(n, instant)
        high, _ = corrected_branch.period_doubling(n, instant)
        lam = float(low + high) / 2
        _, psi, over = shifted(instant, n, squared, jerk, lam)
        delay = instant.delay + tau * over
        duration = instant.duration + later * over
        orbit = n_t.orbit(exact, n, lam)
        fold, _, _ = shifted(instant, n, squared, jerk, None)
        errors.append(
            [
                psi - delay - orbit.phase,
                n * np.pi + delay - duration - orbit.bounce_velocity,
                lam * np.sin(psi - delay) + (n * np.pi - delay) ** 2 / 2 - orbit.max_height,
                fold - n_t.saddle_node(exact, n).amplitude,
            ]
        )
    order = np.diff(-np.log2(np.abs(np.array(errors, dtype=float))), axis=0)
    # One error passes through zero near by, and falls faster there.
    assert np.all(order[-1] > 2.9), order

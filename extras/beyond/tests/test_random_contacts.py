"""Random contacts of all laws, slow and fast, with kinks and force releases, by an integrator.

Small steps of Runge and Kutta's method in plain time share no code with the panels in root time. A
contact is tested for its end at each step, so that no end is passed that lasts longer than a step.
"""

import numpy as np
import pytest
from own_laws import flores, hunt_crossley_linear, limited_damper, stepped_spring

from bouncing_ball_beyond.contacts.named_laws import (
    adams_impact,
    hunt_crossley,
    kuwabara_kono,
    linear,
    simscape_contact,
    tsuji,
)

LAWS = {
    "hunt_crossley": hunt_crossley(1e3, 0.08),
    "hunt_crossley_linear": hunt_crossley_linear(400.0, 0.05),
    "tsuji": tsuji(1e3, 0.3),
    "kuwabara_kono": kuwabara_kono(1e3, 0.01),
    "flores": flores(1e3, 0.7),
    "linear": linear(20.0, 0.03),
    "linear, force": linear(20.0, 0.1, release="force"),
    "linear, approach": linear(20.0, 0.03, release="approach"),
    "limited_damper": limited_damper(20.0, 0.1),
    "adams_impact": adams_impact(1e3, 3.0, 0.01),
    "stepped_spring": stepped_spring(700.0, 6.0, 0.011),
    "simscape_contact": simscape_contact(700.0, 6.0, 0.011),
}

NUMBER, STEP, LONGEST = 300, 2.5e-4, 3.0
"""Contacts of each law, the length of a step, and the time after which contacts are left."""

BARELY = 1e-5
"""An end is uncertain where p + κp′ turns back within this distance of zero: it is the error of the
steps at kinks, (ωh)² of a depth of about 0.3."""


def random_contacts():
    """Phases, closing speeds over five decades, and amplitudes."""
    rng = np.random.default_rng(5)
    speed = 10 ** rng.uniform(-4, 1, NUMBER)
    return rng.uniform(0, 2 * np.pi, NUMBER), speed, rng.uniform(0, 3, NUMBER)


def stepped(law, tau, u, amplitude):
    """Times and speeds at the ends of contacts, infinite and NaN if they last longer, and the least
    distance of p + κp′ from zero where it turned back before."""
    kappa = law.lag(**law.values) if law.lag else 0.0

    def rates(t, p, v):
        more = {"start_speed": u[rows]} if law.needs else {}
        force = law.force(np.maximum(p, 0.0), v, **law.values, **more)
        return np.array([v, 1 - amplitude[rows] * np.sin(tau[rows] + t) - force])

    rows = np.arange(u.size)
    end = np.full(u.size, np.inf)
    speed = np.full(u.size, np.nan)
    margin = np.full(u.size, np.inf)
    state = np.array([0 * u, u])
    before = np.array([0 * u - 1, 0 * u])
    for t in STEP * np.arange(round(LONGEST / STEP)):
        first = rates(t, *state)
        second = rates(t + STEP / 2, *(state + STEP / 2 * first))
        third = rates(t + STEP / 2, *(state + STEP / 2 * second))
        fourth = rates(t + STEP, *(state + STEP * third))
        state = state + STEP / 6 * (first + 2 * second + 2 * third + fourth)
        level = state[0] + kappa * state[1]
        turns = (before[1] <= before[0]) & (before[1] <= level)
        margin[rows[turns]] = np.fmin(margin[rows], np.abs(before[1]))[turns]
        before = np.array([before[1], level])
        ended = level < 0
        if ended.any():
            late = STEP * (level / (level - before[0]))[ended]
            end[rows[ended]] = t + STEP - late
            speed[rows[ended]] = -(state[1][ended] - late * fourth[1][ended])
            rows = rows[~ended]
            state = state[:, ~ended]
            before = before[:, ~ended]
    return end, speed, margin


@pytest.mark.parametrize("name", LAWS)
def test_contacts_end_where_small_steps_end(name):
    law = LAWS[name]
    tau, u, amplitude = random_contacts()
    impact = law.first_impact(tau, u, amplitude)[1]
    end, speed, margin = stepped(law, tau, u, amplitude)
    duration = np.where(impact.duration < LONGEST - STEP, impact.duration, np.inf)
    end = np.where(end < LONGEST - STEP, end, np.inf)
    certain = margin > BARELY
    assert certain.sum() > 0.9 * NUMBER
    assert np.array_equal(np.isinf(duration[certain]), np.isinf(end[certain]))
    both = certain & np.isfinite(end)
    assert both.sum() > 0.3 * NUMBER
    np.testing.assert_allclose(duration[both], end[both], atol=STEP)
    # Slow releases change their speed by the acceleration in the error of the time.
    np.testing.assert_allclose(impact.speed[both], speed[both], rtol=1e-3, atol=20 * STEP)

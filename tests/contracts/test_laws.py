"""What every law of a contact with a duration keeps: flow, release, energy.

A new law is one more line of :data:`LAWS`. The Jacobian of the flow is tested in
``tests/contacts/test_spring_damper.py``.
"""

import numpy as np
import pytest

from bouncing_ball.contacts.spring_damper import SpringDamper, contact_force
from bouncing_ball.motion.contacts import simulate

EPS = np.finfo(float).eps
LAWS = {
    "linear": SpringDamper(7.0, 0.2),
    "linear, force release": SpringDamper(7.0, 0.2, "force"),
    "undamped": SpringDamper(3.0, 0.0),
    "soft": SpringDamper(0.6, 0.1),
    "stiff": SpringDamper(2e3, 0.05),
}
every_law = pytest.mark.parametrize("name", LAWS)
AMPLITUDE, PHASE, SPEED = 0.8, 0.7, -2.5


def contact_of(name):
    """The first contact of a simulation: the law, its duration and its ends."""
    law = LAWS[name]
    velocity = SPEED + AMPLITUDE * np.cos(PHASE)
    return law, simulate(law, AMPLITUDE, PHASE, velocity, 1)


@every_law
def test_the_flow_contracts_at_the_rate_of_the_damping(name):
    law, sequence = contact_of(name)
    time = np.linspace(0, 1, 11) * float(sequence.contact_duration[0])
    flow = law.flow(time, 0.0, SPEED, PHASE, AMPLITUDE)
    contraction = np.linalg.det(flow.jacobian[:, :, 1:3])
    expected = np.exp(-2 * law.damping_ratio * law.frequency_ratio * time)
    np.testing.assert_allclose(contraction, expected, rtol=0, atol=100 * EPS)


@every_law
def test_the_release_is_the_first(name):
    law, sequence = contact_of(name)
    duration = float(sequence.contact_duration[0])
    time = np.linspace(0, 1, 20_001)[1:-1] * duration
    flow = law.flow(time, 0.0, SPEED, PHASE, AMPLITUDE)
    assert np.all(flow.displacement + law.lag * flow.velocity < 0)
    end = law.flow(duration, 0.0, SPEED, PHASE, AMPLITUDE)
    size = abs(SPEED) * (1 / law.frequency_ratio + law.lag)
    assert abs(end.displacement + law.lag * end.velocity) < 100 * EPS * size
    assert end.velocity > 0


@every_law
def test_the_force_does_the_work(name):
    # The energy of the ball changes by the work of the table's force.
    law, sequence = contact_of(name)
    duration = float(sequence.contact_duration[0])
    node, weight = np.polynomial.legendre.leggauss(80)
    time = duration * (node + 1) / 2
    flow = law.flow(time, 0.0, SPEED, PHASE, AMPLITUDE)
    force = contact_force(flow.displacement, flow.velocity, law.frequency_ratio, law.damping_ratio)
    velocity = flow.velocity + AMPLITUDE * np.cos(PHASE + time)
    work = duration / 2 * float(weight @ (force * velocity))

    def energy(at):
        flow, angle = law.flow(at, 0.0, SPEED, PHASE, AMPLITUDE), PHASE + at
        height = flow.displacement + AMPLITUDE * np.sin(angle)
        return float((flow.velocity + AMPLITUDE * np.cos(angle)) ** 2 / 2 + height)

    # 80 nodes integrate half a period of an analytic motion to rounding.
    assert energy(duration) - energy(0.0) == pytest.approx(work, abs=100 * EPS * SPEED**2)


@every_law
def test_the_free_contact(name):
    # Neither weight nor table: a very fast impact. Both are of order 1/speed.
    law = LAWS[name]
    fast = -1e9
    sequence = simulate(law, 0.0, 0.0, fast, 1)
    assert sequence.contact_duration[0] == pytest.approx(float(law.free_duration), rel=1e-7)
    assert sequence.apparent_restitution[0] == pytest.approx(float(law.restitution), rel=1e-7)

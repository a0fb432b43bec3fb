"""The signature of the linear contact against the motion in the contact."""

import numpy as np
import pytest

from bouncing_ball.contacts.engines.impedance import Impedance
from bouncing_ball.errors import ModelError
from bouncing_ball.models.damping import Release
from bouncing_ball.models.laws.elasto_backlash import ElastoBacklash
from bouncing_ball.models.laws.hertzian import KuwabaraKono
from bouncing_ball.models.laws.signature import Signature
from bouncing_ball.models.spring_damper import SpringDamper

RELEASES = list(Release)
NODES, WEIGHTS = np.polynomial.legendre.leggauss(40)


def test_flights_continued_into_any_contact_meet_at_the_centroid_of_its_force():
    """This is exact for any motion of the table; the corrected model is built on this identity."""
    rng = np.random.default_rng(11)
    for release in RELEASES:
        for _ in range(50):
            omega = 10 ** rng.uniform(0.3, 2)
            zeta = rng.uniform(0, 0.6)
            lam = rng.uniform(0, 3)
            phase = rng.uniform(-3, 3)
            speed = rng.uniform(2, 9)
            contact = SpringDamper(omega, zeta, release)
            impact = contact.dynamics(lam).simulate(phase, lam * np.cos(phase) - speed, 1)
            end = float(impact.contact_duration[0])
            left = float(impact.release_displacement[0])
            if not np.isfinite(end):
                continue
            time = end * (NODES + 1) / 2
            flow = SpringDamper(omega, zeta).flow(time, 0.0, -speed, phase, lam)
            force = contact.force(-flow.displacement, -flow.velocity)
            impulse = np.sum(WEIGHTS * force)
            centroid = np.sum(WEIGHTS * force * time) / impulse
            # Absolute flights: they meet where the distance at release is J (D - t_c).
            start = lam * np.sin(phase)
            arrival = lam * np.cos(phase) - speed
            apart = left + lam * np.sin(phase + end) - (start + arrival * end - end * end / 2)
            meeting = end - apart / (impulse * end / 2)
            # Relative to the contact: forty nodes integrate its half oscillation to
            # rounding, and the distance loses the digits of its terms, lam + speed D.
            lost = (lam + 1) / (speed * end)
            assert abs(centroid - meeting) < 4e-14 * end * (1 + lost)


@pytest.mark.parametrize("release", RELEASES)
def test_an_elastic_contact_has_its_centroid_in_the_middle(release):
    instant = Signature(SpringDamper(np.array([2.0, 50.0]), 0.0, release))()
    np.testing.assert_array_equal(instant.delay, instant.duration / 2)
    np.testing.assert_array_equal(instant.restitution, 1.0)
    np.testing.assert_array_equal(instant.load, 0.0)


def test_an_overdamped_contact_has_no_signature(refusal):
    with refusal(ModelError, "damping ratio ζ = 1.0", "below 1"):
        Signature(SpringDamper(10.0, 1.0))


KINKED = Impedance(10.0, 0.136, 0.95, 0.5, width=0.2)


@pytest.mark.parametrize(
    ("law", "missed"),
    [
        (KuwabaraKono(1e3, 0.005), 1e-12),
        # Of a law with a kink, the documented error at the speed that just reaches it.
        (ElastoBacklash(10.0, 0.136), 1e-12),
        (KINKED, 1e-6),
    ],
    ids=lambda x: getattr(x, "name", ""),
)
def test_between_its_nodes_a_signature_is_that_of_free_impacts(law, missed):
    speed = np.geomspace(0.3, 12.0, 37)
    found = Signature(law)(speed)
    exact = law.signature(speed)
    for name in ("delay", "load", "duration"):
        error = np.abs(getattr(found, name) - getattr(exact, name)) / exact.duration
        assert error.max() < missed
    assert np.abs(found.restitution - exact.restitution).max() < max(1e-2 * missed, 1e-12)

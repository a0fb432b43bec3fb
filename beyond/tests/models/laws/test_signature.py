"""The signature of the linear contact against the motion in the contact."""

import math

import numpy as np
import pytest
from loaded_laws import Sharing

from bouncing_ball_beyond.inherited.errors import ModelError
from bouncing_ball_beyond.models.damping import LINEAR
from bouncing_ball_beyond.models.laws.elasto_backlash import ElastoBacklash
from bouncing_ball_beyond.models.laws.hertzian import (
    HuntCrossley,
    KuwabaraKono,
    LinearHuntCrossley,
    Tsuji,
)
from bouncing_ball_beyond.models.laws.signature import Signature
from bouncing_ball_beyond.models.spring_damper import SpringDamper

RELEASES = LINEAR
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


def test_an_overdamped_contact_that_pulls_has_no_signature(refusal):
    with refusal(ModelError, "a free impact of speed 1 does not end within a dozen oscillations"):
        Signature(SpringDamper(10.0, 1.5))(np.ones(1))


def test_where_impacts_do_not_end_the_signature_is_refused_or_unknown(refusal):
    """d = -p' c grows with the speed, until the contact holds the ball."""
    signature = Signature(HuntCrossley(100.0, 0.2))
    with refusal(ModelError, "a free impact of speed 1e+20 does not end"):
        signature(np.array([1.0, 1e20]))
    found = signature.where_known(np.array([1.0, 1e20, np.nan]))
    assert np.isnan(found.delay).tolist() == [False, True, True]
    assert found.restitution[0] == signature(1.0).restitution


def test_an_overdamped_contact_that_does_not_pull_has_the_signature_of_its_roots():
    """p = (e^{at} - e^{bt})/(a - b) with the roots a and b, up to p″ = 0, where the force ends."""
    omega, zeta = 10.0, 1.5
    slow, fast = (omega * (-zeta + sign * math.sqrt(zeta**2 - 1)) for sign in (1, -1))
    end = 2 * math.log(fast / slow) / (slow - fast)
    rate = (slow * math.exp(slow * end) - fast * math.exp(fast * end)) / (slow - fast)
    found = Signature(SpringDamper(omega, zeta, "force"))(np.ones(1))
    assert found.restitution[0] == pytest.approx(-rate, rel=1e-10)
    assert found.duration[0] == pytest.approx(end, rel=1e-10)


KINKED = Sharing(10.0, 0.136, 0.95, 0.5, width=0.2)


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


ROWS = [
    HuntCrossley(np.array([1e2, 1e4, 1e6]), np.array([0.0, 0.3, 0.02])),
    LinearHuntCrossley(np.array([1e2, 1e4, 1e6]), np.array([0.1, 0.3, 0.02])),
    Tsuji(np.array([1e2, 1e4, 1e6]), np.array([0.0, 0.5, 1.9])),
    KuwabaraKono(np.array([1e2, 1e4, 1e6]), np.array([0.0, 0.05, 1e-4])),
]


@pytest.mark.parametrize("laws", ROWS, ids=lambda x: x.name)
def test_one_table_serves_all_laws_of_a_kind(laws):
    speed = np.array([[0.3], [2.9], [11.0]])
    found = Signature(laws)(speed)
    exact = laws.signature(speed)
    for name in ("delay", "load", "duration"):
        error = np.abs(getattr(found, name) - getattr(exact, name)) / exact.duration
        assert error.max() < 1e-12
    assert np.abs(found.restitution - exact.restitution).max() < 1e-12
    assert np.abs((found.d_restitution - exact.d_restitution) * speed).max() < 1e-11
    # Differences of sixth order, with h⁶ times a seventh derivative, and 1e-14 over h.
    h = 1e-2
    beside = [Signature(laws)(speed * (1 + h * k)) for k in (-3, -2, -1, 1, 2, 3)]
    weights = np.array([-1, 9, -45, 45, -9, 1]) / 60
    for name in ("delay", "load"):
        values = np.stack([getattr(x, name) for x in beside])
        slope = np.tensordot(weights, values, axes=1) / (h * speed)
        np.testing.assert_allclose(slope, getattr(found, f"d_{name}"), atol=1e-10)


def test_where_there_is_no_impact_a_row_has_no_signature():
    found = Signature(ROWS[2])(np.array([np.nan, 1.0, np.nan]))
    for values in found:
        assert np.isnan(values).tolist() == [True, False, True]

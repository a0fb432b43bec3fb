"""Admissible orbits and their limits, against dense samples."""

from functools import partial

import numpy as np
import pytest
from scipy.optimize import minimize_scalar

from bouncing_ball_beyond.inherited.periodic.orbit import Side
from bouncing_ball_beyond.models.damping import LINEAR, Release
from bouncing_ball_beyond.models.rigid import RestitutionModel
from bouncing_ball_beyond.models.spring_damper import SpringDamper
from bouncing_ball_beyond.periodic.branches.following import orbits_on
from bouncing_ball_beyond.periodic.one_impact import n_t
from bouncing_ball_beyond.periodic.one_impact.paper_unknowns import PaperUnknowns
from bouncing_ball_beyond.periodic.one_impact.spring_damper_bifurcations import orbit_at
from bouncing_ball_beyond.periodic.one_impact.spring_damper_branch import (
    branch_point,
    orbits_of_points,
    orbits_on_branch,
)
from bouncing_ball_beyond.periodic.orbits.domain_limits import domain_limits
from bouncing_ball_beyond.periodic.orbits.motion import flight_path
from bouncing_ball_beyond.periodic.orbits.orbit import Orbit
from bouncing_ball_beyond.periodic.orbits.simulation import is_admissible

SHARES = np.linspace(0, 1, 2001)[1:-1, np.newaxis]


def landing_gap(s, phase, velocity, amplitude):
    """Height of the ball over the table a time s after an impact (Eq. 5)."""
    return s * velocity - s * s / 2 - amplitude * (np.sin(phase + s) - np.sin(phase))


def sampled(orbit):
    """Admissibility by its definition, on 2000 samples of contact and flight each."""
    omega = orbit.law.frequency_ratio
    zeta = orbit.law.damping_ratio
    u = orbit.relative_impact_velocity
    lam = orbit.amplitude
    flow = SpringDamper(omega, zeta).flow(SHARES * orbit.contact_duration, 0.0, u, orbit.phase, lam)
    time = orbit.contact_duration + SHARES * orbit.flight_time
    height, velocity = flight_path(orbit, time)
    over = height - lam * np.sin(orbit.phase + time)
    signal = flow.displacement
    if orbit.law.release is Release.FORCE:
        signal = signal + 2 * zeta / omega * flow.velocity
        rate = velocity - lam * np.cos(orbit.phase + time)
        rising = np.logical_and.accumulate(over < 0, axis=0)
        over = np.where(rising, over + 2 * zeta / omega * rate, over)
    possible = (u < 0) & (orbit.contact_duration > 0) & (orbit.flight_time > 0)
    return possible & (signal.max(axis=0) < 0) & (over.min(axis=0) > 0)


@pytest.mark.slow
@pytest.mark.parametrize("release", LINEAR)
def test_admissible_orbits_are_those_without_an_earlier_event_in_dense_samples(release):
    # Contacts from short to as long as the cycle; samples can only miss events
    # between them, at orbits that nearly graze: none in this sample.
    rng = np.random.default_rng(0)
    size = 150
    omega = 10 ** rng.uniform(0.05, 1.5, size)
    zeta = rng.uniform(0.01, 0.8, size)
    n = rng.integers(1, 4, size)
    longest = np.where(rng.random(size) < 0.5, 2 * np.pi * n, 4 / omega)
    duration = rng.uniform(0.1, 1.0, size) * longest
    free = np.pi if release is Release.DISPLACEMENT else np.pi - 2 * np.arcsin(zeta)
    excess = duration * omega * np.sqrt(1 - zeta**2) - free
    contact = SpringDamper(omega, zeta, release)
    orbit = orbits_of_points(branch_point(excess, contact, n), contact, n)
    admissible = orbit.is_admissible()
    assert np.array_equal(admissible, sampled(orbit))
    assert 0.2 < admissible.mean() < 0.8


@pytest.mark.parametrize("release", LINEAR)
def test_the_last_admissible_orbit_grazes_the_table(release):
    # On the unstable side the table rises into the flight from Λ ≈ 2.1 on.
    contact = SpringDamper(10.0, 0.05, release)
    orbit = orbit_at(contact, 1, np.linspace(1.9, 2.4, 6), Side.UNSTABLE)
    system = PaperUnknowns.of(orbit[0])
    inside = partial(is_admissible, system.equations)
    found = domain_limits(system, lambda y: inside(system.inner(y)), system.point(orbit))
    assert len(found) == 1
    at = orbits_on(system, found[0])
    start = float(at.contact_duration)
    lowest = minimize_scalar(
        lambda time: float(at.path(time)[0] - at.amplitude * np.sin(at.phase + time)),
        bounds=(start + 0.5, start + float(at.flight_time) - 0.5),
        method="bounded",
        options={"xatol": 1e-9},
    )
    # Bisection ends within rounding of the grazing orbit.
    assert abs(lowest.fun) < 1e-12
    assert np.max(np.abs(system.residual(found[0]))) < 1e-12


def test_unstable_restitution_orbits_are_admissible_until_they_graze():
    # r = 0.85, n = 1, unstable side: the ball meets the rising table beyond some Λ.
    lam = np.linspace(0.3, 4.0, 200)
    fold = np.pi * 0.15 / 1.85
    phase = -np.arccos(fold / lam)
    admissible = Orbit.of(RestitutionModel(0.85), 1, lam, phase).is_admissible()
    assert admissible[0] and not admissible[-1]
    assert np.sum(np.diff(admissible.astype(int)) != 0) == 1
    time = np.linspace(0, 2 * np.pi, 4001)[1:-1, np.newaxis]
    over = landing_gap(time, phase, np.pi, lam)
    assert np.array_equal(admissible, over.min(axis=0) > 0)


def test_an_earlier_release_at_the_undamped_resonance_makes_an_orbit_inadmissible():
    # There the motion has no steady part, and the flow gives it, with certified steps. One
    # longer than the period of the contact's own oscillation opens on the way.
    duration = np.array([[3.5, 6.0, 9.0, 11.0]])
    orbit = orbits_on_branch(duration - np.pi, SpringDamper(1.0, 0.0), 2)
    assert orbit.is_admissible().tolist() == [[True, True, False, False]]


def test_an_orbit_that_does_not_return_to_its_start_is_inadmissible():
    # By less than what an event that was overlooked would do, and by more than rounding.
    model = RestitutionModel(0.85)
    phase = float(n_t.orbit(model, 1, 1.0).phase)
    for off, same in ((0.0, True), (1e-9, True), (1e-4, False)):
        late = Orbit.of(RestitutionModel(0.85), 1, 1.0, phase + off)
        fast = Orbit.of(RestitutionModel(0.85), 1, 1.0, phase, 0.0, -np.pi * (1 + off))
        assert late.is_admissible() == fast.is_admissible() == same
    # Thrown up at nπ from an earlier phase the ball lands in time, and with another velocity.
    pace = np.cos(phase - 0.1)
    early = Orbit.of(RestitutionModel(0.85), 1, 1.0, phase - 0.1, 0.0, pace - (np.pi - pace) / 0.85)
    assert not early.is_admissible()

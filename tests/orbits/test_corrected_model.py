"""The corrected model through the interface of all models."""

import runpy
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

from bouncing_ball.contacts.signature import Instant, LinearSignature, Signature
from bouncing_ball.contacts.spring_damper import Release, SpringDamper
from bouncing_ball.errors import NoOrbitError
from bouncing_ball.orbits.corrected_model import CorrectedModel
from bouncing_ball.orbits.orbit import OBSERVABLES
from bouncing_ball.orbits.spring_damper_model import SpringDamperModel
from bouncing_ball.orbits.stability import Side

RELEASES = list(Release)
COMPARED = (*OBSERVABLES[1:], "release_displacement", "bounce_height")


def models(omega, zeta, release):
    contact = SpringDamper(omega, zeta, release)
    return CorrectedModel.of_contact(contact), SpringDamperModel(contact)


@pytest.mark.parametrize("side", list(Side))
@pytest.mark.parametrize("release", RELEASES)
def test_every_observable_of_an_orbit_is_of_second_order(release, side):
    errors = []
    for omega in (300.0, 600.0):
        corrected, exact = (m.orbit(1, 1.0, side) for m in models(omega, 0.1359, release))
        errors.append([abs(getattr(corrected, k) - getattr(exact, k)) for k in COMPARED])
        trace, det = (
            a - b
            for a, b in zip(
                corrected.trace_and_determinant(), exact.trace_and_determinant(), strict=True
            )
        )
        errors[-1] += [abs(trace), abs(det)]
    order = np.log2(np.array(errors[0]) / np.array(errors[1]))
    assert np.all(order > 1.9), dict(zip((*COMPARED, "trace", "det"), order, strict=True))


def test_the_papers_orbit():
    """At ϖ = 10 the error of the greatest height falls from 9 % to 0.05 %."""
    corrected, exact = models(10.0, 0.13585, Release.DISPLACEMENT)
    truth = exact.orbit(1, 1.0).max_height
    restitution = np.sin(np.arccos(np.pi * 0.35 / 1.65)) + np.pi**2 / 2
    assert 0.08 < restitution / truth - 1 < 0.1
    assert 4e-4 < corrected.orbit(1, 1.0).max_height / truth - 1 < 5e-4


@pytest.mark.parametrize("release", RELEASES)
@pytest.mark.parametrize("side", list(Side))
def test_orbits_solve_their_equations_and_close(release, side):
    model, _ = models(np.array([3.0, 10.0, 100.0]), 0.1, release)
    orbit = model.orbit(1, 0.9, side)
    assert np.all(orbit.defect() < 1e-14)
    assert np.all(orbit.is_admissible())
    assert np.all(orbit.is_stable() == (side is Side.STABLE))
    # The path is continuous at release, and comes back after 2π.
    before, after = (
        orbit.contact_path(orbit.contact_duration),
        orbit.flight_path(orbit.contact_duration),
    )
    np.testing.assert_allclose(before, after, atol=1e-13)
    start, end = orbit.contact_path(0 * orbit.phase), orbit.flight_path(2 * np.pi)
    np.testing.assert_allclose(start, end, atol=1e-13)


def test_orbits_at_one_amplitude_and_below():
    model, _ = models(8.0, 0.2, Release.DISPLACEMENT)
    assert model.orbits(1, 1.2).shape == (2,)
    assert model.orbits(1, 0.1).shape == (0,)
    with pytest.raises(NoOrbitError, match=r"below the saddle-node at Λ = 0\.897402"):
        model.require_orbit(1, 0.1)


def test_arrays_of_models():
    model, _ = models(np.array([5.0, 50.0]), 0.1, Release.DISPLACEMENT)
    assert model.shape == (2,)
    one = CorrectedModel.of_contact(SpringDamper(50.0, 0.1))
    assert model[1].orbit(1, 0.9).max_height == one.orbit(1, 0.9).max_height
    assert model.saddle_node(1).amplitude[1] == one.saddle_node(1).amplitude
    run = model.simulate(0.9, 0.0, -3.0, 20)
    np.testing.assert_array_equal(run.time[:, 1], one.simulate(0.9, 0.0, -3.0, 20).time)


OWN = runpy.run_path(str(Path(__file__).parents[1] / "contracts" / "plastic_impact.py"))


@dataclass(frozen=True, repr=False)
class _Plastic(Signature):
    """An instant without delay and load, whose restitution falls with the speed."""

    yield_speed: float

    def __call__(self, speed):
        v = np.asarray(speed, dtype=float)
        r = (self.yield_speed / v) ** 0.25
        zero = np.zeros_like(v)
        return Instant(zero, r, zero, zero, d_restitution=-r / (4 * v))


@pytest.mark.parametrize("n", [1, 2])
def test_a_law_that_depends_on_the_speed(n):
    # Against a model of its own, which solves for the speed.
    corrected, own = CorrectedModel(_Plastic(0.7)), OWN["MODEL"]
    for kind in ("saddle_node", "period_doubling"):
        computed, expected = getattr(corrected, kind)(n), getattr(own, kind)(n)
        assert float(computed.amplitude) == pytest.approx(float(expected.amplitude), rel=1e-14)
    lam = own.saddle_node(n).amplitude + np.array([1e-9, 0.1, 0.7])
    for side in Side:
        computed, expected = (model.orbit(n, lam, side) for model in (corrected, own))
        # Next to the fold the phase has half the digits.
        np.testing.assert_allclose(computed.phase, expected.phase, atol=1e-9)
        np.testing.assert_allclose(computed.multipliers(), expected.multipliers(), rtol=1e-7)
    assert np.isnan(corrected.orbit(n, own.saddle_node(n).amplitude - 1e-9).phase)
    assert not corrected.law.is_constant and LinearSignature(SpringDamper(1.0, 0.1)).is_constant

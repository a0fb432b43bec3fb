"""The corrected model through the interface of all models."""

import numpy as np
import pytest

from bouncing_ball_beyond.inherited.periodic.orbit import OBSERVABLES, Side
from bouncing_ball_beyond.models.contact_model import ContactModel
from bouncing_ball_beyond.models.corrected.model import CorrectedModel
from bouncing_ball_beyond.models.damping import LINEAR, Release
from bouncing_ball_beyond.models.laws.hertzian import Tsuji
from bouncing_ball_beyond.models.laws.signature import Signature
from bouncing_ball_beyond.models.spring_damper import SpringDamper
from bouncing_ball_beyond.periodic.one_impact import n_t

RELEASES = LINEAR
COMPARED = (*OBSERVABLES[1:], "bounce_height")


def models(omega, zeta, release):
    contact = SpringDamper(omega, zeta, release)
    return CorrectedModel.of_contact(contact), ContactModel(contact)


@pytest.mark.parametrize("side", list(Side))
@pytest.mark.parametrize("release", RELEASES)
def test_every_observable_of_an_orbit_is_of_second_order(release, side):
    errors = []
    for omega in (300.0, 600.0):
        corrected, exact = (n_t.orbit(m, 1, 1.0, side) for m in models(omega, 0.1359, release))
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


def test_the_correction_reduces_the_height_error_of_the_papers_orbit_from_9_to_0_05_percent():
    """At ϖ = 10 the error of the greatest height falls from 9 % to 0.05 %."""
    corrected, exact = models(10.0, 0.13585, Release.DISPLACEMENT)
    truth = n_t.orbit(exact, 1, 1.0).max_height
    restitution = np.sin(np.arccos(np.pi * 0.35 / 1.65)) + np.pi**2 / 2
    assert 0.08 < restitution / truth - 1 < 0.1
    assert 4e-4 < n_t.orbit(corrected, 1, 1.0).max_height / truth - 1 < 5e-4


@pytest.mark.parametrize("stiffness", [300.0, 2e4])
def test_without_dissipation_an_orbit_is_neutral_and_has_no_fold(stiffness):
    model = CorrectedModel(Signature(Tsuji(stiffness, 0.0)))
    families = np.array([1, 2, 3])
    assert not np.any(n_t.orbit(model, families, 0.5).is_stable())
    assert np.all(np.isnan(n_t.saddle_node(model, families).amplitude))


def linearised_cycle(instant, n, lam, phase):
    """Trace and determinant of a cycle whose instants are at the phase ψ, in closed form: see
    :mod:`bouncing_ball_beyond.periodic.one_impact.corrected_branch`.
    """
    x = lam * np.cos(phase)
    y = lam * np.sin(phase)
    half = n * np.pi
    r = instant.restitution
    delay = instant.delay
    by_phase = -(1 + r) * y - instant.load * x
    speed = half + x - delay * (1 - y)
    rest = 2 * half - delay
    trace = 1 - r + (rest * (by_phase + r) - delay) / speed
    determinant = (rest * r - delay - delay * by_phase) / speed - r
    return trace, determinant


@pytest.mark.parametrize("side", list(Side))
@pytest.mark.parametrize("release", RELEASES)
def test_trace_and_determinant_have_a_closed_form(release, side):
    contact = SpringDamper(20.0, 0.1359, release)
    n = np.array([1, 2, 3])
    orbit = n_t.orbit(CorrectedModel.of_contact(contact), n, 2.5, side)
    instant = contact.signature(1.0)
    expected = linearised_cycle(instant, n, 2.5, orbit.phase + instant.delay)
    for found, known in zip(orbit.trace_and_determinant(), expected, strict=True):
        assert found == pytest.approx(known, rel=1e-13, abs=1e-13)

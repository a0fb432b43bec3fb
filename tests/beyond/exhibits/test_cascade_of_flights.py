"""Openings as a dataset."""

import numpy as np
import pytest

from bouncing_ball.beyond.exhibits import cascades
from bouncing_ball.beyond.exhibits.cascades import cascade_of_flights
from bouncing_ball.long_run.destination import final_motions
from bouncing_ball.models.contact_model import ContactModel
from bouncing_ball.models.damping import Release
from bouncing_ball.models.spring_damper import SpringDamper
from bouncing_ball.pipeline.configuration import typed

# The ends of the grid. A whole row takes half a minute, and `make diff` compares it.
FLIGHTS = {
    "restitution": [0.85, 0.65],
    "frequency_ratio": {"min": 1.2, "max": 100.0, "samples": 2},
    "flights": 2,
}


@pytest.fixture
def without_openings(monkeypatch):
    """The dataset without the openings, which take most of its time."""

    def none(zeta, ratio, most):
        return np.full((2, zeta.size, most, ratio.size), np.nan)

    monkeypatch.setattr(cascades, "openings", none)


@pytest.fixture
def without_leaving(monkeypatch):
    """The dataset without the places where balls leave, which other tests have."""

    def none(law, second):
        return np.full(law.shape, np.nan), np.zeros(law.shape, dtype=int)

    monkeypatch.setattr(cascades, "_leaving", none)


def test_each_row_of_openings_is_that_of_its_restitution_and_tends_to_its_limit(
    described, without_leaving
):
    found = described(typed(cascade_of_flights)(FLIGHTS, "displacement"))
    assert found.opening_amplitude.dims == ("flights", "frequency_ratio")
    # The openings are those of the first r: Λ_SD at ϖ = 1.2 by another program, and limits of E.
    assert float(found.threshold_amplitude[0]) == pytest.approx(0.3175, abs=1e-4)
    stiffest = found.isel(frequency_ratio=-1)
    opened = stiffest.opening_amplitude
    last = stiffest.opening_excess
    held = float(stiffest.threshold_amplitude)
    np.testing.assert_allclose(last, 100.0**2 * (opened - held), rtol=1e-13)
    limits = found.stiff_opening.isel(restitution=0)
    np.testing.assert_allclose(last, limits, rtol=0.02)
    # The ratio of a limit to the one before, for the first r of the two.
    growth = float(found.restitution[0]) ** 2 * limits[1] / limits[0]
    assert float(found.stiff_opening_ratio[0, 0]) == pytest.approx(float(growth), rel=1e-13)
    # A compliant contact loses its stability first.
    assert np.isnan(found.opening_amplitude[..., 0]).all() and (found.opening_multiplier.max() < 1)


def test_a_ball_leaves_the_orbit_of_one_period_on_compliant_contacts_only(without_openings):
    given = {"restitution": [0.95], "frequency_ratio": {"min": 27.12, "max": 100, "samples": 2}}
    found = typed(cascade_of_flights)(given | {"flights": 2}, "displacement")
    (compliant, stiff) = found.leaving[0]
    assert found.stiff_opening[0, 0] * 0.7 < compliant < found.stiff_opening[0, 0]
    assert found.leaving_periods[0, 0] == 2 and np.isnan(stiff)
    # Another start just below and just above it.
    law = SpringDamper.from_restitution(0.95, 27.12, Release.DISPLACEMENT)
    lam = float(found.threshold_amplitude[0]) + (float(compliant) - np.array([0.4, 0.0])) / 27.12**2
    assert final_motions(ContactModel(law), lam, 1.7, -0.2).periods.tolist() == [1, 2]


# As above, on a contact where balls need most impacts.
@pytest.mark.long
def test_a_ball_that_comes_slowly_to_an_orbit_of_one_period_does_not_leave_it(without_openings):
    """At E = 10.33 it is not known to be on the orbit within the impacts that suffice elsewhere."""
    given = {"restitution": [0.95], "frequency_ratio": {"min": 36.88, "max": 100, "samples": 2}}
    found = typed(cascade_of_flights)(given | {"flights": 2}, "displacement")
    law = SpringDamper.from_restitution(0.95, 36.88, Release.DISPLACEMENT)
    lam = float(found.threshold_amplitude[0]) + 10.33 / 36.88**2
    # After so many impacts it is within 1.4e-10, and its distance falls tenfold in 180 of them.
    way = ContactModel(law).simulate(lam, 1.7, -0.2, 1500)
    # A period has three impacts.
    apart = np.ptp(way.phase[-30:].reshape(10, 3), axis=0)
    assert apart.max() < 1e-9
    assert found.leaving[0, 0] > 13 and found.leaving_periods[0, 0] == 2


def test_only_the_papers_release_has_openings():
    found = typed(cascade_of_flights)(FLIGHTS | {"restitution": [0.85]}, "force")
    for name in ("opening_amplitude", "stiff_opening"):
        assert np.isnan(found[name]).all()
    assert np.isfinite(found.threshold_amplitude).all()

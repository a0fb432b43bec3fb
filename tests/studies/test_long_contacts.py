"""Openings and basins as datasets."""

from functools import partial

import numpy as np
import pytest

from bouncing_ball.attractors.mapper import label
from bouncing_ball.configuration.study import typed
from bouncing_ball.studies import long_contacts
from bouncing_ball.studies.long_contacts import MOTIONS, basins, cascade_of_flights

FLIGHTS = {
    "restitution": [0.85, 0.65],
    "frequency_ratio": {"min": 1.2, "max": 100.0, "samples": 25},
    "flights": 2,
}
BASINS = {
    "n": [1, 2],
    "restitution": 0.85,
    "frequency_ratio": 2.0,
    "amplitude": [0.72, 0.9, 1.05],
    "velocity_max": 8.0,
    "starts": 40,
    "impacts": 40,
}


def test_openings_over_both_parameters(described):
    found = described(typed(cascade_of_flights)(FLIGHTS, "displacement"))
    assert found.opening_amplitude.dims == ("restitution", "flights", "frequency_ratio")
    # Each row is that of its r: Λ_SD at ϖ = 1.2 by another program, and the limits of E.
    assert float(found.threshold_amplitude[0, 0]) == pytest.approx(0.3175, abs=1e-4)
    excess = 100.0**2 * (found.opening_amplitude - found.threshold_amplitude).isel(
        frequency_ratio=-1
    )
    np.testing.assert_allclose(
        excess.transpose(*found.stiff_opening.dims), found.stiff_opening, rtol=0.02
    )
    # A compliant contact loses its stability first.
    assert np.isnan(found.opening_amplitude[..., 0]).all() and (found.opening_multiplier.max() < 1)
    assert found.joining_ratio.values == pytest.approx([2.003, 2.107], abs=1e-3)


def test_limits_are_those_of_the_papers_release():
    found = typed(cascade_of_flights)(FLIGHTS | {"restitution": [0.85]}, "force")
    for name in ("opening_amplitude", "stiff_opening", "joining_ratio"):
        assert np.isnan(found[name]).all()
    assert np.isfinite(found.threshold_amplitude).all()


def test_basins_of_one_contact(described):
    found = described(typed(basins)(BASINS, "displacement"))
    # The starts are the middles of even cells.
    assert [found.start_phase.mean(), found.start_speed.mean()] == pytest.approx([0, 4], abs=1e-12)
    shares = found.basin_share.values
    assert shares.sum(axis=1) == pytest.approx([1, 1, 1], abs=1e-15)
    permanent, short, long, longer, other = shares.T
    # Permanent contact below Λ_SD = 0.7518 only, the long contact above it.
    assert (permanent > 0).tolist() == [True, False, False]
    assert (long > 0).tolist() == [False, True, True]
    assert (short > 0.4).all() and (longer > 0.1).all()
    assert (other > 0.1).tolist() == [False, False, True]
    assert found.other_period.values.tolist() == [0, 0, 3]
    # The 1-T orbits lie in their own basins, and each has one.
    assert np.isnan(found.orbit_phase.isel(motion=[0, 3, 4])).all()
    for case in range(3):
        for kind, name in enumerate(MOTIONS[1:3], start=1):
            place = found.sel(case=case, motion=name)
            assert np.isfinite(place.orbit_phase) == (shares[case, kind] > 0)
            if shares[case, kind] > 0:
                near = found.destination.sel(case=case).sel(
                    start_phase=place.orbit_phase, start_speed=place.orbit_speed, method="nearest"
                )
                assert near.item() == kind


def test_balls_that_rise_when_they_are_given_up_have_no_period(monkeypatch):
    monkeypatch.setattr(long_contacts, "label", partial(label, impacts=60))
    parameters = {"n": [1, 10], "restitution": 0.5707358288321754, "starts": 119, "impacts": 10}
    parameters |= {"frequency_ratio": 24.11573489959817, "amplitude": [8.614520580887136]}
    found = typed(basins)({**parameters, "velocity_max": 0.12824839560054857}, "force")
    assert found.other_period.values.tolist() == [0]

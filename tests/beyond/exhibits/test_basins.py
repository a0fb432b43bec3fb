"""Basins of three models against the stable orbits, and against each other for a stiff contact."""

import numpy as np
import pytest

from bouncing_ball.beyond.exhibits.basins import MOTIONS, BasinStarts, basins
from bouncing_ball.beyond.exhibits.motion_samples import three_models
from bouncing_ball.models.damping import Release
from bouncing_ball.periodic.one_impact import n_t
from bouncing_ball.pipeline.configuration import typed

CASE = {"restitution": 0.5, "frequency_ratio": 1e5, "amplitude": 1.3}
SIZES = {"velocity_max": 6.0, "starts": 24, "random": 60, "shifts": [0.1, 0.01], "impacts": 200}


@pytest.fixture(scope="module")
def data():
    return typed(basins)({"cases": [CASE], "confidence": 0.95, "seed": 3, **SIZES}, "displacement")


def test_a_stable_orbit_lies_in_its_basin(data):
    for k, model in enumerate(three_models(np.array(0.5), 1e5, Release.DISPLACEMENT)):
        orbit = n_t.orbit(model, 1, 1.3)
        place = {"start_phase": orbit.phase, "start_speed": -orbit.relative_impact_velocity}
        end = data.destination.isel(case=0, model=k).sel(place, method="nearest")
        assert MOTIONS[int(end)] == "1-T orbit"


def test_a_stiff_contact_has_the_restitution_models_basins(data):
    image = data.destination.isel(case=0)
    # A boundary moves by some units of 1/ϖ, of which a cell is a thousand.
    assert (image != image.isel(model=0)).mean() < 0.01
    assert data.basin_share.sum("motion").values == pytest.approx(np.ones((1, 3)))
    assert np.all(data.basin_share_low <= data.basin_share)
    assert np.all(
        data.uncertain_share.isel(change_of_phase=0) >= data.uncertain_share.isel(change_of_phase=1)
    )


def test_the_starts_of_the_picture_are_the_middles_of_its_cells():
    given = {"cases": [CASE], "confidence": 0.95, "seed": 3, **SIZES, "starts": 12}
    phase, speed = BasinStarts(**given).grid()
    # Cells of π/6 from -π to π, and of 1/2 from 0 to 6.
    np.testing.assert_allclose(phase, -np.pi + np.pi / 12 + np.pi / 6 * np.arange(12), atol=1e-15)
    np.testing.assert_allclose(speed, 0.25 + 0.5 * np.arange(12), rtol=1e-15)

"""Orbit diagrams, against the stable orbit and its multiplier."""

import numpy as np
import xarray as xr

from bouncing_ball.beyond.exhibits.motion_samples import three_models
from bouncing_ball.beyond.exhibits.orbit_diagram import orbit_diagrams
from bouncing_ball.models.damping import Release
from bouncing_ball.periodic.one_impact import n_t
from bouncing_ball.pipeline.configuration import typed


def test_diagrams_have_the_stable_orbit_with_its_phase_and_exponent():
    grid = {"min": 1.1, "max": 1.2, "samples": 2}
    given = {"restitution": 0.6, "frequency_ratio": 100.0, "amplitude": grid, "bins": 20}
    sizes = {"starts": 1, "samples": 10, "impacts": 200}
    data = typed(orbit_diagrams)(given | sizes, Release.DISPLACEMENT)
    assert np.allclose(data.phase_density.sum("bin_phase"), 1)
    for k, model in enumerate(three_models(np.array(0.6), 100.0, Release.DISPLACEMENT)):
        one = data.isel(model=k)
        orbit = n_t.orbit(model, 1, data["amplitude"].values)
        here = one.phase_density.sel(
            bin_phase=xr.DataArray(orbit.phase, dims="x"), method="nearest"
        )
        assert np.all(np.diag(here) > 0)
        # Every other motion there is locked, and attracts more strongly.
        modulus = np.abs(orbit.multipliers()).max(axis=-1)
        assert np.allclose(one.lyapunov_exponent, np.log(modulus), atol=1e-5)

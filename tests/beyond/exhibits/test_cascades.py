"""The study of cascades, against the closed law of the first doubling's error."""

import numpy as np
import pytest
from pydantic import create_model

from bouncing_ball.accuracy.error_law import coefficients
from bouncing_ball.beyond.exhibits import cascades_figures
from bouncing_ball.beyond.exhibits.cascades import Cascades, cascades
from bouncing_ball.models.damping import LINEAR, Release, damping_ratio
from bouncing_ball.pipeline.configuration import check_parameters, typed
from bouncing_ball.pipeline.yaml_files import ConfigurationError

R = [0.5, 0.85]
STIFF = {"min": 500.0, "max": 1000.0, "samples": 2}
# Ω² = 1 g/m.
TEXTBOOK = {"frequency": 9.80665**0.5 / (2 * np.pi), "amplitudes": [0.5]}
CONFIG = {"n": 1, "restitution": R, "frequency_ratio": STIFF, "doublings": 3, "textbook": TEXTBOOK}


@pytest.fixture(scope="module", params=LINEAR)
def study(request):
    return request.param, typed(cascades)(CONFIG, request.param)


def test_k_of_the_first_doubling_is_that_of_the_error_law(study):
    """Measured on orbits here, and there a closed form."""
    release, data = study
    assert np.allclose(data.textbook_cascade, [0.5, np.nan, np.nan], equal_nan=True)
    law = coefficients(1, damping_ratio(np.array(R)), data.restitution_cascade[:, 0], release)
    # Of the error's expansion the third order is left, over the two ϖ.
    assert np.allclose(data.cascade_coefficient[:, 0], law["period_doubling"], rtol=1e-4)


def test_errors_tend_to_the_two_laws(study):
    _, data = study
    error = data.cascade_error
    ratio = data.frequency_ratio
    missed = error.sel(model="restitution") * ratio - data.cascade_coefficient
    # The next order is one of 1/ϖ: twice as stiff a contact misses half as much.
    halves = missed.isel(frequency_ratio=0) / missed.isel(frequency_ratio=1)
    assert np.allclose(halves, 2, atol=0.1)
    # The corrected model's third order may nearly vanish; at ϖ = 500 it is below one per cent.
    left = error.sel(model="corrected") * ratio**2 / data.cascade_second_order - 1
    assert np.all(np.abs(left) < 0.01)


def test_a_contact_keeps_the_ratio_of_the_doublings(study):
    _, data = study
    shift = data.contact_cascade_ratio / data.cascade_ratio - 1
    assert np.all(shift != 0) and np.max(np.abs(shift)) < 1e-2
    assert np.allclose(shift.isel(frequency_ratio=0) / shift.isel(frequency_ratio=1), 2, atol=0.05)


def test_a_doubling_that_is_not_found_does_not_affect_the_others():
    """At ϖ = 0.8 the first doubling lies at Λ < 1, where a ball that leaves the orbit rests."""
    span = {"min": 0.8, "max": 8.0, "samples": 2}
    changed = {"restitution": [0.05, 0.94], "frequency_ratio": span, "doublings": 5}
    data = typed(cascades)(CONFIG | changed, Release.DISPLACEMENT)
    assert np.all(np.isfinite(data.cascade_error).sum("doubling") == [1, 5])


def test_a_single_frequency_ratio_with_orbits_is_drawn_as_dots(study):
    _, data = study
    stiffest = data.frequency_ratio == data.frequency_ratio[-1]
    single = data.assign(
        cascade_error=data.cascade_error.where(stiffest),
        cascade_zero=data.cascade_zero.where(False),
    )
    figure = cascades_figures.cascades(single.assign_attrs(n=1))
    dots = [line for line in figure.axes[0].lines if line.get_marker() == "."]
    assert all(np.isfinite(line.get_ydata()).sum() == 1 for line in dots)


def test_more_doublings_of_a_textbook_than_are_computed_are_refused(refusal):
    textbook = {"frequency": 60.0, "amplitudes": [1e-4, 1.1e-4, 1.2e-4, 1.3e-4]}
    ratios = {"min": 2.0, "max": 20.0, "samples": 2}
    given = {"n": 1, "restitution": [0.5], "frequency_ratio": ratios, "textbook": textbook}
    run = create_model("Run", fig=(Cascades, ...))
    text = "textbook.amplitudes has 4 values, more than doublings = 3"
    with refusal(ConfigurationError, text):
        check_parameters(run, {"fig": given | {"doublings": 3}})

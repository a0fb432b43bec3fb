"""Figure 11: permanent contact along ϖ."""

import numpy as np
import pytest

from bouncing_ball.paper.exhibits.permanent_contact import permanent_contact
from bouncing_ball.pipeline.configuration import typed

permanent_contact = typed(permanent_contact)

PARAMETERS = {"restitution": 0.65, "frequency_ratio": {"min": 0.5, "max": 100.0, "samples": 201}}


def test_the_minimum_is_the_lowest_threshold_and_that_of_eq_36(described):
    data = described(permanent_contact(PARAMETERS, "displacement"))
    zeta = float(data.damping_ratio)
    omega = data.frequency_ratio.values
    assert zeta == pytest.approx(0.13585, abs=5e-6)
    gamma = (omega**2 - 1) ** 2 + (2 * zeta * omega) ** 2
    assert data.threshold_amplitude.values == pytest.approx(np.sqrt(gamma) / omega**2, rel=1e-13)
    assert float(data.minimum_threshold) == pytest.approx(
        2 * zeta * np.sqrt(1 - zeta**2), rel=1e-14
    )
    assert float(data.minimum_frequency_ratio) == pytest.approx(
        1 / np.sqrt(1 - 2 * zeta**2), rel=1e-14
    )
    assert float(data.threshold_amplitude.min()) >= float(data.minimum_threshold)
    assert float(data.restitution_threshold) == 1.0


def test_the_force_release_lifts_off_earlier(described):
    paper = permanent_contact(PARAMETERS, "displacement")
    dry = described(permanent_contact(PARAMETERS, "force"))
    assert np.all(dry.threshold_amplitude < paper.threshold_amplitude)
    assert float(dry.threshold_amplitude.min()) >= float(dry.minimum_threshold)

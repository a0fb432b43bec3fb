"""Figure 11: permanent contact along ϖ."""

import numpy as np
import pytest

from bouncing_ball.paper.exhibits import permanent_contact_figures
from bouncing_ball.paper.exhibits.permanent_contact import permanent_contact
from bouncing_ball.pipeline.job import typed

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


# The axis of the paper, and one below and one above the resonance; others weekly.
SELDOM = [pytest.param(*x, marks=pytest.mark.long) for x in ((0.1, 10.0), (0.1, 100.0))]


@pytest.mark.parametrize(("low", "high"), [(0.5, 100.0), (0.1, 1.0), (3.0, 30.0), *SELDOM])
@pytest.mark.parametrize(
    "restitution", [0.65, *(pytest.param(r, marks=pytest.mark.long) for r in (0.5, 0.85))]
)
def test_each_region_has_its_name_inside(low, high, restitution):
    span = {"min": low, "max": high, "samples": 401}
    data = permanent_contact({"restitution": restitution, "frequency_ratio": span}, "displacement")
    data.attrs["restitution"] = restitution
    figure = permanent_contact_figures.permanent_contact(data)
    figure.draw_without_rendering()
    (axes,) = figure.axes
    names = {" ".join(text.get_text().split()): text for text in axes.texts}
    for name, sign in (("permanent contact", 1), ("the ball leaves the table", -1)):
        box = names[name].get_window_extent().transformed(axes.transData.inverted())
        assert low <= box.x0 < box.x1 <= high
        assert 0 <= box.y0 < box.y1 <= 2
        beside = data.sel(frequency_ratio=slice(box.x0, box.x1)).threshold_amplitude
        edge = box.y1 if sign > 0 else box.y0
        assert (sign * (beside - edge) > 0).all(), name

"""How stiff a contact must be for the restitution model to be right."""

import numpy as np
import pytest

from bouncing_ball.accuracy.errors import Quantity, modulus, relative_errors
from bouncing_ball.accuracy.thresholds import ThresholdStatus
from bouncing_ball.errors import NoOrbitError
from bouncing_ball.models.damping import Release, damping_ratio
from bouncing_ball.models.restitution import RestitutionModel
from bouncing_ball.models.spring_damper import SpringDamper
from bouncing_ball.paper.exhibits.error_thresholds import error_thresholds, height_error
from bouncing_ball.paper.exhibits.permanent_contact import permanent_contact_error
from bouncing_ball.periodic.explicit import explicit_branch
from bouncing_ball.periodic.orbit import Bifurcation
from bouncing_ball.pipeline.job import typed

PARAMETERS = {
    "n": 1,
    "restitution": 0.65,
    "amplitude": 1.0,
    "quantities": [str(q) for q in Quantity],
    "tolerances": [0.1, 0.01],
    "frequency_ratio": {"min": 1.0, "max": 1e4, "samples": 81},
}


@pytest.fixture(scope="module")
def of_the_paper():
    """The thresholds of all quantities under the release of the paper."""
    return typed(error_thresholds)(PARAMETERS, "displacement")


def test_the_height_is_within_one_percent_above_82(described):
    # Eq. 37, Figure 14: n = 1, r = 0.65, Λ = 1; printed "≈ 82".
    parameters = {key: PARAMETERS[key] for key in ("n", "restitution", "amplitude")}
    parameters |= {"frequency_ratio": {"min": 1.0, "max": 1000.0, "samples": 31}, "tolerance": 0.01}
    data = described(typed(height_error)(parameters, "displacement"))
    assert data.error_threshold.item() == pytest.approx(82.177, abs=5e-4)
    assert data.threshold_status.item() == str(ThresholdStatus.FOUND)
    reference = np.pi**2 / 2 + np.sqrt(1 - (np.pi * 0.35 / 1.65) ** 2)
    assert float(data.restitution_max_height) == pytest.approx(reference, rel=1e-14)
    expected = np.abs(data.max_height / reference - 1)
    np.testing.assert_allclose(data.relative_error, expected, rtol=1e-9)


def test_contacts_of_which_none_has_an_orbit_are_refused(refusal):
    parameters = {key: PARAMETERS[key] for key in ("n", "restitution", "amplitude")}
    parameters |= {"frequency_ratio": {"min": 0.1, "max": 0.2, "samples": 11}, "tolerance": 0.01}
    with refusal(NoOrbitError, "no 1-T orbit at Λ = 1 for any ϖ from 0.1 to 0.2"):
        typed(height_error)(parameters, "displacement")


def test_the_threshold_of_permanent_contact_is_within_one_percent_above_9_81(described):
    # Eq. 38, Figure 16; printed "≈ 6".
    span = {"min": 0.5, "max": 100.0, "samples": 101}
    parameters = {"restitution": 0.65, "frequency_ratio": span, "tolerance": 0.01}
    data = described(typed(permanent_contact_error)(parameters, "displacement"))
    ratio = data.error_threshold.item()
    assert ratio == pytest.approx(9.81177, abs=5e-6)
    # Λ_SD of Eq. 35, 1 % below the restitution model's Λ = 1.
    gamma = (ratio**2 - 1) ** 2 + (2 * float(damping_ratio(0.65)) * ratio) ** 2
    assert np.sqrt(gamma) / ratio**2 == pytest.approx(0.99, rel=1e-12)


def test_beyond_its_threshold_each_error_is_within_the_tolerance(described, of_the_paper):
    data = described(of_the_paper)
    assert data.relative_error.dims == ("quantity", "frequency_ratio")
    assert data.error_threshold.dims == ("quantity", "tolerance")
    assert data["quantity"].values.tolist() == PARAMETERS["quantities"]
    # With the r and the ζ of Eq. 16, exact over restitution model.
    contact = SpringDamper(data.frequency_ratio.values, float(damping_ratio(0.65)))
    simple = RestitutionModel(0.65)
    expected = modulus(relative_errors(contact, simple, 1, 1.0, tuple(Quantity)))
    np.testing.assert_allclose(data.relative_error, expected, rtol=1e-9)
    for k, tolerance in enumerate(PARAMETERS["tolerances"]):
        one = data.isel(tolerance=k)
        beyond = one.relative_error.where(data.frequency_ratio > one.error_threshold.fillna(0))
        assert float(beyond.max()) <= tolerance


def test_under_the_force_release_the_restitution_never_comes_within_one_percent(of_the_paper):
    dry = typed(error_thresholds)(PARAMETERS, "force")
    # A contact released at zero force keeps more velocity than Eq. 16 says: r_a
    # never comes within 1 % of r.
    at = {"quantity": "apparent_restitution"}
    assert str(dry.threshold_status.sel(at)[1].values) == ThresholdStatus.NEVER_WITHIN
    assert str(of_the_paper.threshold_status.sel(at)[1].values) == ThresholdStatus.FOUND
    contact = SpringDamper(1e4, float(damping_ratio(0.65)), Release.FORCE)
    expected = float(explicit_branch(contact).orbit(1, 1.0).apparent_restitution) / 0.65 - 1
    assert float(dry.relative_error.sel(at)[-1]) == pytest.approx(expected, rel=1e-9)


def test_a_threshold_at_the_end_of_the_bifurcation():
    # r = 0.0893 and 1-T: contacts have a saddle-node from ϖ = 3.6 on only.
    span = {"min": 1.0, "max": 1e4, "samples": 101}
    one = {"n": 1, "restitution": 0.0893, "amplitude": 3.0, "frequency_ratio": span}
    asked = {"quantities": ["saddle_node"], "tolerances": [0.5]}
    data = typed(error_thresholds)(one | asked, "displacement")
    assert data.threshold_status.item() == ThresholdStatus.FOUND
    threshold = data.error_threshold.item()
    # A scan, and both sides of the threshold.
    ratios = np.geomspace(1.0, 10.0, 201)
    ratios = np.append(ratios, [threshold * (1 - 5e-5), threshold * (1 + 5e-5)])
    branch = explicit_branch(SpringDamper.from_restitution(0.0893, ratios))
    there = branch.bifurcation(Bifurcation.SADDLE_NODE, 1).exists
    assert np.array_equal(there, ratios > threshold)
    assert np.array_equal(np.isinf(data.relative_error[0]), data.frequency_ratio < threshold)

"""What the rule that ends a contact changes."""

import numpy as np
import pytest

from bouncing_ball.models.contact import Contact, Release
from bouncing_ball.models.damping import damping_ratio
from bouncing_ball.orbits.closed_form import branch_point
from bouncing_ball.orbits.limits import period_doubling, saddle_node
from bouncing_ball.studies.error_thresholds import Quantity, Status, relative_error
from bouncing_ball.studies.release_rules import READINGS, release_rules

PARAMETERS = {
    "n": [1, 2],
    "restitution": 0.85,
    "frequency_ratio": {"min": 2.0, "max": 1e3, "samples": 4},
    "thresholds": {
        "n": 1,
        "restitution": 0.65,
        "amplitude": 1.0,
        "tolerance": 0.01,
        "quantities": ["max_height", "apparent_restitution"],
        "frequency_ratio": {"min": 1.0, "max": 1e4, "samples": 61},
    },
}


def test_release_rules(described):
    data = described(release_rules(PARAMETERS))
    zeta = float(damping_ratio(0.85))
    for rule in Release:
        for n in (1, 2):
            for omega in data.frequency_ratio.values:
                contact = Contact(omega, zeta, rule)
                expected = [
                    float(branch_point(find(contact, n), contact, n).amplitude)
                    for find in (saddle_node, period_doubling)
                ]
                found = data.bifurcation_amplitude.sel(
                    release=str(rule), n=n, frequency_ratio=omega
                ).values
                # Scalars against arrays: the roundings of a root.
                assert found == pytest.approx(expected, abs=1e-13)
    # A contact released at zero force returns more: its orbits appear earlier.
    nodes = data.bifurcation_amplitude.sel(bound="saddle-node")
    assert np.all(nodes.sel(release="force") < nodes.sel(release="displacement"))
    # By hand: exp(-ζ (π - 2 arcsin ζ)/√(1 - ζ²)) for the ζ of r = 0.65.
    loss = float(damping_ratio(0.65))
    own = np.exp(-loss * (np.pi - 2 * np.arcsin(loss)) / np.sqrt(1 - loss**2))
    assert float(data.force_restitution) == pytest.approx(own, rel=1e-13)
    heights = data.error_threshold.sel(quantity="max_height").values
    assert heights[0] == pytest.approx(82.177, abs=5e-4)
    # On each threshold found the error is one percent.
    references = (0.65, 0.65, own)
    for i, ((rule, _), r) in enumerate(zip(READINGS, references, strict=True)):
        for quantity in PARAMETERS["thresholds"]["quantities"]:
            ratio = float(data.error_threshold.sel(quantity=quantity)[i])
            status = str(data.threshold_status.sel(quantity=quantity)[i].values)
            if np.isnan(ratio):
                assert status in (Status.NEVER_WITHIN, Status.ALWAYS_WITHIN)
                continue
            error = relative_error(
                Quantity(quantity), 1, r, 1.0, np.array([ratio]), rule, damping=loss
            )
            assert status == Status.FOUND
            assert float(error[0]) == pytest.approx(0.01, rel=1e-9)
    # Compared with the wrong r, r_a never agrees; with its own it does.
    statuses = data.threshold_status.sel(quantity="apparent_restitution").values.tolist()
    assert statuses == [Status.FOUND, Status.NEVER_WITHIN, Status.FOUND]

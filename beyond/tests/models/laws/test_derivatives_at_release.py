"""The derivatives of a contact's end are as accurate as the end itself."""

import runpy
from pathlib import Path

import numpy as np

from bouncing_ball_beyond.models.laws.collocation import contacts

OWN = Path(__file__).parents[2] / "contracts" / "hardening_spring.py"


def test_contacts_of_hardening_springs_contract_areas_by_their_damping():
    """The flow contracts areas by exp(-C D), because ∂f/∂p′ = C everywhere."""
    rng = np.random.default_rng(3)
    size = 600
    stiffness = 10 ** rng.uniform(0, 4, size)
    hardening = 10 ** rng.uniform(-1, 7, size)
    damping = rng.uniform(0, 0.6, size) * np.sqrt(stiffness)
    law = runpy.run_path(str(OWN))["HardeningSpring"](stiffness, hardening, damping)
    speed = 10 ** rng.uniform(-0.5, 1, size)
    phase = rng.uniform(-np.pi, np.pi, size)
    ends = contacts(law, speed, phase, 10 ** rng.uniform(-2, -0.5, size))
    jacobian = ends.jacobian
    # ∂(φ + D, p′)/∂(φ, v) is the contraction times v over the speed at release.
    later = 1 + jacobian[:, 0, 0]
    found = later * jacobian[:, 2, 1] - jacobian[:, 0, 1] * jacobian[:, 2, 0]
    missed = np.abs(-found * ends.rate / speed) - np.exp(-damping * ends.duration)
    known = np.isfinite(ends.duration)
    assert known.mean() > 0.9
    # 1e-12 is the error that the collocation promises; the extrapolation of the force to the
    # release had 4e-10.
    assert np.abs(missed[known]).max() < 1e-12

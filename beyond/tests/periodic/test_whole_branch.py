"""Whole branches of n-T orbits, and why there is none."""

import numpy as np
import pytest

import bouncing_ball_beyond
from bouncing_ball_beyond.inherited.errors import NoOrbitError
from bouncing_ball_beyond.models.contact_model import ContactModel
from bouncing_ball_beyond.models.spring_damper import SpringDamper
from bouncing_ball_beyond.periodic.one_impact.whole_branch import whole_branch
from bouncing_ball_beyond.periodic.orbits import ends


@pytest.mark.parametrize(
    ("ratio", "n", "why"),
    [(1.5, 2, "the branch begins at Λ = 0.99476"), (0.5, 1, "was found to start from")],
)
def test_without_an_orbit_to_start_from_it_says_why(ratio, n, why, refusal):
    model = ContactModel(SpringDamper.from_restitution(0.7, ratio))
    with refusal(NoOrbitError, f"no {n}-T orbit up to Λ = 0.6", why):
        whole_branch(model, n, 0.6)


def test_a_branch_is_kept_where_a_doubling_is_announced_next_to_its_end():
    """Without damping all multipliers tend to -1 at permanent contact, at Λ = |ϖ² - 1|/ϖ² = 3, and
    rounding errors decide whether a doubling is announced, which cannot be located. Λ - 3 is
    3 T²/8 for a flight of T.
    """
    ball = bouncing_ball_beyond.spring_damper(restitution=1.0, frequency_ratio=0.5)
    found = bouncing_ball_beyond.branch(ball, n=1, points=30)
    lost, reached = (str(reason) for reason in found.end_reason.values)
    merges = "the flight vanishes: the orbit merges with permanent contact"
    assert lost == merges or (
        lost.startswith(f"{merges}; ") and lost.endswith("could not be located")
    )
    assert reached == "amplitude = 4.2 is reached"
    assert found.special_kind.size == 0
    flight = 2 * np.pi - float(found.contact_duration[0])
    assert flight < ends.CLOSE
    assert float(found.amplitude[0]) - 3.0 == pytest.approx(3 * flight**2 / 8, rel=ends.CLOSE)
    assert float(found.residual.max()) < 1e-11


@pytest.mark.parametrize("points", [30, 300])
def test_a_branch_that_merges_with_a_ringing_contact_is_resampled(points):
    """At ϖ = 1/2 without damping the contact rings with the period 4π. The 2-T branch merges with
    such a motion at Λ = 1; the speed of its impact is the cube of the flight time there, and
    rounding errors move its points by 1e-10 along the branch.
    """
    ball = bouncing_ball_beyond.spring_damper(restitution=1.0, frequency_ratio=0.5)
    found = bouncing_ball_beyond.branch(ball, n=2, points=points)
    why = str(found.end_reason.values[0])
    assert why == "the flight vanishes: the orbit merges with permanent contact"
    aloft = 4 * np.pi - found.contact_duration.values[:4]
    closing = found.impact_velocity.values - found.amplitude.values * np.cos(found.phase.values)
    slopes = np.diff(np.log(-closing[:4])) / np.diff(np.log(aloft))
    assert slopes == pytest.approx(np.full(3, 3.0), abs=0.1)
    assert 1 < float(found.amplitude[0]) < 1 + aloft[0] ** 2
    assert float(found.residual.max()) < 1e-11

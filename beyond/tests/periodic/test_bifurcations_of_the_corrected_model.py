"""The closed form of the corrected model's bifurcations, by the multipliers of its map."""

import numpy as np
import pytest

import bouncing_ball_beyond as bb

BALLS = [(0.6, 8.0, "displacement"), (0.85, 2.5, "displacement"), (0.5, 5.0, "force")]


@pytest.mark.parametrize(("restitution", "ratio", "release"), BALLS)
@pytest.mark.parametrize("n", [1, 2])
def test_a_multiplier_is_one_at_the_saddle_node_and_minus_one_at_the_doubling(
    restitution, ratio, release, n
):
    contact = bb.spring_damper(restitution=restitution, frequency_ratio=ratio, release=release)
    ends = bb.limits(bb.corrected(contact), n=n)
    for orbit, at, near in (
        # Λ is flat at the saddle-node, so that its rounding moves the multiplier by its root.
        (ends.saddle_node, 1.0, 1e-6),
        (ends.period_doubling, -1.0, 1e-11),
    ):
        distance = np.abs(np.asarray(orbit.multipliers()) - at)
        assert distance.min() < near

"""Histories of balls that come to lie on a contact that is computed by collocation."""

import numpy as np
import pytest

import bouncing_ball_beyond as bb
from bouncing_ball_beyond.inherited.errors import ModelError


def on_contact(stiffness, damping):
    return bb.contact_law("kuwabara-kono", stiffness=stiffness, damping=damping)


@pytest.mark.parametrize(("stiffness", "damping"), [(6.2e5, 0.031), (6.2e5, 0.0031)])
def test_a_dropped_ball_lies_on_its_contact_to_the_last_sample(stiffness, damping):
    found = bb.drop(on_contact(stiffness, damping), height=10.0, samples=40)
    # K p^{3/2} = 1.
    rest = stiffness ** (-2 / 3)
    assert found.ball.notnull().all()
    assert float(found.ball[-1]) == pytest.approx(-rest, rel=1e-12)
    assert abs(float(found.ball_velocity[-1])) < 1e-12 and bool(found.contact[-1])


def test_a_ball_that_lies_on_a_moving_table_moves_with_it():
    found = bb.drop(on_contact(6.2e5, 0.031), height=10.0, amplitude=0.5, periods=4.0, samples=40)
    later = found.sel(time=slice(15.0, None))
    # It lies at p with K p^{3/2} = 1 - Λ sin τ, within its inertia p″ ~ p and the delay C p′.
    depth = ((1 - later.table) / 6.2e5) ** (2 / 3)
    assert np.abs(later.table - later.ball - depth).max() < 0.03 * depth.mean()
    # The motion repeats after a period.
    np.testing.assert_allclose(found.ball[-41], found.ball[-1], rtol=0, atol=1e-12)


def test_a_motion_that_takes_too_long_is_refused(refusal):
    with refusal(ModelError, "fewer periods"):
        bb.drop(on_contact(6.2e5, 0.031), height=10.0, amplitude=0.5, periods=2000.0, samples=1)

"""Free impacts: impulse against restitution, and the duration from the phase of the motion."""

import numpy as np
import pytest
from scipy.integrate import simpson

from bouncing_ball_beyond.exhibits.release_rules import free_impacts
from bouncing_ball_beyond.inherited.pipeline.job import typed

DATA = typed(free_impacts)({"restitution": 0.4, "restitution_min": 0.2, "samples": 2001})


@pytest.mark.parametrize("release", ["displacement", "force"])
def test_the_impulse_is_the_change_of_momentum(release):
    one = DATA.sel(release=release)
    # The force vanishes at the end of the force release, so that what is cut off is linear there.
    load = DATA.free_force.clip(min=0) if release == "force" else DATA.free_force
    impulse = simpson(load, x=DATA.time)
    assert impulse == pytest.approx(1 + float(one.end_restitution), abs=1e-6)
    if release == "displacement":
        assert float(one.end_restitution) == pytest.approx(0.4)
        assert one.contact_end == DATA.time[-1]


def test_restitution_and_duration_are_those_of_a_decaying_sine():
    zeta, r, angle = (
        DATA[name].values for name in ("damping_ratio", "restitution", "contact_duration")
    )
    # At the end of either release the decay is e^{-ζ ωt}.
    assert np.allclose(r, np.exp(-zeta * angle), rtol=1e-13)
    turned = np.sqrt(1 - zeta**2) * angle
    assert np.allclose(turned[0], np.pi) and np.allclose(np.cos(turned[1] / 2), zeta)
    assert r[0, -1] == pytest.approx(0.2)

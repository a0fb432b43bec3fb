"""Histories on contacts of any law: against the closed form, and across every event."""

import numpy as np
import pytest

from bouncing_ball.contacts.laws.hunt_crossley import HuntCrossley
from bouncing_ball.contacts.laws.kuwabara_kono import KuwabaraKono
from bouncing_ball.contacts.laws.linear import Linear
from bouncing_ball.contacts.laws.tsuji import Tsuji
from bouncing_ball.contacts.spring_damper import SpringDamper
from bouncing_ball.motion import contacts as closed_form
from bouncing_ball.motion.history import history
from bouncing_ball.motion.law_impacts import simulate


@pytest.mark.parametrize("release", ["displacement", "force"])
def test_the_linear_law_has_the_history_of_the_closed_form(release):
    # The ball chatters at first, which resumes contacts below the level with the force release.
    start = 1.2, 0.4, -1.0, 6
    exact = closed_form.simulate(SpringDamper(20.0, 0.13, release), *start)
    time = np.linspace(0, float(exact.time[-1]), 4001)
    expected = history(exact, time)
    computed = history(simulate(Linear(20.0, 0.13, release), *start), time)
    # Samples next to an event may fall on its other side.
    same = expected.touching == computed.touching
    assert np.count_nonzero(~same) <= 2 * exact.time.size
    for name in ("height", "gap"):
        np.testing.assert_allclose(
            getattr(computed, name)[same], getattr(expected, name)[same], atol=1e-9
        )


@pytest.mark.parametrize(
    "law", [HuntCrossley(4e3, 0.08), Tsuji(4e3, 0.3), KuwabaraKono(4e3, 0.005)]
)
def test_a_history_is_continuous_and_obeys_the_law(law):
    sequence = simulate(law, 1.0, 0.7, -3.0, 3)
    release = sequence.time[:2] + sequence.contact_duration[:2]
    for event in (*sequence.time[1:], *release):
        around = history(sequence, event + np.array([-1e-9, 1e-9]))
        # Twice 1e-9 of a speed of 4, and the path's own digits.
        assert abs(np.diff(around.gap)[0]) < 2e-8
    time = np.linspace(0.1, 0.9, 9) * float(sequence.contact_duration[0])
    h = 1e-5
    now, ahead, behind = (history(sequence, time + shift) for shift in (0, h, -h))
    assert now.touching.all() and np.all(now.gap < 0)
    table_rate = np.cos(0.7 + time)
    force = law.force(-now.gap, -(now.velocity - table_rate))
    acceleration = (ahead.velocity - behind.velocity) / (2 * h)
    # Differences of second order: h²/6 times a third derivative of some 1e5.
    np.testing.assert_allclose(acceleration, force - 1, atol=1e-4)
    flying = history(sequence, 0.5 * (release[0] + sequence.time[1]))
    assert not flying.touching and flying.gap > 0

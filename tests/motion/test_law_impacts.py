"""Simulation with any contact law: against the closed form and the collocation."""

import numpy as np
import pytest

from bouncing_ball.contacts.collocation import contacts
from bouncing_ball.contacts.laws.hunt_crossley import HuntCrossley
from bouncing_ball.contacts.laws.kuwabara_kono import KuwabaraKono
from bouncing_ball.contacts.laws.linear import Linear
from bouncing_ball.contacts.laws.tsuji import Tsuji
from bouncing_ball.contacts.spring_damper import SpringDamper
from bouncing_ball.errors import ModelError
from bouncing_ball.motion import contacts as closed_form
from bouncing_ball.motion.law_impacts import law_cycle, simulate
from bouncing_ball.motion.law_motion import Touch, release
from bouncing_ball.motion.law_table import ReleaseTable
from bouncing_ball.motion.sequence import Status

LAWS = [HuntCrossley(4e3, 0.08), Tsuji(4e3, 0.3), KuwabaraKono(4e3, 0.005)]
every_law = pytest.mark.parametrize("law", LAWS, ids=[law.name for law in LAWS])


@pytest.mark.parametrize("release", ["displacement", "force"])
def test_the_linear_law_is_the_closed_form(release):
    # Grazing and long contacts, and contacts that resume below the level, included.
    rng = np.random.default_rng(0)
    phase, velocity = rng.uniform(-3, 3, 400), -rng.uniform(2, 6, 400)
    exact = closed_form.simulate(SpringDamper(20.0, 0.13, release), 1.5, phase, velocity, 4)
    computed = simulate(Linear(20.0, 0.13, release), 1.5, phase, velocity, 4)
    for name in ("time", "relative_velocity", "contact_duration", "displacement"):
        a, b = getattr(exact, name), getattr(computed, name)
        assert np.array_equal(np.isfinite(a), np.isfinite(b))
        # The tolerance of a step, 1e-12 of the velocity, times what impacts multiply
        # differences by; grazing ones by hundreds.
        assert np.nanmedian(np.abs(a - b)) < 1e-11
        assert np.nanmax(np.abs(a - b)) < 1e-8


@every_law
def test_a_contact_is_that_of_the_collocation(law):
    rng = np.random.default_rng(1)
    phase, velocity = rng.uniform(-3, 3, 200), -rng.uniform(2, 6, 200)
    sequence = simulate(law, 1.0, phase, velocity, 1)
    end = contacts(law, -sequence.relative_velocity[0], phase, 1.0)
    for computed, expected in (
        (sequence.contact_duration[0], end.duration),
        (-sequence.release_displacement[0], end.penetration),
        (-sequence.relative_release_velocity[0], end.rate),
    ):
        np.testing.assert_allclose(computed, expected, rtol=0, atol=2e-11)


@every_law
def test_an_interpolated_contact_is_that_of_the_collocation(law):
    rng = np.random.default_rng(2)
    size = 6000
    speed, phase = rng.uniform(3, 4, size), rng.uniform(0, 1, size)
    table = ReleaseTable(law, 1.0)
    touch = Touch(np.zeros(size), speed, phase, 1.0)
    found = table.release(touch)
    known = [cell for cell, coefficients in table.cells.items() if coefficients is not None]
    assert len(known) == len(table.cells) > 0
    some = slice(0, 200)
    end = contacts(law, speed[some], phase[some], 1.0)
    # What the last coefficients may leave, and the integration of the nodes.
    np.testing.assert_allclose(found.duration[some], end.duration, rtol=3e-12)
    np.testing.assert_allclose(found.rate[some], end.rate, rtol=3e-12)
    np.testing.assert_allclose(found.depth[some], end.penetration, rtol=0, atol=1e-13)


def test_a_cell_with_two_kinds_of_contact_is_quartered():
    # Λ = 1 at φ = π/2 presses the ball only later: some stay for a good part of the cycle.
    law = LAWS[1]
    rng = np.random.default_rng(3)
    speed, phase = rng.uniform(0.05, 0.1, 3000), rng.uniform(1.6, 2.3, 3000)
    table = ReleaseTable(law, 1.0)
    touch = Touch(np.zeros(3000), speed, phase, 1.0)
    found = table.release(touch)
    assert any(coefficients is None for coefficients in table.cells.values())
    assert max(cell.level for cell in table.cells) > 0
    alone = release(law, touch)
    assert not found.undecided.any()
    # Long contacts multiply the integration's own error.
    np.testing.assert_allclose(found.duration, alone.duration, rtol=1e-9)


@every_law
def test_a_ball_on_a_table_at_rest_comes_to_rest(law):
    sequence = simulate(law, 0.0, 0.0, -2.0, 200)
    assert sequence.status == Status.UNDECIDED
    speed = -sequence.relative_velocity[np.isfinite(sequence.time)]
    assert np.all(np.diff(speed) < 0)


@every_law
def test_a_ball_laid_on_the_table_leaves_it(law):
    # From rest at the table's level it sinks in, and swings back out.
    sequence = simulate(law, 1.5, 0.0, 1.5, 3)
    assert np.all(np.isfinite(sequence.time))
    assert 0 < sequence.release_phase[0] < np.pi


def test_many_balls_are_each_its_own():
    law = HuntCrossley(np.array([1e3, 1e5]), np.array([0.1, 0.02]))
    both = simulate(law, 1.0, 0.4, -3.0, 3)
    for k in range(2):
        one = simulate(law[k], 1.0, 0.4, -3.0, 3)
        np.testing.assert_allclose(both.time[:, k], one.time, rtol=1e-11)


def test_what_is_refused():
    with pytest.raises(ModelError, match="Λ"):
        simulate(LAWS[0], -1.0, 0.0, -2.0, 2)
    with pytest.raises(ModelError, match="rises from the table"):
        simulate(LAWS[0], 1.0, 0.0, 2.0, 2)
    assert np.isfinite(law_cycle(LAWS[1], 1.0, 0.0, -2.0).time)

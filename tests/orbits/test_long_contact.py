"""Windows of the orbits with a long contact: an independent scan, their ends, and limits."""

import numpy as np
import pytest

from bouncing_ball.contacts.damping import damping_ratio
from bouncing_ball.contacts.permanent_contact import permanent_contact_threshold
from bouncing_ball.contacts.spring_damper import Release, SpringDamper
from bouncing_ball.errors import ModelError
from bouncing_ball.orbits.long_contact import (
    End,
    joined,
    joining_ratio,
    orbit_with_flight,
    stable_window,
    stiff_limit,
)
from bouncing_ball.orbits.spring_damper_model import SpringDamperModel

RATIOS = np.array([1.2, 2.0, 5.0, 10.0])


def contact(r, ratio, release=Release.DISPLACEMENT):
    return SpringDamper.from_restitution(r, ratio, release)


@pytest.fixture(scope="module")
def window():
    """The windows at r = 0.85, of contacts with each kind of end."""
    return stable_window(contact(0.85, RATIOS))


def test_windows_found_by_another_program(window):
    """A referee's program found the ends by simulations at steps in Λ, hence to such a step."""
    begins = SpringDamperModel(contact(0.85, RATIOS)).permanent_contact_threshold()
    assert begins == pytest.approx([0.3175, 0.7518, 0.9602, 0.9901], abs=1e-4)
    assert window.amplitude == pytest.approx([0.3342, 1.0955, 1.0054, 1.042], abs=2e-3)


def test_each_end_is_what_it_is_called(window):
    assert window.end.tolist() == [
        End.SADDLE_NODE, End.PERIOD_DOUBLING, End.PERIOD_DOUBLING, End.CONTACT,
    ]  # fmt: skip
    orbit = orbit_with_flight(contact(0.85, RATIOS), window.flight_time)
    trace, det = orbit.trace_and_determinant()
    assert abs(1 - trace + det)[0] < 1e-10
    assert abs(1 + trace + det)[1:3] == pytest.approx(0, abs=1e-10)
    # A saddle-node is the greatest Λ; a contact that grazes comes back to the table's level.
    steps = np.array([-1e-4, 0.0, 1e-4])
    near = orbit_with_flight(contact(0.85, 1.2), window.flight_time[0] + steps).amplitude
    assert near[1] > near[0] and near[1] > near[2]
    # Weakly damped, where both multipliers are far from 0.
    weak = contact(0.99, np.array([6.0]))
    end = stable_window(weak)
    assert end.end.tolist() == [End.CONTACT]
    for grazing in (orbit[3], orbit_with_flight(weak, end.flight_time)[0]):
        time = np.linspace(0, float(grazing.contact_duration), 20_001)[200:-200]
        gap = grazing.contact_path(time)[0] - grazing.amplitude * np.sin(grazing.phase + time)
        depth = -gap.min()
        assert -1e-6 * depth < gap.max() < 1e-9 * depth


def test_balls_find_the_orbit_inside_the_window_and_none_beyond(window):
    law = contact(0.85, RATIOS)
    model, last = SpringDamperModel(law), orbit_with_flight(law, window.flight_time)
    begin = model.permanent_contact_threshold()
    inside = orbit_with_flight(law, 0.8 * window.flight_time)
    assert ((begin < inside.amplitude) & (inside.amplitude < window.amplitude)).all()
    # Beyond the end, by a tenth of the width, a ball that was on the orbit leaves it.
    beyond = window.amplitude + 0.1 * (window.amplitude - begin)
    both = model.simulate(
        np.stack([inside.amplitude, beyond]),
        np.stack([inside.phase, last.phase]) + 1e-6,
        np.stack([inside.impact_velocity, last.impact_velocity]),
        200,
    )
    lasts = both.contact_duration[-20:]
    assert lasts[:, 0] == pytest.approx(np.tile(inside.contact_duration, (20, 1)), rel=1e-7)
    away = np.abs(lasts[:, 1] - last.contact_duration)
    assert (away.max(axis=0) > 0.1).all()


def test_every_damped_contact_has_a_window():
    r, ratio = (
        np.ravel(x)
        for x in np.meshgrid([0.3, 0.5, 0.65, 0.85, 0.95, 0.99], np.geomspace(1.05, 100, 13))
    )
    law = SpringDamper(ratio, damping_ratio(r))
    found = stable_window(law)
    assert (found.end != End.NONE).all() and (found.flight_time > 0).all()
    assert (found.amplitude > SpringDamperModel(law).permanent_contact_threshold()).all()


@pytest.mark.parametrize("r", [0.3, 0.65, 0.85, 0.95])
def test_the_stiff_limit_is_reached_with_the_square_of_the_ratio(r):
    ratio = np.array([100.0, 200.0])
    zeta = float(damping_ratio(r))
    threshold = permanent_contact_threshold(ratio, zeta)
    width = ratio**2 * (stable_window(contact(r, ratio)).amplitude - threshold)
    off = stiff_limit(zeta) - width
    assert 0 < off[1] < 0.002 * stiff_limit(zeta)
    # But for the weak oscillation that is left when the ball leaves again.
    assert off[0] / off[1] == pytest.approx(4, abs=0.5)


@pytest.mark.parametrize("zeta", [0.0, 0.95, np.nan])
def test_without_an_oscillation_that_dies_out_there_is_no_stiff_limit(zeta):
    with pytest.raises(ModelError, match="is not in"):
        stiff_limit(zeta)


@pytest.mark.parametrize(("r", "parting"), [(0.85, 2.003), (0.65, 2.107)])
def test_the_families_part_where_another_program_found_it(r, parting):
    zeta = float(damping_ratio(r))
    found = joining_ratio(zeta, Release.DISPLACEMENT, 1.9, 4.0)
    assert found == pytest.approx(parting, abs=1e-3)
    assert joined(contact(r, found + np.array([-0.01, 0.01]))).tolist() == [True, False]


def test_no_parting_where_it_is_not_looked_for():
    zeta = float(damping_ratio(0.85))
    for low, high in ((1.5, 1.9), (2.1, 4.0)):
        assert np.isnan(joining_ratio(zeta, Release.DISPLACEMENT, low, high))
    # No saddle-node, so that there is nothing to join; and one beside it that is apart.
    both = SpringDamper(np.array([1.2, 3.0]), damping_ratio(np.array([0.3, 0.85])))
    assert joined(both).tolist() == [False, False]


def test_the_other_release_is_an_answer_too():
    found = stable_window(contact(0.85, RATIOS, Release.FORCE))
    assert ((found.end == End.NONE) == np.isnan(found.amplitude)).all()

"""MuJoCo's impedance as a contact law: it keeps what beyond's tests ask of every law and model.

What beyond asks of a law that shares the load, with a law of its own, is asked of the impedance
too: its tests are called with the impedance in its place.
"""

import numpy as np
import pytest
import test_collocation
import test_law_orbits
import test_laws
import test_models
import test_signature
import test_steady_contact
from bouncing_ball_beyond.models.contact_model import ContactModel
from bouncing_ball_beyond.models.laws.collocation import contacts
from bouncing_ball_beyond.models.laws.law_of_impact import law_of_impact
from bouncing_ball_beyond.models.laws.loaded import under
from bouncing_ball_beyond.models.laws.scales import rest
from bouncing_ball_beyond.models.laws.steady_contact import permanent_contact
from bouncing_ball_beyond.periodic.orbits.stability import Side
from bouncing_ball_contacts.engines.impedance import Impedance
from bouncing_ball_contacts.engines.laws import LAWS
from loaded_laws import Sharing

from bouncing_ball.errors import ModelError

IMPEDANCES = {
    "impedance": Impedance(10.0, 0.136),
    "weak": Impedance(3.0, 0.05, 0.5),
    "by depth": Impedance(10.0, 0.136, 0.95, 0.5, width=0.2),
    "by depth and deep": Impedance(
        10.0, 0.05, share=0.6, at_surface=0.2, width=0.05, midpoint=0.3, power=3.0
    ),
}
# Other parameters: weekly.
SELDOM = ("weak", "by depth and deep")
every_impedance = pytest.mark.parametrize(
    "law",
    [
        pytest.param(law, id=name, marks=[pytest.mark.long] if name in SELDOM else [])
        for name, law in IMPEDANCES.items()
    ],
)


@every_impedance
@pytest.mark.parametrize(
    "check",
    [
        test_laws.test_the_end_of_a_contact_agrees_with_an_independent_integrator,
        test_laws.test_the_derivatives_of_the_end_agree_with_differences,
        test_laws.test_the_contraction_is_that_of_the_flow,
        test_laws.test_the_force_does_the_work_and_the_release_is_the_first,
        test_laws.test_the_delay_and_the_load_are_those_of_the_continued_flights,
        test_laws.test_the_tabulated_signature_is_the_impact_itself,
    ],
)
def test_an_impedance_keeps_the_contract_of_laws(check, law):
    check(law)


@every_impedance
def test_an_impact_of_a_simulation_is_the_contact(law, monkeypatch):
    # Of contacts that do not end fewer oscillations are followed, more than orbits have.
    monkeypatch.setattr("bouncing_ball_beyond.models.laws.motion.MOST_PANELS", 200)
    test_laws.test_an_impact_of_a_simulation_is_the_contact(law, None)


@pytest.mark.long
@pytest.mark.parametrize("side", list(Side))
@pytest.mark.parametrize("case", test_models.CASES)
@pytest.mark.parametrize(
    "check",
    [
        test_models.test_an_orbit_solves_its_equations,
        test_models.test_the_jacobian_is_the_derivative_of_the_equations,
        test_models.test_an_orbit_is_a_fixed_point_of_the_simulation,
        test_models.test_the_monodromy_is_the_jacobian_of_the_simulated_map,
        test_models.test_the_determinant_is_the_contraction,
        test_models.test_the_path_is_continuous_and_closed,
        test_models.test_the_ball_is_held_in_contact_and_above_the_table_in_flight,
    ],
)
def test_a_ball_on_an_impedance_keeps_the_contract_of_models(check, case, side, monkeypatch):
    n, above = case
    model = ContactModel(Impedance(15.0, 0.1))
    monkeypatch.setitem(test_models.MODELS, "impedance", model)
    monkeypatch.setitem(test_models.EXACT, "impedance", 1e-12)
    monkeypatch.setitem(test_models.SIMULATED, "impedance", 1e-11)
    check(("impedance", model, n, test_models.some_orbit("impedance", n, above, side)))


@pytest.fixture
def shared_by_mujoco(monkeypatch):
    """The tests of beyond have the impedance in place of their own law that shares the load."""
    for module in (test_collocation, test_law_orbits, test_laws, test_steady_contact):
        monkeypatch.setattr(module, "Sharing", Impedance)
    monkeypatch.setitem(test_law_orbits.LAWS, "impedance", Impedance)


def test_a_load_holds_an_undamped_impedance_up_to_the_level(shared_by_mujoco):
    test_collocation.test_a_shared_load_holds_an_undamped_ball_up_to_the_level()


def test_contacts_of_a_ball_coming_to_rest_end_despite_rounding(shared_by_mujoco):
    test_collocation.test_contacts_of_a_ball_coming_to_rest_end_despite_rounding()


@pytest.mark.parametrize(("zeta", "angle"), [(1.0, 2.0), (1.25, 8 / 3 * np.log(2))])
def test_an_impedance_without_oscillation_releases_the_ball(zeta, angle):
    # ϖD = 2 arcosh ζ/√(ζ² - 1) and r = exp(-ζϖD), and σ_d as for ζ < 1.
    omega = 50.0
    d = 0.95
    r = np.exp(-zeta * angle)
    impact = Impedance(omega, zeta, d).signature(1.0)
    lag = 2 * zeta / omega
    load = (1 - r) * angle / omega - (2 - d) * lag * r
    expected = [r * (angle / omega + lag) / (1 + r), r, load, angle / omega]
    assert impact[:4] == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize("until", [None, np.ones(1)], ids=["release", "time"])
def test_newtons_slopes_at_the_end_of_a_panel_are_the_derivatives_along_the_motion(until):
    name = "test_newtons_slopes_at_the_end_of_a_panel_are_the_derivatives_along_the_motion"
    getattr(test_collocation, name)(Impedance(3.0, 0.1, 0.9, 0.5, width=0.5), until)


def test_a_varying_impedance_does_not_depend_on_its_neighbours_in_the_row():
    # At x = 1/4 of the width d is x²/c = 1/8 of the way up, with c = 1/2, if it varies.
    law = Impedance(2.0, 0.5, 0.75, np.array([0.25, 0.75]), width=4.0)
    assert law.has_kink and law.impedance(np.ones(2)).tolist() == [0.3125, 0.75]
    # Below both kinks, at p = 5, a ball that was above the midpoint has passed a kink.
    assert law.continued(np.zeros(2), np.ones(2)).kink(np.full(2, 5.0), 0.0).tolist() == [-3.0, 1.0]


def test_an_impedance_outside_its_range_is_refused():
    for wrong in ({"midpoint": 0.0}, {"midpoint": 1.0}, {"share": 1.0}, {"power": 0.9}):
        with pytest.raises(ModelError, match=f"= {max(wrong.values())} is not"):
            Impedance(2.0, 0.5, **wrong)


def test_a_steady_contact_has_the_threshold_of_the_closed_form():
    law = Impedance(5.0, 0.2, 0.3)
    found = test_steady_contact._touching(law, True)
    assert found == pytest.approx(permanent_contact(law), rel=1e-10)


def test_the_grip_changes_at_the_rate_that_depth_speed_and_load_give_it(shared_by_mujoco):
    test_steady_contact.test_the_grip_changes_at_the_rate_that_depth_speed_and_load_give_it()


def test_an_impedance_by_depth_touches_the_surface_at_its_threshold(shared_by_mujoco):
    test_steady_contact.test_a_share_by_depth_touches_the_surface_at_its_threshold()


def test_a_contact_that_ends_at_the_level_does_not_resume_within_a_rounding_error():
    """Where an impedance lets the contact end at p = 0, the force that is left is positive."""
    phase, fall = np.random.default_rng(0).uniform([[-3], [1.5]], [[3], [5]], (2, 500))
    run = Impedance(30.0, 0.05, 0.95).dynamics(1.0).simulate(phase, -fall - 1, 40)
    assert np.sum(run.release_displacement == 0) > 500
    assert not np.any((run.displacement < 0) & (run.displacement > -1e-15))


def test_between_its_nodes_a_signature_is_that_of_free_impacts():
    # Of a law with kinks whose r depends on the speed.
    law = IMPEDANCES["by depth"]
    test_signature.test_between_its_nodes_a_signature_is_that_of_free_impacts(law, 1e-6)


def test_a_users_law_that_shares_the_load_is_the_impedance_if_it_is_constant():
    law = Sharing(3.0, 0.2, 0.6)
    known = Impedance(3.0, 0.2, 0.6)
    # Some contacts end at the surface and some where the force vanishes.
    speed = np.linspace(0.02, 4.0, 40)
    phase = np.linspace(-3.0, 3.0, 40)
    found, exact = (contacts(one, speed, phase, 1.3) for one in (law, known))
    assert 0 < np.count_nonzero(exact.penetration == 0) < 40
    np.testing.assert_allclose(found.duration, exact.duration, rtol=1e-12)
    np.testing.assert_allclose(found.rate, exact.rate, rtol=1e-11)
    assert rest(law) == pytest.approx(rest(known), rel=1e-12)
    assert permanent_contact(law) == pytest.approx(permanent_contact(known), rel=1e-10)


def test_an_impedance_under_a_load_keeps_its_parameters():
    law = Impedance(3.0, 0.2, 0.6)
    loaded = under(law, 2.0)
    assert loaded == law and loaded.force(1.0, 0.0) == pytest.approx(9.0 + 0.6 * 2.0)
    assert law.force(1.0, 0.0) == pytest.approx(9.0)


@pytest.mark.parametrize("width", [1e-9, 1e-5, 0.1])
def test_a_ball_at_rest_on_a_stiff_impedance_is_held_by_force_and_load(width):
    law = Impedance(3e4, 0.1, 0.9, 0.2, width=width)
    depth = np.array(rest(law))
    assert float(under(law, 1.0).force(depth, np.array(0.0))) == pytest.approx(1.0, abs=1e-14)


@pytest.mark.parametrize(
    ("surface", "amplitude", "phase", "speed"),
    [(0.95, 5.0, 0.8, 0.2), (0.9, 4.947126015, 0.807671628, 0.19328047), (0.9, 3.0, 1.5, 0.01)],
)
def test_a_ball_that_the_load_pulls_away_meets_no_force_at_the_surface(
    shared_by_mujoco, surface, amplitude, phase, speed
):
    check = test_laws.test_a_ball_that_the_load_pulls_away_meets_no_force_at_the_surface
    check(surface, amplitude, phase, speed)


@pytest.mark.parametrize(
    "law",
    [
        IMPEDANCES["impedance"],
        IMPEDANCES["by depth"],
        Impedance(10.0, 5e-5, 0.95, 0.5, width=0.2),
        Impedance(10.0, 0.0, 0.95, 0.5, width=0.2),
    ],
)
def test_an_impedance_of_twice_the_stiffness_pushes_a_ball_at_rest_twice_as_hard(law):
    test_laws.test_a_law_of_twice_the_stiffness_pushes_a_ball_at_rest_twice_as_hard(law)


@pytest.mark.parametrize("name", ["impedance", "by depth"])
def test_the_corrected_model_and_the_error_law_leave_errors_of_second_order(shared_by_mujoco, name):
    check = test_law_orbits.test_the_corrected_model_and_the_error_law_leave_errors_of_second_order
    check(name)


def test_an_impedance_has_the_restitution_and_duration_that_were_asked_for():
    test_law_orbits.test_a_law_has_the_restitution_and_duration_that_were_asked_for(Impedance)


@pytest.mark.parametrize("value", ["x", "2.0", True, [[1.0], [2.0, 3.0]]])
def test_a_parameter_of_an_impedance_that_is_no_number_is_refused(value, refusal):
    test_law_orbits.test_a_parameter_of_a_law_that_is_no_number_is_refused(
        Impedance, value, refusal
    )


def test_with_its_units_a_named_law_has_the_same_force_in_other_units():
    assert LAWS["impedance"] is Impedance
    law = law_of_impact(Impedance, 0.7, 0.1, 3.0)
    length, time = 0.7, 1.3
    other = Impedance(**law.in_si(1.0, length, time))
    force = law.force(np.float64(0.02), np.float64(-0.5))
    scaled = other.force(np.float64(0.02 * length), np.float64(-0.5 * length / time))
    assert scaled == pytest.approx(force * length / time**2, rel=1e-13)
